#pragma once
// One ring read edge by edge, and what its triangles look like from there. Paper: LR 2011, section 4.3.

#include <cstddef>
#include <cstdint>
#include <span>

#include "lrcore/ring/ring.h"

namespace lr {

/// A ring in its own direction, or backwards, where left and right change places. Holds no copy.
class RingWalk {
  public:
    RingWalk() = default;
    explicit RingWalk(std::span<const RingEdge> ring, bool backwards = false) : ring_(ring), backwards_(backwards) {}

    std::size_t size() const { return ring_.size(); }
    std::size_t after(std::size_t i) const { return i + 1 == size() ? 0 : i + 1; }

    /// Ring vertex at which edge i starts.
    VertexId start(std::size_t i) const { return ring_[!backwards_ || i == 0 ? i : size() - i].start; }

    /// The corner facing edge i from side 0 (left) or 1 (right), null at a border; and its vertex, the tip.
    CornerId face(std::uint32_t side, std::size_t i) const {
        return (side == 0) != backwards_ ? edge(i).left : edge(i).right;
    }
    VertexId tip(std::uint32_t side, std::size_t i) const {
        return (side == 0) != backwards_ ? edge(i).left_tip : edge(i).right_tip;
    }

    /// Is edge i's triangle that of the edge after it as well: the first copy of a T2?
    bool repeats(std::uint32_t side, std::size_t i) const {
        const CornerId c = face(side, i), d = face(side, after(i));
        return !c.is_null() && !d.is_null() && triangle(c) == triangle(d);
    }

    /// Are the ring's three edges those of one triangle (a T3, so to speak)?
    bool is_t3(std::uint32_t side) const { return size() == 3 && repeats(side, 0) && repeats(side, 1); }

    /// Where edge i has the first copy of a T2: the corner across the T2's third edge. Null across a border.
    CornerId across_t2(const CornerTable& table, std::uint32_t side, std::size_t i) const {
        const CornerId c = face(side, i), d = face(side, after(i));
        return table.opposite({triangle(c).value * 9 + 3 - c.value - d.value});  // the corner that is neither c nor d
    }

  private:
    const RingEdge& edge(std::size_t i) const { return ring_[backwards_ ? size() - 1 - i : i]; }

    std::span<const RingEdge> ring_;
    bool backwards_ = false;
};

}  // namespace lr
