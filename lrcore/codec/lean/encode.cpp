// Encodes lean streams: LR 2011, section 7, with the wart skipping of section 5. Differs from the paper:
// - a ring with (almost) all triangles on one side stores only the left side; the few others are stored verbatim. The
// left side is a tree of triangles, more than a third of which have a ring edge, so this never takes more than storing
// all triangles verbatim, three references per triangle;
// - a ring is rotated so that its closing edge has a free slot (a border, or a T2's redundant copy). This slot stores
// the ring's first vertex, so additional rings cost nothing;
// - a triangle that was reversed to orient the mesh has a flag in its word.

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>

#include "lacedring/lacedring.hpp"
#include "lacedring/streams.hpp"
#include "lrcore/base/bits.h"
#include "lrcore/base/crc32.h"
#include "lrcore/base/message.h"
#include "lrcore/codec/lean/lean_format.h"
#include "lrcore/ring/ring_walk.h"

namespace lacedring {
namespace {

static_assert(std::endian::native == std::endian::little, "streams are little-endian words");

constexpr std::uint32_t kNone = UINT32_MAX;
constexpr std::uint32_t kMostVertices = LR_LEAN_TIP_MASK + 1;
constexpr std::uint32_t kMostSlots = UINT32_MAX / 3;  // three indices per slot, numbered by 32 bits

/// Number of sides of a ring stored as slots: 1 (left) or 2.
using Sides = std::uint32_t;

class Encoder {
  public:
    Encoder(const CornerTable& table, const Rings& rings, const LeanOptions& options)
        : table_(table),
          rings_(rings),
          options_(options),
          rung_(table.triangle_count()),
          covered_(table.triangle_count()) {}

    Result<EncodedLean> encode() {
        if (table_.vertex_count > kMostVertices) {
            return Error{
                ErrorCode::too_large,
                detail::message(table_.vertex_count, " vertices; a lean stream numbers at most ", kMostVertices)};
        }
        for (const RingEdge& edge : rings_.edges) {
            rung_.set(triangle(edge.left).value);
            if (!edge.right.is_null()) rung_.set(triangle(edge.right).value);
        }
        std::vector<Sides> sides(rings_.count());
        std::uint32_t rings2 = 0, rings1 = 0;
        for (std::size_t r = 0; r < rings_.count(); ++r) {
            sides[r] = choose_sides(rings_.ring(r));
            const auto size = static_cast<std::uint32_t>(rings_.ring(r).size());
            (sides[r] == 2 ? rings2 : rings1) += size;
        }
        out_.statistics.ring_vertices = rings2 + rings1;
        out_.vertex_order.reserve(table_.vertex_count);
        // Reserves space for every triangle without a ring edge; untouched pages cost no memory.
        std::size_t t0 = 0;
        for (std::uint32_t t = 0; t < table_.triangle_count(); ++t) t0 += rung_.test(t) ? 0 : 1;
        out_.words.reserve(LR_LEAN_HEADER_WORDS + std::size_t{2} * rings2 + rings1 + 3 * t0);
        out_.words.resize(LR_LEAN_HEADER_WORDS);
        out_.slot_triangle.reserve(std::size_t{2} * rings2 + rings1 + t0);
        for (const Sides wanted : {2U, 1U}) {
            for (std::size_t r = 0; r < rings_.count(); ++r) {
                if (sides[r] == wanted) emit(rings_.ring(r), wanted);
            }
        }
        const std::uint32_t verbatim = emit_verbatim();
        if (out_.slot_triangle.size() > kMostSlots) {
            return Error{ErrorCode::too_large,
                         detail::message(out_.slot_triangle.size(), " slots; a lean stream has at most ", kMostSlots)};
        }
        renumber();
        write_header(rings2, rings1, verbatim);
        return std::move(out_);
    }

  private:
    /// The T0 that the first copy of a T2 at edge i could hold, given by its corner across the shared edge; null if
    /// none.
    CornerId wart_at(std::uint32_t side, std::size_t i) const {
        if (!options_.wart_skipping || !walk_.repeats(side, i) || walk_.is_t3(side)) return kNullCorner;
        const CornerId y = walk_.across_t2(table_, side, i);
        if (y.is_null() || rung_.test(triangle(y).value) || covered_.test(triangle(y).value)) return kNullCorner;
        return y;
    }

