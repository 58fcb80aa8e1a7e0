#pragma once
// The corner table of a triangle soup, reports on its topology and geometry, and walks over it.

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
    std::uint32_t degenerate = 0;         ///< triangles with a repeated vertex; joined to no other
    std::uint32_t border_edges = 0;       ///< edges of one input triangle
    std::uint32_t nonmanifold_edges = 0;  ///< edges of more than two input triangles
    std::uint32_t flipped = 0;            ///< triangles reversed to orient their component
    /// Manifold edges left unjoined because no orientation fits (a Moebius strip has one).
    std::uint32_t cut_edges = 0;
};

/// Corner table of any triangle soup, made manifold by leaving edges unjoined and oriented by flipping triangles.
/// No vertex is renumbered: a vertex whose triangles form several fans keeps its one number.
struct CornerTable : TableCorners {
    /// V and O are interleaved because most code reads both: a triangle then lies in one cache line.
    struct Corner {
        VertexId vertex;
        /// Null if unjoined: at a border, at a cut, at an unpaired half-edge of a non-manifold edge, in a degenerate
        /// triangle.
        CornerId opposite;
    };
    /// 3 per triangle, in the input's order; the last two are swapped in flipped triangles.
    std::vector<Corner> corners;
    std::vector<std::uint64_t> flip;  ///< bit t: triangle t was reversed; empty if none was
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
/// Joins the triangles of each edge that has two. At an edge with more, pairs opposed half-edges so that few vertices
/// get several fans (after Rossignac and Cardoze's Matchmaker). Orients each component consistently if possible. Cost:
/// O(T) time; 24 bytes per triangle, and 26 more while it runs. Errors: too_large (more than 2^29 vertices, or 2^32
/// corners and vertices together), malformed (index out of range), invalid_argument (the number of indices is no
/// multiple of three). Untrusted input: safe.
Result<CornerTable> build_corner_table(std::span<const std::uint32_t> indices, std::uint32_t vertex_count);

/// Checks V and O: opposite is an involution, joined half-edges are opposed, and no degenerate triangle is joined.
/// Returns the fault; empty if there is none.
std::string check_corner_table(const CornerTable& table);

/// Makes the table a pseudo-manifold (Rossignac and Cardoze 1999): each fan of triangles around a vertex gets its own
/// vertex. The first fan keeps the vertex's number. Returns the originals of the new vertices: entry i is the vertex
/// that vertex (old vertex_count + i) is a copy of; empty if the table was a pseudo-manifold. Cost: O(T) time, 3/8 byte
/// per triangle while it runs.
std::vector<VertexId> split_fans(CornerTable& table);

// Report on a mesh's topology. Rossignac's chapter, sections on borders, shells and handles.

struct TopologyReport {
    std::uint32_t triangles = 0;      ///< triangles that are not degenerate
    std::uint32_t used_vertices = 0;  ///< vertices of such triangles
    std::uint32_t components = 0;     ///< sets of triangles connected by shared vertices
    std::uint32_t shells = 0;         ///< sets of triangles connected by joined edges
    std::uint32_t border_loops = 0;
    std::uint32_t nonmanifold_vertices = 0;  ///< with several fans of triangles
    std::uint32_t fans = 0;                  ///< number of used vertices after split_fans
    std::uint32_t max_valence = 0;           ///< edges at a vertex
    double valence6_percent = 0;             ///< share of used vertices with six edges
    std::int64_t euler_characteristic = 0;   ///< Euler characteristic after split_fans
    bool closed = false;                     ///< no border
    bool orientable = true;
    std::int64_t genus = 0;  ///< handles of all shells, with border loops capped
};

/// Cost: O(T) time, about 7 bytes per triangle.
TopologyReport report_topology(const CornerTable& table);

// Geometry: vertex normals, and the outside of shells, in double precision. Rossignac's chapter, sections 6 and 12.

using Point = std::array<double, 3>;

/// Read access to the positions of vertices, f32 or f64. Holds no copy: the values must outlive it.
class Positions {
  public:
    Positions() = default;
    /// x, y, z of vertex 0, 1, 2, ...
    explicit Positions(std::span<const float> xyz) : bytes_(std::as_bytes(xyz)) {}
    explicit Positions(std::span<const double> xyz) : bytes_(std::as_bytes(xyz)), wide_(true) {}
    /// The bytes of floats or doubles, at any alignment.
    Positions(std::span<const std::byte> bytes, bool doubles) : bytes_(bytes), wide_(doubles) {}

    std::size_t size() const { return bytes_.size() / stride(); }
    bool empty() const { return size() == 0; }

    /// The position of v; the origin if v has none.
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

/// Unit normals, 3 floats per vertex of the table. A normal is the sum of the cross products of the triangles around
/// the vertex, so it is weighted by area (chapter, section 6). After split_fans each fan has its own normal, if
/// `positions` includes the copies. A vertex without a normal gets (0,0,1). Differs from lrio's normals_f32: uses the
/// table's orientation, ignores a file's NORMAL attribute, and sums in doubles. Cost: O(V + T) time, 24 bytes per
/// vertex beside the result.
std::vector<float> vertex_normals(const CornerTable& table, const Positions& positions);

/// A shell without a border edge, and its volume.
struct ClosedShell {
    TriangleId first;  ///< its triangle with the smallest number
    std::uint32_t triangles;
    /// Positive if its triangles are counterclockwise seen from outside.
    double volume;
    double error;  ///< bound of the rounding error of `volume`

