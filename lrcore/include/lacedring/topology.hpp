#pragma once
// A triangle soup as a surface: the corner table, what can be said of it, and how to walk it.

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <vector>

#include "lacedring/base.hpp"
#include "lacedring/corner_walks.hpp"

namespace lacedring {

// The Corner Table: for every corner of a triangle mesh, its vertex (V) and its opposite corner (O).
// Paper: LR 2011, section 2.1; Rossignac's chapter, "Corner Table".
//
//              v(n(c))                    c.n next        c.p previous
//               /  \                      c.o opposite    c.s swing = n(l(c))... around v(c)
//      r(c)    / n  \                     c.l left  = opposite(next(c))
//             /      \     o(c)           c.r right = opposite(previous(c))
//            / c    p \                   (as in the paper; the chapter has left and right swapped)
//        v(c) ------- v(p(c))
//
// Corner c belongs to triangle c/3; next follows the triangle's stored order. Opposite is null across a border.

using TableCorners = CornerSteps<struct CornerTable, 3>;

constexpr TriangleId triangle(CornerId c) {
    return TableCorners::triangle(c);
}
constexpr CornerId corner(TriangleId t, std::uint32_t i) {
    return TableCorners::corner(t, i);
}
constexpr CornerId next(CornerId c) {
    return TableCorners::next(c);
}
constexpr CornerId previous(CornerId c) {
    return TableCorners::previous(c);
}

/// How the triangles of an index list were joined into a manifold.
struct Topology {
    std::uint32_t degenerate = 0;         ///< triangles with a repeated vertex; they take part in nothing
    std::uint32_t border_edges = 0;       ///< edges of the input with one triangle
    std::uint32_t nonmanifold_edges = 0;  ///< edges of the input with more than two triangles
    std::uint32_t flipped = 0;            ///< triangles turned round to orient their component
    std::uint32_t cut_edges = 0;  ///< manifold edges left unjoined because no orientation fits (a Moebius strip)
};

/// Corner table of any triangle soup, made manifold by leaving edges unjoined and oriented by flipping triangles.
/// No vertex is renumbered: a vertex whose triangles form several fans keeps its one number.
struct CornerTable : TableCorners {
    /// V and O side by side: whoever reads one of them mostly reads the other, so a triangle is one cache line.
    struct Corner {
        VertexId vertex;
        CornerId opposite;  ///< or null across a border, a cut or a degenerate triangle
    };
    std::vector<Corner> corners;      ///< 3 per triangle, in the input's order; the last two swapped where flipped
    std::vector<std::uint64_t> flip;  ///< bit t: triangle t was turned round; empty if none was
    std::uint32_t vertex_count = 0;
    Topology topology;

