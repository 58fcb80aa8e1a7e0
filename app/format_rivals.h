#pragma once
// The formats of a FormatSet that are not this project's. What cannot be made is in FormatSet::absent, with the reason.

#include <cstdint>
#include <vector>

#include "app/formats.h"
#include "lrcore/corner_table/corner_table.h"

namespace lr::app {

/// Triangle strips. `triangles`: the mesh's, degenerate ones left out.
void add_strips(FormatSet& set, const Mesh& mesh, const std::vector<std::uint32_t>& triangles);

/// The formats of meshoptimizer that are no index buffers, and its best order for the vertex cache.
void add_codecs(FormatSet& set, const Mesh& mesh, const std::vector<std::uint32_t>& triangles);

/// The structures that answer the corner operators: winged edge, corner table, SQuad. `table` is the mesh's.
void add_structures(FormatSet& set, CornerTable table, std::uint32_t mesh_vertices);

}  // namespace lr::app