    /// The cheaper number of sides, in references: 2 or 1 per ring vertex, plus 3 per triangle stored verbatim.
    Sides choose_sides(std::span<const RingEdge> ring) {
        walk_ = RingWalk(ring);
        std::int64_t on_right = 0, repeated = 0;
        for (std::size_t i = 0; i < walk_.size(); ++i) {
            if (walk_.face(1, i).is_null()) continue;
            ++(walk_.repeats(1, i) ? repeated : on_right);
        }
        if (walk_.is_t3(1)) on_right = 1;
        // Storing the right side costs a slot per vertex; it saves storing its triangles and the T0 of its warts
        // verbatim.
        const auto size = static_cast<std::int64_t>(walk_.size());
        if (size <= 3 * on_right) return 2;
        if (size > 3 * (on_right + repeated)) return 1;
        std::int64_t warts = 0;
        paired_.clear();
        for (std::size_t i = 0; i < walk_.size(); ++i) {
            const CornerId y = wart_at(1, i);
            if (y.is_null()) continue;
            covered_.set(triangle(y).value);
            paired_.push_back(triangle(y));
            ++warts;
        }
        for (const TriangleId t : paired_) covered_.clear(t.value);
        return size <= 3 * (on_right + warts) ? 2 : 1;
    }

    void fill_slots(std::uint32_t side) {
        auto& tip = tip_[side];
        tip.assign(walk_.size(), kNullCorner);
        wart_[side].assign(walk_.size(), false);
        const bool t3 = walk_.is_t3(side);
        for (std::size_t i = 0; i < walk_.size(); ++i) {
            const CornerId c = walk_.face(side, i);
            if (c.is_null()) continue;
            if (t3 ? i != 0 : walk_.repeats(side, i)) {
                if (!t3) ++out_.statistics.t2;
                continue;
            }
            if (covered_.test(triangle(c).value)) continue;  // stored by another ring
            covered_.set(triangle(c).value);
            tip[i] = c;
        }
        if (t3) ++out_.statistics.t2;
    }

    void fill_warts(std::uint32_t side) {
        for (std::size_t i = 0; i < walk_.size(); ++i) {
            const CornerId y = wart_at(side, i);
            if (y.is_null()) continue;
            covered_.set(triangle(y).value);
            tip_[side][i] = y;
            wart_[side][i] = true;
            ++out_.statistics.t0_wart;
        }
    }

    /// Chooses the edge that closes the ring: an edge with a free slot, or else with a wart, which is removed. Sets
    /// `side` to the side of the slot.
    std::size_t closing_edge(std::uint32_t& side) {
        for (std::size_t i = 0; i < walk_.size(); ++i) {
            for (side = 0; side < sides_; ++side) {
                if (tip_[side][i].is_null()) return i;
            }
        }
        side = 0;
        const auto it = std::find(wart_[0].begin(), wart_[0].end(), true);
        // The left side is a tree of triangles, whose leaves are T2.
        assert(it != wart_[0].end());
        const auto i = static_cast<std::size_t>(it - wart_[0].begin());
        covered_.clear(triangle(tip_[0][i]).value);
        tip_[0][i] = kNullCorner;
        wart_[0][i] = false;
        --out_.statistics.t0_wart;
        return i;
    }

    /// Appends a ring's slots. Words hold the mesh's vertex numbers until renumber().
    void emit(std::span<const RingEdge> ring, Sides sides) {
        walk_ = RingWalk(ring);
        sides_ = sides;
        for (std::uint32_t s = 0; s < sides_; ++s) fill_slots(s);
        for (std::uint32_t s = 0; s < sides_; ++s) fill_warts(s);
        std::uint32_t closing_side = 0;
        const std::size_t closing = closing_edge(closing_side);
        std::size_t i = closing;
        do {
            i = walk_.after(i);
            out_.vertex_order.push_back(walk_.start(i).value);
            for (std::uint32_t s = 0; s < sides_; ++s) {
                const CornerId tip = tip_[s][i];
                std::uint32_t word = 0, slot_triangle = kNone;
                if (!tip.is_null()) {
                    slot_triangle = triangle(tip).value;
                    const bool wart = wart_[s][i];
                    word = (wart ? table_.vertex(tip) : walk_.tip(s, i)).value;
                    if (wart) word |= LR_LEAN_WART_FLAG;
                    if (table_.flipped(triangle(tip))) word |= LR_LEAN_FLIP_FLAG;
                } else if (i == closing && s == closing_side) {
                    word = walk_.start(walk_.after(i)).value | LR_LEAN_CLOSE_FLAG;
                } else {
                    word = walk_.start(s == 0 ? i : walk_.after(i)).value;
                }
                out_.words.push_back(word);
                out_.slot_triangle.push_back(slot_triangle);
            }
        } while (i != closing);
    }

