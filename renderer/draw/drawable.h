#pragma once
// A mesh on the device, with the descriptor sets that draw it.

#include <optional>

#include "renderer/decode/expander.h"
#include "renderer/draw/adjacency.h"
#include "renderer/draw/surface.h"

namespace lacedring::gpu {

/// Must be destroyed before its context.
struct Drawable : ExpandedMesh {
    DrawPlan draw;
    std::optional<Adjacency> adjacency;  ///< View::silhouette
};

}  // namespace lacedring::gpu
