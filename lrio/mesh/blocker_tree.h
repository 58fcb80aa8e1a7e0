#pragma once
// Finds the corners of a polygon that lie in a triangle. Internal to lrio.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "lrio/mesh/plane.h"

namespace lacedring::detail {

/// A polygon corner that may be inside an ear of the polygon.
struct Blocker {
    PlanePoint point;
    std::uint32_t corner = 0;
    bool removed = false;
};

/// A counterclockwise triangle with values that searches use.
struct PlaneTriangle {
    PlanePoint a, b, c;
    PlanePoint low, high;  ///< bounding box
    double slack;          ///< rounding error of its projections onto the axes of rotated boxes

    PlaneTriangle(const PlanePoint& first, const PlanePoint& second, const PlanePoint& third);
    /// Includes the boundary.
    bool contains(const PlanePoint& p) const {
        return orientation(a, b, p) >= 0 && orientation(b, c, p) >= 0 && orientation(c, a, p) >= 0;
    }
};

/// Blockers in a binary tree of boxes. The best order of the leaves depends on the polygon. Leaves of neighbors in
/// space have small boxes, but a long needle crosses O(sqrt B) of them. Leaves of neighbors in the polygon suit needles
/// and combs, but not spirals. So PolygonCutter searches a tree of each order at once, until one has the answer.
class BlockerTree {
  public:
    enum class Order { outline, space };

    /// Takes a copy of the blockers. Cost: O(B log B).
    void build(const std::vector<Blocker>& blockers, Order order);
    /// `blocker`: its index in build()'s argument. Cost: O(log B).
    void remove(std::uint32_t blocker);

    /// A search for blockers in a triangle, box by box.
    class Search {
      public:
        Search(const BlockerTree& tree, const PlaneTriangle& triangle)
            : tree_(tree), triangle_(triangle), stack_{{0, 0, tree.blockers_.size()}} {}

        bool is_done() const { return depth_ == 0; }
        /// Visits one box. True if test(blocker) holds for a blocker in the box and in the triangle. Adds the visited
        /// box and blockers to `steps`.
        template <class Test>
        bool finds(std::uint64_t& steps, const Test& test) {
            const auto [node, first, last] = stack_[--depth_];
            ++steps;
            if (!tree_.nodes_[node].may_meet(triangle_)) return false;
            if (2 * node + 2 < tree_.nodes_.size()) {
                const std::size_t middle = first + (last - first) / 2;
                stack_[depth_++] = {2 * node + 2, middle, last};
                stack_[depth_++] = {2 * node + 1, first, middle};
                return false;
            }
            for (std::size_t i = first; i < last; ++i) {
                const Blocker& blocker = tree_.blockers_[i];
                if (blocker.removed) continue;
                ++steps;
                if (triangle_.contains(blocker.point) && test(blocker)) return true;
            }
            return false;
        }

      private:
        struct Entry {
            std::size_t node, first, last;
        };
        const BlockerTree& tree_;
        const PlaneTriangle& triangle_;
        Entry stack_[64];
        std::size_t depth_ = 1;
    };

  private:
    struct Range {
        double low = 0, high = 0;
    };
    struct Node {
        PlanePoint low, high;     // the axis-aligned box
        PlanePoint direction;     // unit vector along the rotated box
        Range along, across;      // the rotated box: ranges along and across `direction`
        std::uint32_t count = 0;  // blockers that are not removed

        bool may_meet(const PlaneTriangle& triangle) const;
    };

    void build_node(std::size_t node, std::size_t first, std::size_t last, Order order);
    void turn_box(Node& node, std::size_t first, std::size_t last) const;

    std::vector<Blocker> blockers_;      // leaves are ranges of it
    std::vector<std::uint32_t> places_;  // index in blockers_ of each blocker of build()
    std::vector<Node> nodes_;            // the children of node i are 2i + 1 and 2i + 2
};

}  // namespace lacedring::detail
