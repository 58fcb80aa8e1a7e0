// Checks the conditions that the operators rely on (listed in docs/lr-tables.md). Safe with untrusted words.

#include <vector>

#include "lacedring/operators.hpp"
#include "lrcore/base/bits.h"
#include "lrcore/base/message.h"
#include "lrcore/codec/tables/stream_header.h"

namespace lacedring {
namespace {

/// Checks the indices within a representation: tips, VO* indices, records.
std::string check_slots(const LrView& view) {
    for (std::uint32_t slot = 0; slot < view.lr.size(); ++slot) {
        const std::uint32_t w = view.lr[slot], kind = w & word::kKind, tip = w & word::kTip;
        const bool irregular = (kind & (word::kSpecial | word::kIrregular)) == word::kIrregular;
        if (irregular ? view.star.size() < 3 || tip > view.star.size() - 3
                      : kind != word::kBorder && tip >= view.used_vertices()) {
            return detail::message("ring vertex ", slot / 2, ": word ", detail::hexadecimal(w));
        }
        if (irregular && view.star[tip] >= view.used_vertices())
            return detail::message("ring vertex ", slot / 2, ": VO* tip");
        if (kind == word::kClosing && slot % 2 == 1)
            return detail::message("ring vertex ", slot / 2, " closes on its right");
    }
    return {};
}

std::string check_slots(const CompactLrView& view) {
    if (view.unit < 2 || view.unit > 4096 || view.unit % 2 != 0) return "unit of VO*";
    for (std::uint32_t v = 0; v < view.ring_vertices; ++v) {
        const std::uint32_t w = view.lr[v];
        if (!CompactLrView::is_long(w)) continue;  // short offsets need no check: tip() wraps them
        const std::size_t at = view.record(w);
        const bool left = (w & compact::kLongLeftIrregular) != 0, right = (w & compact::kLongRightIrregular) != 0;
        const std::size_t size = 2 + (left ? 2U : 0U) + (right ? 2U : 0U);
        if (at > view.star.size() || size > view.star.size() - at)
            return detail::message("ring vertex ", v, ": record");
        for (std::uint32_t side = 0; side < 2; ++side) {
            const std::uint32_t entry = view.star[at + side], kind = entry & word::kKind;
            const bool irregular = (kind & (word::kSpecial | word::kIrregular)) == word::kIrregular;
            const bool wart = (kind & (word::kSpecial | word::kWart)) == word::kWart;
            if (kind != word::kBorder && (entry & word::kTip) >= view.used_vertices()) {
                return detail::message("ring vertex ", v, ": long tip");
            }
            if (irregular != (side == 0 ? left : right) ||
                wart != ((w & (side == 0 ? compact::kLongLeftWart : compact::kLongRightWart)) != 0) ||
                (kind == word::kClosing && side == 1)) {
                return detail::message("ring vertex ", v, ": long flags");
            }
        }
    }
    for (std::uint32_t v = 0; v < view.ring_vertices; ++v) {
        if (CompactLrView::is_long(view.lr[v])) continue;
        for (std::uint32_t side = 0; side < 2; ++side) {
            if (view.tip(v, side) >= view.ring_vertices) return detail::message("ring vertex ", v, ": offset");
        }
    }
    return {};
}

/// Returns whether VO* has opposites of the slot's triangle.
template <class View>
bool is_irregular(const View& view, std::uint32_t slot) {
    return (view.kind(slot / 2, slot % 2) & (word::kSpecial | word::kIrregular)) == word::kIrregular;
}

/// Checks that kinds are valid, rings tile and close, and each T2 has its second copy.
template <class View>
std::string check_rings(const View& view) {
    const Operators<View> ops(view);
    std::uint32_t first = 0;
    for (std::uint32_t v = 0; v < view.ring_vertices; ++v) {
        for (std::uint32_t side = 0; side < 2; ++side) {
            const std::uint32_t kind = view.kind(v, side);
            if ((kind & word::kSpecial) != 0 && kind != word::kRedundant && kind != word::kBorder &&
                kind != word::kClosing) {
                return detail::message("ring vertex ", v, ": kind ", detail::hexadecimal(kind));
            }
        }
        if (!view.closes(v)) continue;
        if (v - first < 2 || view.first(v) != first)
            return detail::message("the ring from vertex ", first, " does not close");
        // ring_previous of the first vertex is the tip of its left slot, which must be the last vertex.
        if ((view.kind(first, 0) & word::kSpecial) != 0 || view.tip(first, 0) != v) {
            return detail::message("the ring from vertex ", first, ": the tip of its left slot is not the last vertex");
        }
        first = v + 1;
    }
    if (first != view.ring_vertices) return detail::message("the ring from vertex ", first, " does not close");
    // The first copy of a T2, or the T0w that replaces it, must be followed by the second copy.
    for (std::uint32_t v = 0; v < view.ring_vertices; ++v) {
        for (std::uint32_t side = 0; side < 2; ++side) {
            const std::uint32_t kind = view.kind(v, side);
            const bool wart = (kind & (word::kSpecial | word::kWart)) == word::kWart;
            if (!wart && kind != word::kRedundant && kind != word::kClosing) continue;
            const std::uint32_t n = ops.ring_next(v), nn = ops.ring_next(n);
            if (kind == word::kRedundant && view.tip(v, side) != nn)
                return detail::message("ring vertex ", v, ": a T2 with another tip than v.n.n");
            const bool second = (view.kind(n, side) & word::kSpecial) == 0;
            const bool third = !wart && ops.ring_next(nn) == v && (view.kind(nn, side) & word::kSpecial) == 0 &&
                               (view.kind(n, side) == word::kRedundant || view.kind(n, side) == word::kClosing);
            if (!second && !third) return detail::message("ring vertex ", v, ": a T2 without its second copy");
            if (second && (view.kind(n, side) & word::kWart) != 0)
                return detail::message("ring vertex ", v, ": a wart in a wart");
            if (second && view.tip(n, side) != v)
                return detail::message("ring vertex ", v, ": the second copy of its T2 has another tip");
        }
    }
    return {};
}

/// Checks that the corners in VO, VO* and C are canonical or null, and that the vertices in VO are used. Requires
/// check_rings.
template <class View>
std::string check_named(const View& view) {
    const Operators<View> ops(view);
    const auto exists = [&](std::uint32_t c) {
        return c / 4 < view.triangle_numbers() && c % 4 < 3 && ops.is_canonical(TriangleId{c / 4});
    };
    const auto exists_or_null = [&](std::uint32_t c) { return c == kNullCorner.value || exists(c); };
    for (const std::uint32_t c : view.c) {
        if (!exists(c)) return "an isolated vertex has an invalid corner";
    }
    for (std::uint32_t i = 0; i < view.vo.size() / 2; ++i) {
        const bool has_flag = i % 3 != 0 && (view.vo[std::size_t{i / 3} * 6 + i % 3] & word::kT0Flip) != 0;
        if (has_flag || view.t0_vertex(i) >= view.used_vertices()) return detail::message("T0 ", i / 3, ": vertex");
        if (!exists_or_null(view.t0_opposite(i)))
            return detail::message("T0 ", i / 3, ": opposite ", view.t0_opposite(i));
    }
    for (std::uint32_t slot = 0; slot < 2 * view.ring_vertices; ++slot) {
        if (!is_irregular(view, slot)) continue;
        for (std::uint32_t end = 0; end < 2; ++end) {
            const std::uint32_t o = view.star_opposite(slot / 2, slot % 2, end);
            if (!exists_or_null(o)) return detail::message("ring vertex ", slot / 2, ": VO* opposite ", o);
        }
    }
    return {};
}

/// Walks each star once and checks the opposites met. Requires check_named.
///
/// Opposite is an involution if opposite(opposite(c)) == c for each c with a larger opposite, and if the numbers of
/// corners with a larger and with a smaller opposite are equal. Before this is known a walk may not return, so the
/// number of steps is limited to the number of corners.
template <class View>
class StarChecker {
  public:
    explicit StarChecker(const View& view) : view_(view), ops_(view), numbers_(view.triangle_numbers()) {}