    /// Clockwise from outside, as the inner surface of a hollow body should be.
    bool inside_out() const { return volume < -error; }
    /// Volume 0 within the rounding error: neither clockwise nor counterclockwise.
    bool flat() const { return std::abs(volume) <= error; }
};

/// The closed shells of the table, with signed volumes: a sixth of the sum of mixed products (chapter, section 12).
/// Unlike the chapter, measures each shell from one of its own vertices, not from the average of the mesh's vertices,
/// so that small shells far from each other keep their precision. A shell that was cut (not orientable) is not closed.
/// Cost: O(T) time, a quarter of a byte per triangle and 24 bytes per closed shell.
std::vector<ClosedShell> closed_shells(const CornerTable& table, const Positions& positions);

/// Reverses every closed shell that is inside out, including hollows, so that all are counterclockwise (chapter,
/// section 12). Updates `flip` and topology.flipped. Returns the number of shells reversed. The library never calls it.
/// Cost: as closed_shells.
std::uint32_t make_counterclockwise(CornerTable& table, const Positions& positions);

// Test for simple meshes (smeshes): homeomorphic to a sphere. Rossignac's chapter, sections 1, 8 and 12.

/// The first condition, in this order, that a mesh violates.
enum class SmeshFault : std::uint8_t {
    none,                ///< it is an smesh
    empty,               ///< no triangles
    degenerate,          ///< a triangle with a repeated vertex
    nonmanifold_edge,    ///< a corner has several opposites
    border,              ///< a corner has no opposite
    not_connected,       ///< it has several shells (the chapter's edge-connected components)
    not_orientable,      ///< the triangles have no consistent orientation
    nonmanifold_vertex,  ///< a vertex has several fans
    handles,             ///< Equation 1, |T| = 2|G| - 4, does not hold
    flat,                ///< bounds no volume, so it cannot be counterclockwise
    clockwise,           ///< inside out
};

struct SmeshCheck {
    SmeshFault fault = SmeshFault::none;
    std::string reason;  ///< a phrase that includes counts; empty for an smesh

    bool is_smesh() const { return fault == SmeshFault::none; }
};

/// Euler's formula as the chapter's Equation 1: |T| = 2|G| - 4, over the triangles that are not degenerate and the
/// vertices that they use. A vertex that no triangle uses is not part of the surface.
bool satisfies_equation_1(const TopologyReport& report);

/// Checks connectivity only: an edge-connected, orientable manifold of genus 0. `report` is report_topology(table).
/// Edges are checked as in the input, before non-manifold edges were paired. The input's own orientation was consistent
/// if topology.flipped is 0. Cost: O(1).
SmeshCheck check_smesh(const CornerTable& table, const TopologyReport& report);

/// Checks the chapter's whole definition, which also requires counterclockwise triangles. `shells` is
/// closed_shells(table, positions). Cost: O(1).
SmeshCheck check_smesh(const CornerTable& table, const TopologyReport& report, std::span<const ClosedShell> shells);

// Rossignac's chapter, section 9: the depth-first traversal that winds around the surface like a spiral.
//
//     swirl(c) { if (!c.t.m) { c.t.m = true; swirl(c.l); swirl(c.r); } }
//
// The chapter's c.l is opposite(previous(c)), our right; its c.r is our left. The chapter's recursion may be as deep as
// the mesh has triangles. This implementation needs neither recursion nor a stack: a triangle's mark stores the corner
// at which it was entered, and the opposite of that corner leads back.

/// The marks of one or several swirls over a corner table. The table must stay unchanged and outlive it. Memory: a
/// quarter of a byte per triangle.
class Swirl {
  public:
    explicit Swirl(const CornerTable& table)
        : table_(table), marks_((std::size_t{table.triangle_count()} + kPerWord - 1) / kPerWord, 0) {}

    /// Was the triangle visited by a swirl?
    bool visited(TriangleId t) const { return mark(t) != 0; }

    /// Calls visit(c) once for every triangle reachable from the seed through triangles not visited before, in the
    /// order of the chapter's swirl(seed). c is the corner facing the edge across which the triangle is entered. Unlike
    /// the chapter's procedure, it finally also crosses the edge that the seed faces, which leads to new triangles only
    /// in shells with borders. Cost: O(triangles visited) time; no memory.
    template <class Visit>
    void run(CornerId seed, Visit visit) {
        if (visited(triangle(seed))) return;
        const auto enter = [&](CornerId c) {
            set_mark(c);
            visit(c);
            return c;
        };
        CornerId at = enter(seed);     // where the current triangle was entered
        CornerId side = previous(at);  // faces the edge to cross next
        for (;;) {
            const CornerId to = table_.opposite(side);
            if (!to.is_null() && !visited(triangle(to))) {
                at = enter(to);
                side = previous(at);
                continue;
            }
            while (side != previous(at) && at != seed) {  // both sides done: return to the previous triangle
                side = table_.opposite(at);
                at = corner(triangle(side), mark(triangle(side)) - 1);
            }
            if (side == seed) return;
            side = side == previous(at) ? next(at) : seed;
        }
    }

  private:
    static constexpr std::uint32_t kPerWord = 32;

    /// 0 if not visited; else 1 + the index (0 to 2) of the corner at which the triangle was entered.
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
/// triangle that is not degenerate; shells are numbered 0, 1, 2, ... Returns their number: the chapter's edge-connected
/// components (section 8). Cost: O(T) time, a quarter of a byte per triangle.
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
