// Compares the library with sections 6 and 12 of Rossignac's chapter, which need positions (docs/chapter-map.md).

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "lacedring/topology.hpp"
#include "lrlab/generate/generate.h"
#include "tests/support/built.h"
#include "tests/support/capture.h"
#include "tests/support/meshes.h"
#include "tests/support/shapes.h"

using namespace lacedring;
using lacedring::test::build;

namespace {

/// Boxes with counterclockwise or clockwise triangles.
struct Solid {
    std::vector<double> xyz;
    std::vector<std::uint32_t> indices;

    void add_box(Point low, Point high, bool clockwise = false) {
        const auto base = static_cast<std::uint32_t>(xyz.size() / 3);
        for (std::uint32_t i = 0; i < 8; ++i) {
            for (std::uint32_t k = 0; k < 3; ++k) xyz.push_back((i >> k & 1) != 0 ? high[k] : low[k]);
        }
        constexpr std::array<std::array<std::uint32_t, 4>, 6> kFaces{
            {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}};
        for (const auto& f : kFaces) {
            for (std::array<std::uint32_t, 3> t : {std::array{f[0], f[1], f[2]}, std::array{f[0], f[2], f[3]}}) {
                if (clockwise) std::swap(t[1], t[2]);
                for (const std::uint32_t v : t) indices.push_back(base + v);
            }
        }
    }
    CornerTable table() const { return build(indices, static_cast<std::uint32_t>(xyz.size() / 3)); }
    Positions positions() const { return Positions(std::span<const double>(xyz)); }
    std::vector<ClosedShell> shells() const { return closed_shells(table(), positions()); }
};

Solid unit_cube(bool clockwise = false) {
    Solid solid;
    solid.add_box({0, 0, 0}, {1, 1, 1}, clockwise);
    return solid;
}

Mesh generated(std::string_view kind, std::uint64_t triangles, std::uint64_t seed) {
    Result<Mesh> mesh = generate(kind, triangles, seed);
    REQUIRE(mesh);
    return std::move(*mesh);
}

}  // namespace

TEST_CASE("section 12: signed volumes of small shells") {
    SUBCASE("a cube of clockwise triangles has the negative volume") {
        const std::vector<ClosedShell> right = unit_cube().shells(), wrong = unit_cube(true).shells();
        REQUIRE(right.size() == 1);
        REQUIRE(wrong.size() == 1);
        CHECK(right[0].volume == doctest::Approx(1.0).epsilon(1e-15));
        CHECK(right[0].triangles == 12);
        CHECK(right[0].error < 1e-13);
        CHECK_FALSE(right[0].inside_out());
        CHECK(wrong[0].volume == doctest::Approx(-1.0).epsilon(1e-15));
        CHECK(wrong[0].inside_out());
    }
    SUBCASE("a tetrahedron of float positions is a sixth of its parallelepiped") {
        const std::vector<float> xyz{0, 0, 0, 2, 0, 0, 0, 3, 0, 0, 0, 5};
        const CornerTable table = build({0, 2, 1, 0, 1, 3, 1, 2, 3, 0, 3, 2}, 4);
        const auto shells = closed_shells(table, Positions(std::span<const float>(xyz)));
        REQUIRE(shells.size() == 1);
        CHECK(shells[0].volume == doctest::Approx(5.0).epsilon(1e-15));
    }
    SUBCASE("small shells far from the origin and each other have exact volumes") {
        Solid solid;
        solid.add_box({1e6, 1e6, 1e6}, {1e6 + 0.125, 1e6 + 0.25, 1e6 + 0.5});
        solid.add_box({-1e6, 0, 0}, {-1e6 + 2, 2, 2}, true);
        const auto shells = solid.shells();
        REQUIRE(shells.size() == 2);
        CHECK(shells[0].volume == doctest::Approx(1.0 / 64).epsilon(1e-14));
        CHECK(shells[1].volume == doctest::Approx(-8.0).epsilon(1e-14));
        CHECK(shells[1].first.value == 12);
    }
    SUBCASE("open and non-orientable shells have no volume") {
        Solid solid = unit_cube();
        solid.indices.resize(33);
        CHECK(solid.shells().empty());
        // Each rotation of the first triangle meets the border at another corner.
        for (std::uint32_t k = 0; k < 3; ++k) {
            std::vector<std::uint32_t> cap{0, 1, 2, 0, 3, 1, 0, 2, 3};  // three sides of a tetrahedron
            std::rotate(cap.begin(), cap.begin() + k, cap.begin() + 3);
            CHECK(closed_shells(build(cap, 4), unit_cube().positions()).empty());
        }
        const test::Shape shape = test::projective_plane();
        const Mesh plane = test::make_mesh(shape.triangles, shape.vertices);
        CHECK(closed_shells(build(plane), positions_of(plane)).empty());
    }
}

