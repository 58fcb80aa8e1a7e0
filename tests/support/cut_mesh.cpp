#include "tests/support/cut_mesh.h"

#include <algorithm>
#include <cstring>

#include "tests/support/cuts.h"

namespace lacedring::test {
namespace {

template <class T>
void append(Attribute& attribute, T value) {
    const std::size_t at = attribute.data.size();
    attribute.data.resize(at + sizeof value);
    std::memcpy(attribute.data.data() + at, &value, sizeof value);
}

/// Returns whether the corner's triangle has three distinct vertices.
bool is_proper(const Mesh& mesh, std::size_t corner) {
    const std::uint32_t* t = &mesh.indices[corner / 3 * 3];
    return t[0] != t[1] && t[1] != t[2] && t[2] != t[0];
}

}  // namespace

CutMesh cut_mesh(const Mesh& whole, std::uint32_t how, std::uint64_t seed) {
    // The number of a copy serves as its chart: vertices do not share copies.
    const std::vector<std::uint32_t> charts = cut(whole.indices, whole.vertex_count, how, seed).copies;
    CutMesh out;
    out.surface.vertex_count = whole.vertex_count;
    std::vector<std::uint32_t>& vertex_of = out.surface.vertex_of;
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> numbers;  // by vertex and chart
    std::vector<std::uint32_t> chart_of;
    std::vector<bool> used(whole.vertex_count);
    const auto number = [&](std::uint32_t v, std::uint32_t chart) {
        const auto [found, is_new] = numbers.emplace(std::pair(v, chart), static_cast<std::uint32_t>(vertex_of.size()));
        if (is_new) {
            vertex_of.push_back(v);
            chart_of.push_back(chart);
        }
        used[v] = true;
        return found->second;
    };
    for (std::size_t c = 0; c < whole.indices.size(); ++c) {
        if (is_proper(whole, c)) number(whole.indices[c], charts[c]);
    }
    for (std::uint32_t v = 0; v < whole.vertex_count; ++v) {
        if (!used[v]) number(v, 0);
    }
    for (std::size_t i = 0; i < whole.indices.size(); ++i) {
        // Degenerate triangles have the first copies of their vertices.
        const std::uint32_t v = whole.indices[i];
        out.mesh.indices.push_back(
            (is_proper(whole, i) ? numbers.find({v, charts[i]}) : numbers.lower_bound({v, 0}))->second);
    }
    out.mesh.vertex_count = static_cast<std::uint32_t>(vertex_of.size());
    out.mesh.attributes = permute_attributes(std::span(whole.attributes).first(1), vertex_of);
    Attribute normal{"NORMAL", ComponentType::f32, 3, false, {}},
        texture{"TEXCOORD_0", ComponentType::f32, 2, false, {}}, color{"COLOR_0", ComponentType::u8, 3, true, {}},
        part{"part", ComponentType::u16, 1, false, {}};
    texture.v_up = true;
    for (std::uint32_t copy = 0; copy < vertex_of.size(); ++copy) {
        const std::uint32_t v = vertex_of[copy], chart = chart_of[copy];
        const float sign = chart % 2 == 0 ? 1.0F : -1.0F;
        for (const float value : {0.6F * sign, 0.8F, 0.0F * sign}) append(normal, value);
        append(texture, static_cast<float>(v) / 7.0F + static_cast<float>(chart));
        append(texture, v % 50 == 7 ? 0x7fc00000U + chart : 0x3f000000U);  // a NaN, compared by its bits
        for (const std::uint32_t value : {v, chart, v / 3}) append(color, static_cast<std::uint8_t>(value));
        append(part, static_cast<std::uint16_t>(v / 10));
    }
    out.mesh.attributes.insert(out.mesh.attributes.end(), {normal, texture, color, part});
    if (vertex_of.size() == whole.vertex_count) vertex_of.clear();
    return out;
}

std::vector<std::array<std::uint32_t, 3>> triangles_by_values(const Mesh& mesh, ValueNumbers& numbers) {
    std::vector<std::uint32_t> number;
    for (std::uint32_t v = 0; v < mesh.vertex_count; ++v) {
        std::string value;
        for (const Attribute& a : mesh.attributes) {
            value.append(reinterpret_cast<const char*>(a.data.data()) + a.stride() * v, a.stride());
        }
        number.push_back(numbers.emplace(std::move(value), static_cast<std::uint32_t>(numbers.size())).first->second);
    }
    std::vector<std::array<std::uint32_t, 3>> out;
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
        if (!is_proper(mesh, i)) continue;
        const std::uint32_t *t = &mesh.indices[i], a = number[t[0]], b = number[t[1]], c = number[t[2]];
        using Corners = std::array<std::uint32_t, 3>;
        out.push_back(std::min({Corners{a, b, c}, Corners{b, c, a}, Corners{c, a, b}}));
    }
    std::ranges::sort(out);
    return out;
}

bool same_partition(const std::vector<std::uint32_t>& a, const std::vector<std::uint32_t>& b) {
    if (a.size() != b.size()) return false;
    std::map<std::uint32_t, std::uint32_t> forth, back;
    for (std::size_t i = 0; i < a.size(); ++i) {
        if (forth.emplace(a[i], b[i]).first->second != b[i] || back.emplace(b[i], a[i]).first->second != a[i]) {
            return false;
        }
    }
    return true;
}

}  // namespace lacedring::test
