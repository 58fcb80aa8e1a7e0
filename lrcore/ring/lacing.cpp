#include "lrcore/ring/lacing.h"

#include <algorithm>
#include <cstring>

#include "lrcore/base/bits.h"
#include "lrcore/base/compiler.h"

namespace lacedring {
namespace {

/// The left corner of the ring edge after the edge with left corner x. mask(t) has a bit for each corner of t that
/// faces a ring edge.
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

constexpr std::uint32_t kWord = 8;  // states that are tested together

std::uint64_t word(const std::uint8_t* states) {
    std::uint64_t out = 0;
    std::memcpy(&out, states, kWord);
    return out;
}
constexpr std::uint64_t each(std::uint8_t byte) {
    return byte * 0x0101010101010101U;
}

}  // namespace

Lacing::Lacing(const CornerTable& table, const Rings& rings, const RingCost& cost)
    : table_(&table),
      on_ring_(table.vertex_count),
      all_on_rings_(rings.edges.size() == table.vertex_count),
      state_(table.triangle_count()) {
    for (std::size_t ends = 0; ends < 4; ++ends) {
        t0_[ends * kDeadEnd] = kScale * (ends == 0 ? cost.t0 : cost.t0_wart);
    }
    const auto table_bit = [](CornerId c) { return static_cast<std::uint8_t>(1U << c.value % 3); };
    for (const RingEdge& edge : rings.edges) {
        on_ring_.set(edge.start.value);
        state_[triangle(edge.left).value] |= table_bit(edge.left);
        if (edge.right.is_null()) continue;
        state_[triangle(edge.right).value] |= static_cast<std::uint8_t>(table_bit(edge.right) | kRight);
    }
    for (std::uint32_t t = 0; t < size(); ++t) {
        if (is_t0(t) && table.degenerate(TriangleId{t})) state_[t] |= kDegenerate;
        if (!is_t2(t)) continue;
        const CornerId across = table.opposite(corner(TriangleId{t}, kCornerOfT2[mask(t)]));
        if (!across.is_null()) state_[triangle(across).value] += kDeadEnd;
    }
}

bool Lacing::has_expensive() const {
    for (std::uint32_t t = 0; t < size(); ++t) {
        if (is_expensive(t)) return true;
    }
    return false;
}

/// Returns whether the mean index distance of adjacent triangles, each capped at `range`, is so large that ranges of
/// `range` triangles would have long borders.
bool Lacing::scattered(std::uint32_t range) const {
    constexpr std::uint32_t kStep = 16;  // samples one triangle in kStep
    std::uint64_t distances = 0, corners = 0;
    for (std::uint32_t t = 0; t < size(); t += kStep) {
        for (std::uint32_t k = 0; k < 3; ++k, ++corners) {
            const CornerId o = table_->opposite(corner(TriangleId{t}, k));
            if (o.is_null()) continue;
            const std::uint32_t u = triangle(o).value;
            distances += std::min(u < t ? t - u : u - t, range);
        }
    }
    return distances > corners * range / 32;
}

/// Renumbers the triangles breadth first: sets opposite_, including the table's numbers, and reorders the states.
void Lacing::renumber() {
    constexpr std::size_t kAhead = 16;  // distance in the queue of the triangles prefetched
    const std::uint32_t count = size();
    std::vector<std::uint32_t> number(count, kNone);
    std::uint32_t back = 0;
    const auto enter = [&](std::uint32_t t) {
        if (number[t] != kNone) return;
        number[t] = back;
        opposite_[4 * std::size_t{back++} + 3] = t;
    };
    std::uint32_t i = 0;
    for (std::uint32_t first = 0; first < count; ++first) {
        for (enter(first); i < back; ++i) {
            if (i + kAhead < back) {
                detail::prefetch(&table_->corners[3 * std::size_t{opposite_[4 * (i + kAhead) + 3]}]);
            }
            for (std::uint32_t k = 0; k < 3; ++k) {
                const CornerId o = table_->opposite(corner(TriangleId{opposite_[4 * std::size_t{i} + 3]}, k));
                if (!o.is_null()) enter(triangle(o).value);
            }
        }
    }
    std::vector<std::uint8_t> state(count);
    for (std::uint32_t t = 0; t < count; ++t) {
        const std::uint32_t from = opposite_[4 * std::size_t{t} + 3];
        state[t] = state_[from];
        for (std::uint32_t k = 0; k < 3; ++k) {
            const CornerId o = table_->opposite(corner(TriangleId{from}, k));
            opposite_[4 * std::size_t{t} + k] = o.is_null() ? kNone : 4 * number[triangle(o).value] + o.value % 3;
        }
    }
    state_ = std::move(state);
}

void Lacing::number_triangles(std::uint32_t range) {
    opposite_.resize(4 * state_.size());
    if (range < size() && scattered(range)) {
        renumber();
    } else {
        for (std::uint32_t t = 0; t < size(); ++t) {
            for (std::uint32_t k = 0; k < 3; ++k) {
                const CornerId o = table_->opposite(corner(TriangleId{t}, k));
                opposite_[4 * std::size_t{t} + k] = o.is_null() ? kNone : o.value + triangle(o).value;
            }
            opposite_[4 * std::size_t{t} + 3] = t;
        }
    }
    if (all_on_rings_) return;
    // A vertex off the rings is a vertex of a T0 or the tip of a T1.
    for (std::uint32_t t = 0; t < size(); ++t) {
        if (ring_edges(state_[t]) > 1 || (state_[t] & kDegenerate) != 0) continue;
        for (std::uint32_t k = 0; k < 3; ++k) {
            if (!is_t0(t) && !faces_ring(4 * t + k)) continue;
            const VertexId v = table_->vertex(corner(TriangleId{opposite_[4 * std::size_t{t} + 3]}, k));
            if (on_ring_.test(v.value)) continue;
            on_ring_.set(v.value);
            isolated_.push_back(4 * t + k);
        }
    }
    on_ring_ = BitVector(0);
}

void Lacing::mark_expensive(TriangleRange range, std::vector<std::uint32_t>& out) {
    const auto look = [&](std::uint32_t t) {
        state_[t] = static_cast<std::uint8_t>(state_[t] & ~kMark);
        if (!is_expensive(t)) return;
        state_[t] |= kMark;
        out.push_back(t);
    };
    std::uint32_t t = range.begin;
    for (; range.end - t >= kWord; t += kWord) {
        const std::uint64_t states = word(&state_[t]) & each(0xff ^ kMark);
        const std::uint64_t keys = states & each(kT0Key | kDegenerate);  // 0: expensive
        std::memcpy(&state_[t], &states, kWord);
        if (((keys - each(1)) & ~keys & each(0x80)) == 0) continue;
        for (std::uint32_t i = 0; i < kWord; ++i) look(t + i);
    }
    for (; t < range.end; ++t) look(t);
}

void Lacing::find_marked_t2(TriangleRange range, std::vector<std::uint32_t>& out) const {
    std::array<std::uint32_t, kWord> found;
    const auto look = [&](std::uint32_t t, std::uint32_t count) {
        std::uint32_t n = 0;  // no branch on the triangle's kind: it would be mispredicted
        for (std::uint32_t i = 0; i < count; ++i) {
            found[n] = t + i;
            n += std::uint32_t{marked(t + i)} & std::uint32_t{is_t2(t + i)};
        }
        out.insert(out.end(), found.begin(), found.begin() + n);
    };
    std::uint32_t t = range.begin;
    for (; range.end - t >= kWord; t += kWord) {
        if ((word(&state_[t]) & each(kMark)) != 0) look(t, kWord);
    }
    look(t, range.end - t);
}

Rings Lacing::rings(Lacing lacing, const std::vector<std::uint8_t>& states) {
    const CornerTable& table = *lacing.table_;
    std::vector<std::uint8_t>& state = lacing.state_;
    for (std::uint32_t t = 0; t < lacing.size(); ++t) state[lacing.opposite_[4 * std::size_t{t} + 3]] = states[t];
    lacing.opposite_ = {};

    std::size_t size = 0;  // each edge has exactly one triangle on its left
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
