// Cutting polygons into triangles: convex polygons become fans, simple ones are covered exactly, others keep every
// corner.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <map>
#include <numeric>
#include <random>
#include <vector>

#include "lrio/mesh/polygon.h"

using namespace lacedring;
using namespace lacedring::detail;

namespace {

/// Coordinates are integers, so that areas are exact.
struct GridPoint {
    std::int64_t x = 0, y = 0;
    bool operator==(const GridPoint&) const = default;
};
using Polygon = std::vector<GridPoint>;
using Triangles = std::vector<std::uint32_t>;

std::int64_t pick(std::mt19937& random, std::uint32_t below) {
    return static_cast<std::int64_t>(random() % below);
}

std::int64_t twice_area(const GridPoint& a, const GridPoint& b, const GridPoint& c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

std::int64_t twice_area(const Polygon& polygon) {
    std::int64_t area = 0;
    for (std::size_t i = 2; i < polygon.size(); ++i) area += twice_area(polygon[0], polygon[i - 1], polygon[i]);
    return area;
}

int turn(const GridPoint& a, const GridPoint& b, const GridPoint& c) {
    const std::int64_t area = twice_area(a, b, c);
    return area > 0 ? 1 : area < 0 ? -1 : 0;
}

bool is_on(const GridPoint& p, const GridPoint& a, const GridPoint& b) {
    return turn(a, b, p) == 0 && p.x >= std::min(a.x, b.x) && p.x <= std::max(a.x, b.x) && p.y >= std::min(a.y, b.y) &&
           p.y <= std::max(a.y, b.y);
}

bool segments_meet(const GridPoint& a, const GridPoint& b, const GridPoint& c, const GridPoint& d) {
    if (is_on(a, c, d) || is_on(b, c, d) || is_on(c, a, b) || is_on(d, a, b)) return true;
    return turn(a, b, c) * turn(a, b, d) < 0 && turn(c, d, a) * turn(c, d, b) < 0;
}

/// Returns whether no two edges meet except at their shared corner. Tries all pairs.
bool is_simple(const Polygon& p) {
    const std::size_t n = p.size();
    for (std::size_t i = 0; i < n; ++i) {
        const GridPoint &a = p[i], &b = p[(i + 1) % n], &c = p[(i + 2) % n];
        if (a == b || is_on(c, a, b) || is_on(a, b, c)) return false;
        for (std::size_t j = i + 2; j < n; ++j) {
            if ((j + 1) % n != i && segments_meet(a, b, p[j], p[(j + 1) % n])) return false;
        }
    }
    return true;
}

std::vector<std::uint32_t> numbers(std::size_t n) {
    std::vector<std::uint32_t> out(n);
    std::iota(out.begin(), out.end(), 0U);
    return out;
}

template <class Real>
Triangles cut_space(const std::vector<Real>& xyz, std::uint64_t* given_up = nullptr) {
    PolygonCutter cutter({std::as_bytes(std::span(xyz)).data(), sizeof(Real) == 8});
    const auto corners = numbers(xyz.size() / 3);
    const auto triangles = cutter.cut(corners);
    if (given_up != nullptr) *given_up = cutter.given_up();
    if (!triangles.empty()) return {triangles.begin(), triangles.end()};
    Triangles fan;
    for (std::uint32_t i = 2; i < corners.size(); ++i) fan.insert(fan.end(), {0, i - 1, i});
    return fan;
}

template <class Real = float>
Triangles cut(const Polygon& polygon, Real scale = 1) {
    std::vector<Real> xyz;
    for (const GridPoint& p : polygon) {
        xyz.insert(xyz.end(), {static_cast<Real>(p.x) * scale, static_cast<Real>(p.y) * scale, Real{0}});
    }
    return cut_space(xyz);
}

/// Returns whether the n - 2 triangles are a disc whose border is the polygon's edges.
bool is_disc(const Triangles& triangles, std::size_t n) {
    if (triangles.size() != 3 * (n - 2)) return false;
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
    for (std::size_t t = 0; t < triangles.size(); t += 3) {
        if (!(triangles[t] < triangles[t + 1] && triangles[t + 1] < triangles[t + 2])) return false;
        for (std::size_t i = 0; i < 3; ++i) ++edges[{triangles[t + i], triangles[t + (i + 1) % 3]}];
    }
    for (std::uint32_t i = 0; i < n; ++i) {
        if (--edges[{i, static_cast<std::uint32_t>((i + 1) % n)}] != 0) return false;
    }
    return std::all_of(edges.begin(), edges.end(), [&](const auto& edge) {
        const auto other = edges.find({edge.first.second, edge.first.first});
        return edge.second == 0 || (edge.second == 1 && other != edges.end() && other->second == 1);
    });
}

/// Returns whether all triangles have the polygon's orientation and their areas sum up to its area, so that they cover
/// it exactly. Counts triangles without area in `flat`.
bool covers(const Triangles& triangles, const Polygon& polygon, std::size_t& flat) {
    std::int64_t area = 0;
    const std::int64_t whole = twice_area(polygon);
    flat = 0;
    for (std::size_t t = 0; t < triangles.size(); t += 3) {
        const std::int64_t own =
            twice_area(polygon[triangles[t]], polygon[triangles[t + 1]], polygon[triangles[t + 2]]);
        if (own != 0 && (own > 0) != (whole > 0)) return false;
        flat += own == 0 ? 1 : 0;
        area += own;
    }
    return area == whole;
}

bool covers(const Triangles& triangles, const Polygon& polygon) {
    std::size_t flat = 0;
    return covers(triangles, polygon, flat);
}

bool is_fan(const Triangles& triangles) {
    for (std::uint32_t i = 2; 3 * (i - 2) < triangles.size(); ++i) {
        const std::size_t t = 3 * (i - 2);
        if (triangles[t] != 0 || triangles[t + 1] != i - 1 || triangles[t + 2] != i) return false;
    }
    return true;
}

/// A simple polygon of random corners, made by untangling edges that cross.
Polygon random_simple(std::mt19937& random, std::size_t n, std::int64_t size) {
    while (true) {
        Polygon p;
        while (p.size() < n) {
            const GridPoint q{static_cast<std::int64_t>(random() % static_cast<std::uint64_t>(size)),
                              static_cast<std::int64_t>(random() % static_cast<std::uint64_t>(size))};
            if (std::find(p.begin(), p.end(), q) == p.end()) p.push_back(q);
        }
        bool crossed = true;
        for (int round = 0; crossed && round < 200; ++round) {
            crossed = false;
            for (std::size_t i = 0; i + 2 < n; ++i) {
                for (std::size_t j = i + 2; j < n; ++j) {
                    if (i == 0 && j == n - 1) continue;
                    if (!segments_meet(p[i], p[i + 1], p[j], p[(j + 1) % n])) continue;
                    std::reverse(p.begin() + static_cast<std::ptrdiff_t>(i) + 1,
                                 p.begin() + static_cast<std::ptrdiff_t>(j) + 1);
                    crossed = true;
                }
            }
        }
        if (is_simple(p)) return p;
    }
}

/// Rows of unit squares, of random lengths on both sides of a line, which have right angles and flat corners.
Polygon random_steps(std::mt19937& random, std::size_t rows) {
    Polygon right, left;
    for (std::size_t row = 0; row < rows; ++row) {
        const auto y = static_cast<std::int64_t>(row);
        for (const std::int64_t at : {y, y + 1}) right.push_back({1 + static_cast<std::int64_t>(random() % 5), at});
        right.back().x = right[right.size() - 2].x;
        for (const std::int64_t at : {y, y + 1}) left.push_back({-1 - static_cast<std::int64_t>(random() % 5), at});
        left.back().x = left[left.size() - 2].x;
    }
    Polygon out = right;
    out.insert(out.end(), left.rbegin(), left.rend());
    const auto same = std::unique(out.begin(), out.end());
    out.erase(same, out.end());
    return out;
}

/// Adds holes to a polygon, each in one of its triangles and joined to a corner by a bridge, an edge that is walked in
/// both directions.
Polygon with_holes(std::mt19937& random, Polygon p, std::int64_t& hole_area) {
    for (GridPoint& q : p) q = {q.x * 64, q.y * 64};
    if (twice_area(p) < 0) std::reverse(p.begin(), p.end());
    const Triangles triangles = cut(p);
    hole_area = 0;
    struct Hole {
        double angle;  // of the bridge, clockwise from the corner's preceding edge
        Polygon corners;
    };
    std::vector<std::vector<Hole>> at(p.size());
    for (std::size_t t = 0; t < triangles.size(); t += 3) {
        if (random() % 2 == 0) continue;
        const std::size_t first = random() % 3;
        const std::uint32_t corner = triangles[t + first];
        const GridPoint a = p[corner], b = p[triangles[t + (first + 1) % 3]], c = p[triangles[t + (first + 2) % 3]];
        // u + v + w is 64.
        const auto inner = [&](std::int64_t u, std::int64_t v, std::int64_t w) {
            return GridPoint{(u * a.x + v * b.x + w * c.x) / 64, (u * a.y + v * b.y + w * c.y) / 64};
        };
        const GridPoint h[3] = {inner(44, 10, 10), inner(10, 10, 44), inner(10, 44, 10)};
        const GridPoint before = p[(corner + p.size() - 1) % p.size()];
        const auto angle_of = [&](const GridPoint& q) { return std::atan2(double(q.y - a.y), double(q.x - a.x)); };
        double angle = angle_of(before) - angle_of(h[0]);
        if (angle < 0) angle += 6.283185307179586;
        at[corner].push_back({angle, {h[0], h[1], h[2], h[0], a}});
        hole_area -= twice_area(h[0], h[1], h[2]);
    }
    Polygon out;
    for (std::size_t i = 0; i < p.size(); ++i) {
        out.push_back(p[i]);
        std::sort(at[i].begin(), at[i].end(), [](const Hole& x, const Hole& y) { return x.angle < y.angle; });
        for (const Hole& hole : at[i]) out.insert(out.end(), hole.corners.begin(), hole.corners.end());
    }
    return out;
}

Polygon rotated(const Polygon& polygon, std::size_t by) {
    Polygon out = polygon;
    std::rotate(out.begin(), out.begin() + static_cast<std::ptrdiff_t>(by), out.end());
    return out;
}

Polygon comb(std::int64_t teeth) {
    Polygon out{{2 * teeth, -1}, {0, -1}};
    for (std::int64_t i = 0; i < teeth; ++i) out.insert(out.end(), {{2 * i, 0}, {2 * i + 1, 1000}});
    std::reverse(out.begin(), out.end());
    return out;
}

/// A corridor that spirals inwards.
Polygon spiral(std::size_t turns, std::size_t corners_a_turn) {
    Polygon outer, inner;
    for (std::size_t i = 0; i <= turns * corners_a_turn; ++i) {
        const double turned = static_cast<double>(i) / static_cast<double>(corners_a_turn);
        const double x = std::cos(6.283185307179586 * turned), y = std::sin(6.283185307179586 * turned);
        const double radius = 1000 * (static_cast<double>(turns) + 1 - turned);
        outer.push_back({std::llround(radius * x), std::llround(radius * y)});
        inner.push_back({std::llround((radius - 500) * x), std::llround((radius - 500) * y)});
    }
    outer.insert(outer.end(), inner.rbegin(), inner.rend());
    return outer;
}

/// Spikes of random lengths around a point.
Polygon star(std::mt19937& random, std::size_t needles) {
    Polygon out;
    for (std::size_t i = 0; i < 2 * needles; ++i) {
        const double angle = 3.141592653589793 * static_cast<double>(i) / static_cast<double>(needles);
        const double radius = i % 2 == 0 ? 100'000 : 200'000 + static_cast<double>(random() % 6'000'000);
        out.push_back({std::llround(radius * std::cos(angle)), std::llround(radius * std::sin(angle))});
    }
    return out;
}

/// Checks that a simple polygon and its mirror image, started at every corner, are covered exactly, and that triangles
/// without area occur in fans only.
void check_simple(const Polygon& polygon) {
    for (std::size_t by = 0; by < polygon.size(); ++by) {
        Polygon p = rotated(polygon, by);
        for (int mirrored = 0; mirrored < 2; ++mirrored, std::reverse(p.begin(), p.end())) {
            CAPTURE(by);
            CAPTURE(mirrored);
            const Triangles triangles = cut(p);
            REQUIRE_MESSAGE(is_disc(triangles, p.size()), "the triangles are a disc with the polygon's edges");
            std::size_t flat = 0;
            REQUIRE_MESSAGE(covers(triangles, p, flat), "the triangles cover the polygon exactly");
            REQUIRE_MESSAGE((flat == 0 || is_fan(triangles)), "triangles without area occur in fans only");
        }
    }
}

double seconds_of(const Polygon& polygon, std::uint64_t& given_up) {
    std::vector<double> xyz;
    for (const GridPoint& p : polygon) {
        xyz.insert(xyz.end(), {static_cast<double>(p.x), static_cast<double>(p.y), 0.0});
    }
    const auto start = std::chrono::steady_clock::now();
    const Triangles triangles = cut_space(xyz, &given_up);
    const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - start;
    CHECK(triangles.size() == 3 * (polygon.size() - 2));
    return passed.count();
}

}  // namespace

TEST_CASE("orientations are exact") {
    const std::uint32_t seed = 17;
    CAPTURE(seed);
    std::mt19937 random(seed);
    for (int round = 0; round < 200000; ++round) {
        // b and c are on a line through a, except that b is moved by at most one unit.
        const std::int64_t au = pick(random, 1U << 31U), av = pick(random, 1U << 31U);
        const std::int64_t du = pick(random, 1 << 20) - (1 << 19), dv = pick(random, 1 << 20) - (1 << 19);
        const std::int64_t i = pick(random, 64), j = pick(random, 64) << pick(random, 20), moved = pick(random, 3) - 1;
        const std::int64_t bu = au + i * du + moved, bv = av + i * dv, cu = au + j * du, cv = av + j * dv;
        const std::int64_t area = moved * j * dv;
        const int expected = area > 0 ? 1 : area < 0 ? -1 : 0;
        const double scale = std::ldexp(1.0, static_cast<int>(random() % 300) - 150);
        const auto point = [scale](std::int64_t u, std::int64_t v) {
            return PlanePoint{static_cast<double>(u) * scale, static_cast<double>(v) * scale};
        };
        REQUIRE(orientation(point(au, av), point(bu, bv), point(cu, cv)) == expected);
    }
    // Even the differences of these coordinates are rounded.
    CHECK(orientation({1e30, 1e30}, {0, 0}, {1e-30, 1e-30}) == 0);
    CHECK(orientation({1e30, 1e30}, {0, 0}, {1e-30, 2e-30}) < 0);
    CHECK(orientation({1e30, 1e30}, {0, 0}, {2e-30, 1e-30}) > 0);
}

TEST_CASE("a quad that is not convex is cut at its reflex corner") {
    const Polygon dart{{0, 0}, {4, 4}, {0, 8}, {1, 4}};
    CHECK(cut(dart) == Triangles{0, 1, 3, 1, 2, 3});
    CHECK(cut(rotated(dart, 1)) == Triangles{0, 1, 2, 0, 2, 3});
    CHECK(cut(rotated(dart, 2)) == Triangles{0, 1, 3, 1, 2, 3});
    CHECK(cut(rotated(dart, 3)) == Triangles{0, 1, 2, 0, 2, 3});
    for (std::size_t by = 0; by < 4; ++by) check_simple(rotated(dart, by));
}

TEST_CASE("a convex quad is a fan, and one that crosses itself keeps its corners") {
    const Polygon square{{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    const Polygon bow{{0, 0}, {2, 2}, {2, 0}, {0, 1}};
    for (std::size_t by = 0; by < 4; ++by) {
        CHECK(is_fan(cut(rotated(square, by))));
        CHECK(is_disc(cut(rotated(bow, by)), 4));
    }
}

TEST_CASE("a quad with flat or repeated corners, or without area, is a fan") {
    CHECK(is_fan(cut({{0, 0}, {1, 0}, {2, 0}, {1, 1}})));
    CHECK(is_fan(cut({{0, 0}, {1, 0}, {1, 0}, {1, 1}})));
    CHECK(is_fan(cut({{0, 0}, {1, 0}, {2, 0}, {3, 0}})));
    CHECK(is_fan(cut({{5, 5}, {5, 5}, {5, 5}, {5, 5}})));
    CHECK(cut({{0, 0}, {1, 0}, {0, 1}}) == Triangles{0, 1, 2});
}

TEST_CASE("a pentagon with one reflex corner is covered exactly") {
    const Polygon polygon{{0, 0}, {4, 0}, {4, 4}, {2, 1}, {0, 4}};
    check_simple(polygon);
    CHECK(twice_area(polygon) == 20);
}

TEST_CASE("random simple polygons are covered exactly, from every starting corner") {
    for (std::uint32_t seed = 1; seed <= 300; ++seed) {
        CAPTURE(seed);
        std::mt19937 random(seed);
        // On a small grid many corners are flat.
        check_simple(random_simple(random, 4 + random() % 30, std::int64_t{1} << (4 + random() % 16)));
    }
}

TEST_CASE("combs, spirals, stars and steps are covered exactly, from every starting corner") {
    for (std::uint32_t seed = 1; seed <= 30; ++seed) {
        CAPTURE(seed);
        std::mt19937 random(seed);
        for (const Polygon& polygon : {comb(2 + random() % 8), spiral(1 + random() % 4, 5 + random() % 9),
                                       star(random, 3 + random() % 12), random_steps(random, 2 + random() % 12)}) {
            if (is_simple(polygon)) check_simple(polygon);
        }
    }
}

TEST_CASE("polygons with holes, joined to the outline by bridges, are covered exactly") {
    for (std::uint32_t seed = 1; seed <= 300; ++seed) {
        CAPTURE(seed);
        std::mt19937 random(seed);
        std::int64_t holes = 0;
        const Polygon outline = random_simple(random, 4 + random() % 12, 1 << (4 + random() % 10));
        Polygon polygon = with_holes(random, outline, holes);
        REQUIRE(twice_area(polygon) == 4096 * std::abs(twice_area(outline)) - holes);
        for (std::size_t by = 0; by < polygon.size(); ++by) {
            CAPTURE(by);
            const Polygon p = rotated(polygon, by);
            const Triangles triangles = cut(p);
            REQUIRE(is_disc(triangles, p.size()));
            REQUIRE(covers(triangles, p));
        }
    }
}

TEST_CASE("polygons with repeated corners and needles of no width are covered exactly") {
    for (std::uint32_t seed = 1; seed <= 200; ++seed) {
        CAPTURE(seed);
        std::mt19937 random(seed);
        Polygon polygon;
        for (const GridPoint& p : random_simple(random, 4 + random() % 12, 1 << (4 + random() % 10))) {
            const GridPoint q{p.x * 8, p.y * 8};
            const std::size_t kind = random() % 6;
            for (std::size_t i = 0; i < (kind == 0 ? 3 : kind == 1 ? 2 : 1); ++i) polygon.push_back(q);
        }
        // A needle is walked to and back along an edge.
        const std::size_t at = random() % (polygon.size() - 1);
        const GridPoint a = polygon[at], b = polygon[at + 1];
        const auto between = [&](std::int64_t i) {
            return GridPoint{a.x + (b.x - a.x) / 8 * i, a.y + (b.y - a.y) / 8 * i};
        };
        const GridPoint extra[] = {between(6), between(2)};
        polygon.insert(polygon.begin() + static_cast<std::ptrdiff_t>(at) + 1, extra, extra + 2);
        for (std::size_t by = 0; by < polygon.size(); ++by) {
            CAPTURE(by);
            const Polygon p = rotated(polygon, by);
            const Triangles triangles = cut(p);
            REQUIRE(is_disc(triangles, p.size()));
            CHECK(covers(triangles, p));
        }
    }
}

TEST_CASE("polygons of random corners become a disc with the polygon's edges") {
    for (std::uint32_t seed = 1; seed <= 2000; ++seed) {
        CAPTURE(seed);
        std::mt19937 random(seed);
        Polygon polygon(4 + random() % 40);
        const auto size = static_cast<std::uint32_t>(1 + random() % (seed % 2 == 0 ? 5 : 1000));
        for (GridPoint& p : polygon) p = {pick(random, size), pick(random, size)};
        REQUIRE(is_disc(cut(polygon), polygon.size()));
    }
}

TEST_CASE("polygons of every scale have the same triangles, in floats and doubles") {
    for (std::uint32_t seed = 1; seed <= 30; ++seed) {
        CAPTURE(seed);
        std::mt19937 random(seed);
        const Polygon polygon = random_simple(random, 20, 1 << 12);
        const Triangles triangles = cut(polygon);
        for (const float scale : {0x1p-149F, 0x1p-140F, 0x1p-100F, 0x1p-30F, 0x1p30F, 0x1p100F, 0x1p115F}) {
            CAPTURE(scale);
            CHECK(cut(polygon, scale) == triangles);
        }
        for (const double scale : {0x1p-1074, 0x1p-1000, 0x1p-600, 1.0, 0x1p115}) {
            CAPTURE(scale);
            CHECK(cut(polygon, scale) == triangles);
        }
        // Far from the origin, products of coordinates are rounded.
        Polygon far = polygon;
        for (GridPoint& p : far) p = {p.x + (std::int64_t{1} << 50U), p.y - (std::int64_t{1} << 51U)};
        CHECK(cut<double>(far) == triangles);
    }
}

TEST_CASE("the polygon is projected along the largest component of its normal; heights do not matter") {
    for (std::uint32_t seed = 1; seed <= 60; ++seed) {
        CAPTURE(seed);
        std::mt19937 random(seed);
        const Polygon polygon = random_simple(random, 12, 1 << 10);
        const Triangles triangles = cut(polygon);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            std::vector<float> xyz(3 * polygon.size());
            for (std::size_t i = 0; i < polygon.size(); ++i) {
                xyz[3 * i + (axis + 1) % 3] = static_cast<float>(polygon[i].x);
                xyz[3 * i + (axis + 2) % 3] = static_cast<float>(polygon[i].y);
                // The heights are random, but too small to change the largest component of the normal.
                xyz[3 * i + axis] = static_cast<float>(random() % 100) / 100.0F;
            }
            CHECK(cut_space(xyz) == triangles);
        }
    }
}

TEST_CASE("polygons of 160,000 corners are cut within a minute") {
    std::mt19937 random(3);
    for (const std::size_t n : {10'000U, 160'000U}) {
        Polygon tangle(n), zigzag;
        for (GridPoint& p : tangle) p = {pick(random, 1'000'000), pick(random, 1'000'000)};
        for (std::size_t i = 0; i < n; ++i) {
            zigzag.push_back({static_cast<std::int64_t>(i * (random() % 3)), static_cast<std::int64_t>(i)});
        }
        const std::pair<const char*, Polygon> shapes[] = {{"comb", comb(static_cast<std::int64_t>(n) / 2)},
                                                          {"spiral", spiral(n / 80, 40)},
                                                          {"star", star(random, n / 2)},
                                                          {"steps", random_steps(random, n / 4)},
                                                          {"tangle", tangle},
                                                          {"zigzag", zigzag}};
        for (const auto& [name, polygon] : shapes) {
            std::uint64_t given_up = 0;
            const double seconds = seconds_of(polygon, given_up);
            MESSAGE(fmt::format("{} of {} corners: {:.3f} s, {} given up", name, polygon.size(), seconds, given_up));
            CHECK(seconds < 60);
        }
    }
}
