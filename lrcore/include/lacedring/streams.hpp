#pragma once
// Streams and LR tables in memory: views, checks, decoders. Does not depend on corner tables and rings.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "lacedring/base.hpp"

namespace lacedring {

/// Formats of streams. docs/choosing.md says when to use which.
enum class Format : std::uint8_t {
    lean,        ///< one vertex reference per triangle
    packed,      ///< little more than one bit per triangle, in blocks of 256 triangles
    lr,          ///< the standard LR tables: every corner operator in constant time
    lr_compact,  ///< the bit-efficient LR tables: the same operators in fewer bytes
};

/// "lean", "packed", "lr" or "lr-compact".
const char* name_of(Format format);

/// Three vertices.
struct Triangle {
    std::uint32_t v[3];

    /// True for an empty slot: the first two vertices are equal.
    bool degenerate() const { return v[0] == v[1]; }
    bool operator==(const Triangle&) const = default;
};

// The lean LR index stream: one vertex reference per ring edge and side; the few triangles without a ring edge are
// stored verbatim. Paper: LR 2011, section 7 and section 5 (wart skipping).
//
// A stream has at most 3 references per triangle and a 32-byte header, for any mesh.
//
// Slots are numbered: [0, 2*rings2) two-sided, then rings1 one-sided, then verbatim. Each slot decodes to one triangle.
// The triangle is degenerate (its first two vertices are equal) if the slot is the redundant copy of a T2, is at a
// border, or closes a ring.

/// A view of a lean stream with its header parsed. Does not own the words.
struct LeanView {
    std::span<const std::uint32_t> payload;
    std::uint32_t vertices = 0;
    std::uint32_t rings2 = 0;
    std::uint32_t rings1 = 0;
    std::uint32_t verbatim = 0;
    std::uint32_t triangles = 0;

    std::uint32_t ring_slots() const { return 2 * rings2 + rings1; }
    std::uint32_t slots() const { return ring_slots() + verbatim; }
    /// Bytes of the whole stream, including the header.
    std::size_t bytes() const;
    /// References stored: one per ring slot, three per verbatim triangle.
    std::size_t references() const { return std::size_t{ring_slots()} + std::size_t{3} * verbatim; }
};

/// CRC-32 of a stream without its checksum word. `words` is at least the header.
std::uint32_t lean_checksum(std::span<const std::uint32_t> words);

/// Reads the header of `words` and checks sizes only. decode_lean trusts the rest: call validate_lean instead on words
/// that were not just encoded. Errors: malformed. Untrusted input: safe.
Result<LeanView> view_lean(std::span<const std::uint32_t> words);

/// Checks the checksum and everything that decoders rely on: rings tile their sections and close, tips are vertices,
/// and the number of triangles that are not degenerate is the header's. Cost: O(T). Untrusted input: safe.
Result<LeanView> validate_lean(std::span<const std::uint32_t> words);

/// Expands every slot: indices holds 3 * view.slots() entries. The stream must be valid (validate_lean).
/// Triangle 2v is (v, L[v], v.n), 2v+1 is (v.n, R[v], v). Cost: O(slots), no allocation.
void decode_lean(const LeanView& view, std::span<std::uint32_t> indices);

/// Decodes the triangles without degenerate slots, in slot order: 3 * view.triangles entries. Cost: as decode_lean.
void decode_lean_triangles(const LeanView& view, std::span<std::uint32_t> indices);

/// Decodes the triangle of one slot in constant time; reads at most four words.
Triangle decode_lean_slot(const LeanView& view, std::uint32_t slot);

// The packed stream: connectivity in little more than one bit per triangle, in blocks of 256 triangles that can be
// decoded independently.
//
// Each side of a ring is a polygon cut into triangles. A walk over the polygon from triangle to triangle needs a *turn
// bit* per triangle: if a triangle is entered across the edge (a, b), its third vertex is a+1 or b-1, which becomes the
// new a or b. All else is an *event*: a T0, whose third vertex lies further along and which splits the polygon in two,
// or the rare start of another polygon. docs/packed-format.md specifies the format. Not in the paper.

/// A view of a packed stream with its header parsed. Does not own the words.
struct PackedView {
    std::span<const std::uint32_t> words;  ///< the whole stream
    std::uint32_t vertices = 0;
    std::uint32_t triangles = 0;
    std::uint32_t own = 0;  ///< own triangles come first; all others are doubles of these
    std::uint32_t vertex_bits = 0;
    std::uint32_t runs = 0;  ///< number of runs of doubles

