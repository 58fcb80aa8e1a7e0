#include "lrcore/codec/storage/packed_storage.h"

#include <algorithm>
#include <tuple>

#include "lrcore/base/message.h"
#include "lrcore/base/try.h"
#include "lrcore/codec/packed/packed_writer.h"
#include "lrcore/codec/storage/packed_steps.h"
#include "lrcore/codec/storage/walk_coder.h"

namespace lacedring::storage {
namespace {

// Words before the coded steps: vertices, own triangles, runs of doubles (with kHasFlips). If there are runs, the
// stream's words of the doubles follow.
constexpr std::size_t kHeaderWords = 3;
constexpr std::uint32_t kHasFlips = 0x80000000U;

Error malformed(const char* what) {
    return {ErrorCode::malformed, detail::message("stored packed stream: ", what)};
}

/// An edge of a step, (a, x) or (x, b), across which a later step may be entered.
struct Offer {
    PackedEdge edge;
    std::uint32_t step;
    bool is_a;

    auto key() const { return std::tuple(edge.a, edge.b, step, is_a); }
    bool operator<(const Offer& other) const { return key() < other.key(); }
};

/// Sets the steps across each step's edges: a step is entered across the last equal edge offered.
void link_across(PackedSteps& steps) {
    std::vector<Offer> offers;
    offers.reserve(2 * std::size_t{steps.size()});
    for (std::uint32_t i = 0; i < steps.size(); ++i) {
        const auto [a, b] = steps.edge(i);
        const std::uint32_t x = steps.third(i);
        offers.push_back({{a, x}, i, true});
        offers.push_back({{x, b}, i, false});
    }
    std::sort(offers.begin(), offers.end());
    for (std::uint32_t i = 1; i < steps.size(); ++i) {
        const PackedEdge edge = steps.edge(i);
        const auto found = std::lower_bound(offers.begin(), offers.end(), Offer{edge, i, false});
        if (found == offers.begin() || (found - 1)->edge != edge) continue;
        const Offer& offer = *(found - 1);
        // A ring edge links only successive steps; any other step entered there begins a new tree.
        if (edge.b - edge.a == 1 && offer.step + 1 != i) continue;
        std::uint32_t& across = offer.is_a ? steps.step(offer.step).across_a : steps.step(offer.step).across_b;
        if (across == UINT32_MAX) across = i;
    }
}

/// Sets the flags. The first triangle of a tree of steps is on the right if it is decoded reversed; triangles of the
/// tree decoded with the other orientation are flipped. Returns whether any triangle is flipped.
bool set_flags(PackedSteps& steps) {
    bool has_flips = false;
    std::vector<std::uint8_t> right(steps.size(), 0), reached(steps.size(), 0);
    for (std::uint32_t i = 0; i < steps.size(); ++i) {
        const PackedSteps::Step& s = steps.step(i);
        const std::uint8_t reversed = steps.flags_of(i) & CorridorStep::kRight;
        if (reached[i] == 0) right[i] = reversed;  // first step of a tree
        constexpr std::uint8_t kBoth = CorridorStep::kEnterA | CorridorStep::kEnterB;
        const std::uint8_t said = steps.flags_of(i) & (kBoth | CorridorStep::kFirstA);
        std::uint8_t flags = right[i] | (said & kBoth);
        if (right[i] != reversed) flags |= PackedSteps::kFlipped;
        has_flips |= right[i] != reversed;
        for (const std::uint32_t step : {s.across_a, s.across_b}) {
            if (step == UINT32_MAX) continue;
            reached[step] = 1;
            right[step] = right[i];
        }
        if (s.across_a != UINT32_MAX) flags |= CorridorStep::kEnterA;
        if (s.across_b != UINT32_MAX) flags |= CorridorStep::kEnterB;
        const bool first_a = (said & kBoth) == kBoth ? (said & CorridorStep::kFirstA) != 0 : s.across_a < s.across_b;
        if ((flags & kBoth) == kBoth && first_a) flags |= CorridorStep::kFirstA;
        steps.flags_of(i) = flags;
    }
    return has_flips;
}

}  // namespace

std::optional<std::vector<std::uint32_t>> store_packed(const PackedView& view) {
    PackedSteps steps = read_steps(view);
    link_across(steps);
    const bool has_flips = set_flags(steps);
    std::vector<std::uint32_t> out{view.vertices, view.own, view.runs | (has_flips ? kHasFlips : 0)};
    const auto doubles = view.words.subspan(view.doubles_word(), view.groups_word() - view.doubles_word());
    out.insert(out.end(), doubles.begin(), doubles.end());
    Encoder coder;
    WalkCoder<Encoder>(coder, steps, view.vertices, has_flips).code(view.own);
    const std::vector<std::uint32_t> coded = coder.finish();
    out.insert(out.end(), coded.begin(), coded.end());
    const auto restored = restore_packed(out, {view.vertices, view.triangles});
    if (!restored || !std::ranges::equal(*restored, view.words)) return {};
    return out;
}

Result<StoredPacked> StoredPacked::read(std::span<const std::uint32_t> stored, const PackedLimits& limits) {
    if (stored.size() < kHeaderWords) return malformed("shorter than its header");
    const std::uint32_t vertices = stored[0], own = stored[1], runs = stored[2] & ~kHasFlips;
    if (vertices > limits.vertices || own > limits.triangles)
        return malformed("more vertices or triangles than allowed");
    const std::size_t doubles = runs == 0 ? 0 : LR_PACKED_DOUBLES_WORDS + LR_PACKED_RUN_WORDS * std::size_t{runs};
    if (doubles > stored.size() - kHeaderWords) return malformed("doubles beyond its end");
    StoredPacked out;
    out.vertices_ = vertices;
    out.runs_ = runs;
    out.doubles_ = stored.subspan(kHeaderWords, doubles);
    out.steps_.reserve(own);
    Decoder coder(stored.subspan(kHeaderWords + doubles));
    WalkCoder<Decoder> walk(coder, out.steps_, vertices, (stored[2] & kHasFlips) != 0);
    if (!walk.code(own) || !coder.is_at_end()) return malformed("its steps are invalid");
    return out;
}

std::vector<std::uint32_t> StoredPacked::triangles() const {
    std::vector<std::uint32_t> out;
    if (runs_ != 0) return out;
    out.reserve(std::size_t{3} * steps_.size());
    for (std::uint32_t i = 0; i < steps_.size(); ++i) {
        const auto [a, b] = steps_.edge(i);
        const std::uint32_t x = steps_.third(i);
        const bool reversed = steps_.on_right(i) != steps_.flipped(i);
        for (const std::uint32_t v : {a, reversed ? x : b, reversed ? b : x}) out.push_back(v);
    }
    return out;
}

Result<std::vector<std::uint32_t>> StoredPacked::write() const {
    PackedStatistics statistics;
    Result<std::vector<std::uint32_t>> words = write_packed(steps_, vertices_, statistics);
    if (!words || runs_ == 0) return words;
    PackedView view;
    view.triangles = view.own = steps_.size();
    words->insert(words->begin() + static_cast<std::ptrdiff_t>(view.doubles_word()), doubles_.begin(), doubles_.end());
    (*words)[LR_PACKED_WORD_VERTICES] |= LR_PACKED_DOUBLES;
    (*words)[LR_PACKED_WORD_CHECKSUM] = packed_checksum(*words);
    return words;
}

Result<std::vector<std::uint32_t>> restore_packed(std::span<const std::uint32_t> stored, const PackedLimits& limits) {
    LR_ASSIGN(const StoredPacked read, StoredPacked::read(stored, limits));
    return read.write();
}

}  // namespace lacedring::storage
