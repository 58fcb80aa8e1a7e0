// Seam sections: which copies are home copies of their vertices, what decoders ask about each corner, and the bits of
// the answers. Questions and codes: docs/seams-format.md.

#include <algorithm>
#include <array>
#include <bit>
#include <limits>

#include "lacedring/lacedring.hpp"
#include "lacedring/lacedring_seams.h"
#include "lacedring/seams.hpp"
#include "lrcore/base/bits.h"
#include "lrcore/base/crc32.h"
#include "lrcore/base/message.h"
#include "lrcore/base/signature.h"
#include "lrcore/codec/bit_writer.h"
#include "lrcore/codec/seams/seam_codes.h"

namespace lacedring {
namespace {

constexpr std::uint32_t kNone = UINT32_MAX;
constexpr std::uint32_t kPrivate = LACEDRING_SEAMS_PRIVATE;
constexpr std::uint32_t kMostHomes = LACEDRING_SEAMS_MAX_STEPS;  // of a vertex: one step fewer, or as many with a wrap

using Triangles = std::span<const std::uint32_t>;

std::uint32_t corner_next(std::uint32_t c) {
    return c % 3 == 2 ? c - 2 : c + 1;
}
std::uint32_t corner_previous(std::uint32_t c) {
    return c % 3 == 0 ? c + 2 : c - 1;
}

/// Home copies of the vertices, by the copies' numbers.
struct Homes {
    std::vector<std::uint32_t> first;  ///< of vertex v in `copy`: first[v] to first[v + 1]
    std::vector<std::uint32_t> copy;   ///< UINT32_MAX of a vertex without corners
    std::vector<std::uint8_t> wrap;    ///< of each vertex: its last position is its first copy again
    std::vector<std::uint32_t> index;  ///< of each copy among its vertex's homes, or UINT32_MAX

    std::uint32_t steps(std::uint32_t v) const { return first[v + 1] - first[v] - 1 + wrap[v]; }
    std::uint32_t count(std::uint32_t v) const { return first[v + 1] - first[v]; }
    /// The home copy at a position; private states are left as they are.
    std::uint32_t copy_at(std::uint32_t v, std::uint32_t state) const {
        return wrap[v] != 0 && state == steps(v) ? 0 : state;
    }
};

/// The side of each triangle: that of its ring edge, or its parent's.
std::vector<std::uint8_t> find_sides(Triangles triangles) {
    std::vector<std::uint8_t> out(triangles.size() / 3);
    for (std::uint32_t i = 0; i < out.size(); ++i) {
        const std::uint32_t in_block = i % kSeamBlock, side = lacedring_seam_side(&triangles[std::size_t{3} * i]);
        std::uint32_t pair[2];
        out[i] = static_cast<std::uint8_t>(side);
        if (side < 2 || lacedring_seam_is_empty(&triangles[std::size_t{3} * i])) continue;
        const std::uint32_t back = lacedring_seam_parent(&triangles[std::size_t{3} * (i - in_block)], in_block, pair);
        out[i] = back > 0 ? out[i - back] : 0;
    }
    return out;
}

/// Chooses the home copies of vertices: those of the fan on the left, in its order.
class HomeFinder {
  public:
    HomeFinder(Triangles triangles, std::span<const std::uint32_t> copies, std::span<const std::uint8_t> sides)
        : triangles_(triangles), copies_(copies), sides_(sides), visited_(triangles.size()) {}