TEST_CASE("section 12: rounding errors of the signed volume") {
    SUBCASE("two triangles back to back are flat at any positions") {
        for (std::uint64_t seed = 1; seed < 200; ++seed) {
            CAPTURE(seed);
            test::SplitMix64 random(seed);
            std::vector<float> xyz;
            for (int i = 0; i < 9; ++i) xyz.push_back(static_cast<float>(random.below(1U << 24)) / 1000.0F);
            const CornerTable table = build({0, 1, 2, 2, 1, 0}, 3);
            const auto shells = closed_shells(table, Positions(std::span<const float>(xyz)));
            REQUIRE(shells.size() == 1);
            CHECK(shells[0].flat());
            CHECK_FALSE(shells[0].inside_out());
            CHECK(check_smesh(table, report_topology(table), shells).fault == SmeshFault::flat);
        }
    }
    SUBCASE("a dome and its reversed copy are flat, though a million products cancel") {
        constexpr std::uint32_t kSide = 700;
        const test::Shape top = test::grid(kSide, kSide, false, false, false);
        const std::uint32_t row = kSide + 1;
        std::vector<double> xyz;
        for (std::uint32_t v = 0; v < top.vertices; ++v) {
            const double x = (v % row) / 70.0 - 5, y = static_cast<double>(v / row) / 70.0 - 5;
            xyz.insert(xyz.end(), {x, y, 100 - x * x - y * y / 3});
        }
        xyz.insert(xyz.end(), xyz.begin(), xyz.end());
        for (const bool outwards : {true, false}) {
            std::vector<std::uint32_t> indices;
            for (auto [a, b, c] : top.triangles) {
                if (!outwards) std::swap(b, c);
                indices.insert(indices.end(), {a, b, c});
                // Dome and lining share the rim.
                const auto lining = [&](std::uint32_t v) {
                    const bool rim = v % row == 0 || v % row == kSide || v / row == 0 || v / row == kSide;
                    return rim ? v : v + top.vertices;
                };
                if (lining(a) == a && lining(b) == b && lining(c) == c) {
                    indices.resize(indices.size() - 3);  // all three at the rim: equal to its lining
                } else {
                    indices.insert(indices.end(), {lining(a), lining(c), lining(b)});
                }
            }
            const CornerTable table = build(indices, 2 * top.vertices);
            const auto shells = closed_shells(table, Positions(std::span<const double>(xyz)));
            REQUIRE(shells.size() == 1);
            CHECK(shells[0].flat());
            CHECK_FALSE(shells[0].inside_out());
            CHECK(shells[0].error < 1e-10);
        }
    }
    SUBCASE("the sum of a hundred thousand slivers, each below the rounding error of the volume, counts") {
        constexpr std::uint32_t kSlivers = 100000;
        // A tetrahedron whose edge from 2 to 3 is cut into kSlivers + 1 pieces.
        std::vector<double> xyz{0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0};
        std::vector<std::uint32_t> edge{2};
        for (std::uint32_t i = 1; i <= kSlivers; ++i) {
            edge.push_back(3 + i);
            xyz.insert(xyz.end(), {std::ldexp(i, -54), 0, 0});
        }
        edge.push_back(3);
        std::vector<std::uint32_t> indices{0, 1, 2, 1, 0, 3};
        for (std::size_t i = 0; i + 1 < edge.size(); ++i) {
            indices.insert(indices.end(), {0, edge[i], edge[i + 1], 1, edge[i + 1], edge[i]});
        }
        // The last two triangles, at vertex 3, have nearly all of the volume: sum them first or last.
        for (std::size_t first = 0; first < 2; ++first) {
            std::rotate(indices.begin(), indices.end() - 3, indices.end());
            for (std::size_t k = 0; k < 3; ++k) {
                std::rotate(indices.begin(), indices.begin() + 1, indices.begin() + 3);
                const CornerTable table = build(indices, 4 + kSlivers);
                const auto shells = closed_shells(table, Positions(std::span<const double>(xyz)));
                REQUIRE(shells.size() == 1);
                CHECK(std::abs(std::abs(shells[0].volume) - 1.0 / 6) <= shells[0].error);
                CHECK(shells[0].error < 1e-14);
            }
        }
    }
}