    std::uint32_t blocks() const;
    std::size_t table_word() const;    ///< index in `words` of the table of groups
    std::size_t doubles_word() const;  ///< index of the doubles, if there are any
    std::size_t groups_word() const;   ///< index of the groups
    std::size_t bytes() const { return words.size_bytes(); }
};

/// CRC-32 of a stream without its checksum word. `words` is at least the header.
std::uint32_t packed_checksum(std::span<const std::uint32_t> words);

/// Reads the header of `words` and checks sizes only: call validate_packed instead on words that were not just encoded.
/// Errors: malformed. Untrusted input: safe.
Result<PackedView> view_packed(std::span<const std::uint32_t> words);

/// Checks the checksum, doubles, heads and every block: each triangle has three different vertices in range.
/// Cost: O(T). Untrusted input: safe.
Result<PackedView> validate_packed(std::span<const std::uint32_t> words);

/// Expands all triangles: indices holds 3 * view.triangles entries. The stream must be valid (validate_packed). Cost:
/// O(T), no allocation. Runs on at most `threads` threads, including the calling thread; on fewer if the stream is
/// small or the system creates no more threads. Never throws.
void decode_packed(const PackedView& view, std::span<std::uint32_t> indices, unsigned threads = 1);

/// Expands one block: from triangle 256 * block on, 3 * 256 entries or fewer for the last block.
void decode_packed_block(const PackedView& view, std::uint32_t block, std::span<std::uint32_t> indices);

/// Decodes one triangle with a few popcounts. Reads at most 8 words of turn bits, 12 words of its group's head and 200
/// bytes of its record.
Triangle decode_packed_triangle(const PackedView& view, std::uint32_t triangle);

// The words of the standard LR tables. Paper: LR 2011, sections 4.4, 4.5 and 5.
//
// L and R are interleaved: word 2v is v.l, word 2v+1 is v.r. A word has a vertex and four bits for the kind of the
// slot. The paper infers two kinds from the references (a redundant T2, a border). Here they are explicit, so that the
// tables are correct even if two edges have the same ends, as on surfaces of high genus and after a non-manifold mesh
// was made manifold.

namespace word {

constexpr std::uint32_t kTip = 0x0fffffff;   ///< the tip vertex; for an irregular triangle, its index in VO*
constexpr std::uint32_t kWart = 0x80000000;  ///< T0w: the slot's edge skips the tip of the T2w in the next slot
/// Ti: VO* holds the tip and the opposites of the start and end corners.
constexpr std::uint32_t kIrregular = 0x40000000;
constexpr std::uint32_t kFlip = 0x20000000;     ///< the input's triangle has the opposite orientation
constexpr std::uint32_t kSpecial = 0x10000000;  ///< the slot has no own triangle; the other bits say why:

constexpr std::uint32_t kRedundant = kSpecial;            ///< first copy of a T2; the tip is v.n.n
constexpr std::uint32_t kBorder = kSpecial | kIrregular;  ///< no triangle on this side
/// Redundant, left side only: the slot of the ring's last vertex; the tip is the ring's first.
constexpr std::uint32_t kClosing = kSpecial | kWart;
constexpr std::uint32_t kKind = kWart | kIrregular | kSpecial;

constexpr std::uint32_t kT0Flip = 0x80000000;  ///< on the first vertex of a T0 in VO: as kFlip

}  // namespace word

// The standard Laced Ring representation: L, R, VO, VO* and C. Paper: LR 2011, sections 4 and 5.
//
// Vertices 0 .. ring_vertices-1 lie along the rings, ring after ring; then come isolated vertices, then vertices of no
// triangle. Triangle 2v is (v, L[v], v.n), triangle 2v+1 is (v.n, R[v], v), triangles from 2 ring_vertices on are T0.
// Corners are 8v+0, 1, 2 (left: v, v.l, v.n) and 8v+4, 5, 6 (right: v.n, v.r, v); T0 triangle t has 4t, 4t+1, 4t+2.

/// A view of the arrays, in an LrTable or a memory-mapped file. Does not own them.
struct LrView {
    std::uint32_t vertices = 0;         ///< all: on rings, isolated, and of no triangle
    std::uint32_t ring_vertices = 0;    ///< m_r
    std::span<const std::uint32_t> lr;  ///< 2 m_r words (namespace word)
    std::span<const std::uint32_t> vo;  ///< 6 per T0: three vertices, three opposite corners
    /// VO*, 3 per irregular triangle: tip, opposites of the start and end corners.
    std::span<const std::uint32_t> star;
    std::span<const std::uint32_t> c;  ///< a corner of each isolated vertex