    std::uint32_t triangle_count() const { return static_cast<std::uint32_t>(corners.size() / 3); }
    IdRange<TriangleTag> triangles() const { return IdRange<TriangleTag>(triangle_count()); }
    IdRange<VertexTag> vertices() const { return IdRange<VertexTag>(vertex_count); }
    VertexId vertex(CornerId c) const { return corners[c.value].vertex; }
    CornerId opposite(CornerId c) const { return corners[c.value].opposite; }
    bool flipped(TriangleId t) const { return !flip.empty() && (flip[t.value / 64] >> (t.value % 64) & 1) != 0; }
};

/// Builds the corner table of `indices` (3 per triangle, each < vertex_count).
/// Edges of two triangles are joined; at an edge of more, opposed half-edges are paired so that few vertices split into
/// several fans (after Rossignac and Cardoze's Matchmaker). Orientation is made consistent per component where it can
/// be. Cost: O(T) time; 24 bytes a triangle, and 26 more while it runs. Errors: too_large (2^29 vertices; or 2^32
/// corners and vertices together), malformed (index out of range), invalid_argument (no multiple of three). Untrusted
/// input: safe.
Result<CornerTable> build_corner_table(std::span<const std::uint32_t> indices, std::uint32_t vertex_count);

/// Checks V and O against each other: involution, shared edges opposed, no degenerate joined. Empty if all is well.
std::string check_corner_table(const CornerTable& table);

/// Gives every fan of triangles around a vertex a vertex of its own, so that vertices and adjacency agree (a
/// pseudo-manifold; Rossignac and Cardoze 1999). A vertex keeps its number for its first fan.
/// Returns the copies: entry i is the vertex that the new vertex (old vertex_count + i) is a copy of; empty if the
/// table was a pseudo-manifold. Cost: O(T) time, 3/8 byte a triangle while it runs.
std::vector<VertexId> split_fans(CornerTable& table);

// What can be said of a mesh's topology. Rossignac's chapter, sections on borders, shells and handles.

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

// What needs positions: vertex normals, and which side of a shell is outside.
// Rossignac's chapter, sections 6 and 12. Everything is computed in double precision.

using Point = std::array<double, 3>;

/// Read access to the positions of vertices, f32 or f64, without a copy. What it is made of must outlive it.
class Positions {
  public:
    Positions() = default;
    /// x, y, z of vertex 0, 1, 2, ...
    explicit Positions(std::span<const float> xyz) : bytes_(std::as_bytes(xyz)) {}
    explicit Positions(std::span<const double> xyz) : bytes_(std::as_bytes(xyz)), wide_(true) {}
    /// The bytes of floats, or of doubles, at any alignment.
    Positions(std::span<const std::byte> bytes, bool doubles) : bytes_(bytes), wide_(doubles) {}

    std::size_t size() const { return bytes_.size() / stride(); }
    bool empty() const { return size() == 0; }

    /// The origin for a vertex that has no position.
    Point operator[](VertexId v) const {
        if (v.value >= size()) return {};
        const std::byte* from = bytes_.data() + v.value * stride();
        Point wide{};
        if (wide_) {
            std::memcpy(wide.data(), from, sizeof wide);
            return wide;
        }
        std::array<float, 3> narrow{};
        std::memcpy(narrow.data(), from, sizeof narrow);
        for (std::size_t i = 0; i < 3; ++i) wide[i] = double{narrow[i]};
        return wide;
    }

  private:
    std::size_t stride() const { return 3 * (wide_ ? sizeof(double) : sizeof(float)); }

    std::span<const std::byte> bytes_;
    bool wide_ = false;
};

/// Unit normals, 3 floats a vertex of the table: the sum over its corners of the cross product of the triangle's sides,
/// so weighted by area (chapter, section 6). After split_fans every fan has a normal of its own, if `positions` has the
/// copies. A vertex without a normal gets (0,0,1). Differs from lrio's normals_f32 in that triangles
/// count as the table oriented them, a file's own NORMAL is not looked at, and sums are of doubles. Cost: O(V + T)
/// time, 24 bytes a vertex beside the result.
std::vector<float> vertex_normals(const CornerTable& table, const Positions& positions);

/// A shell without a border edge, and the volume that it bounds.
struct ClosedShell {
    TriangleId first;  ///< its triangle of the smallest number
    std::uint32_t triangles;
    double volume;  ///< positive if its triangles are counterclockwise seen from outside
    double error;   ///< bound of what rounding can have added to or taken from `volume`

