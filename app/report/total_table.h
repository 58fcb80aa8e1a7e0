#pragma once
// stats --table total: sizes of whole meshes (connectivity and attributes) beside rival formats, equally quantized.

#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "app/cli/command.h"
#include "lacedring/lr_file.hpp"
#include "lacedring/mesh.hpp"

namespace lacedring::app {

/// A mesh in one format.
struct TotalEntry {
    const char* name;
    std::size_t bytes = 0;
    std::optional<std::size_t> zstd, brotli;  ///< empty: built without the compressor
    bool random_access = false;
    std::vector<std::pair<std::string, double>> errors;  ///< largest error of each attribute
};

struct TotalTable {
    std::size_t triangles = 0, vertices = 0, copies = 0;  ///< in the packed file
    std::vector<TotalEntry> entries;
    std::vector<std::pair<std::string, std::string>> absent;  ///< name, reason
    /// The format that decoded to another mesh, and the difference; empty: none.
    std::string invalid;

    const TotalEntry* find(std::string_view name) const;
};

/// Makes the mesh in every format of the table. Errors: those of build_corner_table and make_file.
Result<TotalTable> make_total(const std::string& path, const Mesh& mesh, const Surface& surface, const RingChoice& ring,
                              const AttributeBits& bits, RunLog& log);

nlohmann::ordered_json to_json(const TotalTable& table);
/// Versions of the rivals' libraries.
nlohmann::ordered_json total_versions();
void print_total(const std::string& path, const TotalTable& table);
/// Prints medians over several meshes.
void print_medians(std::span<const TotalTable> tables);

}  // namespace lacedring::app
