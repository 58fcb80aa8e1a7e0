#pragma once
// Codes the steps of a packed stream in order: the edge of entry and the third vertex of each. Encoder and decoder run
// the same code. Internal to lrcore. Specified in docs/storage-format.md.
//
// Steps are in depth-first order: most are entered across the edge that the previous step left open, or across the last
// open edge. Most third vertices are the next vertex on one of the two chains. The numbers of triangles that the ends
// of the edge have so far, on both sides of the ring, predict which chain.

#include <array>
#include <vector>

#include "lrcore/codec/storage/packed_steps.h"
#include "lrcore/codec/storage/rans.h"

namespace lacedring::storage {

template <class Coder>
class WalkCoder {
  public:
    /// An encoder reads `steps`; a decoder appends to it.
    WalkCoder(Coder& coder, PackedSteps& steps, std::uint32_t vertices, bool has_flips)
        : coder_(coder),
          steps_(steps),
          vertices_(vertices),
          vertex_bits_(static_cast<std::uint32_t>(std::bit_width(vertices))),
          has_flips_(has_flips),
          around_(std::size_t{vertices} + 1),
          opened_(steps.size(), UINT32_MAX) {}

    /// Codes `count` steps. Returns false if a decoder's input is invalid.
    bool code(std::uint32_t count) {
        for (std::uint32_t i = 0; i < count;) {
            if (goes_on_) i = code_simple(i, count);
            if (i == count) break;
            Step s{};
            if constexpr (!Coder::kDecodes) s = of(i);
            if (goes_on_) {
                s.edge = goes_on_edge_;
            } else {
                code_entry(i, s);
            }
            if (s.edge.a >= vertices_ || s.edge.b >= vertices_) return false;
            if (has_flips_) last_flip_ = s.flip = coder_.bit(flip_[last_flip_], s.flip);
            if (!is_fork_) s.simple = coder_.bit(simple_[context_of(s.edge)], s.simple);
            is_fork_ = false;
            if (s.simple != 0) {
                code_turn(s);
            } else {
                code_fork(i, s);
            }
            if (s.third >= vertices_ || coder_.bad()) return false;
            if constexpr (Coder::kDecodes) {
                const std::uint32_t flags =
                    right_ | s.enters << 1 | s.first_a << 3 | (s.flip != 0 ? std::uint32_t{PackedSteps::kFlipped} : 0U);
                steps_.add(s.edge, s.third, static_cast<std::uint8_t>(flags), goes_on_ ? i + 1 : UINT32_MAX);
            }
            count_triangle(s);
            ++i;
        }
        return !goes_on_;
    }

  private:
    struct Step {
        PackedEdge edge;
        std::uint32_t third;
        std::uint32_t enters, first_a;  ///< CorridorStep's flags: bit 0 (a, x), bit 1 (x, b)
        /// 1: a turn bit suffices, and the next step continues across the edge it leaves open.
        std::uint32_t simple;
        std::uint32_t right, flip;
    };

    /// An edge, (a, x) or (x, b) of step `from`, across which a later step is expected. `from` is UINT32_MAX after that
    /// step.
    struct Open {
        PackedEdge edge;
        std::uint32_t from;
        bool is_a;
        std::uint8_t right;
    };

    Step of(std::uint32_t i) const {
        Step s{};
        s.edge = steps_.edge(i);
        s.third = steps_.third(i);
        s.enters = steps_.flags(i) >> 1 & 3;
        s.first_a = steps_.flags(i) >> 3 & 1;
        s.right = steps_.on_right(i) ? 1 : 0;
        s.flip = steps_.flipped(i) ? 1 : 0;
        const bool next_a = s.third == s.edge.a + 1, next_b = s.third + 1 == s.edge.b;
        if (next_a && next_b) {
            s.simple = s.enters == 0;
        } else if (next_a || next_b) {
            s.simple = s.enters == (next_a ? 2U : 1U) && steps_.across(i, next_b) == i + 1;
        }
        return s;
    }

    void code_entry(std::uint32_t i, Step& s) {
        while (!open_.empty() && open_.back().from == UINT32_MAX) open_.pop_back();
        const std::uint32_t context = is_open_ ? 2 : open_.empty() ? 0 : 1;
        is_open_ = false;
        std::uint32_t depth = 0, drop = 1;
        if constexpr (!Coder::kDecodes) depth = depth_of(i, drop);
        if (context == 0 || coder_.bit(new_[context], depth == UINT32_MAX ? 1 : 0) != 0) return code_root(s);
        if (coder_.bit(deeper_[context - 1], depth != 0 ? 1 : 0) == 0) {
            depth = 0;
        } else {
            depth = 1 + depth_.code(coder_, depth - 1);
            drop = coder_.bit(drop_, drop);
        }
        s.edge = {vertices_, vertices_};  // invalid unless replaced by an open edge below
        if (depth >= open_.size()) return;
        const std::size_t at = open_.size() - 1 - depth;
        const Open open = open_[at];
        open_[at].from = UINT32_MAX;
        if (drop != 0) open_.resize(at);  // edges above it were reached another way, as at a handle
        if (open.from == UINT32_MAX) return;
        s.edge = open.edge;
        right_ = open.right;
        if constexpr (Coder::kDecodes) {
            (open.is_a ? steps_.step(open.from).across_a : steps_.step(open.from).across_b) = i;
            steps_.flags_of(open.from) |= open.is_a ? CorridorStep::kEnterA : CorridorStep::kEnterB;
        }
    }

