#pragma once
// Triangulates polygons: by the fan around the first corner if it covers the polygon, else by ear clipping. Internal to
// lrio; docs/formats-read.md specifies the triangles for other programs.

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <span>
#include <vector>

#include "lrio/mesh/blocker_tree.h"
#include "lrio/mesh/plane.h"
#include "lrio/mesh/read_formats.h"

namespace lacedring::detail {

/// Positions of vertices, 3 floats or 3 doubles each, at any alignment.
struct PositionView {
    const std::byte* data = nullptr;
    bool doubles = false;
};

/// Triangulates polygons. Reuses its memory for the next polygon.
class PolygonCutter {
  public:
    explicit PolygonCutter(PositionView positions) : positions_(positions) {}

    /// The n - 2 triangles of a polygon with n vertices: 3 polygon corners (0 to n - 1) each, valid until the next
    /// call. Empty: the fan (0, 1, 2), (0, 2, 3), ... is right. Any polygon is safe, even a self-intersecting one.
    /// Cost: usually O(n log n); a budget of O(n) steps limits it.
    std::span<const std::uint32_t> cut(std::span<const std::uint32_t> vertices);

    /// A quick test for the most common polygons: true if the fan of this quadrangle is right; false: call cut().
    bool is_plain_quad(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) const;

    /// Number of polygons whose budget ended before they were cut; the rest of each became a fan.
    std::uint64_t given_up() const { return given_up_; }

  private:
    enum Rule : std::size_t { strict_ear, flat, touched_ear, convex, rules };

    struct Corner {
        PlanePoint point;
        std::uint32_t previous, next;  // among the remaining corners
        std::uint32_t changes;         // counts changes of previous and next; UINT32_MAX: cut off
        std::uint32_t blocker;         // index in blockers_; UINT32_MAX: no blocker
    };
    /// A corner that a rule has to try. Short cuts come first. Cuts of similar length are in the polygon's order, which
    /// suits caches better than the exact order of lengths.
    struct Candidate {
        std::uint32_t length;  // floating-point exponent of the cut's squared length
        std::uint32_t corner;
        std::uint32_t changes;  // Corner::changes when it was entered; outdated if the corner's differs

        bool operator>(const Candidate& other) const {
            if (length != other.length) return length > other.length;
            return changes != other.changes ? changes < other.changes : corner > other.corner;
        }
    };
    using Heap = std::vector<Candidate>;

    bool project(std::span<const std::uint32_t> vertices);
    bool is_fan() const;
    void start_ring();
    void enter(std::uint32_t corner);
    bool find_ear(std::uint32_t& ear);
    bool is_ear(std::uint32_t corner, bool may_be_touched);
    template <class Test>
    bool is_any_in(const PlaneTriangle& triangle, const Test& test);
    bool blocks_at_tip(std::uint32_t blocker, std::uint32_t tip) const;
    void cut_off(std::uint32_t corner);
    void cut_rest();
    void emit(std::uint32_t a, std::uint32_t b, std::uint32_t c);

    PositionView positions_;
    std::uint64_t given_up_ = 0;
    std::vector<double> space_;       // x y z of each corner
    std::vector<PlanePoint> points_;  // counterclockwise
    std::vector<Corner> corners_;
    Heap candidates_[rules];
    std::uint32_t left_ = 0;  // number of remaining corners
    std::uint64_t steps_ = 0;
    std::uint64_t most_steps_ = 0;
    std::vector<Blocker> blockers_;
    BlockerTree trees_[2];
    bool two_trees_ = false;
    std::vector<std::uint32_t> triangles_;
};

/// Records where a file's polygons are in the triangle list. Readers append each polygon as a fan; when all positions
/// are known, cut() replaces the wrong fans in place.
class PolygonList {
  public:
    /// Adds the file's next face. A face of fewer than 3 corners has no triangles.
    void add(std::uint64_t corners) {
        if (corners == 3 && skipped_ != UINT32_MAX) {
            ++skipped_;
        } else {
            add_other(corners);
        }
    }
    /// Skips triangles that are not faces, such as those of strips.
    void skip(std::uint64_t triangles);

    /// Each list has 3 entries a triangle. The first list has vertex indices; the others are reordered in the same way;
    /// null lists are ignored. Reports faces without triangles and polygons that stayed fans. Cost: see PolygonCutter.
    void cut(PositionView positions, std::initializer_list<std::vector<std::uint32_t>*> lists, Reading& reading) const;

  private:
    struct Polygon {
        std::uint32_t skipped;  // triangles between the previous polygon and this one
        std::uint32_t corners;
    };

    void add_other(std::uint64_t corners);

    // Polygons of more than 3 corners, and fillers of 2 corners where `skipped` would overflow.
    std::vector<Polygon> polygons_;
    std::uint32_t skipped_ = 0;
    std::uint64_t short_faces_ = 0;
};

}  // namespace lacedring::detail
