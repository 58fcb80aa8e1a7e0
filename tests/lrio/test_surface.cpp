#include <doctest/doctest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <limits>
#include <set>

#include "lacedring/surface.hpp"
#include "lrcore/base/vec3.h"
#include "tests/support/capture.h"
#include "tests/support/cut_mesh.h"
#include "tests/support/cuts.h"
#include "tests/support/meshes.h"
#include "tests/support/shapes.h"

using namespace lacedring;

namespace {

template <class Real>
Attribute position_attribute(const std::vector<Point>& points) {
    std::vector<Real> values;
    for (const Point& p : points) {
        for (const double x : p) values.push_back(static_cast<Real>(x));
    }
    const auto bytes = std::as_bytes(std::span(values));
    return {"POSITION",
            sizeof(Real) == 8 ? ComponentType::f64 : ComponentType::f32,
            3,
            false,
            {bytes.begin(), bytes.end()}};
}

/// A soup whose vertices are at few positions and have an attribute "mark" of two values.
Mesh random_mesh(std::uint64_t seed) {
    const auto size = static_cast<std::uint32_t>(seed);
    Mesh mesh = test::random_soup(2 + size % 30, size % 40, seed);
    const double values[] = {0.0, -0.0, 0.5, 0.125, 0.25, 1.0};
    test::SplitMix64 random(seed);
    std::vector<Point> points;
    Attribute mark{"mark", ComponentType::u8, 1, false, {}};
    for (std::uint32_t v = 0; v < mesh.vertex_count; ++v) {
        Point p{};
        for (double& x : p) x = values[random.below(1 + random.below(6))];
        points.push_back(p);
        mark.data.push_back(static_cast<std::byte>(random.below(2)));
    }
    const bool wide = random.below(2) == 0;
    mesh.attributes = {wide ? position_attribute<double>(points) : position_attribute<float>(points), mark};
    return mesh;
}

double distance(const Mesh& mesh, std::uint32_t v, std::uint32_t w) {
    const Positions positions = positions_of(mesh);
    const Point a = positions[VertexId{v}], b = positions[VertexId{w}];
    return detail::length(detail::minus(a, b));
}

std::vector<std::byte> value(const Attribute& attribute, std::size_t v) {
    const auto from = attribute.data.begin() + static_cast<std::ptrdiff_t>(v * attribute.stride());
    return {from, from + static_cast<std::ptrdiff_t>(attribute.stride())};
}

/// The position of v at its surface vertex: that of its first copy, where -0 is 0 if any copy has 0.
std::vector<std::byte> joined_value(const Mesh& mesh, std::span<const std::uint32_t> first, std::uint32_t v) {
    const Positions positions = positions_of(mesh);
    Point p = positions[VertexId{first[v]}];
    for (std::uint32_t w = 0; w < mesh.vertex_count; ++w) {
        const Point q = positions[VertexId{w}];
        for (std::size_t k = 0; k < 3; ++k) {
            if (first[w] == first[v] && p[k] == 0 && q[k] == 0 && !std::signbit(q[k])) p[k] = 0;
        }
    }
    const bool wide = mesh.attributes[0].type == ComponentType::f64;
    return (wide ? position_attribute<double>({p}) : position_attribute<float>({p})).data;
}

/// The first copy of each vertex's surface vertex.
std::vector<std::uint32_t> first_copies_of(const Mesh& mesh, const Surface& surface) {
    std::vector<std::uint32_t> out;
    for (std::uint32_t v = 0; v < mesh.vertex_count; ++v) {
        std::uint32_t w = 0;
        while (surface.has_seams() ? surface.vertex_of[w] != surface.vertex_of[v] : w != v) ++w;
        out.push_back(w);
    }
    return out;
}

/// The pairs of vertices that a triangle has, in both orders.
std::set<std::pair<std::uint32_t, std::uint32_t>> pairs_of(const Mesh& mesh) {
    std::set<std::pair<std::uint32_t, std::uint32_t>> out;
    for (const auto& t : test::oriented_triangles(mesh.indices)) {
        for (std::uint32_t k = 0; k < 3; ++k) {
            out.emplace(t[k], t[(k + 1) % 3]);
            out.emplace(t[(k + 1) % 3], t[k]);
        }
    }
    return out;
}

/// For each used vertex, the one that it would be joined with if triangles kept none apart.
std::vector<std::uint32_t> nearest_kept(const Mesh& mesh, double tolerance,
                                        const std::set<std::pair<std::uint32_t, std::uint32_t>>& pairs) {
    std::vector<std::uint32_t> out, kept;
    for (std::uint32_t v = 0; v < mesh.vertex_count; ++v) {
        const auto pair = pairs.lower_bound({v, 0});
        const bool used = pair != pairs.end() && pair->first == v;
        std::uint32_t best = v;
        // Vertices of one position are joined with the same vertex.
        for (std::uint32_t w = 0; used && w < v && best == v; ++w) {
            const auto other = pairs.lower_bound({w, 0});
            if (other != pairs.end() && other->first == w && distance(mesh, v, w) == 0) best = out[w];
        }
        if (used && best == v) {
            double least = tolerance;
            for (const std::uint32_t w : kept) {
                const double d = distance(mesh, v, w);
                if (d > least || (d == least && best < v)) continue;
                least = d;
                best = w;
            }
            if (best == v) kept.push_back(v);
        }
        out.push_back(best);
    }
    return out;
}

using VertexPairs = std::set<std::pair<std::uint32_t, std::uint32_t>>;

void check_surface_numbers(const Mesh& mesh, const Surface& surface) {
    REQUIRE(surface.has_seams() == (surface.vertex_count < mesh.vertex_count));
    if (!surface.has_seams()) return;
    INFO("surface vertices are numbered in the order of their first copies");
    REQUIRE(surface.vertex_of.size() == mesh.vertex_count);
    std::uint32_t next = 0;
    for (const std::uint32_t s : surface.vertex_of) {
        REQUIRE(s <= next);
        next = std::max(next, s + 1);
    }
    REQUIRE(next == surface.vertex_count);
}

/// `first`: the first copy of each vertex.
void check_joined_copies(const Mesh& mesh, double tolerance, const VertexPairs& pairs,
                         const std::vector<std::uint32_t>& first) {
    const std::vector<std::uint32_t> nearest = nearest_kept(mesh, tolerance, pairs);
    for (std::uint32_t v = 0; v < mesh.vertex_count; ++v) {
        CAPTURE(v);
        REQUIRE_MESSAGE(nearest[v] == nearest[first[v]], "copies have the same nearest vertex");
        REQUIRE_MESSAGE(distance(mesh, v, first[v]) <= tolerance, "copies are within the tolerance");
        bool apart = first[v] == first[nearest[v]];
        for (std::uint32_t w = 0; w < mesh.vertex_count; ++w) {
            if (first[w] == first[nearest[v]] && pairs.contains({v, w})) apart = true;
            if (first[w] == first[v]) REQUIRE_MESSAGE(!pairs.contains({v, w}), "no triangle has two copies");
        }
        REQUIRE_MESSAGE(apart, "a vertex is joined with its nearest unless a triangle has both");
    }
}

void check_surface_report(const Mesh& mesh, const SurfaceReport& report, const std::vector<std::uint32_t>& first) {
    INFO("the report counts moved vertices and has the largest move");
    std::uint32_t moved = 0;
    double largest = 0;
    for (std::uint32_t v = 0; v < mesh.vertex_count; ++v) {
        if (value(mesh.attributes[0], v) != joined_value(mesh, first, v)) ++moved;
        largest = std::max(largest, distance(mesh, v, first[v]));
    }
    REQUIRE(report.moved == moved);
    REQUIRE(report.largest_move == largest);
}

void check_surface_meshes(const Mesh& mesh, const Surface& surface, const std::vector<std::uint32_t>& first) {
    const std::vector<std::uint32_t> firsts = first_vertices(surface);
    REQUIRE(firsts.size() == surface.vertex_count);
    Mesh at_surface = mesh;
    move_to_surface(at_surface, surface);
    const Mesh joined = surface_mesh(mesh, surface);
    {
        INFO("move_to_surface changes positions only");
        REQUIRE(at_surface.indices == mesh.indices);
        REQUIRE(at_surface.attributes[1].data == mesh.attributes[1].data);
    }
    INFO("surface_mesh has the surface's vertices, their positions and all triangles");
    REQUIRE(joined.vertex_count == surface.vertex_count);
    REQUIRE(joined.attributes.size() == 1);
    REQUIRE(joined.indices.size() == mesh.indices.size());
    for (std::size_t i = 0; i < mesh.indices.size(); ++i) {
        const std::uint32_t v = mesh.indices[i], s = joined.indices[i];
        REQUIRE(s == (surface.has_seams() ? surface.vertex_of[v] : v));
        REQUIRE(firsts[s] == first[v]);
        REQUIRE(value(at_surface.attributes[0], v) == joined_value(mesh, first, v));
        REQUIRE(value(joined.attributes[0], s) == value(at_surface.attributes[0], v));
    }
    REQUIRE(test::oriented_triangles(joined.indices).size() == test::oriented_triangles(mesh.indices).size());
}

/// Compares find_surface() with its definition, found by trying all pairs of vertices.
void check_surface(const Mesh& mesh, double tolerance) {
    SurfaceReport report;
    const Surface surface = find_surface(mesh, tolerance, &report);
    const std::vector<std::uint32_t> first = first_copies_of(mesh, surface);
    check_surface_numbers(mesh, surface);
    check_joined_copies(mesh, tolerance, pairs_of(mesh), first);
    check_surface_report(mesh, report, first);
    check_surface_meshes(mesh, surface, first);
}

/// Checks that merge_copies joins the copies whose attributes differ in positions only, and keeps the others.
void check_merging(const Mesh& mesh, double tolerance) {
    Surface surface = find_surface(mesh, tolerance);
    const Surface before = surface;
    const Mesh merged = merge_copies(mesh, surface);
    REQUIRE(surface.vertex_count == before.vertex_count);
    REQUIRE(surface.has_seams() == (surface.vertex_count < merged.vertex_count));
    REQUIRE(merged.indices.size() == mesh.indices.size());
    const auto own = [](const Surface& s, std::uint32_t v) { return s.has_seams() ? s.vertex_of[v] : v; };
    std::set<std::pair<std::uint32_t, std::vector<std::byte>>> kept, wanted;
    for (std::uint32_t v = 0; v < merged.vertex_count; ++v) {
        REQUIRE(kept.emplace(own(surface, v), value(merged.attributes[1], v)).second);
    }
    for (std::uint32_t v = 0; v < mesh.vertex_count; ++v) {
        wanted.emplace(own(before, v), value(mesh.attributes[1], v));
    }
    REQUIRE_MESSAGE(kept == wanted, "each surface vertex has one copy for each value");
    const std::vector<std::uint32_t> first = first_copies_of(mesh, before);
    for (std::size_t i = 0; i < mesh.indices.size(); ++i) {
        const std::uint32_t v = mesh.indices[i], w = merged.indices[i];
        REQUIRE(own(before, v) == own(surface, w));
        REQUIRE(value(mesh.attributes[1], v) == value(merged.attributes[1], w));
        REQUIRE(distance(mesh, v, first[v]) <= tolerance);
    }
}

}  // namespace

