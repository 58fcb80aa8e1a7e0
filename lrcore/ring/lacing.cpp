#include "lrcore/ring/lacing.h"

#include <algorithm>

#include "lrcore/base/bits.h"
#include "lrcore/base/compiler.h"

namespace lacedring {
namespace {

/// The left corner of the ring edge after that of left corner x. `mask` says which corners of a triangle face a ring
/// edge.
template <class Mask>
CornerId table_edge_after(const CornerTable& table, CornerId x, const Mask& mask) {
    const auto faces_ring = [&](CornerId c) { return (mask(triangle(c)) >> c.value % 3 & 1) != 0; };
    CornerId y = table.opposite(x);
    do {
        const CornerId p = previous(x);
        if (faces_ring(p)) return p;
        x = table.opposite(p);
    } while (!x.is_null());
    while (true) {
        const CornerId n = next(y);
        y = table.opposite(n);
        if (faces_ring(n)) return y;
    }
}

}  // namespace

Lacing::Lacing(const CornerTable& table, Rings rings, const RingCost& cost)
    : table_(&table), state_(table.triangle_count()) {
    for (std::size_t ends = 0; ends < 4; ++ends) {
        t0_[ends * kDeadEnd] = kScale * (ends == 0 ? cost.t0 : cost.t0_wart);
    }
    BitVector done(table.vertex_count);  // on a ring, or in isolated_
    {
        std::vector<std::uint8_t> state(table.triangle_count());
        const auto table_bit = [](CornerId c) { return static_cast<std::uint8_t>(1U << c.value % 3); };
        for (const RingEdge& edge : rings.edges) {
            done.set(edge.start.value);
            state[triangle(edge.left).value] |= table_bit(edge.left);
            if (edge.right.is_null()) continue;
            state[triangle(edge.right).value] |= static_cast<std::uint8_t>(table_bit(edge.right) | kRight);
        }
        rings = {};
        join(table);
        for (std::uint32_t t = 0; t < size(); ++t) state_[t] = state[order_[t]];
    }
    for (std::uint32_t t = 0; t < size(); ++t) {
        if (table.degenerate(TriangleId{order_[t]})) {
            state_[t] |= kDegenerate;
            continue;
        }
        for (std::uint32_t k = 0; k < 3; ++k) {
            const VertexId v = table.vertex(corner(TriangleId{order_[t]}, k));
            if (done.test(v.value)) continue;
            done.set(v.value);
            isolated_.push_back(4 * t + k);
        }
        if (!is_t2(t)) continue;
        const std::uint32_t across = opposite(t2_corner(t));
        if (across != kNone) state_[across >> 2] += kDeadEnd;
    }
    set_reach();
}

/// Numbers the triangles breadth first, and sets opposite_.
void Lacing::join(const CornerTable& table) {
    constexpr std::size_t kAhead = 16;  // triangles of the queue that are fetched before their turn
    const std::uint32_t count = size();
    std::vector<std::uint32_t> number(count, kNone);
    order_.reserve(count);
    for (std::uint32_t first = 0; first < count; ++first) {
        if (number[first] != kNone) continue;
        number[first] = static_cast<std::uint32_t>(order_.size());
        order_.push_back(first);
        for (std::size_t i = order_.size() - 1; i < order_.size(); ++i) {
            if (i + kAhead < order_.size()) {
                detail::prefetch(&table.corners[3 * std::size_t{order_[i + kAhead]}]);
            }
            for (std::uint32_t k = 0; k < 3; ++k) {
                const CornerId o = table.opposite(corner(TriangleId{order_[i]}, k));
                if (o.is_null() || number[triangle(o).value] != kNone) continue;
                number[triangle(o).value] = static_cast<std::uint32_t>(order_.size());
                order_.push_back(triangle(o).value);
            }
        }
    }
    opposite_.resize(4 * std::size_t{count});
    for (std::uint32_t t = 0; t < count; ++t) {
        for (std::uint32_t k = 0; k < 3; ++k) {
            const CornerId o = table.opposite(corner(TriangleId{order_[t]}, k));
            opposite_[4 * std::size_t{t} + k] = o.is_null() ? kNone : 4 * number[triangle(o).value] + o.value % 3;
        }
    }
}

/// turn_over(t) touches the triangles up to two edges away.
void Lacing::set_reach() {
    reach_unit_ = std::max(0, static_cast<int>(std::bit_width(size())) - 15);
    for (std::uint32_t t = 0; t < size(); ++t) {
        std::uint32_t least = t, most = t;
        for (std::uint32_t k = 0; k < 3; ++k) {
            const std::uint32_t o = opposite(4 * t + k);
            if (o == kNone) continue;
            for (const std::uint32_t p : {o, opposite(next(o)), opposite(previous(o))}) {
                if (p == kNone) continue;
                least = std::min(least, p >> 2);
                most = std::max(most, p >> 2);
            }
        }
        const auto units = [&](std::uint32_t n) { return (n + (1U << reach_unit_) - 1) >> reach_unit_; };
        opposite_[4 * std::size_t{t} + 3] = units(t - least) | units(most - t) << 16;
    }
}

Rings Lacing::rings(Lacing lacing, const std::vector<std::uint8_t>& states) {
    const CornerTable& table = *lacing.table_;
    lacing.opposite_ = {};
    std::vector<std::uint8_t>& state = lacing.state_;
    for (std::uint32_t t = 0; t < lacing.size(); ++t) state[lacing.order_[t]] = states[t];
    lacing.order_ = {};

    std::size_t size = 0;  // each edge has one triangle on its left
    for (const std::uint8_t s : state) size += (s & kRight) != 0 ? 0 : kBits[s & kMask];
    Rings out;
    out.edges.reserve(size);
    BitVector done(table.vertex_count);
    for (std::uint32_t t = 0; t < state.size(); ++t) {
        if ((state[t] & kRight) != 0) continue;
        for (std::uint32_t k = 0; k < 3; ++k) {
            const CornerId c = corner(TriangleId{t}, k);
            if ((state[t] >> k & 1) == 0 || done.test(table.vertex(lacedring::previous(c)).value)) continue;
            out.first.push_back(static_cast<std::uint32_t>(out.edges.size()));
            CornerId left = c;
            do {
                const VertexId v = table.vertex(lacedring::previous(left));
                const CornerId right = table.opposite(left);
                done.set(v.value);
                out.edges.push_back(
                    {v, left, right, table.vertex(left), right.is_null() ? kNullVertex : table.vertex(right)});
                left = table_edge_after(table, left, [&](TriangleId u) { return state[u.value] & kMask; });
            } while (left != c);
        }
    }
    out.first.push_back(static_cast<std::uint32_t>(out.edges.size()));
    return out;
}

}  // namespace lacedring