TEST_CASE("section 12: signed volumes of generated meshes") {
    SUBCASE("a sphere and its inside-out twin have opposite volumes, near the ball's") {
        for (const std::uint64_t triangles : {100U, 1000U, 30000U}) {
            Mesh mesh = generated("sphere", triangles, 1);
            const auto shells = closed_shells(build(mesh), positions_of(mesh));
            REQUIRE(shells.size() == 1);
            const std::vector<float> p = positions_f32(mesh);
            double radius = 0;
            for (std::size_t i = 0; i < 3; ++i) radius += double{p[i]} * double{p[i]};
            const double ball = 4.0 / 3.0 * 3.14159265358979 * std::pow(std::sqrt(radius), 3);
            CHECK(shells[0].volume < ball);
            CHECK(shells[0].volume > ball * (1 - 16.0 / static_cast<double>(triangles)));
            for (std::size_t t = 0; t < mesh.triangle_count(); ++t)
                std::swap(mesh.indices[3 * t], mesh.indices[3 * t + 1]);
            const auto twin = closed_shells(build(mesh), positions_of(mesh));
            CHECK(std::abs(twin[0].volume + shells[0].volume) <= twin[0].error + shells[0].error);
        }
    }
    SUBCASE("generated closed meshes are counterclockwise, and smeshes unless they have handles") {
        for (const char* kind : {"sphere", "blob", "torus", "genus"}) {
            CAPTURE(kind);
            const Mesh mesh = generated(kind, 2000, 3);
            const CornerTable table = build(mesh);
            const auto shells = closed_shells(table, positions_of(mesh));
            REQUIRE(shells.size() == 1);
            CHECK_FALSE(shells[0].inside_out());
            const SmeshFault fault = check_smesh(table, report_topology(table), shells).fault;
            CHECK(fault == (kind[0] == 's' || kind[0] == 'b' ? SmeshFault::none : SmeshFault::handles));
        }
    }
    SUBCASE("a vertex without a position is at the origin") {
        const std::vector<double> none;
        const auto shells = closed_shells(unit_cube().table(), Positions(std::span<const double>(none)));
        REQUIRE(shells.size() == 1);
        CHECK(shells[0].flat());
    }
}

TEST_CASE("section 12: a clockwise smesh is a fault until it is turned") {
    const Solid solid = unit_cube(true);
    CornerTable table = solid.table();
    const auto fault = [&] {
        return check_smesh(table, report_topology(table), closed_shells(table, solid.positions())).fault;
    };
    CHECK(fault() == SmeshFault::clockwise);
    CHECK(make_counterclockwise(table, solid.positions()) == 1);
    CHECK(fault() == SmeshFault::none);
    CHECK(table.topology.flipped == 12);
    CHECK(make_counterclockwise(table, solid.positions()) == 0);
}

