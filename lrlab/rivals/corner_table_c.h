#pragma once
// The corner table with a corner of every vertex: V, O and C, 6.5 references a triangle. Paper: LR 2011, section 2.1;
// the structure that sections 7 and 8 compare with.
//
// Corner 3t+i is corner i of triangle t, as in lacedring::CornerTable. Every operator below takes constant time unless
// it says otherwise.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "lacedring/topology.hpp"

namespace lacedring {

/// The arrays, wherever they are: in a CornerTableC, or in a memory-mapped file. Holds no copy. The names of
/// Operators. Entries are trusted, as are the arguments.
struct CornerTableCView : CornerWalks<CornerTableCView, 3> {
    std::uint32_t vertices = 0;
    std::span<const std::uint32_t> vertex_of;    ///< V, 3 a triangle
    std::span<const std::uint32_t> opposite_of;  ///< O, 3 a triangle; UINT32_MAX across a border
    std::span<const std::uint32_t> corner_of;    ///< C, 1 a vertex: at a border the first in swing order;
                                                 ///< UINT32_MAX where a vertex has no triangle

    using CornerWalks::corner;

    /// c.v
    VertexId vertex(CornerId c) const { return VertexId{vertex_of[c.value]}; }
    /// c.o: null across a border.
    CornerId opposite(CornerId c) const { return CornerId{opposite_of[c.value]}; }
    /// v.c: null for a vertex of no triangle.
    CornerId corner(VertexId v) const { return CornerId{corner_of[v.value]}; }

    /// Triangles keep the input's numbers; degenerate ones are held, and take part in nothing.
    bool is_canonical(TriangleId t) const { return !degenerate(t); }
    std::uint32_t triangle_numbers() const { return static_cast<std::uint32_t>(vertex_of.size() / 3); }
    /// 6 n + m.
    std::size_t references() const { return vertex_of.size() + opposite_of.size() + corner_of.size(); }
};

struct CornerTableC {
    std::vector<std::uint32_t> vertex_of, opposite_of, corner_of;

    CornerTableCView view() const {
        return {{}, static_cast<std::uint32_t>(corner_of.size()), vertex_of, opposite_of, corner_of};
    }
};

/// The same table as flat arrays, with C. `table` is a pseudo-manifold (split_fans), so that one corner reaches a
/// vertex's whole star. Cost: O(T) time; nothing but the result.
CornerTableC build_corner_table_c(const CornerTable& table);

}  // namespace lacedring