    std::string check() {
        for (std::uint32_t t = 0; t < numbers_; ++t) most_ += ops_.is_canonical(TriangleId{t}) ? 3 : 0;
        for (std::uint32_t v = 0; v < view_.used_vertices(); ++v) {
            if (!check_star(VertexId{v})) return std::move(why_);
        }
        // Fewer corners were walked if a vertex has several fans: v.c leads to only one.
        if (corners_ != most_) return detail::message(corners_, " corners found around vertices, of ", most_);
        if (larger_ != smaller_) return "opposite is not an involution";
        for (std::uint32_t slot = 0; slot < 2 * view_.ring_vertices; ++slot) {
            if (is_irregular(view_, slot) && !check_star_entries(slot)) return std::move(why_);
        }
        return {};
    }

  private:
    template <class... Args>
    bool fail(const Args&... parts) {
        why_ = detail::message(parts...);
        return false;
    }
    bool fail_at(CornerId c, CornerId o) { return fail("corner ", c.value, ": opposite ", o.value); }

    bool exists(CornerId c) const {
        return ops_.triangle(c).value < numbers_ && c.value % 4 < 3 && ops_.is_canonical(ops_.triangle(c));
    }
    void count(CornerId c, CornerId o) { ++(c.value < o.value ? larger_ : smaller_); }

    struct Around {
        VertexId after, before;  ///< vertices of the next and previous corner
    };
    /// Reads the triangle of c into `at`; checks that its vertices differ and that vertex(c) is v.
    bool enter(CornerId c, VertexId v, Around& at) {
        if (corners_++ == most_) return fail("vertex ", v.value, ": its star does not end");
        at = {ops_.vertex(ops_.next(c)), ops_.vertex(ops_.previous(c))};
        if (ops_.vertex(c) != v) return fail("corner ", c.value, " is not at vertex ", v.value);
        if (at.after == v || at.before == v || at.after == at.before)
            return fail("triangle ", c.value / 4, " is degenerate");
        return true;
    }

