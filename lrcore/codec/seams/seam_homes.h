#pragma once
// Chooses the home copies of a surface's vertices. Internal to lrcore; docs/seams-format.md.

#include <cstdint>
#include <span>
#include <vector>

namespace lacedring {

/// The corners of each vertex, in increasing order. Slots without a triangle (UINT32_MAX) have none.
class VertexCorners {
  public:
    VertexCorners(std::span<const std::uint32_t> triangles, std::uint32_t vertices);

    std::span<const std::uint32_t> of(std::uint32_t v) const {
        return std::span(corners_).subspan(begin_[v], begin_[v + 1] - begin_[v]);
    }

  private:
    std::vector<std::uint32_t> begin_, corners_;
};

inline std::uint32_t corner_next(std::uint32_t c) {
    return c % 3 == 2 ? c - 2 : c + 1;
}
inline std::uint32_t corner_previous(std::uint32_t c) {
    return c % 3 == 0 ? c + 2 : c - 1;
}

/// Home copies of the vertices, by the copies' numbers.
struct SeamHomes {
    std::vector<std::uint32_t> first;  ///< of vertex v in `copy`: first[v] to first[v + 1]
    std::vector<std::uint32_t> copy;   ///< UINT32_MAX of a vertex without corners
    std::vector<std::uint8_t> wrap;    ///< of each vertex: its last position is its first copy again
    std::vector<std::uint8_t> single;  ///< of each vertex: it has one copy
    std::vector<std::uint32_t> index;  ///< of each copy among its vertex's homes, or UINT32_MAX

    std::uint32_t steps(std::uint32_t v) const { return first[v + 1] - first[v] - 1 + wrap[v]; }
    std::uint32_t count(std::uint32_t v) const { return first[v + 1] - first[v]; }
    /// The home copy at a position; private states are left as they are.
    std::uint32_t copy_at(std::uint32_t v, std::uint32_t state) const {
        return wrap[v] != 0 && state == steps(v) ? 0 : state;
    }
};

/// Chooses the home copies: those of the fan on the vertex's left, in its order. The copy of each corner is below
/// `copy_count`, and of one vertex. Cost: O(T), and O(n log n) of a vertex with n corners and several copies.
SeamHomes find_homes(std::span<const std::uint32_t> triangles, std::uint32_t vertices,
                     std::span<const std::uint32_t> copies, std::uint32_t copy_count, const VertexCorners& corners);

}  // namespace lacedring
