#include "lrcore/codec/storage/vertex_walk.h"

#include <algorithm>

namespace lacedring::storage {
namespace {

bool is_degenerate(const std::uint32_t* v) {
    return (v[0] == v[1]) | (v[1] == v[2]) | (v[2] == v[0]);
}

/// Makes triangles that follow each other neighbors.
void join_successive(std::span<const std::uint32_t> triangles, std::vector<std::uint32_t>& opposite) {
    constexpr std::uint8_t kAlone[8] = {3, 3, 3, 2, 3, 1, 0, 3};  // the one of three whose bit is 0
    bool before_is_good = false;
    for (std::size_t c = 0; c < opposite.size(); c += 3) {
        const std::uint32_t* v = triangles.data() + c;
        const bool is_good = !is_degenerate(v), both = is_good && before_is_good;
        before_is_good = is_good;
        if (!both) continue;
        const std::uint32_t p = v[-3], q = v[-2], r = v[-1];
        std::uint32_t shared = 0;  // a bit of each vertex that is among the three before
        for (std::uint32_t i = 0; i < 3; ++i) {
            shared |= static_cast<std::uint32_t>((v[i] == p) | (v[i] == q) | (v[i] == r)) << i;
        }
        const std::uint32_t k = kAlone[shared];
        if (k == 3) continue;
        const std::uint32_t other = p ^ q ^ r ^ v[0] ^ v[1] ^ v[2] ^ v[k];  // the one before that is not shared
        const std::size_t from = c - 3 + (other == q ? 1 : 0) + (other == r ? 2 : 0);
        if (opposite[from] != kNone) continue;
        opposite[c + k] = static_cast<std::uint32_t>(from);
        opposite[from] = static_cast<std::uint32_t>(c + k);
    }
}

/// An edge, and the corner that faces it.
struct Facing {
    std::uint32_t corner, smaller, larger;
};

/// The corners without an opposite one, in their order, but those of degenerate triangles.
std::vector<Facing> open_corners(std::span<const std::uint32_t> triangles, std::span<const std::uint32_t> opposite) {
    std::vector<Facing> out(opposite.size() / 2 + 3);
    std::size_t size = 0;
    for (std::size_t c = 0; c < opposite.size(); c += 3) {
        const std::uint32_t* v = triangles.data() + c;
        if (is_degenerate(v)) continue;
        if (out.size() - size < 3) out.resize(2 * out.size());
        const auto corner = static_cast<std::uint32_t>(c);
        const auto add = [&](std::uint32_t k, std::uint32_t x, std::uint32_t y) {  // without a branch
            out[size] = {corner + k, std::min(x, y), std::max(x, y)};
            size += opposite[c + k] == kNone ? 1 : 0;
        };
        add(0, v[1], v[2]);
        add(1, v[2], v[0]);
        add(2, v[0], v[1]);
    }
    out.resize(size);
    return out;
}

}  // namespace

std::vector<std::uint32_t> opposite_corners(std::span<const std::uint32_t> triangles, std::uint32_t vertices) {
    std::vector<std::uint32_t> out(triangles.size() / 3 * 3, kNone);
    join_successive(triangles, out);
    const std::vector<Facing> corners = open_corners(triangles, out);
    // In the order of the smaller ends of their edges.
    std::vector<std::uint32_t> begin(std::size_t{vertices} + 1, 0);
    for (const Facing& of : corners) ++begin[std::size_t{of.smaller} + 1];
    for (std::size_t v = 1; v < begin.size(); ++v) begin[v] += begin[v - 1];
    std::vector<Facing> sorted(corners.size());
    for (const Facing& of : corners) sorted[begin[of.smaller]++] = of;
    struct Open {
        std::uint32_t smaller = kNone, corner = 0;
    };
    std::vector<Open> open(vertices);  // by the larger end: an edge whose other triangle was not met yet
    for (const auto& [corner, smaller, larger] : sorted) {
        Open& edge = open[larger];
        const std::uint32_t found = edge.smaller == smaller ? UINT32_MAX : 0;  // masks: whether is hard to predict
        const std::uint32_t other = corner ^ ((corner ^ edge.corner) & found);
        out[corner] = edge.corner | ~found;
        out[other] = corner | ~found;
        edge = {smaller | found, corner};
    }
    return out;
}

}  // namespace lacedring::storage
