#include "lrio/mesh/polygon.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <functional>

namespace lacedring::detail {
namespace {

constexpr std::uint32_t none = UINT32_MAX;
// Combs, stars, spirals and random walks of a million corners take 50 to 250 steps a corner, square spirals 480.
constexpr std::uint64_t kFreeSteps = 100'000, kStepsACorner = 1000;
constexpr std::size_t kOneTree = 64;  // up to this number of blockers, a single tree is searched

/// The index of a normal's largest component; the last one among equals.
std::size_t largest_of(const double (&size)[3]) {
    return size[2] >= size[0] && size[2] >= size[1] ? 2 : size[1] >= size[0] ? 1 : 0;
}

}  // namespace

bool PolygonCutter::is_plain_quad(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) const {
    if (positions_.doubles) return false;
    float p[4][3];
    const std::uint32_t vertices[4] = {a, b, c, d};
    for (std::size_t i = 0; i < 4; ++i) std::memcpy(p[i], positions_.data + std::size_t{vertices[i]} * 12, 12);
    double to[3][3];  // b, c and d
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t k = 0; k < 3; ++k) to[i][k] = double{p[i + 1][k]} - double{p[0][k]};
    }
    double first[3], second[3], size[3];  // area vectors of the fan's two triangles; size of their sum
    for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t u = (k + 1) % 3, v = (k + 2) % 3;
        first[k] = to[0][u] * to[1][v] - to[0][v] * to[1][u];
        second[k] = to[1][u] * to[2][v] - to[1][v] * to[2][u];
        size[k] = std::abs(first[k] + second[k]);
    }
    const std::size_t k = largest_of(size), u = (k + 1) % 3, v = (k + 2) % 3;
    const auto is_sure = [&](double area, std::size_t i) {
        return std::abs(area) >
               kSureOrientation * (std::abs(to[i][u] * to[i + 1][v]) + std::abs(to[i][v] * to[i + 1][u]));
    };
    return (first[k] > 0) == (second[k] > 0) && is_sure(first[k], 0) && is_sure(second[k], 1);
}

std::span<const std::uint32_t> PolygonCutter::cut(std::span<const std::uint32_t> vertices) {
    if (vertices.size() < 4 || !project(vertices) || is_fan()) return {};
    start_ring();
    for (std::uint32_t ear = 0; left_ > 3 && find_ear(ear);) cut_off(ear);
    if (steps_ > most_steps_) ++given_up_;
    cut_rest();
    return triangles_;
}

/// Projects the polygon onto a plane and fills points_. False if the polygon has no area, and so no plane.
bool PolygonCutter::project(std::span<const std::uint32_t> vertices) {
    const std::size_t n = vertices.size();
    space_.resize(3 * n);
    if (positions_.doubles) {
        double largest = 0;
        for (std::size_t i = 0; i < n; ++i) {
            std::memcpy(&space_[3 * i], positions_.data + std::size_t{vertices[i]} * 24, 24);
            for (std::size_t k = 0; k < 3; ++k) largest = std::max(largest, std::abs(space_[3 * i + k]));
        }
        // Scales the coordinates, and flushes tiny ones to 0, so that no product of two coordinates underflows.
        int exponent = 0;
        std::frexp(largest, &exponent);
        for (double& x : space_) {
            x = std::ldexp(x, 1 - exponent);
            if (std::abs(x) < 0x1p-400) x = 0;
        }
    } else {
        for (std::size_t i = 0; i < n; ++i) {
            float xyz[3];
            std::memcpy(xyz, positions_.data + std::size_t{vertices[i]} * 12, 12);
            for (std::size_t k = 0; k < 3; ++k) space_[3 * i + k] = double{xyz[k]};
        }
    }
    double normal[3] = {0, 0, 0};
    const double* origin = space_.data();
    double a[3] = {origin[3] - origin[0], origin[4] - origin[1], origin[5] - origin[2]};
    for (std::size_t i = 2; i < n; ++i) {
        const double* p = origin + 3 * i;
        const double b[3] = {p[0] - origin[0], p[1] - origin[1], p[2] - origin[2]};
        normal[0] += a[1] * b[2] - a[2] * b[1];
        normal[1] += a[2] * b[0] - a[0] * b[2];
        normal[2] += a[0] * b[1] - a[1] * b[0];
        std::copy_n(b, 3, a);
    }
    const double size[3] = {std::abs(normal[0]), std::abs(normal[1]), std::abs(normal[2])};
    const std::size_t dropped = largest_of(size);
    if (!(size[dropped] > 0)) return false;
    std::size_t u = (dropped + 1) % 3, v = (dropped + 2) % 3;
    if (normal[dropped] < 0) std::swap(u, v);
    points_.resize(n);
    for (std::size_t i = 0; i < n; ++i) points_[i] = {space_[3 * i + u], space_[3 * i + v]};
    return true;
}

