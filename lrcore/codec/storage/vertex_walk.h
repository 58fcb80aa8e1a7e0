#pragma once
// The order in which the storage form codes the vertices of a mesh, and the parallelograms that predict each. Internal
// to lrcore.
//
// A region grows from a triangle of each component. A triangle is complete when its vertices are known and it is the
// component's first or shares an edge with a complete one. Where a complete triangle (x, y, z) and one that is not,
// (x, y, v), share an edge, x + y - z predicts v. The next vertex is one with two or more such parallelograms, if there
// is one, else one with a single parallelogram; of these the one that has been waiting longest.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace lacedring::storage {

/// Predicts the vertex opposite to z across the edge (x, y).
struct Parallelogram {
    std::uint32_t x, y, z;
};

constexpr std::uint32_t kMostParallelograms = 8;  ///< that predict one vertex; more are not looked at
constexpr std::uint32_t kNone = UINT32_MAX;

/// For each corner the one that faces the same edge in another triangle, or kNone. Of more than two triangles at an
/// edge, the first and the second are neighbors, the third and the fourth, and so on. A triangle with a vertex twice
/// has no neighbors. Cost: O(T + V).
std::vector<std::uint32_t> opposite_corners(std::span<const std::uint32_t> triangles, std::uint32_t vertices);

class VertexWalk {
  public:
    /// Each of `triangles` is three numbers below `vertices`; they have to outlive the walk.
    VertexWalk(std::span<const std::uint32_t> triangles, std::uint32_t vertices)
        : triangles_(triangles), opposite_(opposite_corners(triangles, vertices)), vertices_(vertices) {}

    /// Visits each vertex once: visitor.predicted(v, parallelograms), or visitor.start(v, from), where `from` is a
    /// known vertex of a triangle of v, or kNone. Once only.
    template <class Visitor>
    void run(Visitor& visitor) {
        const auto count = static_cast<std::uint32_t>(triangles_.size() / 3);
        complete_.assign(count, 0);
        state_.assign(vertices_, 0);
        first_.assign(vertices_, kNone);
        for (std::uint32_t t = 0; t < count; ++t) {
            const std::uint32_t* v = triangles_.data() + std::size_t{3} * t;
            if (complete_[t] != 0 || v[0] == v[1] || v[1] == v[2] || v[2] == v[0]) continue;
            start(visitor, v);
            complete_[t] = 1;
            pending_.push_back(t);
            grow(visitor);
        }
        for (std::uint32_t v = 0; v < vertices_; ++v) {
            if (state_[v] != kKnown) visitor.start(v, kNone);
        }
    }

  private:
    static constexpr std::uint8_t kKnown = 3;  // else 0 to 2: parallelograms, two or more being 2

    /// The vertices of a component's first triangle.
    template <class Visitor>
    void start(Visitor& visitor, const std::uint32_t* v) {
        std::uint32_t from = kNone;
        for (std::uint32_t k = 0; k < 3; ++k) {
            if (state_[v[k]] == kKnown) from = v[k];
        }
        for (std::uint32_t k = 0; k < 3; ++k) {
            if (state_[v[k]] == kKnown) continue;
            visitor.start(v[k], from);
            state_[v[k]] = kKnown;
            from = v[k];
        }
    }

    template <class Visitor>
    void grow(Visitor& visitor) {
        while (true) {
            while (!pending_.empty()) {
                const std::uint32_t t = pending_.back();
                pending_.pop_back();
                open(t);
            }
            const std::uint32_t v = next();
            if (v == kNone) return;
            std::array<Parallelogram, kMostParallelograms> found;
            std::uint32_t count = 0;
            for (std::uint32_t c = first_[v]; c != kNone;) {
                const std::uint32_t t = c / 3, k = c - 3 * t, across = opposite_[c];
                if (count < kMostParallelograms) {
                    const std::uint32_t* at = triangles_.data() + std::size_t{3} * t;
                    found[count++] = {at[k == 2 ? 0 : k + 1], at[k == 0 ? 2 : k - 1], triangles_[across]};
                }
                complete_[t] = 1;
                pending_.push_back(t);
                c = opposite_[across];
            }
            visitor.predicted(v, std::span<const Parallelogram>(found.data(), count));
            state_[v] = kKnown;
        }
    }

    /// The neighbors of a triangle that just became complete are complete, too, or get a parallelogram.
    void open(std::uint32_t t) {
        for (std::uint32_t c = 3 * t; c < 3 * t + 3; ++c) {
            const std::uint32_t across = opposite_[c];
            if (across == kNone || complete_[across / 3] != 0) continue;
            const std::uint32_t v = triangles_[across];
            if (state_[v] == kKnown) {
                complete_[across / 3] = 1;
                pending_.push_back(across / 3);
                continue;
            }
            opposite_[c] = first_[v];  // of no use any more: links the corners of v that have parallelograms
            first_[v] = across;
            if (state_[v] < 2) waiting_[state_[v]++].push_back(v);
        }
    }

    /// The vertex to visit now, or kNone.
    std::uint32_t next() {
        for (std::uint32_t i = 2; i-- > 0;) {
            while (head_[i] < waiting_[i].size()) {
                const std::uint32_t v = waiting_[i][head_[i]++];
                if (state_[v] != kKnown) return v;
            }
        }
        return kNone;
    }

    std::span<const std::uint32_t> triangles_;
    std::vector<std::uint32_t> opposite_;
    std::uint32_t vertices_;
    std::vector<std::uint8_t> complete_, state_;
    std::vector<std::uint32_t> first_;                   // a corner of each vertex that has a parallelogram
    std::vector<std::uint32_t> pending_;                 // complete triangles whose neighbors were not looked at
    std::array<std::vector<std::uint32_t>, 2> waiting_;  // vertices with one parallelogram, and with more
    std::array<std::size_t, 2> head_{};
};

}  // namespace lacedring::storage
