#pragma once
// Walks a ring edge by edge and classifies its triangles. Paper: LR 2011, section 4.3.

#include <cstddef>
#include <cstdint>
#include <span>

#include "lacedring/ring.hpp"

namespace lacedring {

/// A ring's edges and the triangles beside them. Does not own them.
class RingWalk {
  public:
    RingWalk() = default;
    explicit RingWalk(std::span<const RingEdge> ring) : ring_(ring) {}

    std::size_t size() const { return ring_.size(); }
    std::size_t after(std::size_t i) const { return i + 1 == size() ? 0 : i + 1; }

    /// Ring vertex at which edge i starts.
    VertexId start(std::size_t i) const { return ring_[i].start; }

    /// The corner facing edge i from side 0 (left) or 1 (right), null at a border; and its vertex, the tip.
    CornerId face(std::uint32_t side, std::size_t i) const { return side == 0 ? ring_[i].left : ring_[i].right; }
    VertexId tip(std::uint32_t side, std::size_t i) const { return side == 0 ? ring_[i].left_tip : ring_[i].right_tip; }

    /// Do edge i and the next edge have the same triangle on this side? If so, edge i has the first copy of a T2.
    bool repeats(std::uint32_t side, std::size_t i) const {
        const CornerId c = face(side, i), d = face(side, after(i));
        return !c.is_null() && !d.is_null() && triangle(c) == triangle(d);
    }

    /// Does the ring consist of the three edges of one triangle (a T3)?
    bool is_t3(std::uint32_t side) const { return size() == 3 && repeats(side, 0) && repeats(side, 1); }

    /// The corner opposite the third edge of the T2 whose first copy is at edge i. Null across a border.
    CornerId across_t2(const CornerTable& table, std::uint32_t side, std::size_t i) const {
        const CornerId c = face(side, i), d = face(side, after(i));
        // The corner of the triangle that is neither c nor d.
        return table.opposite(CornerId{triangle(c).value * 9 + 3 - c.value - d.value});
    }

  private:
    std::span<const RingEdge> ring_;
};

}  // namespace lacedring