    /// The home copies of vertex v, which has these corners, in increasing order. True: its fan wraps.
    bool find(std::uint32_t v, std::span<const std::uint32_t> corners, std::vector<std::uint32_t>& homes) {
        find_fan(v, corners);
        homes.clear();
        const auto add = [&](std::uint32_t copy) {
            if (homes.size() < kMostHomes - 2 && std::ranges::find(homes, copy) == homes.end()) homes.push_back(copy);
        };
        std::uint32_t ends[2] = {kNone, kNone};  // copies at the ring edges to v - 1 and v + 1
        for (const std::uint32_t c : fan_) add(copies_[c]);
        for (const std::uint32_t c : corners) {
            if (sides_[c / 3] != 0) continue;
            add(copies_[c]);
            const std::uint32_t a = triangles_[corner_next(c)], b = triangles_[corner_previous(c)];
            if (ends[0] == kNone && (a == v - 1 || b == v - 1)) ends[0] = copies_[c];
            if (ends[1] == kNone && (a == v + 1 || b == v + 1)) ends[1] = copies_[c];
        }
        if (homes.empty()) homes.push_back(corners.empty() ? kNone : copies_[corners.front()]);
        if (homes.size() > 1) {
            if (ends[1] != kNone && ends[1] != ends[0]) {
                std::erase(homes, ends[1]);
                homes.push_back(ends[1]);
            }
            if (ends[0] != kNone) {
                std::erase(homes, ends[0]);
                homes.insert(homes.begin(), ends[0]);
            }
        }
        std::size_t changes = 0;
        for (std::size_t i = 1; i < fan_.size(); ++i) changes += copies_[fan_[i - 1]] != copies_[fan_[i]] ? 1U : 0U;
        return homes.size() > 1 && changes == homes.size() && copies_[fan_.front()] == copies_[fan_.back()];
    }

  private:
    /// The left corners of v from its ring edge (v - 1, v) to (v, v + 1), or as far as the triangles go from there.
    void find_fan(std::uint32_t v, std::span<const std::uint32_t> corners) {
        walk(corners, v + 1, v - 1, corner_next, corner_previous);
        std::ranges::reverse(fan_);
        if (fan_.empty()) walk(corners, v - 1, v + 1, corner_previous, corner_next);
        std::erase_if(fan_, [&](std::uint32_t c) { return sides_[c / 3] != 0; });
    }

    template <class Corner>
    void walk(std::span<const std::uint32_t> corners, std::uint32_t start, std::uint32_t stop, Corner from, Corner to) {
        fan_.clear();
        by_.clear();
        for (const std::uint32_t c : corners) by_.emplace_back(triangles_[from(c)], c);
        std::ranges::sort(by_);
        for (std::uint32_t at = start; fan_.empty() || at != stop; at = triangles_[to(fan_.back())]) {
            const auto found = std::ranges::lower_bound(by_, std::pair(at, 0U));
            if (found == by_.end() || found->first != at || visited_.test(found->second)) break;
            visited_.set(found->second);
            fan_.push_back(found->second);
        }
        for (const std::uint32_t c : fan_) visited_.clear(c);
    }

    Triangles triangles_;
    std::span<const std::uint32_t> copies_;
    std::span<const std::uint8_t> sides_;
    BitVector visited_;
    std::vector<std::uint32_t> fan_;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> by_;  // vertex, corner
};

Homes find_homes(Triangles triangles, std::uint32_t vertices, std::span<const std::uint32_t> copies,
                 std::uint32_t copy_count) {
    std::vector<std::uint32_t> begin(std::size_t{vertices} + 2), corners(triangles.size());
    for (const std::uint32_t v : triangles) {
        if (v != kNone) ++begin[v + 2];
    }
    for (std::size_t v = 2; v < begin.size(); ++v) begin[v] += begin[v - 1];
    for (std::uint32_t c = 0; c < triangles.size(); ++c) {
        if (triangles[c] != kNone) corners[begin[triangles[c] + 1]++] = c;
    }
    const std::vector<std::uint8_t> sides = find_sides(triangles);
    HomeFinder finder(triangles, copies, sides);
    Homes out;
    out.index.assign(copy_count, kNone);
    out.first.reserve(std::size_t{vertices} + 1);
    out.wrap.reserve(vertices);
    std::vector<std::uint32_t> homes;
    for (std::uint32_t v = 0; v < vertices; ++v) {
        const auto own = std::span(corners).subspan(begin[v], begin[v + 1] - begin[v]);
        out.first.push_back(static_cast<std::uint32_t>(out.copy.size()));
        out.wrap.push_back(finder.find(v, own, homes) ? 1 : 0);
        for (std::uint32_t i = 0; i < homes.size(); ++i) {
            if (homes[i] != kNone) out.index[homes[i]] = i;
        }
        out.copy.insert(out.copy.end(), homes.begin(), homes.end());
    }
    out.first.push_back(static_cast<std::uint32_t>(out.copy.size()));
    return out;
}

SeamAnswers answer_vertices(const Homes& homes, std::uint32_t vertices) {
    SeamAnswers out;
    for (std::uint32_t v = 0, before = 0; v < vertices; ++v) {
        if (v % kSeamBlock == 0) {
            out.begin.push_back(out.all.size());
            out.copies.push_back(0);
            before = 0;
        }
        const std::uint32_t steps = homes.steps(v);
        if (out.flag(LACEDRING_SEAM_V0 + before, steps > 0) && out.flag(LACEDRING_SEAM_MORE, steps > 1)) {
            for (std::uint32_t n = 2; n < LACEDRING_SEAMS_MAX_STEPS && out.flag(LACEDRING_SEAM_MANY, steps > n);) ++n;
            out.flag(LACEDRING_SEAM_WRAP, homes.wrap[v] != 0);
        }
        out.copies.back() += homes.count(v) - 1;
        before = std::min(steps, 2U);
    }
    return out;
}

/// SeamAnswers what decoders ask about the triangles' corners, as lacedring_seams.h asks it.
class CornerEncoder {
  public:
    CornerEncoder(Triangles triangles, std::span<const std::uint32_t> copies, const Homes& homes)
        : triangles_(triangles), copies_(copies), homes_(homes), private_(homes.index.size(), kNone) {}

