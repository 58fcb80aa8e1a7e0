#pragma once
// The steps that a packed stream was written from: what each triangle was entered across, and what lies across its two
// other edges. Internal to lrcore.

#include <cstdint>
#include <vector>

#include "lacedring/streams.hpp"
#include "lrcore/codec/packed/corridors.h"
#include "lrcore/codec/packed/record_plan.h"

namespace lacedring::storage {

/// As Planner wants them.
class PackedSteps {
  public:
    enum Flag : std::uint8_t { kFlipped = 16 };  ///< beside CorridorStep's

    struct Step {
        PackedEdge edge;
        std::uint32_t third;
        std::uint32_t across_a = UINT32_MAX, across_b = UINT32_MAX;  ///< the steps across (a, x) and (x, b)
    };

    std::uint32_t size() const { return static_cast<std::uint32_t>(steps_.size()); }
    std::uint8_t flags(std::uint32_t i) const { return flags_[i] & 15; }
    bool on_right(std::uint32_t i) const { return (flags_[i] & CorridorStep::kRight) != 0; }
    bool flipped(std::uint32_t i) const { return (flags_[i] & kFlipped) != 0; }
    PackedEdge edge(std::uint32_t i) const { return steps_[i].edge; }
    std::uint32_t third(std::uint32_t i) const { return steps_[i].third; }
    std::uint32_t across(std::uint32_t i, bool a) const { return a ? steps_[i].across_a : steps_[i].across_b; }

    void reserve(std::size_t steps) {
        steps_.reserve(steps);
        flags_.reserve(steps);
    }
    /// `next`, or UINT32_MAX: the step across the one edge that the flags say is entered.
    void add(PackedEdge edge, std::uint32_t third, std::uint8_t flags, std::uint32_t next = UINT32_MAX) {
        const bool is_a = (flags & CorridorStep::kEnterA) != 0;
        steps_.push_back({edge, third, is_a ? next : UINT32_MAX, is_a ? UINT32_MAX : next});
        flags_.push_back(flags);
    }
    /// Step i, across one of whose edges the next step is: by `up` (x, b), else (a, x).
    void add_simple(std::uint32_t i, PackedEdge edge, std::uint32_t third, std::uint32_t right, std::uint32_t up) {
        const std::uint32_t next = i + 1;
        steps_.push_back({edge, third, next | (0 - up), next | (up - 1)});
        flags_.push_back(static_cast<std::uint8_t>(right | (1 + up) << 1));
    }
    Step& step(std::uint32_t i) { return steps_[i]; }
    std::uint8_t& flags_of(std::uint32_t i) { return flags_[i]; }

  private:
    std::vector<Step> steps_;
    std::vector<std::uint8_t> flags_;
};

/// Reads them back from a valid stream, without doubles; what is across the edges is not known yet. Of the flags kRight
/// says whether the triangle comes out reversed, and the others are what its event says, if it has one. Those of plain
/// blocks are a guess.
PackedSteps read_steps(const PackedView& view);

}  // namespace lacedring::storage