    // The interface that Operators requires of a representation. side: 0 left, 1 right.
    std::uint32_t kind(std::uint32_t v, std::uint32_t side) const { return lr[2 * v + side] & word::kKind; }
    bool closes(std::uint32_t v) const { return kind(v, 0) == word::kClosing; }
    std::uint32_t first(std::uint32_t v) const { return lr[2 * v] & word::kTip; }
    std::uint32_t tip(std::uint32_t v, std::uint32_t side) const { return tip(lr[2 * v + side]); }
    /// The opposite of an irregular triangle's start corner (end = 0) or end corner (end = 1).
    std::uint32_t star_opposite(std::uint32_t v, std::uint32_t side, std::uint32_t end) const {
        return star[(lr[2 * v + side] & word::kTip) + 1 + end];
    }
    /// A slot's word, and the tip of such a word.
    std::uint32_t word(std::uint32_t v, std::uint32_t side) const { return lr[2 * v + side]; }
    std::uint32_t tip(std::uint32_t w) const {
        const std::uint32_t i = w & word::kTip;
        return (w & (word::kSpecial | word::kIrregular)) == word::kIrregular ? star[i] : i;
    }

    static constexpr std::uint32_t kNotPlain = UINT32_MAX;
    /// The opposite of a ring corner in the common case: no wart, redundant slot, border, end of a ring or irregular
    /// triangle nearby. Otherwise kNotPlain: Operators must handle it.
    std::uint32_t plain_opposite(std::uint32_t corner) const {
        const std::uint32_t v = corner / 8, side = corner / 4 % 2;
        if (v < 2 || v + 1 >= ring_vertices) return kNotPlain;
        const std::uint32_t* left = lr.data() + 2 * std::size_t{v};  // left[-2] is the word of v.p
        if (corner % 4 == 1) return (left[0] | left[1]) <= word::kTip ? corner ^ 4 : kNotPlain;
        const std::uint32_t* w = left + side;
        const std::uint32_t u = w[0];
        if ((u | w[-2]) > word::kTip || closing(left[0])) return kNotPlain;
        // A corner at v: the opposite is in the slot that starts at v.n or in the slot that ends at the tip.
        if (corner % 8 % 6 == 0) {
            if (w[2] > word::kTip) return kNotPlain;
            if (w[2] == u) return corner + 8 + (side == 0 ? 2 : 0U - 2);
            if (u < 2 || u >= ring_vertices) return kNotPlain;
            const std::uint32_t* far = lr.data() + 2 * std::size_t{u - 1};
            return far[side] == v + 1 && !skips(far[static_cast<std::ptrdiff_t>(side) - 2]) && !closing(far[0])
                       ? 8 * (u - 1) + corner % 8
                       : kNotPlain;
        }
        // A corner at v.n: the opposite is in the slot that ends at v or in the slot that starts at the tip.
        if (skips(w[-4]) || closing(left[-2]) || closing(left[-4])) return kNotPlain;
        if (w[-2] == u) return corner - 8 + (side == 0 ? 0U - 2 : 2);
        return u < ring_vertices && lr[2 * std::size_t{u} + side] == v ? 8 * u + corner % 8 : kNotPlain;
    }

    /// The neighbors of a ring vertex v whose triangles are two runs of T1, one on each side (the common case): left,
    /// v.n, right .. right + right_count, v.p, left + left_count .. left + 1 (inclusive, in swing order).
    struct PlainFan {
        std::uint32_t left, left_count, right, right_count;
    };
    /// Along a corridor, tips run opposite to v, so the slots between L[v] and L[v.p] have v as their tip: they are
    /// counted without a walk and only tested. Constant time; returns false if Operators must walk.
    bool plain_fan(std::uint32_t v, PlainFan& fan) const {
        if (v < 2 || v + 1 >= ring_vertices) return false;
        const std::uint32_t* w = lr.data() + 2 * std::size_t{v};
        if ((w[0] | w[1] | w[-1] | w[-2]) > word::kTip) return false;
        // The slots of v.p.p may be anything except a wart, which would skip v.p, or the end of another ring.
        if ((int{skips(w[-3])} | int{skips(w[-4])} | int{closing(w[-4])}) != 0) return false;
        fan = {w[0], w[-2] - w[0], w[1], w[-1] - w[1]};
        return run_has_tip(fan.left, fan.left_count, v, 0) && run_has_tip(fan.right, fan.right_count, v, 1);
    }