    SeamAnswers run() {
        const auto count = static_cast<std::uint32_t>(triangles_.size() / 3);
        state_.resize(triangles_.size());
        sides_.resize(count);
        for (first_ = 0; first_ < count; first_ = end_) {
            end_ = std::min(count - first_, kSeamBlock) + first_;
            out_.begin.push_back(out_.all.size());
            const std::size_t before = order_.size();
            for (std::uint32_t i = first_; i < end_; ++i) encode(i);
            out_.copies.push_back(static_cast<std::uint32_t>(order_.size() - before));
        }
        return std::move(out_);
    }

    /// The private copies in their order.
    const std::vector<std::uint32_t>& order() const { return order_; }

  private:
    struct Question {
        std::uint32_t at = 0, at_context = LACEDRING_SEAM_NONE;
        std::uint32_t new_context = 0;
        bool new_first = false;
    };
    struct End {
        std::uint32_t corner, state, far, type;
        bool is_last;
    };

    bool is_home(std::uint32_t c) const { return homes_.index[copies_[c]] != kNone; }
    bool has_state(std::uint32_t c, std::uint32_t state) const {
        if (is_home(c)) return homes_.copy_at(triangles_[c], state) == homes_.index[copies_[c]];
        return private_[copies_[c]] != kNone && state == (kPrivate | private_[copies_[c]]);
    }

    /// The state of corner c, whose copy is not that of state `current`.
    std::uint32_t choose(std::uint32_t c, std::uint32_t current, const Question& q) {
        const std::uint32_t v = triangles_[c];
        std::uint32_t asked[2] = {kNone, kNone}, left = homes_.count(v);
        if (current < kPrivate) {
            asked[0] = homes_.copy_at(v, current);
            --left;
        }
        const bool is_new = !is_home(c) && private_[copies_[c]] == kNone;
        const auto ask_new = [&] { return out_.flag(q.new_context, is_new); };
        bool made = q.new_first && ask_new();
        if (!made && q.at_context != LACEDRING_SEAM_NONE && homes_.copy_at(v, q.at) != asked[0]) {
            if (out_.flag(q.at_context, has_state(c, q.at))) return q.at;
            asked[1] = homes_.copy_at(v, q.at);
            --left;
        }
        if (!q.new_first) made = ask_new();
        if (made) {
            private_[copies_[c]] = static_cast<std::uint32_t>(order_.size());
            order_.push_back(copies_[c]);
            return kPrivate | private_[copies_[c]];
        }
        if (left > 0 && out_.flag(LACEDRING_SEAM_HOME, is_home(c))) {
            const std::uint32_t copy = homes_.index[copies_[c]];
            const std::uint32_t skipped = (asked[0] < copy ? 1U : 0U) + (asked[1] < copy ? 1U : 0U);
            out_.bits(copy - skipped, static_cast<std::uint32_t>(std::bit_width(left - 1)));
            return copy;
        }
        out_.golomb(static_cast<std::uint32_t>(order_.size()) - 1 - private_[copies_[c]], 2);
        return kPrivate | private_[copies_[c]];
    }

