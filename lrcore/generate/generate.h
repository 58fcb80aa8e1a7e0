#pragma once
// Procedural meshes of any size, for tests, figures and a first look. The same arguments give the same bits everywhere.

#include <cstdint>
#include <span>
#include <string_view>

#include "lrcore/base/result.h"
#include "lrcore/mesh/mesh.h"

namespace lr {

struct GeneratorInfo {
    std::string_view name;         ///< as the command line spells it
    std::string_view description;  ///< one line
};

/// sphere, torus, genus, terrain, blob, parts, moebius, soup
std::span<const GeneratorInfo> generators();

/// About `triangles` triangles (at least the kind's smallest, never more than 2 % or 64 over).
/// Attributes: POSITION f32. Cost: O(T). Errors: invalid_argument (kind, or more than 2^29 vertices).
Result<Mesh> generate(std::string_view kind, std::uint64_t triangles, std::uint64_t seed = 1);

}  // namespace lr
