#pragma once
// The orders in which packed streams visit triangles.

#include <cstdint>
#include <vector>

#include "lacedring/ring.hpp"
#include "lacedring/topology.hpp"

namespace lacedring {

/// Flags of one triangle visited. It is entered across the edge (a, b) that its corner faces; its other edges are (a,
/// x) and (x, b), where x is the corner's vertex.
struct CorridorStep {
    enum Flag : std::uint8_t {
        /// On the right of its ring: a is the vertex of previous(corner); else of next(corner).
        kRight = 1,
        kEnterA = 2,  ///< the triangle across (a, x) can be visited from here
        kEnterB = 4,  ///< the triangle across (x, b) can be visited from here
        /// If both can be visited: (a, x) and everything reached through it first, then (x, b); else the reverse.
        kFirstA = 8,
    };
};

struct Corridors {
    std::vector<std::uint32_t> vertex_order;  ///< vertex_order[new] = old; ring vertices first, in ring order
    std::vector<CornerId> corners;            ///< per step
    std::vector<std::uint8_t> flags;          ///< per step
    std::uint32_t ring_vertices = 0;
    std::uint32_t events = 0;  ///< approximate number of steps that need more than a turn bit
};

/// Visits every triangle of the table that is not degenerate, once: the polygons on both sides of each ring, depth
/// first. This order gives the smallest streams. Cost: O(T) time; 5 bytes per triangle and 4 per vertex for the result;
/// while it runs 4 bits per triangle and 4 bytes per vertex.
Corridors walk_corridors(const CornerTable& table, const Rings& rings);

/// Visits the triangles in short pieces of corridors, each beside the previous piece, so that its vertices are mostly
/// still in a FIFO cache of 32. Cost: about ten times that of walk_corridors; 4 bytes per vertex more.
Corridors walk_pieces(const CornerTable& table, const Rings& rings);

}  // namespace lacedring