    static bool skips(std::uint32_t w) { return (w & (word::kSpecial | word::kWart)) == word::kWart; }
    static bool closing(std::uint32_t w) { return (w & word::kKind) == word::kClosing; }

    /// Does triangle t have the opposite orientation in the input?
    bool flipped(std::uint32_t t) const {
        return t < 2 * ring_vertices ? (lr[t] & word::kFlip) != 0
                                     : (vo[std::size_t{6} * (t - 2 * ring_vertices)] & word::kT0Flip) != 0;
    }
    std::uint32_t t0_vertex(std::uint32_t i) const { return vo[std::size_t{i / 3} * 6 + i % 3] & ~word::kT0Flip; }
    std::uint32_t t0_opposite(std::uint32_t i) const { return vo[std::size_t{i / 3} * 6 + 3 + i % 3]; }
    std::uint32_t isolated_corner(std::uint32_t i) const { return c[i]; }

    /// Do the slots first .. first + count - 1 have the plain tip v? False if count > 4. Does not branch on the count.
    bool run_has_tip(std::uint32_t first, std::uint32_t count, std::uint32_t v, std::uint32_t side) const {
        if (count > 4 || std::uint64_t{first} + 3 >= ring_vertices) return false;
        const std::uint32_t* w = lr.data() + 2 * std::size_t{first} + side;
        return ((w[0] == v) | (count < 1)) & ((w[2] == v) | (count < 2)) & ((w[4] == v) | (count < 3)) &
               ((w[6] == v) | (count < 4));
    }

    std::uint32_t used_vertices() const { return ring_vertices + static_cast<std::uint32_t>(c.size()); }
    /// Number of triangle numbers: 2 m_r, then one per T0. The numbers of redundant T2 copies and borders name no
    /// triangle.
    std::uint32_t triangle_numbers() const { return 2 * ring_vertices + static_cast<std::uint32_t>(vo.size() / 6); }
    /// Stored references: 2 m_r + 6 n_0 + 3 n_i + m_i.
    std::size_t references() const { return lr.size() + vo.size() + star.size() + c.size(); }
};

// The bit-efficient Laced Ring representation. Paper: LR 2011, section 6 and Figure 9.
//
// One 32-bit word per ring vertex, with 16 bits for each side, left in the upper half: a wart bit and a 15-bit signed
// offset from v to the tip, modulo m_r. Both wart bits are never needed at once; if both are set, the other 30 bits are
// four flags and a 26-bit index of a record in VO* (in units of `unit` entries, two unless VO* is too large):
//     v.l, v.r             as words of the standard representation (namespace word), each with its kind
//     two more             the opposites of an irregular left triangle
//     two more             the opposites of an irregular right triangle
//
//     31    30-16         15    14-0            31   30   29   28   27   26-16      15   14-0
//     L_w   left offset   R_w   right offset    1    L_w  R_w  L_i  R_i  index, hi  1    index, lo
//
// A short offset of 0 means a border; 2, without wart bit, a redundant T2. So these need a record: a triangle whose tip
// is v or v+2, a redundant T2 across a ring's end, a closing edge, and a triangle that was reversed. T0, isolated
// vertices and all numbering are as in the standard representation.

namespace compact {
constexpr std::uint32_t kLeftWart = 0x80000000, kRightWart = 0x00008000, kLong = kLeftWart | kRightWart;
constexpr std::uint32_t kLongLeftWart = 0x40000000, kLongRightWart = 0x20000000;
constexpr std::uint32_t kLongLeftIrregular = 0x10000000, kLongRightIrregular = 0x08000000;
constexpr std::uint32_t kIndexBits = 26;
}  // namespace compact

/// A view of the arrays, for Operators. Does not own them.
struct CompactLrView {
    std::uint32_t vertices = 0;
    std::uint32_t ring_vertices = 0;
    std::uint32_t unit = 2;               ///< entries of VO* per unit of a record's index
    std::span<const std::uint32_t> lr;    ///< m_r words
    std::span<const std::uint32_t> vo;    ///< 6 per T0
    std::span<const std::uint32_t> star;  ///< VO*: records of 2, 4 or 6 entries
    std::span<const std::uint32_t> c;     ///< a corner of each isolated vertex

