// Half-edges are sorted into buckets by the smaller vertex of their edge; within a bucket, half-edges with the same
// larger vertex are joined. A bucket has three half-edges on average, so comparing all pairs is fastest; the rare large
// bucket is sorted.

#include "lrcore/topology/edges.h"

#include <algorithm>
#include <numeric>

namespace lacedring {
namespace {

// `key` is the larger vertex of the edge (the bucket implies the smaller one); bit 31 is set if the half-edge starts at
// the larger vertex. So directions are known without reading the corner table again.
struct HalfEdge {
    std::uint32_t key;
    std::uint32_t corner;

    std::uint32_t larger() const { return key & (kBackward - 1); }
    static constexpr std::uint32_t kBackward = 1U << 31;
};

constexpr std::size_t kSmallStar = 24;

class Joiner {
  public:
    Joiner(CornerTable& table, NonManifoldEdges& nonmanifold) : table_(table), nonmanifold_(nonmanifold) {}

    /// Joins all half-edges of one edge.
    void join(std::span<const HalfEdge> group) {
        if (group.size() == 1) {
            ++table_.topology.border_edges;
        } else if (group.size() == 2) {
            const CornerId a{group[0].corner}, b{group[1].corner};
            table_.corners[a.value].opposite = b;
            table_.corners[b.value].opposite = a;
            if (group[0].key == group[1].key) twisted_ = true;
        } else {
            ++table_.topology.nonmanifold_edges;
            for (const HalfEdge& h : group) nonmanifold_.corners.push_back(CornerId{h.corner});
            nonmanifold_.first.push_back(static_cast<std::uint32_t>(nonmanifold_.corners.size()));
        }
    }

    /// Joins the half-edges of a bucket, grouped by the larger vertex. Reorders the bucket.
    void join_bucket(std::span<HalfEdge> bucket) {
        if (bucket.size() > kSmallStar) {
            std::sort(bucket.begin(), bucket.end(), [](const HalfEdge& a, const HalfEdge& b) {
                return a.larger() != b.larger() ? a.larger() < b.larger() : a.corner < b.corner;
            });
        }
        while (!bucket.empty()) {
            std::size_t size = 1;
            if (bucket.size() > kSmallStar) {
                while (size < bucket.size() && bucket[size].larger() == bucket[0].larger()) ++size;
            } else {
                for (std::size_t i = 1; i < bucket.size(); ++i) {
                    if (bucket[i].larger() == bucket[0].larger()) std::swap(bucket[i], bucket[size++]);
                }
            }
            join(bucket.first(size));
            bucket = bucket.subspan(size);
        }
    }

    bool twisted() const { return twisted_; }

  private:
    CornerTable& table_;
    NonManifoldEdges& nonmanifold_;
    bool twisted_ = false;
};

}  // namespace

bool join_edges(CornerTable& table, NonManifoldEdges& nonmanifold) {
    const std::uint32_t triangles = table.triangle_count();
    const auto for_each_half_edge = [&](auto&& visit) {
        for (std::uint32_t t = 0; t < triangles; ++t) {
            const std::uint32_t a = table.corners[3 * t].vertex.value, b = table.corners[3 * t + 1].vertex.value,
                                c = table.corners[3 * t + 2].vertex.value;
            if (a == b || b == c || c == a) continue;
            visit(b, c, 3 * t);
            visit(c, a, 3 * t + 1);
            visit(a, b, 3 * t + 2);
        }
    };
    std::vector<std::uint32_t> end(std::size_t{table.vertex_count} + 1, 0);
    for_each_half_edge([&](std::uint32_t a, std::uint32_t b, std::uint32_t) { ++end[std::min(a, b) + 1]; });
    std::partial_sum(end.begin(), end.end(), end.begin());
    std::vector<HalfEdge> half_edges(end.back());
    // Filling moves end[v] from the beginning of bucket v to its end.
    for_each_half_edge([&](std::uint32_t a, std::uint32_t b, std::uint32_t corner) {
        half_edges[end[std::min(a, b)]++] = {a < b ? b : a | HalfEdge::kBackward, corner};
    });

    Joiner joiner(table, nonmanifold);
    std::uint32_t begin = 0;
    for (std::uint32_t v = 0; v < table.vertex_count; ++v) {
        joiner.join_bucket(std::span(half_edges).subspan(begin, end[v] - begin));
        begin = end[v];
    }
    return joiner.twisted();
}

void pair_nonmanifold(CornerTable& table, const NonManifoldEdges& nonmanifold) {
    if (nonmanifold.corners.empty()) return;
    // Fans around vertices as sets of corners.
    std::vector<std::uint32_t> parent(table.corners.size());
    std::iota(parent.begin(), parent.end(), 0U);
    const auto find = [&](CornerId c) {
        std::uint32_t i = c.value;
        while (parent[i] != i) i = parent[i] = parent[parent[i]];
        return i;
    };
    const auto merge = [&](CornerId a, CornerId b) { parent[find(a)] = find(b); };
    const auto merge_across = [&](CornerId c, CornerId o) {  // opposed half-edges: next meets previous
        merge(next(c), previous(o));
        merge(previous(c), next(o));
    };
    for (std::uint32_t i = 0; i < table.corners.size(); ++i) {
        const CornerId c{i}, o = table.corners[i].opposite;
        if (!o.is_null() && i < o.value) merge_across(c, o);
    }

    // Limits the search for the best partner, so that edges with very many triangles take linear time.
    constexpr std::size_t kLookahead = 32;
    std::vector<CornerId> forward, backward;
    for (std::size_t e = 0; e + 1 < nonmanifold.first.size(); ++e) {
        forward.clear();
        backward.clear();
        for (std::uint32_t i = nonmanifold.first[e]; i < nonmanifold.first[e + 1]; ++i) {
            CornerId c = nonmanifold.corners[i];
            // The corners were listed before orient(), which swapped the last two corners of flipped triangles.
            if (table.flipped(triangle(c)) && c.value % 3 != 0) c = c.value % 3 == 1 ? next(c) : previous(c);
            (edge_start(table, c) < edge_end(table, c) ? forward : backward).push_back(c);
        }
        for (int wanted = 2; wanted >= 0; --wanted) {  // number of fans that the pair merges
            for (std::size_t f = 0; f < forward.size();) {
                const CornerId c = forward[f];
                bool paired = false;
                for (std::size_t b = 0; b < std::min(backward.size(), kLookahead); ++b) {
                    const CornerId o = backward[b];
                    const int merged =
                        int{find(next(c)) != find(previous(o))} + int{find(previous(c)) != find(next(o))};
                    if (merged < wanted) continue;
                    table.corners[c.value].opposite = o;
                    table.corners[o.value].opposite = c;
                    merge_across(c, o);
                    std::swap(backward[b], backward.back());
                    backward.pop_back();
                    std::swap(forward[f], forward.back());
                    forward.pop_back();
                    paired = true;
                    break;
                }
                if (!paired) ++f;
            }
        }
    }
}

}  // namespace lacedring