    End end_of(std::uint32_t i, std::uint32_t parent, std::uint32_t j, std::uint32_t other) const {
        const std::uint32_t c = 3 * i + j, v = triangles_[c], steps = homes_.steps(v);
        const std::uint32_t* p = &triangles_[std::size_t{3} * parent];
        const std::uint32_t in_parent = lacedring_seam_corner(p, v);
        const bool precedes = p[in_parent > 0 ? in_parent - 1 : 2] == triangles_[3 * i + other];
        std::uint32_t more = 1;
        while (more < 3 && (i + more >= end_ || lacedring_seam_corner(&triangles_[std::size_t{3} * (i + more)], v) < 3))
            ++more;
        End e{c, state_[3 * parent + in_parent], (sides_[i] == 0) == precedes ? 0 : steps, 0, more == 1};
        if (sides_[i] == 0) {
            const std::uint32_t distance =
                e.state >= kPrivate ? 0 : std::max(e.far, e.state) - std::min(e.far, e.state);
            e.type = distance > 0 ? (distance < more ? 2 : 3) : steps > 0 ? 1 : 0;
        } else {
            e.type = homes_.copy_at(v, e.state) != homes_.copy_at(v, e.far) ? 2 : steps > 0 ? 1 : 0;
        }
        return e;
    }

    std::uint32_t change(std::uint32_t side, const End& e) {
        const std::uint32_t steps = homes_.steps(triangles_[e.corner]);
        if (side == 0) {
            std::uint32_t to = e.far;
            if (e.state < kPrivate) {
                to = e.far > e.state ? e.state + 1 : e.state - 1;
                if (e.far == e.state) to = steps == 0 ? 0 : e.far == 0 ? 1 : e.far - 1;
            }
            return choose(e.corner, e.state, {to, LACEDRING_SEAM_STEP_L, LACEDRING_SEAM_NEW_L});
        }
        if (e.type < 2) return choose(e.corner, e.state, {.new_context = LACEDRING_SEAM_LEAVE});
        return choose(e.corner, e.state,
                      {e.far, e.is_last ? LACEDRING_SEAM_LAST_R : LACEDRING_SEAM_NEXT_R, LACEDRING_SEAM_NEW_R});
    }

    static std::uint32_t spoke_context(std::uint32_t side, const End& a, const End& b) {
        if (side == 0) {
            if (a.type == 0) return LACEDRING_SEAM_LONE;
            if (a.type > 1) return LACEDRING_SEAM_LEFT2;
            return b.type < 3 ? LACEDRING_SEAM_LEFT0 : LACEDRING_SEAM_LEFT1;
        }
        if (a.type == 1 || b.type == 1) return LACEDRING_SEAM_RIGHT0;
        if (a.type == 2) return LACEDRING_SEAM_RIGHT4;
        if (b.type == 0) return LACEDRING_SEAM_RIGHT1;
        return a.is_last ? LACEDRING_SEAM_RIGHT2 : LACEDRING_SEAM_RIGHT3;
    }

    void encode_spoke(std::uint32_t i, std::uint32_t parent, const std::uint32_t (&pair)[2]) {
        End a = end_of(i, parent, pair[0], pair[1]), b = end_of(i, parent, pair[1], pair[0]);
        if (b.type < a.type) std::swap(a, b);
        const bool a_changes = !has_state(a.corner, a.state), b_changes = !has_state(b.corner, b.state);
        const std::uint32_t context = spoke_context(sides_[i], a, b);
        if (out_.flag(context, a_changes || b_changes)) {
            const bool lone = context == LACEDRING_SEAM_LONE;
            const bool usual = b_changes && a_changes == !lone;
            if (!out_.flag(a.type == 0 ? LACEDRING_SEAM_HALF : LACEDRING_SEAM_BOTH, usual)) {
                out_.bits(b_changes ? 0 : 1, 1);
            }
        }
        state_[a.corner] = a_changes ? change(sides_[i], a) : a.state;
        state_[b.corner] = b_changes ? change(sides_[i], b) : b.state;
    }

