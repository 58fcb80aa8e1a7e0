#pragma once
// Reads a packed document's description of its streams and checks it before decoding. Internal to lrio.

#include <cstdint>
#include <optional>
#include <set>
#include <vector>

#include "lacedring/base.hpp"
#include "lrio/scene/packed_scene.h"

namespace lacedring::detail {

struct StreamPlan {
    std::uint64_t view = 0;                        ///< buffer view of the .lr file
    std::optional<std::uint64_t> parts_view;       ///< buffer view of the part codes
    std::vector<std::vector<std::uint32_t>> sets;  ///< accessors of each set
    bool ordered = false;                          ///< the input's order was kept
    struct Part {
        std::uint32_t set = UINT32_MAX;
        std::optional<std::uint32_t> indices;  ///< accessor
    };
    std::vector<Part> parts;
};

struct UnpackPlan {
    std::vector<StreamPlan> streams;
    std::set<std::uint32_t> positions;  ///< compressed accessors used as POSITION, also in morph targets
    std::vector<bool> kept;             ///< marks the buffer views that the plain scene keeps
    std::size_t primitives = 0;         ///< number of compressed primitives
};

/// Makes the plan. Checks that indices of accessors and views exist, that each part of a stream has a primitive, and
/// that nothing else refers to views of streams or placeholders. `images`: keeps the images' views. Errors: malformed.
Result<UnpackPlan> plan_unpacking(PackedScene& scene, bool images);

}  // namespace lacedring::detail
