#pragma once
// A triangle mesh as its file gives it: an index list, and attributes whose bits are never changed.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "lacedring/topology.hpp"
#include "lacedring/vertices.hpp"

namespace lacedring {

/// One value per vertex. `data` holds vertex_count * components values, little-endian, tightly packed.
struct Attribute {
    std::string name;  ///< glTF's (POSITION, NORMAL, TEXCOORD_0, COLOR_0, ...) where one fits, else the file's own
    ComponentType type = ComponentType::f32;
    std::uint8_t components = 3;
    bool normalized = false;  ///< integers stand for [0,1] or [-1,1]
    std::vector<std::byte> data;
    bool v_up = false;  ///< of texture coordinates: v is 0 at the image's lower edge (OBJ), not at its upper one (glTF)

    std::size_t stride() const { return size_of(type) * components; }
};

/// Indices into vertices, and the attributes of the vertices.
/// Invariant after a reader returned it: indices.size() is a multiple of 3, every index < vertex_count, attribute sizes
/// fit vertex_count, attributes[0] is POSITION (f32 or f64, 3 components, finite). Degenerate triangles may be present.
struct Mesh {
    std::uint32_t vertex_count = 0;
    std::vector<std::uint32_t> indices;  ///< 3 per triangle, in the file's order and orientation
    std::vector<Attribute> attributes;

    std::size_t triangle_count() const { return indices.size() / 3; }
};

/// The attribute of that name, or nullptr.
const Attribute* find_attribute(const Mesh& mesh, std::string_view name);

/// The mesh's POSITION, f32 or f64, without a copy; empty where it has none of three components.
Positions positions_of(const Mesh& mesh);

/// Positions as 3 floats a vertex (f64 is rounded). Cost: O(V).
std::vector<float> positions_f32(const Mesh& mesh);

/// Unit normals, 3 floats a vertex: the file's NORMAL where it has one (f32), else area-weighted from the triangles.
/// A vertex without a normal gets (0,0,1). Cost: O(V + T).
std::vector<float> normals_f32(const Mesh& mesh);

/// The same mesh with its vertices renumbered: new vertex i is old vertex order[i].
/// `order` is a permutation of 0..vertex_count-1; indices are left as they are, for the caller to replace.
std::vector<Attribute> permute_attributes(std::span<const Attribute> attributes, std::span<const std::uint32_t> order);

}  // namespace lacedring