TEST_CASE("section 12: making every closed shell counterclockwise") {
    SUBCASE("clockwise closed shells are turned, others stay; flips are counted against the input") {
        Solid solid;
        solid.add_box({0, 0, 0}, {1, 1, 1});
        solid.add_box({2, 0, 0}, {3, 1, 1}, true);
        solid.add_box({4, 0, 0}, {5, 1, 1}, true);
        // One triangle of the second box is counterclockwise, and the third box is open.
        std::swap(solid.indices[36 + 1], solid.indices[36 + 2]);
        solid.indices.resize(solid.indices.size() - 3);
        CornerTable table = solid.table();
        CHECK(table.topology.flipped == 1);
        CHECK(make_counterclockwise(table, solid.positions()) == 1);
        CHECK(table.topology.flipped == 11);
        CHECK(check_corner_table(table) == "");
        for (std::uint32_t t = 0; t < table.triangle_count(); ++t) {
            CHECK(table.flipped(TriangleId{t}) == (t > 12 && t < 24));
            const std::size_t second = table.flipped(TriangleId{t}) ? 2 : 1;
            CHECK(table.vertex(corner(TriangleId{t}, 1)).value == solid.indices[std::size_t{t} * 3 + second]);
        }
        const auto shells = closed_shells(table, solid.positions());
        REQUIRE(shells.size() == 2);
        CHECK(shells[1].volume == doctest::Approx(1.0));
    }
    SUBCASE("a shell turned twice has no flipped triangle") {
        Solid solid = unit_cube();
        CornerTable table = solid.table();
        for (double& x : solid.xyz) x = -x;  // mirrored: inside out
        CHECK(make_counterclockwise(table, solid.positions()) == 1);
        CHECK(table.topology.flipped == 12);
        for (double& x : solid.xyz) x = -x;
        CHECK(make_counterclockwise(table, solid.positions()) == 1);
        CHECK(table.topology.flipped == 0);
        CHECK(table.flip.empty());
    }
    SUBCASE("every named mesh keeps its shells, genus, fans and triangles") {
        for (const auto& [name, mesh] : test::named_meshes()) {
            CAPTURE_COPY(name);
            CornerTable table = build(mesh);
            const TopologyReport before = report_topology(table);
            const auto shells = closed_shells(table, positions_of(mesh));
            const auto wrong =
                std::count_if(shells.begin(), shells.end(), [](const ClosedShell& s) { return s.inside_out(); });
            CHECK(make_counterclockwise(table, positions_of(mesh)) == static_cast<std::uint32_t>(wrong));
            CHECK(check_corner_table(table) == "");
            const TopologyReport after = report_topology(table);
            CHECK(after.shells == before.shells);
            CHECK(after.genus == before.genus);
            CHECK(after.fans == before.fans);
            std::uint32_t flipped = 0;
            for (std::uint32_t t = 0; t < table.triangle_count(); ++t) {
                flipped += table.flipped(TriangleId{t}) ? 1 : 0;
                CHECK(table.vertex(corner(TriangleId{t}, 0)).value == mesh.indices[std::size_t{t} * 3]);
                CHECK(table.vertex(corner(TriangleId{t}, table.flipped(TriangleId{t}) ? 2 : 1)).value ==
                      mesh.indices[std::size_t{t} * 3 + 1]);
            }
            CHECK(table.topology.flipped == flipped);
            for (const ClosedShell& shell : closed_shells(table, positions_of(mesh))) CHECK_FALSE(shell.inside_out());
        }
    }
}

