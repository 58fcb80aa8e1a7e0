#pragma once
// Is a mesh simple? Rossignac's chapter, sections 1, 8 and 12: an smesh is homeomorphic to a sphere.

#include <cstdint>
#include <span>
#include <string>

#include "lrcore/topology/corner_table.h"
#include "lrcore/topology/geometry.h"
#include "lrcore/topology/report.h"

namespace lr {

/// The first condition that a mesh does not meet, in this order.
enum class SmeshFault : std::uint8_t {
    none,                ///< it is an smesh
    empty,               ///< no triangles
    degenerate,          ///< a triangle with a repeated vertex
    nonmanifold_edge,    ///< a corner has several opposites
    border,              ///< a corner has no opposite
    not_connected,       ///< several shells (the chapter's edge-connected components)
    not_orientable,      ///< no orientation of the triangles fits
    nonmanifold_vertex,  ///< a vertex's star is several fans
    handles,             ///< Equation 1, |T| = 2|G| - 4, does not hold
    flat,                ///< bounds no volume, so it cannot be counterclockwise
    clockwise,           ///< inside out
};

struct SmeshCheck {
    SmeshFault fault = SmeshFault::none;
    std::string reason;  ///< a phrase with the numbers, for people; empty for an smesh

    bool is_smesh() const { return fault == SmeshFault::none; }
};

/// Euler's formula as the chapter's Equation 1: |T| = 2|G| - 4, over the triangles that are not degenerate and the
/// vertices that they use. A vertex that no triangle uses is not part of the surface.
bool satisfies_equation_1(const TopologyReport& report);

/// What connectivity says: an edge-connected manifold, orientable, of genus 0. `report` is report_topology(table).
/// Edges count as they were in the input, before non-manifold ones were paired. The orientation is the table's: whether
/// the input's triangles all had it, topology.flipped says. Cost: O(1).
SmeshCheck check_smesh(const CornerTable& table, const TopologyReport& report);

/// The chapter's whole definition: also counterclockwise. `shells` is closed_shells(table, positions). Cost: O(1).
SmeshCheck check_smesh(const CornerTable& table, const TopologyReport& report, std::span<const ClosedShell> shells);

}  // namespace lr
