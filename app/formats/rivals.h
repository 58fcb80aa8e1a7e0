#pragma once
// Adds baseline formats to a FormatSet. A format that cannot be made is added to FormatSet::absent with the reason.

#include <cstdint>
#include <vector>

#include "app/formats/formats.h"
#include "lacedring/topology.hpp"

namespace lacedring::app {

/// Adds triangle strips. `triangles` are those of the mesh without the degenerate ones.
void add_strips(FormatSet& set, const Mesh& mesh, const std::vector<std::uint32_t>& triangles);

/// Adds meshoptimizer's index codec and meshlets, and sets FormatSet::best_order.
void add_codecs(FormatSet& set, const Mesh& mesh, const std::vector<std::uint32_t>& triangles);

/// Adds the structures with corner operators: winged edge, corner table, SQuad. `table`: the surface's corner table;
/// `vertices`: its number of vertices.
void add_structures(FormatSet& set, CornerTable table, std::uint32_t vertices);

}  // namespace lacedring::app