TEST_CASE("section 6: vertex normals") {
    SUBCASE("at a box's vertex: the sum of its triangles' normals, weighted by area") {
        const Solid solid = unit_cube();
        const std::vector<float> normals = vertex_normals(solid.table(), solid.positions());
        for (std::uint32_t v = 0; v < 8; ++v) {
            double sum[3] = {0, 0, 0};
            // A face's normal is along the axis whose bit its vertices share.
            for (std::size_t t = 0; t < solid.indices.size(); t += 3) {
                const std::uint32_t* i = &solid.indices[t];
                if (std::find(i, i + 3, v) == i + 3) continue;
                const std::uint32_t shared_bits = i[0] & i[1] & i[2], clear_bits = ~(i[0] | i[1] | i[2]);
                for (std::size_t k = 0; k < 3; ++k)
                    sum[k] += double(shared_bits >> k & 1) - double(clear_bits >> k & 1);
            }
            const double length = std::hypot(sum[0], sum[1], sum[2]);
            for (std::size_t k = 0; k < 3; ++k) CHECK(double{normals[v * 3 + k]} == doctest::Approx(sum[k] / length));
        }
    }
    SUBCASE("normals of a sphere point outwards") {
        Mesh mesh = generated("sphere", 5000, 1);
        const std::vector<float> p = positions_f32(mesh), n = vertex_normals(build(mesh), positions_of(mesh));
        for (std::size_t v = 0; v < mesh.vertex_count; ++v) {
            double dot = 0, length = 0;
            for (std::size_t i = v * 3; i < v * 3 + 3; ++i) {
                dot += double{p[i]} * double{n[i]};
                length += double{p[i]} * double{p[i]};
            }
            CHECK(dot > 0.99 * std::sqrt(length));
        }
    }
    SUBCASE("a vertex of no triangle has the normal (0, 0, 1)") {
        const Mesh loose = test::make_mesh({0, 1, 2}, 5);
        const std::vector<float> few = vertex_normals(build(loose), positions_of(loose));
        CHECK(std::vector<float>(few.begin() + 9, few.end()) == std::vector<float>{0, 0, 1, 0, 0, 1});
    }
    SUBCASE("equal to normals_f32 within single precision, where no triangle was turned") {
        std::size_t compared = 0;
        for (const auto& [name, mesh] : test::named_meshes()) {
            const CornerTable table = build(mesh);
            if (table.topology.flipped > 0) continue;
            CAPTURE_COPY(name);
            const std::vector<float> expected = normals_f32(mesh), normals = vertex_normals(table, positions_of(mesh));
            REQUIRE(normals.size() == expected.size());
            // Normals at a vertex may cancel: the error of their sum is relative to the triangles' areas.
            std::vector<double> areas(mesh.vertex_count, 0.0), sums(std::size_t{mesh.vertex_count} * 3, 0.0);
            const std::vector<float> p = positions_f32(mesh);
            for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
                const std::uint32_t* v = &mesh.indices[t * 3];
                double e[3], f[3], n[3];
                for (std::size_t i = 0; i < 3; ++i) {
                    e[i] = double{p[v[1] * 3 + i]} - double{p[v[0] * 3 + i]};
                    f[i] = double{p[v[2] * 3 + i]} - double{p[v[0] * 3 + i]};
                }
                for (std::size_t i = 0; i < 3; ++i)
                    n[i] = e[(i + 1) % 3] * f[(i + 2) % 3] - e[(i + 2) % 3] * f[(i + 1) % 3];
                const double bound = std::hypot(e[0], e[1], e[2]) * std::hypot(f[0], f[1], f[2]);
                for (std::size_t k = 0; k < 3; ++k) {
                    areas[v[k]] += bound;
                    for (std::size_t i = 0; i < 3; ++i) sums[v[k] * 3 + i] += n[i];
                }
            }
            for (std::size_t v = 0; v < mesh.vertex_count; ++v) {
                const double left = std::hypot(sums[v * 3], sums[v * 3 + 1], sums[v * 3 + 2]);
                if (!(left > 1e-4 * areas[v])) continue;
                ++compared;
                const double tolerance = 3e-6 * areas[v] / left;
                for (std::size_t i = v * 3; i < v * 3 + 3; ++i) {
                    CHECK(std::abs(double{normals[i]} - double{expected[i]}) < tolerance);
                }
            }
        }
        CHECK(compared > 20000);
    }
    SUBCASE("triangles have the orientation of the table, not of the input") {
        Solid turned = unit_cube();
        std::swap(turned.indices[1], turned.indices[2]);
        std::swap(turned.indices[16], turned.indices[17]);
        const Solid right = unit_cube();
        const CornerTable table = turned.table();
        CHECK(table.topology.flipped == 2);
        CHECK(vertex_normals(table, turned.positions()) == vertex_normals(right.table(), right.positions()));
    }
}