    static bool is_long(std::uint32_t w) { return (w & compact::kLong) == compact::kLong; }
    std::size_t record(std::uint32_t w) const { return std::size_t{(w >> 16 & 0x7ff) << 15 | (w & 0x7fff)} * unit; }
    static std::int32_t offset(std::uint32_t w, std::uint32_t side) {
        const std::uint32_t half = side == 0 ? w >> 16 : w;
        return static_cast<std::int32_t>(half << 17) >> 17;
    }

    std::uint32_t kind(std::uint32_t v, std::uint32_t side) const {
        const std::uint32_t w = lr[v];
        if (is_long(w)) return star[record(w) + side] & word::kKind;
        if ((w & (side == 0 ? compact::kLeftWart : compact::kRightWart)) != 0) return word::kWart;
        const std::int32_t o = offset(w, side);
        return o == 0 ? word::kBorder : o == 2 ? word::kRedundant : 0;
    }
    bool closes(std::uint32_t v) const {
        const std::uint32_t w = lr[v];
        return is_long(w) && (star[record(w)] & word::kKind) == word::kClosing;
    }
    std::uint32_t first(std::uint32_t v) const { return star[record(lr[v])] & word::kTip; }
    std::uint32_t tip(std::uint32_t v, std::uint32_t side) const {
        const std::uint32_t w = lr[v];
        if (is_long(w)) return star[record(w) + side] & word::kTip;
        const std::uint32_t t = v + static_cast<std::uint32_t>(offset(w, side));  // wraps below zero
        if (t < ring_vertices) return t;
        return offset(w, side) < 0 ? t + ring_vertices : t - ring_vertices;
    }
    /// The slot as a word of the standard representation, always with the tip vertex.
    std::uint32_t word(std::uint32_t v, std::uint32_t side) const {
        const std::uint32_t w = lr[v];
        if (is_long(w)) return star[record(w) + side];
        const std::uint32_t half = side == 0 ? w >> 16 : w & 0xffff;
        const auto o = static_cast<std::uint32_t>(static_cast<std::int32_t>(half << 17) >> 17);
        std::uint32_t t = v + o;  // wraps below zero
        if (t >= ring_vertices) t += o >> 31 != 0 ? ring_vertices : 0U - ring_vertices;
        return (half & 0x8000) << 16 | (half == 0 ? word::kBorder : half == 2 ? word::kRedundant : 0) | t;
    }
    static std::uint32_t tip(std::uint32_t w) { return w & word::kTip; }
    std::uint32_t star_opposite(std::uint32_t v, std::uint32_t side, std::uint32_t end) const {
        const std::uint32_t w = lr[v];
        const bool behind_left = side == 1 && (w & compact::kLongLeftIrregular) != 0;
        return star[record(w) + 2 + (behind_left ? 2 : 0) + end];
    }
    /// As LrView::plain_fan.
    using PlainFan = LrView::PlainFan;
    bool plain_fan(std::uint32_t v, PlainFan& fan) const {
        if (v < 2 || v + 1 >= ring_vertices) return false;
        const std::uint32_t a = lr[v], b = lr[v - 1];
        if (((a | b | lr[v - 2]) & compact::kLong) != 0) return plain_long_fan(v, fan);
        const std::int32_t la = offset(a, 0), ra = offset(a, 1), lb = offset(b, 0), rb = offset(b, 1);
        // 0 is a border and 2 a redundant copy; both are 0 with bit 1 cleared.
        if (((la & ~2) == 0) | ((ra & ~2) == 0) | ((lb & ~2) == 0) | ((rb & ~2) == 0)) return false;
        const auto at = [](std::uint32_t u, std::int32_t o) { return u + static_cast<std::uint32_t>(o); };
        fan.left = at(v, la);
        fan.right = at(v, ra);
        fan.left_count = at(v - 1, lb) - fan.left;
        fan.right_count = at(v - 1, rb) - fan.right;
        return run_has_tip(fan.left, fan.left_count, v, 0) && run_has_tip(fan.right, fan.right_count, v, 1);
    }
    /// plain_fan if some of the words are long.
    bool plain_long_fan(std::uint32_t v, PlainFan& fan) const {
        const std::uint32_t l = word(v, 0), r = word(v, 1), pl = word(v - 1, 0), pr = word(v - 1, 1);
        const std::uint32_t ppl = word(v - 2, 0);
        if ((l | r | pl | pr) > word::kTip || LrView::skips(ppl) || LrView::closing(ppl) ||
            LrView::skips(word(v - 2, 1)))
            return false;
        fan = {l, pl - l, r, pr - r};
        const auto row = [&](std::uint32_t first, std::uint32_t count, std::uint32_t side) {
            if (count > 4 || std::uint64_t{first} + 3 >= ring_vertices) return false;
            bool all = true;
            for (std::uint32_t i = 0; i < count; ++i) all &= word(first + i, side) == v;
            return all;
        };
        return row(l, fan.left_count, 0) && row(r, fan.right_count, 1);
    }

