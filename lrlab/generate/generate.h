#pragma once
// Procedural meshes of any size, for tests, measurements and demonstrations. The same arguments give the same bits on
// all machines: values are computed from integers with +, *, / and square roots of doubles, which IEEE 754 rounds
// exactly (no libm functions, no std distributions, no fused multiply-add).

#include <cstdint>
#include <span>
#include <string_view>

#include "lacedring/base.hpp"
#include "lacedring/mesh.hpp"

namespace lacedring {

struct GeneratorInfo {
    std::string_view name;         ///< the name on the command line
    std::string_view description;  ///< one line
};

/// All kinds of generated meshes:
/// sphere   closed, genus 0, nearly all valences 6; the seed is not used
/// torus    closed, genus 1, all valences 6; the seed is not used
/// genus    closed, connected, genus 2 + seed % 30: a plate with that many holes; smallest about 35 triangles a hole
/// terrain  a height field with an outer border and 2 to 16 holes, each with its own border loop
/// blob     closed, genus 0, valences 3 to 12 (random edge flips), bumpy; vertices and triangles in scan order
/// parts    unconnected small pieces: triangles, quads, strips, patches, fans, tetrahedra, octahedra, boxes
/// moebius  a strip with one half twist: one border loop, not orientable; the seed is not used
/// soup     all kinds of defects: edges of 3 and more triangles, bow-ties, duplicates, degenerate triangles, mixed
///          orientation, unused vertices, Moebius strips; random positions
std::span<const GeneratorInfo> generators();

/// Generates a mesh of about `triangles` triangles: at least the kind's minimum, and at most 2 % or 64 triangles too
/// many; for parts and soup exactly `triangles`. Attributes: POSITION f32. Cost: O(T) time; memory beside the mesh: 15
/// bytes a triangle for blob, else O(sqrt T). Errors: invalid_argument (kind, or more than 2^29 vertices), too_large
/// (memory).
Result<Mesh> generate(std::string_view kind, std::uint64_t triangles, std::uint64_t seed = 1);

}  // namespace lacedring
