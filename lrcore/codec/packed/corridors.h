#pragma once
// The orders in which packed streams visit triangles.

#include <cstdint>
#include <vector>

#include "lacedring/ring.hpp"
#include "lacedring/topology.hpp"

namespace lacedring {

/// One triangle visited: entered across the edge (a, b) that `corner` faces. Seen from there its other edges are (a, x)
/// and (x, b), x being the corner's vertex.
struct CorridorStep {
    enum Flag : std::uint8_t {
        kRight = 1,   ///< on the right of its ring: a is the vertex of previous(corner), else of next(corner)
        kEnterA = 2,  ///< something across (a, x) can be visited from here
        kEnterB = 4,  ///< across (x, b)
        kFirstA = 8,  ///< of both, (a, x) is next and (x, b) after all that lies behind; else the other way round
    };
};

struct Corridors {
    std::vector<std::uint32_t> vertex_order;  ///< vertex_order[new] = old; ring vertices first, in ring order
    std::vector<CornerId> corners;            ///< of each step
    std::vector<std::uint8_t> flags;          ///< of each step
    std::uint32_t ring_vertices = 0;
    std::uint32_t events = 0;  ///< steps that a stream needs more than a turn bit for, about
};

/// Visits every triangle of the table that is not degenerate, once: the polygons on either side of each ring, depth
/// first. The fewest bits. Cost: O(T) time; 5 bytes a triangle and 4 a vertex for the result; while it runs 4 bits a
/// triangle, 4 bytes a vertex.
Corridors walk_corridors(const CornerTable& table, const Rings& rings);

/// Visits them in short pieces of corridors, each beside the one before: the vertices of a FIFO cache of 32 are mostly
/// still there. Cost: about ten times that of walk_corridors; 4 bytes a vertex more.
Corridors walk_pieces(const CornerTable& table, const Rings& rings);

}  // namespace lacedring
