#pragma once
// The order in which the storage form codes the vertices of a mesh, and the parallelograms that predict each. Internal
// to lrcore.
//
// A region grows from a triangle of each component. A triangle is complete when its vertices are known and it is the
// component's first or shares an edge with a complete one. Where a complete triangle (x, y, z) and one that is not, (x,
// y, v), share an edge, x + y - z predicts v. The next vertex is a vertex with two such parallelograms if there is one,
// else a vertex with one; among equals the one waiting longest.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "lrcore/base/compiler.h"

namespace lacedring::storage {

/// Predicts the vertex opposite z across the edge (x, y).
struct Parallelogram {
    std::uint32_t x, y, z;
    bool operator==(const Parallelogram&) const = default;
};

/// The two parallelograms of a predicted vertex; equal if it has only one.
using Parallelograms = std::array<Parallelogram, 2>;

constexpr std::uint32_t kNone = UINT32_MAX;

/// For each corner, the corner facing the same edge in the neighbor triangle, or kNone. Successive triangles that share
/// two vertices are neighbors, unless the earlier one already has a neighbor there. Among the other triangles at an
/// edge, the first and second are neighbors, the third and fourth, and so on. A triangle with a vertex twice has no
/// neighbors. Cost: O(T + V).
std::vector<std::uint32_t> opposite_corners(std::span<const std::uint32_t> triangles, std::uint32_t vertices);

class VertexWalk {
  public:
    /// `triangles`: three numbers below `vertices` each; they must outlive the walk.
    VertexWalk(std::span<const std::uint32_t> triangles, std::uint32_t vertices)
        : triangles_(triangles), opposite_(opposite_corners(triangles, vertices)), vertices_(vertices) {}

    /// Visits each vertex once: calls visitor.predicted(v, parallelograms), or visitor.start(v, from), where `from` is
    /// a known vertex of a triangle of v, or kNone. May be called only once.
    template <class Visitor>
    void run(Visitor& visitor) {
        const auto count = static_cast<std::uint32_t>(triangles_.size() / 3);
        complete_.assign(count, 0);
        state_.assign(vertices_, 0);
        corner_.resize(vertices_);
        for (auto& queue : waiting_) queue.resize(vertices_);
        head_ = tail_ = {};
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
    // state_ of a known vertex; else the number of parallelograms, at most 2.
    static constexpr std::uint8_t kKnown = 3;

    /// Visits the vertices of a component's first triangle.
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
                const std::uint32_t c = 3 * pending_.back();
                pending_.pop_back();
                for (std::uint32_t k = 0; k < 3; ++k) look_across(c + k);
            }
            const std::uint32_t v = next();
            if (v == kNone) return;
            std::uint32_t c = corner_[v], next = before(c);
            visitor.predicted(v, {parallelogram(c), parallelogram(next != kNone ? next : c)});
            state_[v] = kKnown;
            complete_[c / 3] = 1;
            for (std::uint32_t i = next; i != kNone; i = before(i)) complete_[i / 3] = 1;
            while (true) {
                const std::uint32_t first = c - c % 3;
                look_across(first + kNext[c - first]);
                look_across(first + kBefore[c - first]);
                if (next == kNone) break;
                c = next;
                next = before(c);
            }
        }
    }

    /// The previous corner of the same vertex that got a parallelogram, or kNone. The list is stored in opposite_ of
    /// the corner across, whose entry is no longer needed since its triangle is complete.
    std::uint32_t before(std::uint32_t corner) const { return opposite_[opposite_[corner]]; }

    LACEDRING_INLINE Parallelogram parallelogram(std::uint32_t corner) const {
        const std::uint32_t k = corner % 3;
        const std::uint32_t* v = triangles_.data() + (corner - k);
        return {v[kNext[k]], v[kBefore[k]], triangles_[opposite_[corner]]};
    }

    /// Visits the neighbor across from a complete triangle's corner: it becomes complete, or its vertex gets a
    /// parallelogram.
    LACEDRING_INLINE void look_across(std::uint32_t corner) {
        const std::uint32_t across = opposite_[corner];
        if (across == kNone) return;
        const std::uint32_t v = triangles_[across], found = state_[v];
        if (found == kKnown) {
            if (complete_[across / 3] != 0) return;
            complete_[across / 3] = 1;
            pending_.push_back(across / 3);
            return;
        }
        const std::uint32_t more = found < 2 ? 1 : 0, queue = found != 0 ? 1 : 0;
        opposite_[corner] = found == 0 ? kNone : corner_[v];
        corner_[v] = across;
        waiting_[queue][tail_[queue]] = v;
        tail_[queue] += more;
        state_[v] = static_cast<std::uint8_t>(found + more);
    }

    /// The next vertex to visit, or kNone.
    std::uint32_t next() {
        if (head_[1] < tail_[1]) return waiting_[1][head_[1]++];
        while (head_[0] < tail_[0]) {
            const std::uint32_t v = waiting_[0][head_[0]++];
            if (state_[v] != kKnown) return v;
        }
        return kNone;
    }

    static constexpr std::array<std::uint32_t, 3> kNext{1, 2, 0}, kBefore{2, 0, 1};

    std::span<const std::uint32_t> triangles_;
    std::vector<std::uint32_t> opposite_;
    std::uint32_t vertices_;
    std::vector<std::uint8_t> complete_, state_;
    std::vector<std::uint32_t> corner_;                  // per vertex: its corner at the last parallelogram
    std::vector<std::uint32_t> pending_;                 // complete triangles whose neighbors have not been visited
    std::array<std::vector<std::uint32_t>, 2> waiting_;  // queues of vertices with one and with two parallelograms
    std::array<std::uint32_t, 2> head_{}, tail_{};
};

}  // namespace lacedring::storage
