#pragma once
// Polygons to triangles: the fan around the first corner where it is right, else ears are cut off. Internal to
// lrio; docs/formats-read.md describes the same triangles for other programs.

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

/// Cuts polygons into triangles. Its memory is reused from polygon to polygon.
class PolygonCutter {
  public:
    explicit PolygonCutter(PositionView positions) : positions_(positions) {}

    /// The triangles of a polygon with these vertices: 3 numbers of its corners each, one triangle less than two for
    /// each corner, valid until the next call. Empty: the fan (0, 1, 2), (0, 2, 3), ... is right. Any polygon is safe,
    /// one that crosses itself, too. Cost: O(n log n) as a rule, and at most what a budget of O(n) steps allows.
    std::span<const std::uint32_t> cut(std::span<const std::uint32_t> vertices);

    /// Is this quadrangle's fan right for sure? If not, cut() tells. Most polygons are such, so this is quick.
    bool is_plain_quad(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) const;

    /// Polygons whose budget ended before they were cut. What was left of each is a fan.
    std::uint64_t given_up() const { return given_up_; }

  private:
    enum Rule : std::size_t { strict_ear, flat, touched_ear, convex, rules };

    struct Corner {
        PlanePoint point;
        std::uint32_t previous, next;  // of those that are left
        std::uint32_t changes;         // of these two, UINT32_MAX once the corner is cut off
        std::uint32_t blocker;         // its number, UINT32_MAX: it is none
    };
    /// A corner that a rule has to try: those with short cuts come first, those of about the same length in the order
    /// of the polygon, which is kinder to caches than their exact order.
    struct Candidate {
        std::uint32_t length;  // the exponent of the cut's length, squared
        std::uint32_t corner;
        std::uint32_t changes;  // of the corner; it counts only while this is right

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
    std::uint32_t left_ = 0;  // corners
    std::uint64_t steps_ = 0;
    std::uint64_t most_steps_ = 0;
    std::vector<Blocker> blockers_;
    BlockerTree trees_[2];
    bool two_trees_ = false;
    std::vector<std::uint32_t> triangles_;
};

/// The polygons of a file among its triangles. A reader appends each as a fan; once all positions are known, the fans
/// that are wrong are replaced, in place.
class PolygonList {
  public:
    /// The next face of the file has so many corners; below 3 it has no triangles.
    void add(std::uint64_t corners) {
        if (corners == 3 && skipped_ != UINT32_MAX) {
            ++skipped_;
        } else {
            add_other(corners);
        }
    }
    /// So many triangles follow that are no faces.
    void skip(std::uint64_t triangles);

    /// `lists`: 3 entries a triangle each, the first one vertices, of which all others are reordered in the same way;
    /// null ones are passed over. Tells what has no triangles or not the right ones. Cost: see PolygonCutter.
    void cut(PositionView positions, std::initializer_list<std::vector<std::uint32_t>*> lists, Reading& reading) const;

  private:
    struct Polygon {
        std::uint32_t skipped;  // triangles between the polygon before and this one
        std::uint32_t corners;
    };

    void add_other(std::uint64_t corners);

    std::vector<Polygon> polygons_;  // of more than 3 corners
    std::uint32_t skipped_ = 0;
    std::uint64_t short_faces_ = 0;
};

}  // namespace lacedring::detail