    bool check_star(VertexId v) {
        const CornerId first = ops_.corner(v);
        if (first.is_null()) return fail("vertex ", v.value, ": no corner");
        neighbors_.clear();
        Around at;
        if (!enter(first, v, at)) return false;
        const Around begin = at;
        for (CornerId c = first;;) {
            neighbors_.push_back(at.after);
            const CornerId facing = ops_.next(c), o = ops_.opposite(facing);
            if (o.is_null()) return check_border(v, first, begin);
            if (!exists(o) || o == facing) return fail_at(facing, o);
            if (facing.value < o.value && ops_.opposite(o) != facing) return fail_at(facing, o);
            count(facing, o);
            c = ops_.next(o);
            const Around left = at;
            if (c == first) return begin.after == left.before ? check_fan(v) : fail_at(facing, o);
            if (!enter(c, v, at)) return false;
            if (at.after != left.before) return fail_at(facing, o);
        }
    }

    /// Walks backward from v.c to the other border. Each step is checked to invert a swing, so the walk meets no corner
    /// of the forward walk.
    bool check_border(VertexId v, CornerId first, Around at) {
        if (ops_.near_neighbors(v, [](VertexId) {}))
            return fail("vertex ", v.value, ": near_neighbors misses its border");
        for (CornerId c = first;;) {
            const CornerId facing = ops_.previous(c), o = ops_.opposite(facing);
            if (o.is_null()) return true;
            if (!exists(o) || o == facing || ops_.opposite(o) != facing) return fail_at(facing, o);
            count(o, facing);
            c = ops_.previous(o);
            const Around left = at;
            if (!enter(c, v, at)) return false;
            if (at.before != left.after) return fail_at(facing, o);
        }
    }

    /// Compares near_neighbors with the neighbors found by the walk.
    bool check_fan(VertexId v) {
        std::size_t i = 0;
        bool same = true;
        const bool told =
            ops_.near_neighbors(v, [&](VertexId u) { same = i < neighbors_.size() && neighbors_[i++] == u && same; });
        return !told || (same && i == neighbors_.size()) || fail("vertex ", v.value, ": neighbors");
    }

    /// Checks that the opposites in VO* agree with the operators, which infer some of them from other slots instead.
    bool check_star_entries(std::uint32_t slot) {
        const std::uint32_t v = slot / 2, side = slot % 2;
        for (std::uint32_t end = 0; end < 2; ++end) {
            const CornerId c{8 * v + (end == 0 ? 6 * side : 2 + 2 * side)};
            const std::uint32_t entry = view_.star_opposite(v, side, end);
            if (ops_.opposite(c).value != entry) return fail("ring vertex ", v, ": VO* opposite ", entry);
        }
        return true;
    }

    const View& view_;
    const Operators<View> ops_;
    const std::uint32_t numbers_;
    std::uint64_t most_ = 0;                  // corners of all triangles
    std::uint64_t corners_ = 0;               // corners walked
    std::uint64_t larger_ = 0, smaller_ = 0;  // corners with a larger, a smaller opposite
    std::vector<VertexId> neighbors_;         // neighbors of one vertex, in star order
    std::string why_;
};

std::string check_copies(std::uint32_t vertices, std::span<const std::uint32_t> copies) {
    BitVector copied(copies.empty() ? 0 : vertices);
    for (std::size_t i = 0; i < copies.size(); i += 2) {
        if (copies[i] >= vertices || (i > 0 && copies[i] <= copies[i - 2])) {
            return detail::message("copied vertex ", copies[i]);  // ascending, for binary search
        }
        copied.set(copies[i]);
    }
    for (std::size_t i = 1; i < copies.size(); i += 2) {
        if (copies[i] >= vertices || copied.test(copies[i])) return detail::message("a copy of vertex ", copies[i]);
    }
    return {};
}

template <class View>
Result<LrStreamView<View>> validate_tables(std::span<const std::uint32_t> words,
                                           const Result<LrStreamView<View>>& stream) {
    if (!stream) return stream;
    if (words[kW_crc] != lr_checksum(words)) return malformed_lr("checksum does not match");
    const View& view = stream->view;
    std::string why = check_slots(view);
    if (why.empty()) why = check_rings(view);
    if (why.empty()) why = check_named(view);
    if (why.empty()) why = StarChecker<View>(view).check();
    if (why.empty()) why = check_copies(view.used_vertices(), stream->copies);
    if (!why.empty()) return malformed_lr(std::move(why));
    return stream;
}

}  // namespace

Result<LrStreamView<LrView>> validate_lr(std::span<const std::uint32_t> words) {
    return validate_tables(words, view_lr(words));
}
Result<LrStreamView<CompactLrView>> validate_compact_lr(std::span<const std::uint32_t> words) {
    return validate_tables(words, view_compact_lr(words));
}

}  // namespace lacedring