bool PolygonCutter::is_fan() const {
    for (std::size_t i = 2; i < points_.size(); ++i) {
        if (orientation(points_[0], points_[i - 1], points_[i]) < 0) return false;
    }
    return true;
}

void PolygonCutter::start_ring() {
    const auto n = static_cast<std::uint32_t>(points_.size());
    left_ = n;
    corners_.resize(n);
    blockers_.clear();
    for (Heap& heap : candidates_) heap.clear();
    triangles_.clear();
    triangles_.reserve(3 * std::size_t{n - 2});
    for (std::uint32_t i = 0; i < n; ++i) {
        const std::uint32_t previous = i == 0 ? n - 1 : i - 1, next = i == n - 1 ? 0 : i + 1;
        corners_[i] = {points_[i], previous, next, 0, none};
        if (orientation(points_[previous], points_[i], points_[next]) > 0) continue;
        corners_[i].blocker = static_cast<std::uint32_t>(blockers_.size());
        blockers_.push_back({points_[i], i});
    }
    for (std::uint32_t i = 0; i < n; ++i) enter(i);
    trees_[0].build(blockers_, BlockerTree::Order::outline);
    two_trees_ = blockers_.size() > kOneTree;
    if (two_trees_) trees_[1].build(blockers_, BlockerTree::Order::space);
    steps_ = 0;
    most_steps_ = kFreeSteps + kStepsACorner * n;
}

/// Makes the corner a candidate for the first rule that may accept it.
void PolygonCutter::enter(std::uint32_t corner) {
    const Corner& own = corners_[corner];
    const PlanePoint &a = corners_[own.previous].point, &c = corners_[own.next].point;
    const int turn = orientation(a, own.point, c);
    if (turn < 0) return;
    const double u = c.u - a.u, v = c.v - a.v;
    Heap& heap = candidates_[turn == 0 ? flat : strict_ear];
    const auto exponent = static_cast<std::uint32_t>(std::bit_cast<std::uint64_t>(u * u + v * v) >> 52U);
    heap.push_back({exponent, corner, own.changes});
    std::push_heap(heap.begin(), heap.end(), std::greater<>());
}

/// Finds the corner to cut off next. A rule is used only if the earlier rules refuse all corners, and a corner is tried
/// again only after a neighbor of it has changed; so each rule tries O(n) corners.
bool PolygonCutter::find_ear(std::uint32_t& ear) {
    for (std::size_t rule = 0; rule < rules; ++rule) {
        Heap& heap = candidates_[rule];
        while (!heap.empty()) {
            std::pop_heap(heap.begin(), heap.end(), std::greater<>());
            const Candidate candidate = heap.back();
            heap.pop_back();
            ear = candidate.corner;
            if (corners_[ear].changes != candidate.changes) continue;
            if (rule == flat || rule == convex) return true;
            const bool accepted = is_ear(ear, rule == touched_ear);
            if (steps_ > most_steps_) return false;
            if (accepted) return true;
            Heap& later = candidates_[rule == strict_ear ? touched_ear : convex];
            later.push_back(candidate);
            std::push_heap(later.begin(), later.end(), std::greater<>());
        }
    }
    return false;
}

/// Has the convex corner's triangle no blocker? `may_be_touched`: blockers on its boundary are allowed.
bool PolygonCutter::is_ear(std::uint32_t corner, bool may_be_touched) {
    const Corner& own = corners_[corner];
    const PlaneTriangle triangle(corners_[own.previous].point, own.point, corners_[own.next].point);
    const PlanePoint &a = triangle.a, &b = triangle.b, &c = triangle.c;
    return !is_any_in(triangle, [&](const Blocker& blocker) {
        const PlanePoint& p = blocker.point;
        if (may_be_touched) return orientation(a, b, p) > 0 && orientation(b, c, p) > 0 && orientation(c, a, p) > 0;
        if (p == b) return blocks_at_tip(blocker.corner, corner);
        return p != a && p != c;  // a bridge to a hole passes the same point twice: not an obstacle
    });
}