    std::uint32_t emit_verbatim() {
        std::uint32_t count = 0;
        for (std::uint32_t i = 0; i < table_.triangle_count(); ++i) {
            const TriangleId t{i};
            if (covered_.test(i) || table_.degenerate(t)) continue;
            const std::uint32_t swap = table_.flipped(t) ? 1 : 0;
            out_.words.push_back(table_.vertex(corner(t, 0)).value);
            out_.words.push_back(table_.vertex(corner(t, 1 + swap)).value);
            out_.words.push_back(table_.vertex(corner(t, 2 - swap)).value);
            out_.slot_triangle.push_back(i);
            ++(rung_.test(i) ? out_.statistics.unrung : out_.statistics.t0);
            ++count;
        }
        // Counts the neighbors of the T0 left. covered_ is reused: it marks the triangles not yet counted.
        for (std::size_t s = out_.slot_triangle.size() - count; s < out_.slot_triangle.size(); ++s) {
            const TriangleId t{out_.slot_triangle[s]};
            if (rung_.test(t.value)) continue;
            for (std::uint32_t k = 0; k < 3; ++k) {
                const CornerId o = table_.opposite(corner(t, k));
                if (o.is_null() || !covered_.test(triangle(o).value)) continue;
                covered_.clear(triangle(o).value);
                ++out_.statistics.irregular;
            }
        }
        return count;
    }

    /// Numbers the vertices off the rings after the ring vertices, and writes the new numbers into the words.
    void renumber() {
        std::vector<std::uint32_t> number(table_.vertex_count, kNone);
        const auto on_rings = static_cast<std::uint32_t>(out_.vertex_order.size());
        for (std::uint32_t i = 0; i < on_rings; ++i) number[out_.vertex_order[i]] = i;
        for (std::uint32_t v = 0; v < table_.vertex_count; ++v) {
            if (number[v] != kNone) continue;
            number[v] = static_cast<std::uint32_t>(out_.vertex_order.size());
            out_.vertex_order.push_back(v);
        }
        BitVector used(table_.vertex_count);
        for (std::size_t i = LR_LEAN_HEADER_WORDS; i < out_.words.size(); ++i) {
            const std::uint32_t v = number[out_.words[i] & LR_LEAN_TIP_MASK];
            out_.words[i] = (out_.words[i] & ~LR_LEAN_TIP_MASK) | v;
            if (v >= on_rings && !used.test(v)) {
                used.set(v);
                ++out_.statistics.isolated;
            }
        }
    }

    void write_header(std::uint32_t rings2, std::uint32_t rings1, std::uint32_t verbatim) {
        out_.words[LR_LEAN_WORD_MAGIC] = LR_LEAN_MAGIC;
        out_.words[LR_LEAN_WORD_VERSION] = LR_LEAN_VERSION;
        out_.words[LR_LEAN_WORD_VERTICES] = table_.vertex_count;
        out_.words[LR_LEAN_WORD_RINGS2] = rings2;
        out_.words[LR_LEAN_WORD_RINGS1] = rings1;
        out_.words[LR_LEAN_WORD_VERBATIM] = verbatim;
        out_.words[LR_LEAN_WORD_TRIANGLES] = table_.triangle_count() - table_.topology.degenerate;
        out_.words[LR_LEAN_WORD_CHECKSUM] = lean_checksum(out_.words);
    }

    const CornerTable& table_;
    const Rings& rings_;
    const LeanOptions& options_;
    BitVector rung_;     // triangles with a ring edge
    BitVector covered_;  // triangles that have a slot
    // The ring being written: its walk, the number of sides stored, and the contents of their slots.
    RingWalk walk_;
    Sides sides_ = 2;
    std::array<std::vector<CornerId>, 2> tip_;  // null: the slot is free
    std::array<std::vector<bool>, 2> wart_;
    std::vector<TriangleId> paired_;
    EncodedLean out_;
};

}  // namespace

Result<EncodedLean> encode_lean(const CornerTable& table, const Rings& rings, const LeanOptions& options) {
    return Encoder(table, rings, options).encode();
}

}  // namespace lacedring