    /// Does triangle t have the opposite orientation in the input?
    bool flipped(std::uint32_t t) const {
        if (t >= 2 * ring_vertices) return (vo[std::size_t{6} * (t - 2 * ring_vertices)] & word::kT0Flip) != 0;
        const std::uint32_t w = lr[t / 2];
        return is_long(w) && (star[record(w) + t % 2] & word::kFlip) != 0;
    }
    std::uint32_t t0_vertex(std::uint32_t i) const { return vo[std::size_t{i / 3} * 6 + i % 3] & ~word::kT0Flip; }
    std::uint32_t t0_opposite(std::uint32_t i) const { return vo[std::size_t{i / 3} * 6 + 3 + i % 3]; }
    std::uint32_t isolated_corner(std::uint32_t i) const { return c[i]; }

    /// Do the slots first .. first + count - 1 have the plain tip v? False if count > 4 or one of their words is long.
    bool run_has_tip(std::uint32_t first, std::uint32_t count, std::uint32_t v, std::uint32_t side) const {
        if (count > 4 || std::uint64_t{first} + 3 >= ring_vertices) return false;
        const std::uint32_t* w = lr.data() + first;
        const std::uint32_t shift = side == 0 ? 16 : 0;
        // Offset of the first slot; it decreases by one per slot; 2 would be a redundant copy.
        const std::uint32_t o = v - first;
        const auto is = [&](std::uint32_t i) {
            return ((w[i] >> shift & 0xffff) == ((o - i) & 0x7fff)) & (o - i + (1U << 14) < 1U << 15) & (o - i != 2);
        };
        return (is(0) | (count < 1)) & (is(1) | (count < 2)) & (is(2) | (count < 3)) & (is(3) | (count < 4));
    }

    std::uint32_t used_vertices() const { return ring_vertices + static_cast<std::uint32_t>(c.size()); }
    std::uint32_t triangle_numbers() const { return 2 * ring_vertices + static_cast<std::uint32_t>(vo.size() / 6); }
    /// 4 (m_r + 6 n_0 + 3 n_i + n_l + m_i).
    std::size_t bytes() const { return 4 * (lr.size() + vo.size() + star.size() + c.size()); }
};

// LR tables as one sequence of words, as in files. docs/lr-tables.md specifies the format.

constexpr std::size_t kLrHeaderWords = 10;

/// A view of LR tables. Does not own the words.
template <class View>
struct LrStreamView {
    View view;
    /// Pairs (copy, original), in ascending order of the copies: one for each further fan of triangles around a
    /// non-manifold vertex (split_fans).
    std::span<const std::uint32_t> copies;