TEST_CASE("the surface of small random meshes equals its definition") {
    for (std::uint64_t seed = 0; seed < (test::kSanitized ? 200 : 2000); ++seed) {
        CAPTURE(seed);
        const Mesh mesh = random_mesh(seed);
        for (const double tolerance : {0.0, 0.125, 0.3, 1.0, 1e-320, 1e300}) {
            CAPTURE(tolerance);
            check_surface(mesh, tolerance);
            check_merging(mesh, tolerance);
        }
    }
}

TEST_CASE("charts cut from small named meshes are joined again, and seam edges are the cuts") {
    for (const auto& [name, whole] : test::named_meshes()) {
        if (whole.triangle_count() > 1000) continue;
        CAPTURE_COPY(name);
        for (std::uint32_t charting = 0; charting < test::kCuts; ++charting) {
            CAPTURE(charting);
            const auto [mesh, surface] = test::cut_mesh(whole, charting, charting + 1);
            const Surface found = find_surface(mesh);
            REQUIRE(found.vertex_count == whole.vertex_count);
            REQUIRE(test::same_partition(found.vertex_of, surface.vertex_of));
            const Mesh joined = surface_mesh(mesh, surface);
            const CornerTable table = build_corner_table(joined.indices, joined.vertex_count).value();
            // For each edge of the surface, the mesh's vertices at its ends, a pair per triangle.
            using Edge = std::pair<std::uint32_t, std::uint32_t>;
            std::map<Edge, std::vector<Edge>> ends;
            for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
                for (std::size_t k = 0; k < 3; ++k) {
                    std::size_t a = i + k, b = i + (k + 1) % 3;
                    if (joined.indices[a] > joined.indices[b]) std::swap(a, b);
                    ends[{joined.indices[a], joined.indices[b]}].emplace_back(mesh.indices[a], mesh.indices[b]);
                }
            }
            const std::vector<CornerId> seams = seam_edges(table, mesh);
            REQUIRE(std::ranges::is_sorted(seams));
            std::set<Edge> cut;
            for (const CornerId c : seams) {
                REQUIRE(c < table.opposite(c));
                const Edge edge = std::minmax({table.vertex(next(c)).value, table.vertex(previous(c)).value});
                cut.insert(edge);
                if (const auto& pairs = ends.at(edge); pairs.size() == 2) REQUIRE(pairs[0] != pairs[1]);
            }
            for (const auto& [edge, pairs] : ends) {
                if (pairs.size() == 2 && pairs[0] != pairs[1] && table.topology.nonmanifold_edges == 0 &&
                    table.topology.cut_edges == 0 && table.topology.degenerate == 0) {
                    REQUIRE(cut.contains(edge));
                }
            }
        }
    }
}