    /// The number of open edges above the edge that step i crosses; UINT32_MAX if it crosses none. Sets `drop` if the
    /// edges above are not crossed later.
    std::uint32_t depth_of(std::uint32_t i, std::uint32_t& drop) const {
        constexpr std::uint32_t kLooked = 64;
        const std::uint32_t at = opened_[i];
        if (at == UINT32_MAX) return UINT32_MAX;
        const auto depth = static_cast<std::uint32_t>(open_.size() - 1 - at);
        drop = depth <= kLooked ? 1 : 0;
        for (std::size_t k = at + 1; k < open_.size() && drop != 0; ++k) {
            const Open& open = open_[k];
            if (open.from == UINT32_MAX) continue;
            const std::uint32_t across = steps_.across(open.from, open.is_a);
            if (across != UINT32_MAX && across > i) drop = 0;
        }
        return depth;
    }

    enum Root : std::uint32_t { kOtherSide, kNext, kAny };

    void code_root(Step& s) {
        const PackedEdge other = root_, next{seen_, 0};
        std::uint32_t kind = kAny;
        if constexpr (!Coder::kDecodes) {
            if (s.edge == other && s.right != right_) {
                kind = kOtherSide;
            } else if (s.edge.a == next.a && s.right == 0) {
                kind = kNext;
            }
        }
        kind = coder_.symbol(root_kind_, kind);
        if (kind == kOtherSide) {
            s.edge = other;
            right_ ^= 1;
        } else if (kind == kNext) {
            s.edge = {next.a, next.a + root_size_.code(coder_, s.edge.b - s.edge.a)};
            right_ = 0;
        } else {
            s.edge.a = coder_.raw(s.edge.a, vertex_bits_);
            s.edge.b = coder_.raw(s.edge.b, vertex_bits_);
            right_ = coder_.raw(s.right, 1);
        }
        root_ = s.edge;
    }

    /// Fast path for most steps: codes steps from i on as long as each continues from the previous step and a turn bit
    /// suffices. Returns the first other step. If its first bit was already coded, sets is_fork_.
    std::uint32_t code_simple(std::uint32_t i, std::uint32_t count) {
        if (has_flips_) return i;
        Coder coder = std::move(coder_);  // in registers
        auto [a, b] = goes_on_edge_;
        for (; i < count && b - a > 2 && a < b && b < vertices_ && !coder.bad(); ++i) {
            std::uint32_t simple = 0, up = 0;
            if constexpr (!Coder::kDecodes) {
                const Step s = of(i);
                simple = s.simple;
                up = s.third == a + 1 ? 1 : 0;
            }
            const std::uint32_t context = context_of({a, b});
            if (coder.bit(simple_[context], simple) == 0) {
                is_fork_ = true;
                break;
            }
            up = coder.bit(up_[context], up);
            for (const std::uint32_t v : {a, b}) count_at(v);
            const PackedEdge edge{a, b};
            a += up;  // branchless: turns are hard to predict
            b -= 1 - up;
            const std::uint32_t x = (a & (0 - up)) | (b & (up - 1));
            count_at(x);
            around_[x - up] |= kRingEdge;
            if constexpr (Coder::kDecodes) steps_.add_simple(i, edge, x, right_, up);
        }
        seen_ = std::max(seen_, goes_on_edge_.b + 1);
        goes_on_edge_ = {a, b};
        coder_ = std::move(coder);
        return i;
    }

    void code_turn(Step& s) {
        const auto [a, b] = s.edge;
        const std::uint32_t context = context_of(s.edge);
        goes_on_ = b - a != 2;
        std::uint32_t up = 1;
        if (goes_on_) up = coder_.bit(up_[context], s.third == a + 1 ? 1 : 0);
        s.third = up != 0 ? a + 1 : b - 1;
        s.enters = goes_on_ ? 1 + up : 0;
        s.first_a = 0;
        goes_on_edge_ = {up != 0 ? s.third : a, up != 0 ? b : s.third};
    }

