#pragma once
// Chooses the home copies of a surface's vertices (docs/seams-format.md). Internal to lrcore.

#include <cstdint>
#include <span>
#include <vector>

namespace lacedring {

/// The corners of each vertex, in ascending order. Slots without a triangle (UINT32_MAX) have no corners.
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
    std::vector<std::uint32_t> first;  ///< vertex v has copy[first[v]] to copy[first[v + 1] - 1]
    std::vector<std::uint32_t> copy;   ///< UINT32_MAX for a vertex without corners
    std::vector<std::uint8_t> wrap;    ///< per vertex: 1: its last position is its first copy again
    std::vector<std::uint8_t> single;  ///< per vertex: 1: it has only one copy
    /// Per copy: its index among its vertex's homes; UINT32_MAX if private.
    std::vector<std::uint32_t> index;

    std::uint32_t steps(std::uint32_t v) const { return first[v + 1] - first[v] - 1 + wrap[v]; }
    std::uint32_t count(std::uint32_t v) const { return first[v + 1] - first[v]; }
    /// The home copy at position `state`; returns a private state unchanged.
    std::uint32_t copy_at(std::uint32_t v, std::uint32_t state) const {
        return wrap[v] != 0 && state == steps(v) ? 0 : state;
    }
};

/// Chooses the home copies of each vertex: those of its corners in triangles left of the ring, in the order of its fan.
/// The copy of each corner is below `copy_count` and belongs to one vertex. Cost: O(T), plus O(n log n) for a vertex
/// with n corners and several copies.
SeamHomes find_homes(std::span<const std::uint32_t> triangles, std::uint32_t vertices,
                     std::span<const std::uint32_t> copies, std::uint32_t copy_count, const VertexCorners& corners);

}  // namespace lacedring
