#include "lrio/mesh/blocker_tree.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace lacedring::detail {
namespace {

constexpr std::size_t kLeafBlockers = 8;
// A bound of the rounding error of projections, relative to size_of(p); 3.4e-16 would suffice. Rotated boxes are
// enlarged by it, so that rounding never changes an answer.
constexpr double kRounding = 1e-15;

double size_of(const PlanePoint& p) {
    return std::abs(p.u) + std::abs(p.v);
}
double project_along(const PlanePoint& p, const PlanePoint& direction) {
    return p.u * direction.u + p.v * direction.v;
}
double project_across(const PlanePoint& p, const PlanePoint& direction) {
    return p.v * direction.u - p.u * direction.v;
}

}  // namespace

PlaneTriangle::PlaneTriangle(const PlanePoint& first, const PlanePoint& second, const PlanePoint& third)
    : a(first),
      b(second),
      c(third),
      low{std::min({a.u, b.u, c.u}), std::min({a.v, b.v, c.v})},
      high{std::max({a.u, b.u, c.u}), std::max({a.v, b.v, c.v})},
      slack(kRounding * std::max({size_of(a), size_of(b), size_of(c)})) {}

void BlockerTree::build(const std::vector<Blocker>& blockers, Order order) {
    blockers_ = blockers;
    places_.resize(blockers.size());
    // While the tree is built, `corner` holds the index of the blocker.
    for (std::uint32_t i = 0; i < blockers.size(); ++i) blockers_[i].corner = i;
    std::size_t leaves = 1;
    while (leaves * kLeafBlockers < blockers_.size()) leaves *= 2;
    nodes_.assign(2 * leaves - 1, {});
    build_node(0, 0, blockers_.size(), order);
    for (std::uint32_t i = 0; i < blockers.size(); ++i) {
        places_[blockers_[i].corner] = i;
        blockers_[i].corner = blockers[blockers_[i].corner].corner;
    }
}

void BlockerTree::build_node(std::size_t node, std::size_t first, std::size_t last, Order order) {
    Node& own = nodes_[node];
    own.count = static_cast<std::uint32_t>(last - first);
    if (first == last) return;
    own.low = own.high = blockers_[first].point;
    for (std::size_t i = first + 1; i < last; ++i) {
        const PlanePoint& p = blockers_[i].point;
        own.low = {std::min(own.low.u, p.u), std::min(own.low.v, p.v)};
        own.high = {std::max(own.high.u, p.u), std::max(own.high.v, p.v)};
    }
    turn_box(own, first, last);
    if (2 * node + 2 >= nodes_.size()) return;
    const std::size_t middle = first + (last - first) / 2;
    if (order == Order::space) {
        const bool by_u = own.high.u - own.low.u > own.high.v - own.low.v;
        const auto at = [this](std::size_t i) { return blockers_.begin() + static_cast<std::ptrdiff_t>(i); };
        std::nth_element(at(first), at(middle), at(last), [by_u](const Blocker& x, const Blocker& y) {
            return by_u ? x.point.u < y.point.u : x.point.v < y.point.v;
        });
    }
    build_node(2 * node + 1, first, middle, order);
    build_node(2 * node + 2, middle, last, order);
}

/// Computes a second box along the principal axis of the blockers: it is small for needles and slanted walls.
void BlockerTree::turn_box(Node& node, std::size_t first, std::size_t last) const {
    const PlanePoint origin = blockers_[first].point;
    double size = 0, u_sum = 0, v_sum = 0, uu = 0, uv = 0, vv = 0;
    for (std::size_t i = first; i < last; ++i) {
        const PlanePoint& p = blockers_[i].point;
        size = std::max(size, size_of(p));
        const double u = p.u - origin.u, v = p.v - origin.v;
        u_sum += u, v_sum += v, uu += u * u, uv += u * v, vv += v * v;
    }
    const double count = node.count;
    uu -= u_sum * u_sum / count, uv -= u_sum * v_sum / count, vv -= v_sum * v_sum / count;
    const double angle = std::atan2(2 * uv, uu - vv) / 2;
    node.direction = {std::cos(angle), std::sin(angle)};
    node.along.low = node.along.high = project_along(origin, node.direction);
    node.across.low = node.across.high = project_across(origin, node.direction);
    for (std::size_t i = first + 1; i < last; ++i) {
        const double x = project_along(blockers_[i].point, node.direction);
        const double y = project_across(blockers_[i].point, node.direction);
        node.along = {std::min(node.along.low, x), std::max(node.along.high, x)};
        node.across = {std::min(node.across.low, y), std::max(node.across.high, y)};
    }
    for (Range* range : {&node.along, &node.across}) range->low -= kRounding * size, range->high += kRounding * size;
}

void BlockerTree::remove(std::uint32_t blocker) {
    const std::size_t place = places_[blocker];
    blockers_[place].removed = true;
    std::size_t first = 0, last = blockers_.size();
    for (std::size_t node = 0; node < nodes_.size();) {
        --nodes_[node].count;
        const std::size_t middle = first + (last - first) / 2;
        const bool right = place >= middle;
        (right ? first : last) = middle;
        node = 2 * node + (right ? 2 : 1);
    }
}

/// False only if no blocker can be in the triangle.
bool BlockerTree::Node::may_meet(const PlaneTriangle& t) const {
    if (count == 0 || low.u > t.high.u || high.u < t.low.u || low.v > t.high.v || high.v < t.low.v) return false;
    const auto apart = [&t](double x, double y, double z, const Range& range) {
        return std::max({x, y, z}) + t.slack < range.low || std::min({x, y, z}) - t.slack > range.high;
    };
    if (apart(project_along(t.a, direction), project_along(t.b, direction), project_along(t.c, direction), along) ||
        apart(project_across(t.a, direction), project_across(t.b, direction), project_across(t.c, direction), across)) {
        return false;
    }
    // The box is outside an edge if its corner farthest to the inner side is.
    const auto is_outside = [this](const PlanePoint& p, const PlanePoint& q) {
        const PlanePoint inmost{q.v > p.v ? low.u : high.u, q.u > p.u ? high.v : low.v};
        return orientation(p, q, inmost) < 0;
    };
    return !is_outside(t.a, t.b) && !is_outside(t.b, t.c) && !is_outside(t.c, t.a);
}

}  // namespace lacedring::detail