TEST_CASE("the vertices of one triangle stay apart, and no vertex moves farther than the tolerance") {
    // Vertices 1 and 2 are on either side of 0, each in a triangle with 0. To join each other they would have to move
    // twice the tolerance.
    Mesh mesh = test::make_mesh({0, 1, 3, 0, 2, 4}, 5);
    mesh.attributes[0] = position_attribute<float>({{0, 0, 0}, {1, 0, 0}, {-1, 0, 0}, {9, 0, 0}, {0, 9, 0}});
    SurfaceReport report;
    CHECK(find_surface(mesh, 1, &report).vertex_count == 5);
    CHECK(report.moved == 0);
    // Without triangles that have both, they are joined with 0.
    mesh.indices = {0, 3, 4, 1, 3, 4, 2, 3, 4};
    const Surface joined = find_surface(mesh, 1, &report);
    CHECK(joined.vertex_of == std::vector<std::uint32_t>{0, 0, 0, 1, 2});
    CHECK(report.moved == 2);
    CHECK(report.largest_move == 1);
}

TEST_CASE("meshes without positions, without triangles and without vertices have no seams") {
    Mesh mesh = test::make_mesh({0, 1, 2, 3, 4, 5}, 6);
    mesh.attributes[0] = position_attribute<double>(std::vector<Point>(6, Point{1, 2, 3}));
    const auto whole = [](const Mesh& m) {
        Surface surface = find_surface(m);
        CHECK(!surface.has_seams());
        CHECK(surface.vertex_count == m.vertex_count);
        CHECK(merge_copies(m, surface).vertex_count == m.vertex_count);
        CHECK(surface_mesh(m, surface).indices == m.indices);
    };
    CHECK(find_surface(mesh).vertex_count == 3);
    mesh.indices = {0, 0, 1};  // degenerate: uses no vertex
    whole(mesh);
    mesh.indices.clear();
    whole(mesh);
    mesh.indices = {0, 1, 2, 3, 4, 5};
    mesh.attributes[0].name = "normal";
    whole(mesh);
    mesh.attributes.clear();
    whole(mesh);
    whole({});
}

