// Writes binary PLY with all attributes bit for bit. Comment lines keep what PLY cannot express (ply_header.h).

#include <cctype>
#include <cstring>
#include <string>

#include "lrio/mesh/ply_header.h"
#include "lrio/mesh/read_formats.h"
#include "lrio/mesh/write_formats.h"

namespace lacedring::detail {
namespace {

std::string_view ply_type(ComponentType type) {
    switch (type) {
        case ComponentType::i8:
            return "char";
        case ComponentType::u8:
            return "uchar";
        case ComponentType::i16:
            return "short";
        case ComponentType::u16:
            return "ushort";
        case ComponentType::i32:
            return "int";
        case ComponentType::u32:
            return "uint";
        case ComponentType::f32:
            return "float";
        case ComponentType::f64:
            break;
    }
    return "double";
}

/// The property names of an attribute: those that other programs know if there is one for each component.
std::vector<std::string> component_names(const Attribute& attribute) {
    std::vector<std::string> names;
    if (attribute.name == "POSITION") names = {"x", "y", "z"};
    if (attribute.name == "NORMAL") names = {"nx", "ny", "nz"};
    if (attribute.name == "TEXCOORD_0") names = {"s", "t"};
    if (attribute.name == "COLOR_0") names = {"red", "green", "blue", "alpha"};
    if (attribute.name == "COLOR_0" && attribute.components == 3) names.pop_back();
    if (names.size() == attribute.components) return names;
    names.clear();
    std::string base;
    for (const char c : attribute.name) base += std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '_';
    if (base.empty()) base.push_back('_');
    for (std::size_t i = 0; i < attribute.components; ++i) {
        names.push_back(attribute.components == 1 ? base : fmt::format("{}_{}", base, i));
    }
    return names;
}

std::string header(const Mesh& mesh, std::string_view index_type) {
    std::string out = "ply\nformat binary_little_endian 1.0\ncomment made by LacedRing\n";
    std::string properties;
    UniqueNames names;
    for (const Attribute& attribute : mesh.attributes) {
        out += fmt::format("comment {}{} {} {}\n", ply_note_prefix, attribute.components,
                           (attribute.normalized ? 1 : 0) + (attribute.v_up ? 2 : 0), escape_ply_name(attribute.name));
        for (const std::string& name : component_names(attribute)) {
            properties += fmt::format("property {} {}\n", ply_type(attribute.type), names.take(name));
        }
    }
    out += fmt::format("element vertex {}\n{}", mesh.vertex_count, properties);
    out += fmt::format("element face {}\nproperty list uchar {} vertex_indices\nend_header\n", mesh.triangle_count(),
                       index_type);
    return out;
}

}  // namespace

void make_ply(const Mesh& mesh, Bytes& head, Bytes& body) {
    append(head, header(mesh, mesh.vertex_count > INT32_MAX ? "uint" : "int"));
    std::size_t row = 0;
    for (const Attribute& attribute : mesh.attributes) row += attribute.stride();
    constexpr std::size_t face = 1 + 3 * sizeof(std::uint32_t);
    body.resize(row * mesh.vertex_count + face * mesh.triangle_count());
    std::size_t column = 0;
    for (const Attribute& attribute : mesh.attributes) {
        const std::size_t stride = attribute.stride();
        for (std::size_t v = 0; v < mesh.vertex_count; ++v) {
            std::memcpy(body.data() + v * row + column, attribute.data.data() + v * stride, stride);
        }
        column += stride;
    }
    std::byte* at = body.data() + row * mesh.vertex_count;
    for (std::size_t t = 0; t < mesh.triangle_count(); ++t, at += face) {
        *at = std::byte{3};
        std::memcpy(at + 1, mesh.indices.data() + t * 3, 3 * sizeof(std::uint32_t));
    }
}

}  // namespace lacedring::detail
