#pragma once
// Figure 10 of LR 2011: the corner operators with resident memory limited.
//
// Each structure's arrays are written to a scratch file and mapped by a pager (lrlab/pager/paged_file.h) that keeps to
// a limit, with the same policy for all. Vertex positions, the elements to visit and the results stay in memory: the
// limit is on connectivity alone.

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <utility>
#include <vector>

#include "lacedring/base.hpp"
#include "lacedring/mesh.hpp"
#include "lacedring/topology.hpp"

namespace lacedring::app {

struct ResidentOptions {
    std::string scratch;           ///< folder of the scratch files; "": the system's for temporary files
    std::uint32_t sample = 10000;  ///< elements of each kind that a random-order visit takes
    /// Limits, as shares of the corner table's bytes. The sizes of LR and of bit-efficient LR, and half of LR's are
    /// added.
    std::vector<double> levels = {1.25, 1, 0.75, 0.5, 0.375, 0.25, 0.1875, 0.125};
    std::size_t page_kib = 0;  ///< of the pager; 0: 32, less for small meshes, more for very large ones
    int rounds = 5;
};

struct ResidentFigures {
    struct Cell {
        double ns_per_op = 0;     ///< median of the rounds
        double pages_per_op = 0;  ///< read from the file, mean of the rounds
    };
    struct Structure {
        std::string name;
        std::size_t bytes = 0;  ///< of its file
        bool direct = true;     ///< reads reach the disk (PagedFile::direct)
    };
    struct Level {
        std::size_t limit_bytes = 0;
        double corner_tables = 0;  ///< the limit in corner tables
        /// The most bytes of its mapping that were in memory after any operator, as the system says; each structure.
        std::vector<std::size_t> resident_bytes;
        std::vector<std::vector<Cell>> cells;  ///< [structure][operator]
    };
    std::size_t page_bytes = 0, contour_triangles = 0;
    std::uint32_t sample = 0;
    std::vector<Structure> structures;  ///< corner_table, squad, lr, lr_compact; without the absent ones
    std::vector<std::pair<std::string, std::string>> absent;  ///< structure, reason
    std::vector<Level> levels;                                ///< largest limit first
};

/// Sequential loops in the structure's own order, each after an untimed one unless everything fits; random-order visits
/// of the same sample of elements in the same order by every structure, after others untimed; contours of
/// parallel planes, the same ones in the same order. Degenerate triangles are left out. Structures take turns.
/// Errors: cannot_write (scratch), those of the builders, invalid_argument if two structures disagree on a result.
Result<ResidentFigures> measure_resident(const Mesh& mesh, CornerTable table, const ResidentOptions& options);

/// What bench prints, and its JSON.
void print_resident(const ResidentFigures& figures);
nlohmann::ordered_json to_json(const ResidentFigures& figures);

}  // namespace lacedring::app
