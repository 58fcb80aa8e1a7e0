#pragma once
// What needs positions: vertex normals, and which side of a shell is outside.
// Rossignac's chapter, sections 6 and 12. Everything is computed in double precision.

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

#include "lrcore/base/ids.h"
#include "lrcore/topology/corner_table.h"

namespace lr {

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

}  // namespace lr
