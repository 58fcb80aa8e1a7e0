// Writes OBJ, with the shortest decimals that read back as the same floats.

#include <fmt/compile.h>
#include <fmt/format.h>

#include <cstring>
#include <iterator>

#include "lrio/mesh/read_formats.h"
#include "lrio/mesh/write_formats.h"

namespace lacedring::detail {
namespace {

/// The values of an attribute, written as the lines of a keyword.
struct Values {
    const Attribute* attribute = nullptr;
    bool turn_v = false;  ///< flip v of texture coordinates, which points up in OBJ

    /// Null unless the attribute has floats and `components` components.
    static Values of(const Mesh& mesh, std::string_view name, std::size_t components) {
        const Attribute* a = find_attribute(mesh, name);
        const bool fits = a != nullptr && a->components == components &&
                          (a->type == ComponentType::f32 || a->type == ComponentType::f64);
        return fits ? Values{a, name == "TEXCOORD_0" && !a->v_up} : Values{};
    }
    explicit operator bool() const { return attribute != nullptr; }

    void add(std::size_t v, fmt::memory_buffer& out) const {
        attribute->type == ComponentType::f32 ? add_as<float>(v, out) : add_as<double>(v, out);
    }

  private:
    template <class Real>
    void add_as(std::size_t v, fmt::memory_buffer& out) const {
        for (std::size_t i = 0; i < attribute->components; ++i) {
            Real value{};
            std::memcpy(&value, attribute->data.data() + (v * attribute->components + i) * sizeof(Real), sizeof(Real));
            if (turn_v && i == 1) value = Real{1} - value;
            fmt::format_to(std::back_inserter(out), FMT_COMPILE(" {}"), value);
        }
    }
};

void add_lines(std::string_view keyword, const Values& values, const Values& behind, std::size_t count,
               fmt::memory_buffer& out) {
    for (std::size_t v = 0; v < count && values; ++v) {
        out.append(keyword);
        values.add(v, out);
        if (behind) behind.add(v, out);
        out.push_back('\n');
    }
}

}  // namespace

void make_obj(const Mesh& mesh, Bytes& body, WriteNotes& notes) {
    fmt::memory_buffer out;
    out.append(std::string_view("# made by LacedRing\n"));
    const std::size_t count = mesh.vertex_count;
    const Values v = Values::of(mesh, "POSITION", 3), vt = Values::of(mesh, "TEXCOORD_0", 2),
                 vn = Values::of(mesh, "NORMAL", 3);
    Values colors = Values::of(mesh, "COLOR_0", 3);
    if (colors && colors.attribute->type != ComponentType::f32) colors = {};
    add_lines("v", v, colors, count, out);
    add_lines("vt", vt, {}, count, out);
    add_lines("vn", vn, {}, count, out);
    for (std::size_t i = 0; i < mesh.indices.size(); ++i) {
        const std::uint64_t number = std::uint64_t{mesh.indices[i]} + 1;
        if (i % 3 == 0) out.push_back('f');
        if (vt && vn) {
            fmt::format_to(std::back_inserter(out), FMT_COMPILE(" {}/{}/{}"), number, number, number);
        } else if (vt) {
            fmt::format_to(std::back_inserter(out), FMT_COMPILE(" {}/{}"), number, number);
        } else if (vn) {
            fmt::format_to(std::back_inserter(out), FMT_COMPILE(" {}//{}"), number, number);
        } else {
            fmt::format_to(std::back_inserter(out), FMT_COMPILE(" {}"), number);
        }
        if (i % 3 == 2) out.push_back('\n');
    }
    append(body, std::string_view(out.data(), out.size()));
    std::vector<std::string> dropped;
    for (const Attribute& a : mesh.attributes) {
        if (&a == v.attribute || &a == vt.attribute || &a == vn.attribute || &a == colors.attribute) continue;
        dropped.push_back(a.name);
    }
    if (!dropped.empty()) notes.push_back("OBJ has no place for " + shown_names(dropped) + ": left out");
}

}  // namespace lacedring::detail