    /// Clockwise from outside. So is, rightly, the inner surface of a hollow body.
    bool inside_out() const { return volume < -error; }
    /// Bounds nothing, as far as doubles can tell, so it is neither clockwise nor counterclockwise.
    bool flat() const { return std::abs(volume) <= error; }
};

/// The closed shells of the table, with signed volumes: a sixth of the sum of mixed products (chapter, section 12).
/// Differs: each shell is measured from a vertex of its own, not from the average of all of the mesh's, so that small
/// shells far from each other keep their precision. A shell that had to be cut (not orientable) is not closed.
/// Cost: O(T) time, a quarter of a byte a triangle and 24 bytes a closed shell.
std::vector<ClosedShell> closed_shells(const CornerTable& table, const Positions& positions);

/// Turns every closed shell that is inside out, hollows included, so that all are counterclockwise (chapter, section
/// 12). `flip` and topology.flipped keep saying which triangles differ from the input. Returns how many shells were
/// turned. Nothing in the library calls this by itself. Cost: as closed_shells.
std::uint32_t make_counterclockwise(CornerTable& table, const Positions& positions);

// Is a mesh simple? Rossignac's chapter, sections 1, 8 and 12: an smesh is homeomorphic to a sphere.

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

// Rossignac's chapter, section 9: the depth-first traversal that winds around the surface like a spiral.
//
//     swirl(c) { if (!c.t.m) { c.t.m = true; swirl(c.l); swirl(c.r); } }
//
// The chapter's c.l is opposite(previous(c)), our right; its c.r is our left. Its recursion is as deep as the mesh is
// large. Here there is no recursion and no stack: the mark of a triangle remembers the corner at which it was entered,
// and the opposite of that corner is the way back.

/// The marks of one or several swirls over a corner table, which must outlive it unchanged.
/// Memory: a quarter of a byte a triangle.
class Swirl {
  public:
    explicit Swirl(const CornerTable& table)
        : table_(table), marks_((std::size_t{table.triangle_count()} + kPerWord - 1) / kPerWord, 0) {}

    /// Was the triangle visited by a swirl?
    bool visited(TriangleId t) const { return mark(t) != 0; }

    /// Calls visit(c) once for every triangle of the seed's shell that was not visited before and can be reached
    /// through such ones, in the order of the chapter's swirl(seed). c is the corner at which the triangle is entered:
    /// the edge that it faces was crossed. Where the chapter's procedure ends, the seed's own edge is crossed too,
    /// which nobody does there: it leads to new triangles only where there are borders. Cost: O(triangles visited)
    /// time; no memory.
    template <class Visit>
    void run(CornerId seed, Visit visit) {
        if (visited(triangle(seed))) return;
        const auto enter = [&](CornerId c) {
            set_mark(c);
            visit(c);
            return c;
        };
        CornerId at = enter(seed);     // where the present triangle was entered
        CornerId side = previous(at);  // faces the edge to cross next
        for (;;) {
            const CornerId to = table_.opposite(side);
            if (!to.is_null() && !visited(triangle(to))) {
                at = enter(to);
                side = previous(at);
                continue;
            }
            while (side != previous(at) && at != seed) {  // both sides done: back to where it was entered from
                side = table_.opposite(at);
                at = corner(triangle(side), mark(triangle(side)) - 1);
            }
            if (side == seed) return;
            side = side == previous(at) ? next(at) : seed;
        }
    }

  private:
    static constexpr std::uint32_t kPerWord = 32;

    /// 0, or 1 + the index in its triangle of the corner at which it was entered.
    std::uint32_t mark(TriangleId t) const {
        return static_cast<std::uint32_t>(marks_[t.value / kPerWord] >> (t.value % kPerWord * 2)) & 3;
    }
    void set_mark(CornerId c) {
        const TriangleId t = triangle(c);
        marks_[t.value / kPerWord] |= std::uint64_t{1 + c.value % 3} << (t.value % kPerWord * 2);
    }

    const CornerTable& table_;
    std::vector<std::uint64_t> marks_;
};

/// Swirls over every shell, each from the first corner of its first triangle, and calls visit(shell, c) for every
/// triangle that is not degenerate; shells are numbered 0, 1, 2, ... Returns how many there are: the chapter's
/// edge-connected components (section 8). Cost: O(T) time, a quarter of a byte a triangle.
template <class Visit>
std::uint32_t swirl_shells(const CornerTable& table, Visit visit) {
    Swirl swirl(table);
    std::uint32_t shells = 0;
    for (std::uint32_t t = 0; t < table.triangle_count(); ++t) {
        if (swirl.visited(TriangleId{t}) || table.degenerate(TriangleId{t})) continue;
        swirl.run(corner(TriangleId{t}, 0), [&](CornerId c) { visit(shells, c); });
        ++shells;
    }
    return shells;
}

}  // namespace lacedring
