#pragma once
// What a packed document says of its streams, checked before anything is decoded. Internal to lrio.

#include <cstdint>
#include <optional>
#include <set>
#include <vector>

#include "lacedring/base.hpp"
#include "lrio/scene/packed_scene.h"

namespace lacedring::detail {

struct StreamPlan {
    std::uint64_t view = 0;
    std::optional<std::uint64_t> parts_view;
    std::vector<std::vector<std::uint32_t>> sets;  ///< accessors
    bool ordered = false;
    struct Part {
        std::uint32_t set = UINT32_MAX;
        std::optional<std::uint32_t> indices;
    };
    std::vector<Part> parts;
};

struct UnpackPlan {
    std::vector<StreamPlan> streams;
    std::set<std::uint32_t> positions;  ///< accessors of sets that primitives, or morph targets, have as POSITION
    std::vector<bool> kept;             ///< of each buffer view: its contents are part of the plain scene
    std::size_t primitives = 0;         ///< that are compressed
};

/// Numbers of accessors and views exist, each stream has a primitive for every part, and nothing else refers to views
/// without contents of their own. `images`: their views are kept. Errors: malformed.
Result<UnpackPlan> plan_unpacking(PackedScene& scene, bool images);

}  // namespace lacedring::detail