TEST_CASE("-0 equals 0, and is moved to 0") {
    Mesh mesh = test::make_mesh({0, 1, 2, 3, 1, 4}, 5);
    for (const bool below_first : {false, true}) {
        const double first = below_first ? -0.0 : 0.0, second = below_first ? 0.0 : -0.0;
        mesh.attributes[0] =
            position_attribute<double>({{first, 1, 2}, {1, 0, 0}, {0, 1, 0}, {second, 1, 2}, {5, 5, 5}});
        SurfaceReport report;
        const Surface surface = find_surface(mesh, 0, &report);
        CHECK(surface.vertex_count == 4);
        CHECK(report.moved == 1);
        CHECK(report.largest_move == 0);
        Mesh moved = mesh;
        move_to_surface(moved, surface);
        for (const std::uint32_t v : {0U, 3U}) CHECK(!std::signbit(positions_of(moved)[VertexId{v}][0]));
    }
}

TEST_CASE("a hundred thousand triangles at one position take no quadratic time, at any tolerance") {
    const auto started = std::chrono::steady_clock::now();
    const std::uint32_t triangles = test::kSanitized ? 20000 : 100000;
    using Indices = std::vector<std::uint32_t>;
    Mesh fan = test::make_mesh(Indices(), 3 * triangles), heap = fan,
         hub = test::make_mesh(Indices(), 2 * triangles + 1);
    std::vector<Point> points;
    for (std::uint32_t t = 0; t < triangles; ++t) {
        fan.indices.insert(fan.indices.end(), {3 * t, 3 * t + 1, 3 * t + 2});
        hub.indices.insert(hub.indices.end(), {0, 2 * t + 1, 2 * t + 2});
        const double x = t;
        points.insert(points.end(), {Point{0, 0, 0}, Point{x, 1, 1}, Point{x + 1, 1, 1}});
    }
    heap.indices = fan.indices;
    fan.attributes[0] = position_attribute<float>(points);
    heap.attributes[0] = position_attribute<float>(std::vector<Point>(heap.vertex_count));
    hub.attributes[0] = position_attribute<float>(std::vector<Point>(hub.vertex_count));
    CHECK(find_surface(fan).vertex_count == triangles + 2);
    CHECK(find_surface(heap).vertex_count == 3);
    CHECK(find_surface(hub).vertex_count == 3);
    for (const double tolerance : {std::numeric_limits<double>::denorm_min(), 1e-300, 1e-9, 0.25}) {
        CHECK(find_surface(fan, tolerance).vertex_count == triangles + 2);
    }
    CHECK(find_surface(heap, 1).vertex_count == 3);
    CHECK(find_surface(hub, 1).vertex_count == 3);
    // The hubs are joined, and two vertices per triangle stay apart.
    CHECK(find_surface(fan, 1e9).vertex_count == 2 * triangles + 1);
    // Takes 0.5 s on an idle machine.
    CHECK(std::chrono::steady_clock::now() - started < std::chrono::seconds(20));
}
