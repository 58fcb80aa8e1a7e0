#pragma once
// The mesh that bench measures, and the structures and streams made of it before anything is timed.

#include <cstdint>

#include "app/cli/input.h"
#include "lacedring/lacedring.hpp"
#include "lacedring/ring.hpp"
#include "lacedring/streams.hpp"
#include "lacedring/topology.hpp"

namespace lacedring::app {

struct Subject {
    LoadedMesh loaded;
    /// The surface, whose connectivity is measured, also for rivals.
    Mesh mesh;
    CornerTable table;  ///< of the surface
    RingOptions ring;   ///< options of `rings`
    Rings rings, optimized;
    EncodedLean lean;                    ///< of `rings`
    EncodedPacked packed, packed_cache;  ///< of `optimized`
    LeanView lean_view;
    PackedView packed_view, packed_cache_view;
};

/// Options for optimizing the ring of the packed stream.
OptimizeOptions packed_optimization();

/// Errors: those of build_corner_table, encode_lean and encode_packed.
Result<Subject> make_subject(LoadedMesh loaded, std::uint32_t seeds);

}  // namespace lacedring::app