    void encode_start(std::uint32_t i, std::uint32_t j, bool has_parent) {
        const std::uint32_t* t = &triangles_[std::size_t{3} * i];
        const std::uint32_t c = 3 * i + j, steps = homes_.steps(t[j]);
        const std::uint32_t neighbors[2] = {lacedring_seam_corner(t, t[j] - 1), lacedring_seam_corner(t, t[j] + 1)};
        Question q;
        if (neighbors[0] == 3 && neighbors[1] < 3) q.at = steps;
        if (sides_[i] == 0) {
            const bool middle = neighbors[0] == 3 && neighbors[1] == 3 && steps > 0;
            q.at_context = middle ? LACEDRING_SEAM_MID_L : LACEDRING_SEAM_START_L;
            q.new_context = LACEDRING_SEAM_NEW_L;
        } else {
            q.at_context = steps > 0 ? LACEDRING_SEAM_MID_R2 : LACEDRING_SEAM_MID_R;
            q.new_context = steps > 0 ? LACEDRING_SEAM_NEW_M : LACEDRING_SEAM_NEW_R;
            for (std::uint32_t n = 0; n < 2 && has_parent; ++n) {
                if (neighbors[n] == 3) continue;
                const std::uint32_t other = t[neighbors[n]];
                const std::uint32_t end = homes_.copy_at(other, n == 0 ? homes_.steps(other) : 0);
                if (homes_.copy_at(other, state_[3 * i + neighbors[n]]) == end) {
                    q = {n == 0 ? 0 : steps, LACEDRING_SEAM_PLAIN, LACEDRING_SEAM_NEW_R};
                    break;
                }
                q = {n == 0 ? steps : 0, LACEDRING_SEAM_LEAVE,
                     steps > 0 ? LACEDRING_SEAM_SEAMED2 : LACEDRING_SEAM_SEAMED, true};
            }
        }
        state_[c] = choose(c, kNone, q);
    }

    void encode(std::uint32_t i) {
        if (lacedring_seam_is_empty(&triangles_[std::size_t{3} * i])) return;
        std::uint32_t pair[2] = {3, 3};
        const std::uint32_t back = lacedring_seam_parent(&triangles_[std::size_t{3} * first_], i - first_, pair);
        const std::uint32_t side = lacedring_seam_side(&triangles_[std::size_t{3} * i]);
        sides_[i] = static_cast<std::uint8_t>(side < 2 ? side : back > 0 ? sides_[i - back] : 0U);
        if (back > 0) encode_spoke(i, i - back, pair);
        for (std::uint32_t j = 0; j < 3; ++j) {
            if (j != pair[0] && j != pair[1]) encode_start(i, j, back > 0);
        }
    }

