#include "lrcore/codec/storage/vertex_walk.h"

#include <algorithm>

namespace lacedring::storage {
namespace {

bool is_degenerate(const std::uint32_t* v) {
    return (v[0] == v[1]) | (v[1] == v[2]) | (v[2] == v[0]);
}

/// Pairs opposite corners in the two frequent cases: between successive triangles, and at ring edges (v, v + 1).
class NearPairs {
  public:
    NearPairs(std::uint32_t vertices, std::uint32_t* opposite) : open_(vertices, kNone), opposite_(opposite) {}

    /// If the triangle with corners c to c + 2 and vertices v[0] to v[2] shares two vertices with the previous
    /// triangle, pairs their opposite corners.
    LACEDRING_INLINE void join_successive(const std::uint32_t* v, std::uint32_t c) {
        // Index of the bit that is 0; 3 unless exactly two bits are 1.
        constexpr std::uint8_t kAlone[8] = {3, 3, 3, 2, 3, 1, 0, 3};
        const std::uint32_t p = v[-3], q = v[-2], r = v[-1];
        std::uint32_t shared = 0;  // bit i: v[i] is a vertex of the previous triangle
        for (std::uint32_t i = 0; i < 3; ++i) {
            shared |= static_cast<std::uint32_t>((v[i] == p) | (v[i] == q) | (v[i] == r)) << i;
        }
        const std::uint32_t k = kAlone[shared];
        if (k == 3) return;
        const std::uint32_t other = p ^ q ^ r ^ v[0] ^ v[1] ^ v[2] ^ v[k];  // the previous triangle's vertex not shared
        const std::uint32_t from = c - 3 + (other == q ? 1 : 0) + (other == r ? 2 : 0);
        if (opposite_[from] != kNone) return;
        opposite_[c + k] = from;
        opposite_[from] = c + k;
    }

    /// Pairs an unpaired corner that faces (x, y) if this is a ring edge. Returns whether it is another edge.
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
    std::vector<std::uint32_t> open_;  // per vertex v: an unpaired corner that faces (v, v + 1)
    std::uint32_t* opposite_;
};

/// An edge, and the corner that faces it.
struct Facing {
    std::uint32_t corner, smaller, larger;
};

/// Pairs `corners` whose opposite edges are equal. The edges may be in any order.
void join_others(std::span<const std::uint32_t> triangles, std::uint32_t vertices,
                 std::span<const std::uint32_t> corners, std::span<std::uint32_t> opposite) {
    // Sorts the corners by the smaller end of the opposite edge.
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
    std::vector<Open> open(vertices);  // per larger end: an edge with one triangle so far
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
            // Joins a corner of the previous triangle.
            const auto join = [&](std::uint32_t corner, std::uint32_t x, std::uint32_t y) {
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
