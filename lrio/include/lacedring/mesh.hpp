#pragma once
// A triangle mesh as read from a file: an index list, and attributes with unchanged bits.

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
    /// glTF's name (POSITION, NORMAL, TEXCOORD_0, COLOR_0, ...) if one fits, else the file's own.
    std::string name;
    ComponentType type = ComponentType::f32;
    std::uint8_t components = 3;
    bool normalized = false;  ///< integers represent [0,1] or [-1,1]
    std::vector<std::byte> data;
    /// Texture coordinates: v = 0 is the image's lower edge (OBJ), not the upper edge (glTF).
    bool v_up = false;

    std::size_t stride() const { return size_of(type) * components; }
};

/// Indices into vertices, and the attributes of the vertices.
/// Readers guarantee: indices.size() is a multiple of 3, every index < vertex_count, attribute sizes fit vertex_count,
/// attributes[0] is POSITION (f32 or f64, 3 components, finite). Degenerate triangles may be present.
struct Mesh {
    std::uint32_t vertex_count = 0;
    std::vector<std::uint32_t> indices;  ///< 3 per triangle, in the file's order and orientation
    std::vector<Attribute> attributes;

    std::size_t triangle_count() const { return indices.size() / 3; }
};

/// The attribute named `name`, or nullptr.
const Attribute* find_attribute(const Mesh& mesh, std::string_view name);

/// A view of the mesh's POSITION (f32 or f64); empty if it has none with three components.
Positions positions_of(const Mesh& mesh);

/// Positions as 3 floats a vertex (f64 is rounded). Cost: O(V).
std::vector<float> positions_f32(const Mesh& mesh);

/// Unit normals, 3 floats a vertex: the mesh's NORMAL if it has one (f32), else area-weighted from the triangles.
/// A vertex without a normal gets (0,0,1). Cost: O(V + T).
std::vector<float> normals_f32(const Mesh& mesh);

/// Reorders attributes: element i of the result is element order[i]. `order` may also select or repeat elements.
std::vector<Attribute> permute_attributes(std::span<const Attribute> attributes, std::span<const std::uint32_t> order);

}  // namespace lacedring
