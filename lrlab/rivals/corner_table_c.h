#pragma once
// The corner table with a corner of each vertex: V, O and C, 6.5 references a triangle. Paper: LR 2011, section 2.1;
// sections 7 and 8 compare with this structure.
//
// Corner 3t+i is corner i of triangle t, as in lacedring::CornerTable. Operators take constant time unless stated
// otherwise.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "lacedring/topology.hpp"

namespace lacedring {

/// A view of the arrays of a CornerTableC, or of a memory-mapped file; does not own them. Has the interface of
/// Operators. Entries and arguments are not checked.
struct CornerTableCView : CornerWalks<CornerTableCView, 3> {
    std::uint32_t vertices = 0;
    std::span<const std::uint32_t> vertex_of;    ///< V: the vertex of each corner
    std::span<const std::uint32_t> opposite_of;  ///< O: the opposite corner of each corner; UINT32_MAX: border
    /// C: a corner of each vertex, at a border the first one in swing order; UINT32_MAX: the vertex has no triangle.
    std::span<const std::uint32_t> corner_of;

    using CornerWalks::corner;

    /// c.v
    VertexId vertex(CornerId c) const { return VertexId{vertex_of[c.value]}; }
    /// c.o: null across a border.
    CornerId opposite(CornerId c) const { return CornerId{opposite_of[c.value]}; }
    /// v.c: null for a vertex of no triangle.
    CornerId corner(VertexId v) const { return CornerId{corner_of[v.value]}; }

    /// Triangles keep the input's numbers; degenerate ones are stored, but no operator reaches them.
    bool is_canonical(TriangleId t) const { return !degenerate(t); }
    std::uint32_t triangle_numbers() const { return static_cast<std::uint32_t>(vertex_of.size() / 3); }
    /// 6 n + m for n triangles and m vertices.
    std::size_t references() const { return vertex_of.size() + opposite_of.size() + corner_of.size(); }
};

struct CornerTableC {
    std::vector<std::uint32_t> vertex_of, opposite_of, corner_of;

    CornerTableCView view() const {
        return {{}, static_cast<std::uint32_t>(corner_of.size()), vertex_of, opposite_of, corner_of};
    }
};

/// Copies a table to flat arrays and adds C. `table` is a pseudo-manifold (split_fans), so that a vertex's whole star
/// is reached from one corner. Cost: O(T) time; no memory beside the result.
CornerTableC build_corner_table_c(const CornerTable& table);

}  // namespace lacedring
