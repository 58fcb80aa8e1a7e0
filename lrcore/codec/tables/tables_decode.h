#pragma once
// Decodes one or all triangles of LR tables. Internal to codec/.

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

#include "lacedring/operators.hpp"
#include "lacedring/streams.hpp"

namespace lacedring::detail {

template <class View>
std::uint32_t count_triangles(const LrStreamView<View>& stream) {
    const Operators<View> ops(stream.view);
    std::uint32_t count = 0;
    for (std::uint32_t t = 0; t < stream.view.triangle_numbers(); ++t) count += ops.is_canonical(TriangleId{t}) ? 1 : 0;
    return count;
}

/// Triangle t with the input's orientation; its vertices may be copies.
template <class View>
Triangle table_triangle(const Operators<View>& ops, std::uint32_t t) {
    Triangle out{};
    for (std::uint32_t k = 0; k < 3; ++k) out.v[k] = ops.vertex(CornerId{4 * t + k}).value;
    if (ops.store().flipped(t)) std::swap(out.v[0], out.v[2]);
    return out;
}

/// The index of a corner's vertex in table_triangle's result.
template <class View>
std::uint32_t place_of(const View& view, CornerId c) {
    const std::uint32_t k = c.value % 4;
    return view.flipped(c.value / 4) ? 2 - k : k;
}

template <class View>
std::optional<Triangle> decode_slot(const LrStreamView<View>& stream, std::uint32_t t) {
    const Operators<View> ops(stream.view);
    if (!ops.is_canonical(TriangleId{t})) return std::nullopt;
    Triangle out = table_triangle(ops, t);
    for (std::uint32_t& v : out.v) v = stream.original(v);
    return out;
}

/// Writes three indices for each triangle.
template <class View>
void decode_tables(const LrStreamView<View>& stream, std::uint32_t* out) {
    const Operators<View> ops(stream.view);
    // Copies and originals are used vertices. Unused vertices get no entry: their number in the header is not
    // trustworthy.
    std::vector<std::uint32_t> original(stream.copies.empty() ? 0 : stream.view.used_vertices());
    std::iota(original.begin(), original.end(), 0U);
    for (std::size_t i = 0; i < stream.copies.size(); i += 2) original[stream.copies[i]] = stream.copies[i + 1];
    for (std::uint32_t t = 0; t < stream.view.triangle_numbers(); ++t) {
        if (!ops.is_canonical(TriangleId{t})) continue;
        for (const std::uint32_t v : table_triangle(ops, t).v) *out++ = original.empty() ? v : original[v];
    }
}

}  // namespace lacedring::detail
