#include "lrcore/codec/packed/doubles.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <tuple>

#include "lacedring/streams.hpp"
#include "lrcore/base/bits.h"
#include "lrcore/codec/packed/packed_format.h"

namespace lacedring {
namespace {

// Minimum number of doubles: with fewer, the words that store them may outweigh the gain.
constexpr std::size_t kFewest = 32;

using Vertices = std::array<std::uint32_t, 3>;

/// The vertices in the mesh's order.
Vertices vertices_of(const CornerTable& table, std::uint32_t t) {
    Vertices v;
    for (std::uint32_t k = 0; k < 3; ++k) v[k] = table.vertex(corner(TriangleId{t}, k)).value;
    if (table.flipped(TriangleId{t})) std::swap(v[1], v[2]);
    return v;
}

/// Rotates the smallest vertex to the front. Triangles with the same vertices have the same orientation if the results
/// are equal.
Vertices leading_smallest(Vertices v) {
    std::rotate(v.begin(), std::min_element(v.begin(), v.end()), v.end());
    return v;
}

Vertices ascending(Vertices v) {
    std::sort(v.begin(), v.end());
    return v;
}

/// The triangles, sorted by their vertices; ties by number.
std::vector<std::uint32_t> by_vertices(const CornerTable& table, const std::vector<Vertices>& keys) {
    std::vector<std::uint32_t> order(keys.size()), sorted(keys.size());
    std::iota(order.begin(), order.end(), 0U);
    for (const std::size_t k : {2U, 1U, 0U}) {
        std::vector<std::uint32_t> at(std::size_t{table.vertex_count} + 1);
        for (const Vertices& v : keys) ++at[v[k] + 1];
        std::partial_sum(at.begin(), at.end(), at.begin());
        for (const std::uint32_t t : order) sorted[at[keys[t][k]]++] = t;
        std::swap(order, sorted);
    }
    return order;
}

}  // namespace

std::optional<Doubles> find_doubles(const CornerTable& table) {
    if (table.topology.nonmanifold_edges == 0) return {};
    Doubles out;
    {
        std::vector<Vertices> keys(table.triangle_count());
        for (std::uint32_t t = 0; t < keys.size(); ++t) keys[t] = ascending(vertices_of(table, t));
        const std::vector<std::uint32_t> order = by_vertices(table, keys);
        for (std::size_t i = 0, first = 0; i < order.size(); ++i) {
            if (keys[order[i]] != keys[order[first]]) first = i;
            if (i == first || table.degenerate(TriangleId{order[i]})) continue;
            const bool turned =
                leading_smallest(vertices_of(table, order[i])) != leading_smallest(vertices_of(table, order[first]));
            out.doubles.push_back({order[i], order[first], static_cast<std::uint32_t>(i - first), turned});
        }
    }
    // A stream has at most as many doubles as other triangles, so that a stream's size bounds the size of its decoded
    // triangles.
    out.doubles.resize(
        std::min<std::size_t>(out.doubles.size(), (table.triangle_count() - table.topology.degenerate) / 2));
    if (out.doubles.size() < kFewest) return {};

    const std::uint32_t count = table.triangle_count();
    BitVector is_double(count);
    for (const Doubles::Double& d : out.doubles) is_double.set(d.triangle);
    std::vector<std::uint32_t> indices;
    indices.reserve(3 * (count - out.doubles.size()));
    out.triangle.reserve(count - out.doubles.size());
    for (std::uint32_t t = 0; t < count; ++t) {
        if (is_double.test(t)) continue;
        out.triangle.push_back(t);
        const Vertices v = vertices_of(table, t);
        indices.insert(indices.end(), v.begin(), v.end());
    }
    out.table = *build_corner_table(indices, table.vertex_count);  // cannot fail: the mesh had more triangles
    return out;
}

void add_doubles(EncodedPacked& stream, const Doubles& doubles) {
    const auto own = static_cast<std::uint32_t>(stream.triangle_order.size());
    std::vector<std::uint32_t> place;  // index in the stream of each mesh triangle that is not a double
    for (std::uint32_t i = 0; i < own; ++i) {
        std::uint32_t& t = stream.triangle_order[i];
        t = doubles.triangle[t];
        if (t >= place.size()) place.resize(std::size_t{t} + 1);
        place[t] = i;
    }
    std::vector<Doubles::Double> sorted = doubles.doubles;
    for (Doubles::Double& d : sorted) d.of = place[d.of];
    std::sort(sorted.begin(), sorted.end(), [](const Doubles::Double& a, const Doubles::Double& b) {
        return std::tie(a.turn, a.of) < std::tie(b.turn, b.of);
    });

    std::vector<std::uint32_t> words{static_cast<std::uint32_t>(sorted.size()), 0};
    for (std::size_t i = 0; i < sorted.size(); ++i) {
        const Doubles::Double& d = sorted[i];
        stream.triangle_order.push_back(d.triangle);
        if (i > 0 && d.of == sorted[i - 1].of + 1 && d.turned == sorted[i - 1].turned) continue;
        words.push_back(own + static_cast<std::uint32_t>(i));
        words.push_back(d.of | (d.turned ? LR_PACKED_DOUBLES : 0));
        ++words[1];
    }
    const std::size_t at = view_packed(stream.words)->doubles_word();
    stream.words.insert(stream.words.begin() + static_cast<std::ptrdiff_t>(at), words.begin(), words.end());
    stream.words[LR_PACKED_WORD_VERTICES] |= LR_PACKED_DOUBLES;
    stream.words[LR_PACKED_WORD_CHECKSUM] = packed_checksum(stream.words);
    stream.statistics.doubles = static_cast<std::uint32_t>(sorted.size());
}

}  // namespace lacedring
