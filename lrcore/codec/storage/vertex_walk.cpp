#include "lrcore/codec/storage/vertex_walk.h"

#include <algorithm>

namespace lacedring::storage {
namespace {

bool is_degenerate(const std::uint32_t* v) {
    return (v[0] == v[1]) | (v[1] == v[2]) | (v[2] == v[0]);
}

/// Pairs corners of triangle after triangle: of two that follow each other, and at edges of two vertices that follow
/// each other.
class NearPairs {
  public:
    NearPairs(std::uint32_t vertices, std::uint32_t* opposite) : open_(vertices, kNone), opposite_(opposite) {}

    /// Where the triangle of corner c, whose vertices are v[0] to v[2], shares two vertices with the one before, pairs
    /// the corners of both.
    LACEDRING_INLINE void join_successive(const std::uint32_t* v, std::uint32_t c) {
        constexpr std::uint8_t kAlone[8] = {3, 3, 3, 2, 3, 1, 0, 3};  // the one of three whose bit is 0
        const std::uint32_t p = v[-3], q = v[-2], r = v[-1];
        std::uint32_t shared = 0;  // a bit of each vertex that is among the three before
        for (std::uint32_t i = 0; i < 3; ++i) {
            shared |= static_cast<std::uint32_t>((v[i] == p) | (v[i] == q) | (v[i] == r)) << i;
        }
        const std::uint32_t k = kAlone[shared];
        if (k == 3) return;
        const std::uint32_t other = p ^ q ^ r ^ v[0] ^ v[1] ^ v[2] ^ v[k];  // the one before that is not shared
        const std::uint32_t from = c - 3 + (other == q ? 1 : 0) + (other == r ? 2 : 0);
        if (opposite_[from] != kNone) return;
        opposite_[c + k] = from;
        opposite_[from] = c + k;
    }

    /// Pairs an open corner that faces the edge (x, y), if that is a ring edge. Returns whether it is another one.
    LACEDRING_INLINE bool join_ring_edge(std::uint32_t corner, std::uint32_t x, std::uint32_t y) {
        if (opposite_[corner] != kNone) return false;
        if (x - y != 1 && y - x != 1) return true;
        std::uint32_t& open = open_[std::min(x, y)];
        if (open == kNone) {
            open = corner;
            return false;
        }
        opposite_[corner] = open;
        opposite_[open] = corner;
        open = kNone;
        return false;
    }

  private:
    std::vector<std::uint32_t> open_;  // of each vertex, a corner that faces the edge to the next one
    std::uint32_t* opposite_;
};

/// An edge, and the corner that faces it.
struct Facing {
    std::uint32_t corner, smaller, larger;
};

/// Pairs corners by their edges, whichever these are.
void join_others(std::span<const std::uint32_t> triangles, std::uint32_t vertices,
                 std::span<const std::uint32_t> corners, std::span<std::uint32_t> opposite) {
    // In the order of the smaller ends of their edges.
    std::vector<std::uint32_t> begin(std::size_t{vertices} + 1, 0);
    const auto facing = [&](std::uint32_t corner) {
        const std::uint32_t first = corner - corner % 3, k = corner - first;
        const std::uint32_t x = triangles[first + (k + 1) % 3], y = triangles[first + (k + 2) % 3];
        return Facing{corner, std::min(x, y), std::max(x, y)};
    };
    for (const std::uint32_t c : corners) ++begin[std::size_t{facing(c).smaller} + 1];
    for (std::size_t v = 1; v < begin.size(); ++v) begin[v] += begin[v - 1];
    std::vector<Facing> sorted(corners.size());
    for (const std::uint32_t c : corners) {
        const Facing of = facing(c);
        sorted[begin[of.smaller]++] = of;
    }
    struct Open {
        std::uint32_t smaller = kNone, corner = 0;
    };
    std::vector<Open> open(vertices);  // by the larger end: an edge whose other triangle was not met yet
    for (const auto& [corner, smaller, larger] : sorted) {
        Open& edge = open[larger];
        const std::uint32_t found = edge.smaller == smaller ? UINT32_MAX : 0;
        const std::uint32_t other = corner ^ ((corner ^ edge.corner) & found);
        opposite[corner] = edge.corner | ~found;
        opposite[other] = corner | ~found;
        edge = {smaller | found, corner};
    }
}

}  // namespace

std::vector<std::uint32_t> opposite_corners(std::span<const std::uint32_t> triangles, std::uint32_t vertices) {
    const auto size = static_cast<std::uint32_t>(triangles.size() / 3 * 3);
    std::vector<std::uint32_t> out(size, kNone);
    NearPairs pairs(vertices, out.data());
    std::vector<std::uint32_t> others(size / 4 + 3);
    std::size_t count = 0;
    bool before_is_good = false;
    for (std::uint32_t c = 0; c <= size; c += 3) {
        const std::uint32_t* v = triangles.data() + c;
        const bool is_good = c < size && !is_degenerate(v);
        if (before_is_good) {
            if (is_good) pairs.join_successive(v, c);
            if (others.size() - count < 3) others.resize(2 * others.size());
            const auto join = [&](std::uint32_t corner, std::uint32_t x, std::uint32_t y) {  // of the triangle before
                others[count] = corner;
                count += pairs.join_ring_edge(corner, x, y) ? 1 : 0;
            };
            join(c - 3, v[-2], v[-1]);
            join(c - 2, v[-1], v[-3]);
            join(c - 1, v[-3], v[-2]);
        }
        before_is_good = is_good;
    }
    others.resize(count);
    join_others(triangles, vertices, others, out);
    return out;
}

}  // namespace lacedring::storage