template <class Test>
bool PolygonCutter::is_any_in(const PlaneTriangle& triangle, const Test& test) {
    BlockerTree::Search first(trees_[0], triangle);
    if (!two_trees_) {
        while (!first.is_done()) {
            if (first.finds(steps_, test)) return true;
        }
        return false;
    }
    BlockerTree::Search second(trees_[1], triangle);
    while (true) {
        if (first.finds(steps_, test) || second.finds(steps_, test)) return true;
        if (first.is_done() || second.is_done()) return false;
    }
}

/// Does an edge of `blocker`, a corner at the same point as the tip, lead into the ear?
bool PolygonCutter::blocks_at_tip(std::uint32_t blocker, std::uint32_t tip) const {
    const PlanePoint &a = corners_[corners_[tip].previous].point, &b = corners_[tip].point,
                     &c = corners_[corners_[tip].next].point;
    for (const std::uint32_t end : {corners_[blocker].previous, corners_[blocker].next}) {
        const PlanePoint& p = corners_[end].point;
        if (orientation(a, b, p) > 0 && orientation(b, c, p) > 0) return true;
    }
    return false;
}

void PolygonCutter::cut_off(std::uint32_t corner) {
    Corner& own = corners_[corner];
    emit(own.previous, corner, own.next);
    corners_[own.previous].next = own.next;
    corners_[own.next].previous = own.previous;
    own.changes = none;
    if (own.blocker != none) {
        trees_[0].remove(own.blocker);
        if (two_trees_) trees_[1].remove(own.blocker);
    }
    --left_;
    for (const std::uint32_t neighbor : {own.previous, own.next}) {
        ++corners_[neighbor].changes;
        enter(neighbor);
    }
}

void PolygonCutter::cut_rest() {
    std::uint32_t first = 0;
    while (corners_[first].changes == none) ++first;
    for (std::uint32_t i = corners_[first].next; corners_[i].next != first; i = corners_[i].next) {
        emit(first, i, corners_[i].next);
    }
}

/// Appends a triangle, rotated so that its lowest corner comes first.
void PolygonCutter::emit(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    if (b < a) {
        triangles_.insert(triangles_.end(), {b, c, a});
    } else if (c < b) {
        triangles_.insert(triangles_.end(), {c, a, b});
    } else {
        triangles_.insert(triangles_.end(), {a, b, c});
    }
}

void PolygonList::add_other(std::uint64_t corners) {
    if (corners < 3) {
        ++short_faces_;
    } else if (corners == 3 || corners > std::uint64_t{none} / 3) {
        skip(corners - 2);  // a polygon with more corners than can be counted (gigabytes) stays a fan
    } else {
        polygons_.push_back({skipped_, static_cast<std::uint32_t>(corners)});
        skipped_ = 0;
    }
}

void PolygonList::skip(std::uint64_t triangles) {
    for (; triangles > none - skipped_; triangles -= none - skipped_, skipped_ = 0) polygons_.push_back({none, 2});
    skipped_ += static_cast<std::uint32_t>(triangles);
}

void PolygonList::cut(PositionView positions, std::initializer_list<std::vector<std::uint32_t>*> lists,
                      Reading& reading) const {
    PolygonCutter cutter(positions);
    std::vector<std::uint32_t> corners;
    std::size_t at = 0;
    for (const Polygon& polygon : polygons_) {
        at += 3 * std::size_t{polygon.skipped};
        const std::size_t n = polygon.corners;
        if (n == 4) {
            const std::vector<std::uint32_t>& list = **lists.begin();
            if (cutter.is_plain_quad(list[at], list[at + 1], list[at + 2], list[at + 5])) {
                at += 6;
                continue;
            }
        }
        corners.resize(n);
        const auto unfan = [&](const std::vector<std::uint32_t>& list) {
            if (n > 2) std::copy_n(list.begin() + static_cast<std::ptrdiff_t>(at), 2, corners.begin());
            for (std::size_t i = 2; i < n; ++i) corners[i] = list[at + 3 * (i - 2) + 2];
        };
        unfan(**lists.begin());
        const std::span<const std::uint32_t> triangles = cutter.cut(corners);
        for (std::vector<std::uint32_t>* list : lists) {
            if (list == nullptr || triangles.empty()) continue;
            unfan(*list);
            for (std::size_t i = 0; i < triangles.size(); ++i) (*list)[at + i] = corners[triangles[i]];
        }
        at += 3 * (n - 2);
    }
    reading.leave_out(short_faces_, "face with fewer than 3 corners", "faces with fewer than 3 corners");
    reading.leave_out(cutter.given_up(), "polygon's shape (too intricate: cut as a fan)",
                      "polygons' shapes (too intricate: cut as fans)");
}

}  // namespace lacedring::detail
