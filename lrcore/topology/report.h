#pragma once
// What can be said of a mesh's topology. Rossignac's chapter, sections on borders, shells and handles.

#include <cstdint>

#include "lrcore/topology/corner_table.h"

namespace lr {

struct TopologyReport {
    std::uint32_t triangles = 0;      ///< that are not degenerate
    std::uint32_t used_vertices = 0;  ///< in at least one of them
    std::uint32_t components = 0;     ///< triangles connected through shared vertices
    std::uint32_t shells = 0;         ///< triangles connected through joined edges: pieces of surface
    std::uint32_t border_loops = 0;
    std::uint32_t nonmanifold_vertices = 0;  ///< whose triangles form several fans
    std::uint32_t fans = 0;                  ///< vertices, once each non-manifold vertex is split into its fans
    std::uint32_t max_valence = 0;           ///< edges at a vertex
    double valence6_percent = 0;             ///< share of used vertices with six edges
    std::int64_t euler_characteristic = 0;   ///< of the split, joined surface
    bool closed = false;                     ///< no border
    bool orientable = true;
    std::int64_t genus = 0;  ///< handles, summed over shells, their border loops capped
};

/// Cost: O(T) time, about 7 bytes a triangle.
TopologyReport report_topology(const CornerTable& table);

}  // namespace lr
