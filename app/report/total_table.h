#pragma once
// stats --table total: whole meshes, connectivity and attributes, beside others at the same quantization.

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
    std::optional<std::size_t> zstd, brotli;  ///< none in a build without
    bool random_access = false;
    std::vector<std::pair<std::string, double>> errors;  ///< largest one of each attribute
};

struct TotalTable {
    std::size_t triangles = 0, vertices = 0, copies = 0;  ///< that the packed file has
    std::vector<TotalEntry> entries;
    std::vector<std::pair<std::string, std::string>> absent;  ///< name, reason
    std::string invalid;  ///< a format that decoded to another mesh, and in what; empty if none

    const TotalEntry* find(std::string_view name) const;
};

/// Makes every format of NAME in docs/command-line.md. Errors: those of build_corner_table and make_file.
Result<TotalTable> make_total(const std::string& path, const Mesh& mesh, const Surface& surface, const RingChoice& ring,
                              const AttributeBits& bits, RunLog& log);

nlohmann::ordered_json to_json(const TotalTable& table);
/// Versions of what it compares with.
nlohmann::ordered_json total_versions();
void print_total(const std::string& path, const TotalTable& table);
/// Medians over several meshes.
void print_medians(std::span<const TotalTable> tables);

}  // namespace lacedring::app