    Triangles triangles_;
    std::span<const std::uint32_t> copies_;
    const Homes& homes_;
    std::vector<std::uint32_t> private_;  // number of each copy that is no home
    std::vector<std::uint32_t> order_;    // copy of each number
    std::vector<std::uint32_t> state_;    // of each corner
    std::vector<std::uint8_t> sides_;
    std::uint32_t first_ = 0, end_ = 0;  // triangles of the block
    SeamAnswers out_;
};

/// A directory: lengths of blocks, copies that they make, and sums of both where groups begin. Returns its field widths
/// as the header has them.
std::uint32_t write_directory(BitWriter& out, std::span<const std::uint32_t> lengths,
                              std::span<const std::uint32_t> copies) {
    if (lengths.empty()) return 0;
    const auto length_bits = static_cast<std::uint32_t>(std::bit_width(std::ranges::max(lengths)));
    const auto copy_bits = static_cast<std::uint32_t>(std::bit_width(std::ranges::max(copies)));
    std::uint32_t length_sum = 0, copy_sum = 0;
    for (std::size_t b = 0; b < lengths.size(); ++b) {
        if (b > 0 && b % LACEDRING_SEAMS_GROUP == 0) {
            out.put(length_sum, 32);
            out.put(copy_sum, 32);
        }
        out.put(lengths[b], length_bits);
        out.put(copies[b], copy_bits);
        length_sum += lengths[b];
        copy_sum += copies[b];
    }
    return length_bits | copy_bits << 8;
}

/// The section's words; none if it would be too large.
std::vector<std::uint32_t> write_section(std::uint32_t homes, const SeamAnswers& vertices, const SeamAnswers& corners) {
    const SeamTable table = best_table(vertices, corners);
    std::vector<std::uint32_t> words{magic::kSeams, 0, homes, 0, 0, 0, 0, 0};
    for (std::uint32_t c = 0; c < kSeamContexts; ++c) {
        words[4 + c / 8] |= (table.likely[c] | std::uint32_t{table.run_class[c]} << 1) << 4 * (c % 8);
    }
    BitWriter out, blocks;
    for (const SeamAnswers* answers : {&vertices, &corners}) {
        const std::size_t before = blocks.bits();
        std::vector<std::uint32_t> lengths;
        for (std::size_t b = 0; b < answers->begin.size(); ++b) {
            const std::size_t begin = blocks.bits();
            write_block(blocks, answers->block(b), table);
            lengths.push_back(static_cast<std::uint32_t>(blocks.bits() - begin));
        }
        if (blocks.bits() - before > UINT32_MAX) return {};
        words[3] |= write_directory(out, lengths, answers->copies) << (answers == &vertices ? 0 : 16);
    }
    const std::size_t bits = blocks.bits();
    const std::vector<std::uint8_t>& bytes = blocks.finish();
    for (std::size_t i = 0; i < bits; i += 8) {
        out.put(bytes[i / 8], static_cast<std::uint32_t>(std::min<std::size_t>(bits - i, 8)));
    }
    if (out.bits() % 32 != 0) out.put(0, 32 - static_cast<std::uint32_t>(out.bits() % 32));
    const std::vector<std::uint8_t>& string = out.finish();
    for (std::size_t i = 0; i < string.size(); i += 4) {
        words.push_back(string[i] | std::uint32_t{string[i + 1]} << 8 | std::uint32_t{string[i + 2]} << 16 |
                        std::uint32_t{string[i + 3]} << 24);
    }
    words[1] = crc32(std::as_bytes(std::span(words).subspan(2)));
    return words;
}

Error invalid_seams(std::string message) {
    return {ErrorCode::invalid_argument, "seams: " + std::move(message)};
}

}  // namespace

Result<EncodedSeams> encode_seams(std::span<const std::uint32_t> triangles, std::uint32_t vertices,
                                  std::span<const std::uint32_t> copies) {
    using detail::message;
    const Error too_large{ErrorCode::too_large, "seams: more than 2^30 copies, or 4 GiB"};
    if (triangles.size() % 3 != 0 || copies.size() != triangles.size()) {
        return invalid_seams(message(triangles.size(), " corners, ", copies.size(), " copies"));
    }
    if (triangles.size() > UINT32_MAX || vertices > LACEDRING_SEAMS_MAX_COPIES) return too_large;
    for (std::size_t i = 0; i < triangles.size(); i += 3) {
        const std::uint32_t a = triangles[i], b = triangles[i + 1], c = triangles[i + 2];
        if ((a & b & c) == kNone) continue;
        if (std::max({a, b, c}) >= vertices || a == b || b == c || c == a) {
            return invalid_seams(message("triangle ", i / 3, " has a vertex out of range, or one twice"));
        }
    }
    // The caller's numbers, and for each corner which of them it has.
    std::vector<std::uint32_t> numbers;
    numbers.reserve(copies.size());
    for (std::size_t c = 0; c < copies.size(); ++c) {
        if (triangles[c] != kNone) numbers.push_back(copies[c]);
    }
    std::ranges::sort(numbers);
    numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
    std::vector<std::uint32_t> own(copies.size()), owner(numbers.size(), kNone);
    for (std::size_t c = 0; c < copies.size(); ++c) {
        if (triangles[c] == kNone) continue;
        own[c] = static_cast<std::uint32_t>(std::ranges::lower_bound(numbers, copies[c]) - numbers.begin());
        std::uint32_t& of = owner[own[c]];
        if (of == kNone) of = triangles[c];
        if (of != triangles[c]) {
            return invalid_seams(message("copy ", copies[c], " is of vertices ", of, " and ", triangles[c]));
        }
    }
    if (numbers.size() + vertices > LACEDRING_SEAMS_MAX_COPIES) return too_large;
    const Homes homes = find_homes(triangles, vertices, own, static_cast<std::uint32_t>(numbers.size()));
    CornerEncoder corners(triangles, own, homes);
    const SeamAnswers answers = corners.run();
    EncodedSeams out;
    out.words = write_section(homes.first.back(), answer_vertices(homes, vertices), answers);
    if (out.words.empty()) return too_large;
    out.copy_order.reserve(numbers.size());
    for (const std::uint32_t copy : homes.copy) out.copy_order.push_back(copy == kNone ? kNone : numbers[copy]);
    for (const std::uint32_t copy : corners.order()) out.copy_order.push_back(numbers[copy]);
    return out;
}

Result<EncodedSeams> encode_seams(const Encoded& surface, std::span<const std::uint32_t> indices,
                                  std::span<const std::uint32_t> vertex_of) {
    using detail::message;
    const Result<StreamView> view = view_stream(surface.words);
    if (!view) return view.error();
    std::vector<std::uint32_t> first(surface.vertex_order.size(), kNone);  // the mesh's vertex, of the surface's
    for (std::uint32_t v = 0; v < vertex_of.size(); ++v) {
        if (vertex_of[v] >= first.size()) return invalid_seams(message("surface vertex ", vertex_of[v]));
        if (first[vertex_of[v]] == kNone) first[vertex_of[v]] = v;
    }
    const std::vector<std::uint32_t> slots = slot_triangles(*view);
    std::vector<std::uint32_t> copies(slots.size(), kNone);
    std::size_t triangle = 0;
    for (std::size_t i = 0; i < slots.size(); i += 3) {
        if (slots[i] == kNone) continue;
        const std::size_t t = triangle < surface.triangle_order.size() ? surface.triangle_order[triangle++] : kNone;
        if (t >= indices.size() / 3) return invalid_seams("a triangle that the mesh lacks");
        const std::uint32_t* corners = &indices[3 * t];
        const std::uint32_t begin = surface.vertex_order[slots[i]];
        std::uint32_t place = 0;
        while (place < 3 && (corners[place] >= vertex_of.size() || vertex_of[corners[place]] != begin)) ++place;
        if (place == 3) return invalid_seams(message("triangle ", t, " of the mesh has other vertices"));
        for (std::uint32_t j = 0; j < 3; ++j) copies[i + j] = corners[(place + j) % 3];
    }
    Result<EncodedSeams> out = encode_seams(slots, view->vertices(), copies);
    if (!out) return out;
    const Result<SeamView> seams = view_seams(out->words, view->slots(), view->vertices());
    if (!seams) return seams.error();
    std::vector<std::uint32_t> homes(std::size_t{view->vertices()} + 1);
    first_copies(*seams, homes);
    for (std::uint32_t v = 0; v < view->vertices(); ++v) {
        std::uint32_t& copy = out->copy_order[homes[v]];
        if (copy == kNone) copy = first[surface.vertex_order[v]];
    }
    std::vector<bool> found(vertex_of.size());
    for (const std::uint32_t v : out->copy_order) {
        if (v != kNone) found[v] = true;
    }
    const auto lost = std::ranges::find(found, false);
    if (lost == found.end()) return out;
    return invalid_seams(
        message("vertex ", lost - found.begin(), " has no corner, and is not its surface vertex's only one"));
}

}  // namespace lacedring
