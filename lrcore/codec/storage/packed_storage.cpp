#include "lrcore/codec/storage/packed_storage.h"

#include <algorithm>
#include <tuple>

#include "lrcore/base/message.h"
#include "lrcore/codec/packed/packed_writer.h"
#include "lrcore/codec/storage/packed_steps.h"
#include "lrcore/codec/storage/walk_coder.h"

namespace lacedring::storage {
namespace {

// Words before the coded steps: vertices, own triangles, runs of doubles and whether triangles are flipped. Then, if
// there are runs, the words of the doubles as the stream has them.
constexpr std::size_t kHeaderWords = 3;
constexpr std::uint32_t kHasFlips = 0x80000000U;

Error malformed(const char* what) {
    return {ErrorCode::malformed, detail::message("stored packed stream: ", what)};
}

/// Sets the steps across each step's edges, and its flags; where trees of steps begin, on_right is what the triangle
/// comes out as, and triangles that come out otherwise are flipped. Returns whether any is.
bool link(PackedSteps& steps) {
    struct Entered {
        PackedEdge edge;
        std::uint32_t step;
        auto key() const { return std::tuple(edge.a, edge.b, step); }
        bool operator<(const Entered& other) const { return key() < other.key(); }
    };
    std::vector<Entered> entered;
    entered.reserve(steps.size());
    for (std::uint32_t i = 0; i < steps.size(); ++i) entered.push_back({steps.edge(i), i});
    std::sort(entered.begin(), entered.end());
    std::vector<std::uint8_t> reached(steps.size(), 0);
    const auto across = [&](PackedEdge edge, std::uint32_t from) {
        const auto found = std::upper_bound(entered.begin(), entered.end(), Entered{edge, from});
        if (found == entered.end() || found->edge != edge || reached[found->step] != 0) return UINT32_MAX;
        // A ring edge is not crossed; where a tree of steps begins at one, that is from elsewhere.
        return edge.b - edge.a == 1 && found->step != from + 1 ? UINT32_MAX : found->step;
    };
    bool has_flips = false;
    std::vector<std::uint8_t> right(steps.size(), 0);
    for (std::uint32_t i = 0; i < steps.size(); ++i) {
        PackedSteps::Step& s = steps.step(i);
        const std::uint8_t reversed = steps.flags_of(i) & CorridorStep::kRight;
        if (reached[i] == 0) right[i] = reversed;  // a tree's first
        constexpr std::uint8_t kBoth = CorridorStep::kEnterA | CorridorStep::kEnterB;
        const std::uint8_t said = steps.flags_of(i) & (kBoth | CorridorStep::kFirstA);
        std::uint8_t flags = right[i] | (said & kBoth);
        if (right[i] != reversed) flags |= PackedSteps::kFlipped;
        has_flips |= right[i] != reversed;
        const auto reach = [&](std::uint32_t step) {
            if (step == UINT32_MAX) return;
            reached[step] = 1;
            right[step] = right[i];
        };
        reach(s.across_a = across({s.edge.a, s.third}, i));
        reach(s.across_b = across({s.third, s.edge.b}, i));
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
    std::optional<PackedSteps> steps = read_steps(view);
    if (!steps) return {};
    const bool has_flips = link(*steps);
    std::vector<std::uint32_t> out{view.vertices, view.own, view.runs | (has_flips ? kHasFlips : 0)};
    const auto doubles = view.words.subspan(view.doubles_word(), view.groups_word() - view.doubles_word());
    out.insert(out.end(), doubles.begin(), doubles.end());
    Encoder coder;
    WalkCoder<Encoder>(coder, *steps, view.vertices, has_flips).code(view.own);
    const std::vector<std::uint32_t> coded = coder.finish();
    out.insert(out.end(), coded.begin(), coded.end());
    const auto restored = restore_packed(out, {view.vertices, view.triangles});
    if (!restored || !std::ranges::equal(*restored, view.words)) return {};
    return out;
}

Result<std::vector<std::uint32_t>> restore_packed(std::span<const std::uint32_t> stored, const PackedLimits& limits) {
    if (stored.size() < kHeaderWords) return malformed("shorter than its header");
    const std::uint32_t vertices = stored[0], own = stored[1], runs = stored[2] & ~kHasFlips;
    if (vertices > limits.vertices || own > limits.triangles) return malformed("more than its file has");
    std::size_t at = kHeaderWords;
    const std::size_t doubles = runs == 0 ? 0 : LR_PACKED_DOUBLES_WORDS + LR_PACKED_RUN_WORDS * std::size_t{runs};
    if (doubles > stored.size() - at) return malformed("doubles beyond its end");
    at += doubles;
    Decoder coder(stored.subspan(at));
    PackedSteps steps;
    if (!WalkCoder<Decoder>(coder, steps, vertices, (stored[2] & kHasFlips) != 0).code(own) || !coder.is_at_end()) {
        return malformed("its steps say something impossible");
    }
    PackedStatistics statistics;
    Result<std::vector<std::uint32_t>> words = write_packed(steps, vertices, statistics);
    if (!words || runs == 0) return words;
    PackedView view;
    view.triangles = view.own = own;
    words->insert(words->begin() + static_cast<std::ptrdiff_t>(view.doubles_word()), stored.begin() + kHeaderWords,
                  stored.begin() + static_cast<std::ptrdiff_t>(at));
    (*words)[LR_PACKED_WORD_VERTICES] |= LR_PACKED_DOUBLES;
    (*words)[LR_PACKED_WORD_CHECKSUM] = packed_checksum(*words);
    return words;
}

}  // namespace lacedring::storage
