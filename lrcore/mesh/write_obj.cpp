// OBJ in the shortest decimals that read back as the same floats.

#include <fmt/compile.h>
#include <fmt/format.h>

#include <cstring>
#include <iterator>

#include "lrcore/mesh/write_formats.h"

namespace lr::detail {
namespace {

template <class Real>
void add_values(std::string_view keyword, const Attribute& attribute, std::size_t count, fmt::memory_buffer& out) {
    for (std::size_t v = 0; v < count; ++v) {
        out.append(keyword);
        for (std::size_t i = 0; i < attribute.components; ++i) {
            Real value{};
            std::memcpy(&value, attribute.data.data() + (v * attribute.components + i) * sizeof(Real), sizeof(Real));
            fmt::format_to(std::back_inserter(out), FMT_COMPILE(" {}"), value);
        }
        out.push_back('\n');
    }
}

/// Floats of the right number of components, or nothing is written.
bool add_attribute(std::string_view keyword, const Attribute* attribute, std::size_t components, std::size_t count,
                   fmt::memory_buffer& out) {
    if (attribute == nullptr || attribute->components != components) return false;
    if (attribute->type == ComponentType::f32) {
        add_values<float>(keyword, *attribute, count, out);
    } else if (attribute->type == ComponentType::f64) {
        add_values<double>(keyword, *attribute, count, out);
    } else {
        return false;
    }
    return true;
}

}  // namespace

void make_obj(const Mesh& mesh, Bytes& body) {
    fmt::memory_buffer out;
    out.append(std::string_view("# made by LacedRing\n"));
    const std::size_t count = mesh.vertex_count;
    add_attribute("v", &mesh.attributes.front(), 3, count, out);
    const bool vt = add_attribute("vt", find_attribute(mesh, "TEXCOORD_0"), 2, count, out);
    const bool vn = add_attribute("vn", find_attribute(mesh, "NORMAL"), 3, count, out);
    for (std::size_t i = 0; i < mesh.indices.size(); ++i) {
        const std::uint64_t v = std::uint64_t{mesh.indices[i]} + 1;
        if (i % 3 == 0) out.push_back('f');
        if (vt && vn) {
            fmt::format_to(std::back_inserter(out), FMT_COMPILE(" {}/{}/{}"), v, v, v);
        } else if (vt) {
            fmt::format_to(std::back_inserter(out), FMT_COMPILE(" {}/{}"), v, v);
        } else if (vn) {
            fmt::format_to(std::back_inserter(out), FMT_COMPILE(" {}//{}"), v, v);
        } else {
            fmt::format_to(std::back_inserter(out), FMT_COMPILE(" {}"), v);
        }
        if (i % 3 == 2) out.push_back('\n');
    }
    append(body, std::string_view(out.data(), out.size()));
}

}  // namespace lr::detail
