#pragma once
// The steps from which a packed stream was written: the edge across which each triangle was entered, and the steps
// across its two other edges. Internal to lrcore.

#include <cstdint>
#include <vector>

#include "lacedring/streams.hpp"
#include "lrcore/codec/packed/corridors.h"
#include "lrcore/codec/packed/record_plan.h"

namespace lacedring::storage {

/// Steps with the interface that Planner requires.
class PackedSteps {
  public:
    enum Flag : std::uint8_t { kFlipped = 16 };  ///< in addition to CorridorStep's flags

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
    /// `next`: the step across the edge entered, if the flags name exactly one; else UINT32_MAX.
    void add(PackedEdge edge, std::uint32_t third, std::uint8_t flags, std::uint32_t next = UINT32_MAX) {
        const bool is_a = (flags & CorridorStep::kEnterA) != 0;
        steps_.push_back({edge, third, is_a ? next : UINT32_MAX, is_a ? UINT32_MAX : next});
        flags_.push_back(flags);
    }
    /// Adds step i; the next step is across its edge (x, b) if `up` is 1, else across (a, x).
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

/// Reads the steps from a valid stream, without doubles; the steps across edges are not yet set. The flag kRight means
/// that the triangle is decoded reversed; the other flags come from its event, if it has one. Steps of plain blocks are
/// a guess.
PackedSteps read_steps(const PackedView& view);

}  // namespace lacedring::storage
