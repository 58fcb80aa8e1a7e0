#pragma once
// The mesh that bench measures, and what was made of it before anything is timed.

#include <cstdint>

#include "app/cli/input.h"
#include "lacedring/lacedring.hpp"
#include "lacedring/ring.hpp"
#include "lacedring/streams.hpp"
#include "lacedring/topology.hpp"

namespace lacedring::app {

struct Subject {
    LoadedMesh loaded;
    Mesh mesh;          ///< the surface: connectivity is its, the rivals' too; what is drawn has its copies
    CornerTable table;  ///< of the surface
    RingOptions ring;   ///< of these
    Rings rings, optimized;
    EncodedLean lean;
    EncodedPacked packed, packed_cache;  ///< of the optimized rings
    LeanView lean_view;
    PackedView packed_view, packed_cache_view;
};

/// The options by which the packed stream's ring is optimized.
OptimizeOptions packed_optimization();

/// Errors: build_corner_table's.
Result<Subject> make_subject(LoadedMesh loaded, std::uint32_t seeds);

}  // namespace lacedring::app