    /// The vertex that v is a copy of, or v itself. Cost: O(log copies).
    std::uint32_t original(std::uint32_t v) const {
        std::size_t low = 0, high = copies.size() / 2;
        while (low < high) {
            const std::size_t middle = (low + high) / 2;
            if (copies[2 * middle] < v) {
                low = middle + 1;
            } else {
                high = middle;
            }
        }
        return 2 * low < copies.size() && copies[2 * low] == v ? copies[2 * low + 1] : v;
    }
};

/// Reads the header and checks sizes only. The operators trust the rest: call validate_lr instead on words that were
/// not just made. Errors: malformed. Untrusted input: safe.
Result<LrStreamView<LrView>> view_lr(std::span<const std::uint32_t> words);
Result<LrStreamView<CompactLrView>> view_compact_lr(std::span<const std::uint32_t> words);

/// Checks the checksum and every reference; that rings tile and close; that opposite is an involution; that the star of
/// each used vertex has all its corners; and that near_neighbors agrees with the stars. This guarantees that the
/// operators stay in bounds, terminate and agree with each other. Cost: O(T) time; memory for the neighbors of one
/// vertex. Untrusted input: safe.
Result<LrStreamView<LrView>> validate_lr(std::span<const std::uint32_t> words);
Result<LrStreamView<CompactLrView>> validate_compact_lr(std::span<const std::uint32_t> words);

/// The triangles, three vertices each, oriented as in the input, with copies replaced by their originals. The vertices
/// have their LR numbers. The stream must be valid.
std::vector<std::uint32_t> decode_lr(const LrStreamView<LrView>& stream);
std::vector<std::uint32_t> decode_lr(const LrStreamView<CompactLrView>& stream);

// One interface for all formats.
//
// Triangles are in slots, [0, slots()); a block has 256 slots. Every slot of a packed stream has a triangle; slots of
// other formats may be empty. Decoding a whole stream skips empty slots.

/// A view of a stream with its header parsed. Does not own the words.
class StreamView {
  public:
    using Any = std::variant<LeanView, PackedView, LrStreamView<LrView>, LrStreamView<CompactLrView>>;
    static constexpr std::uint32_t kBlock = 256;  ///< slots per block; the last block may have fewer

    Format format() const { return static_cast<Format>(view_.index()); }
    /// Decoded indices are below it. With LR tables it includes the copies of non-manifold vertices.
    std::uint32_t vertices() const { return vertices_; }
    std::uint32_t triangles() const { return triangles_; }
    std::uint32_t slots() const { return slots_; }
    std::uint32_t blocks() const { return slots_ / kBlock + (slots_ % kBlock != 0 ? 1 : 0); }
    /// The format's own view; null if the stream has another format.
    template <class View>
    const View* get() const {
        return std::get_if<View>(&view_);
    }

  private:
    friend Result<StreamView> view_stream(std::span<const std::uint32_t> words);
    friend Result<StreamView> validate(std::span<const std::uint32_t> words);
    friend std::optional<Triangle> decode_triangle(const StreamView& view, std::uint32_t slot);
    explicit StreamView(const Any& view);

    Any view_;
    std::uint32_t vertices_ = 0, triangles_ = 0, slots_ = 0;
};

/// Checks everything that decoders and operators rely on. Errors: malformed; invalid_argument if the bytes are not
/// aligned to four. Cost: O(T). Untrusted input: safe.
Result<StreamView> validate(std::span<const std::uint32_t> words);
Result<StreamView> validate(std::span<const std::byte> bytes);

/// Checks sizes only: for words just encoded or validated. The call itself is safe with any words, but decoders and
/// operators require valid ones. Errors: malformed. Cost: O(1); O(T) for LR tables.
Result<StreamView> view_stream(std::span<const std::uint32_t> words);

/// Decodes all triangles, oriented as in the encoded mesh: 3 * view.triangles() indices. The stream must be valid.
/// Cost: O(T); for LR tables with copies also 4 bytes per vertex, or with 16-bit indices O(log copies) time per
/// triangle. Packed streams decode to 32-bit indices on at most `threads` threads. Errors: invalid_argument (wrong size
/// of `indices`; more than 65,536 vertices for 16-bit indices).
Result<void> decode(const StreamView& view, std::span<std::uint32_t> indices, unsigned threads = 1);
Result<void> decode(const StreamView& view, std::span<std::uint16_t> indices);
std::vector<std::uint32_t> decode(const StreamView& view);

/// Decodes the triangles of the 256 slots from 256 * block on. Returns their number; 3 * 256 indices always suffice.
/// Cost: O(1); with LR tables O(log copies) per triangle. Errors: invalid_argument (no such block, `indices` too
/// small).
Result<std::uint32_t> decode_block(const StreamView& view, std::uint32_t block, std::span<std::uint32_t> indices);

/// Decodes the triangle of one slot; none if the slot is empty or does not exist. Cost: O(1), with LR tables O(log
/// copies).
std::optional<Triangle> decode_triangle(const StreamView& view, std::uint32_t slot);

}  // namespace lacedring
