#pragma once
// Figure 10 of LR 2011: the corner operators with resident memory limited.
//
// Each structure's arrays are written to a scratch file and mapped by a pager (lrlab/pager/paged_file.h) that limits
// resident memory, with the same policy for all. Vertex positions, the elements to visit and the results stay in
// memory: only connectivity is limited.

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <utility>
#include <vector>

#include "lacedring/base.hpp"
#include "lacedring/mesh.hpp"
#include "lacedring/topology.hpp"

namespace lacedring::app {

struct ResidentOptions {
    std::string scratch;           ///< folder of the scratch files; "": the system's
    std::uint32_t sample = 10000;  ///< elements in a random-order visit
    /// Limits as multiples of the corner table's size. The sizes of LR, of bit-efficient LR, and half that of LR are
    /// added.
    std::vector<double> levels = {1.25, 1, 0.75, 0.5, 0.375, 0.25, 0.1875, 0.125};
    std::size_t page_kib = 0;  ///< 0: chosen by the mesh's size, mostly 32
    int rounds = 5;
};

struct ResidentFigures {
    struct Cell {
        double ns_per_op = 0;     ///< median of the rounds
        double pages_per_op = 0;  ///< read from the file, mean of the rounds
    };
    struct Structure {
        std::string name;
        std::size_t bytes = 0;  ///< size of its file
        bool direct = true;     ///< reads reach the disk (PagedFile::direct)
    };
    struct Level {
        std::size_t limit_bytes = 0;
        double corner_tables = 0;  ///< the limit in corner tables
        /// Per structure: most bytes of its mapping in memory after any operator, as the system reports.
        std::vector<std::size_t> resident_bytes;
        std::vector<std::vector<Cell>> cells;  ///< [structure][operator]
    };
    std::size_t page_bytes = 0, contour_triangles = 0;
    std::uint32_t sample = 0;
    /// Structures in the order corner_table, squad, lr, lr_compact; without those that are absent.
    std::vector<Structure> structures;
    std::vector<std::pair<std::string, std::string>> absent;  ///< structure, reason
    std::vector<Level> levels;                                ///< largest limit first
};

/// Times, for every structure and limit: sequential loops in the structure's own order, after an untimed loop unless
/// everything fits; random-order visits of a sample of elements, the same for all structures, after untimed visits of
/// other samples; contours of parallel planes, the same for all structures. Structures take turns. Degenerate
/// triangles are left out. Errors: cannot_write (scratch), those of the builders, invalid_argument if two structures
/// disagree on a result.
Result<ResidentFigures> measure_resident(const Mesh& mesh, CornerTable table, const ResidentOptions& options);

/// The output of bench: text, or JSON.
void print_resident(const ResidentFigures& figures);
nlohmann::ordered_json to_json(const ResidentFigures& figures);

}  // namespace lacedring::app