    /// Codes a triangle that splits the polygon, or from which the next step does not continue.
    void code_fork(std::uint32_t i, Step& s) {
        const auto [a, b] = s.edge;
        const std::uint32_t span = b - a, size_a = s.third - a, size_b = b - s.third;
        const bool inside = size_a != 0 && size_a < span;
        goes_on_ = false;
        // Symbol: edges entered (bits 0 and 1), x is between a and b (4), x is nearer to a (8).
        const std::uint32_t kind =
            coder_.symbol(fork_, s.enters | (inside ? 4U : 0U) | (inside && size_a <= size_b ? 8U : 0U));
        s.enters = kind & 3;
        if ((kind & 4) != 0) {
            const bool near_a = (kind & 8) != 0;
            const std::uint32_t size = size_[s.enters == 3 ? 1 : 0].code(coder_, near_a ? size_a : size_b);
            s.third = near_a ? a + size : b - size;
        } else {
            s.third = coder_.raw(s.third, vertex_bits_);
        }
        if (s.enters == 3) {
            const std::uint32_t x = s.third;  // the smaller part first, as in polygons.h
            const std::uint32_t small_a = x > a ? x - a : UINT32_MAX, small_b = b > x ? b - x : UINT32_MAX;
            const std::uint32_t usual = small_a <= small_b ? 1 : 0;
            s.first_a = usual ^ coder_.bit(first_, usual ^ s.first_a);
        } else {
            s.first_a = 0;
        }
        if (s.enters == 0) return;
        const auto right = static_cast<std::uint8_t>(right_);
        const Open on_a{{a, s.third}, i, true, right}, on_b{{s.third, b}, i, false, right};
        const bool a_first = s.enters == 3 ? s.first_a != 0 : (s.enters & 1) != 0;
        if (s.enters == 3) open(a_first ? on_b : on_a);
        open(a_first ? on_a : on_b);
        is_open_ = true;
    }

    /// The context of an edge: the numbers of triangles at its ends so far, and whether the ring edges (a, a + 1) and
    /// (b - 1, b) have a triangle.
    std::uint32_t context_of(PackedEdge e) const {
        const std::uint32_t at_a = around_[e.a], at_b = around_[e.b], behind_b = around_[e.b > 0 ? e.b - 1 : 0];
        const std::uint32_t side = at_a / kRingEdge * 2 + behind_b / kRingEdge;
        return (side * (kMostTriangles + 1) + at_a % kRingEdge) * (kMostTriangles + 1) + at_b % kRingEdge;
    }

    void open(const Open& edge) {
        if constexpr (!Coder::kDecodes) {
            const std::uint32_t across = steps_.across(edge.from, edge.is_a);
            if (across != UINT32_MAX) opened_[across] = static_cast<std::uint32_t>(open_.size());
        }
        open_.push_back(edge);
    }

    void count_triangle(const Step& s) {
        for (const std::uint32_t v : {s.edge.a, s.edge.b, s.third}) {
            count_at(v);
            seen_ = std::max(seen_, v + 1);
        }
        const auto mark = [&](std::uint32_t p, std::uint32_t q) {
            if (p + 1 == q) around_[p] |= kRingEdge;
        };
        mark(s.edge.a, s.third);
        mark(s.third, s.edge.b);
        mark(s.edge.a, s.edge.b);
    }
    void count_at(std::uint32_t v) {
        const std::uint8_t now = around_[v];
        around_[v] = static_cast<std::uint8_t>(now + (now % kRingEdge < kMostTriangles ? 1 : 0));
    }

    /// Fields of around_ per vertex v: the number of triangles so far, and kRingEdge if edge (v, v + 1) has a triangle.
    static constexpr std::uint8_t kMostTriangles = 9, kRingEdge = 16;
    static constexpr std::size_t kContexts = 4 * 10 * 10;

    Coder& coder_;
    PackedSteps& steps_;
    std::uint32_t vertices_, vertex_bits_;
    bool has_flips_;
    std::vector<std::uint8_t> around_;
    std::vector<Open> open_;
    std::vector<std::uint32_t> opened_;  ///< encoder only, per step: the place in open_ of its edge
    bool is_open_ = false;               ///< the previous step opened the last edge
    bool goes_on_ = false;               ///< the next step crosses goes_on_edge_
    bool is_fork_ = false;               ///< and it is known not to be simple
    PackedEdge goes_on_edge_{};
    PackedEdge root_{};
    std::uint32_t right_ = 0, last_flip_ = 0, seen_ = 0;
    std::array<BitModel, 3> new_;
    std::array<BitModel, 2> deeper_;
    BitModel drop_, first_;
    std::array<BitModel, 2> flip_;
    std::array<BitModel, kContexts> simple_, up_;
    SymbolModel root_kind_, fork_;
    NumberModel root_size_, depth_;
    std::array<NumberModel, 2> size_;
};

}  // namespace lacedring::storage
