// Compares the order in which RING-EXPANDER invades triangles with the rings that it returns.
#include <doctest/doctest.h>

#include <algorithm>
#include <random>

#include "lacedring/ring.hpp"
#include "tests/support/capture.h"
#include "tests/support/meshes.h"

using namespace lacedring;

namespace {

/// For each triangle, whether it is left of a ring: it has a ring edge on its left side, or is reached from such a
/// triangle without crossing a ring.
std::vector<bool> left_side(const CornerTable& table, const Rings& rings) {
    std::vector<bool> out(table.triangle_count()), on_ring(table.corners.size());
    std::vector<TriangleId> stack;
    for (const RingEdge& edge : rings.edges) {
        on_ring[edge.left.value] = true;
        if (!out[triangle(edge.left).value]) stack.push_back(triangle(edge.left));
        out[triangle(edge.left).value] = true;
    }
    while (!stack.empty()) {
        const TriangleId t = stack.back();
        stack.pop_back();
        for (std::uint32_t k = 0; k < 3; ++k) {
            const CornerId c = corner(t, k), o = table.opposite(c);
            if (o.is_null() || on_ring[c.value] || out[triangle(o).value]) continue;
            out[triangle(o).value] = true;
            stack.push_back(triangle(o));
        }
    }
    return out;
}

/// Marks the two vertices of the edge opposite to `c`, which must be new.
void reach_first_edge(const CornerTable& table, CornerId c, std::vector<bool>& reached) {
    INFO("the first triangle of a ring has three new vertices");
    for (const CornerId x : {next(c), previous(c)}) {
        REQUIRE_FALSE(reached[table.vertex(x).value]);
        reached[table.vertex(x).value] = true;
    }
}

void check_order(const CornerTable& table, const Rings& rings, const Expansion& expansion) {
    REQUIRE(expansion.first.size() == rings.first.size());
    REQUIRE(expansion.first.front() == 0);
    REQUIRE(expansion.first.back() == expansion.corners.size());
    std::vector<bool> invaded(table.triangle_count()), reached(table.vertex_count);
    for (std::size_t r = 0; r < rings.count(); ++r) {
        CAPTURE(r);
        const std::size_t begin = expansion.first[r], end = expansion.first[r + 1];
        REQUIRE_MESSAGE(end - begin == rings.ring(r).size() - 2, "a ring of n vertices invades n - 2 triangles");
        const auto of_ring = [&, before = reached](VertexId v) { return reached[v.value] && !before[v.value]; };
        for (std::size_t i = begin; i < end; ++i) {
            const CornerId c = expansion.corners[i];
            {
                INFO("each step invades a new triangle and reaches a new vertex");
                REQUIRE_FALSE(invaded[triangle(c).value]);
                REQUIRE_FALSE(reached[table.vertex(c).value]);
            }
            invaded[triangle(c).value] = true;
            if (i == begin) {
                reach_first_edge(table, c, reached);
            } else {
                INFO("each step after the first enters from an invaded triangle, over an edge of this ring's vertices");
                REQUIRE_FALSE(table.opposite(c).is_null());
                REQUIRE(invaded[triangle(table.opposite(c)).value]);
                REQUIRE(of_ring(table.vertex(next(c))));
                REQUIRE(of_ring(table.vertex(previous(c))));
            }
            reached[table.vertex(c).value] = true;
        }
        INFO("a ring visits the vertices that its expansion reached");
        for (const RingEdge& edge : rings.ring(r)) REQUIRE(of_ring(edge.start));
    }
    REQUIRE_MESSAGE(invaded == left_side(table, rings), "the invaded triangles are those left of the rings");
}

/// The expansion after its first `done` steps.
struct Progress {
    std::vector<bool> invaded, reached;  ///< by triangle; by vertex
    std::size_t done = 0, rings = 0;

    void advance(const CornerTable& table, const Expansion& expansion, std::size_t steps) {
        for (; done < steps; ++done) {
            const CornerId c = expansion.corners[done];
            invaded[triangle(c).value] = true;
            reached[table.vertex(c).value] = true;
            if (done != expansion.first[rings]) continue;
            ++rings;
            for (const CornerId x : {next(c), previous(c)}) reached[table.vertex(x).value] = true;
        }
    }
    bool reached_all_of(const CornerTable& table, TriangleId t) const {
        return reached[table.vertex(corner(t, 0)).value] && reached[table.vertex(corner(t, 1)).value] &&
               reached[table.vertex(corner(t, 2)).value];
    }
    /// The edges between invaded triangles and others.
    std::size_t boundary(const CornerTable& table) const {
        std::size_t edges = 0;
        for (std::uint32_t i = 0; i < table.corners.size(); ++i) {
            const CornerId o = table.opposite(CornerId{i});
            if (invaded[i / 3] && (o.is_null() || !invaded[triangle(o).value])) ++edges;
        }
        return edges;
    }
};

/// Checks settling_steps() after each step of a short expansion, or after some steps of a long one.
void check_steps(const CornerTable& table, const Rings& rings, const Expansion& expansion, std::uint64_t seed) {
    const std::vector<std::uint32_t> steps = settling_steps(table, expansion);
    REQUIRE(steps.size() == table.triangle_count());
    const std::size_t count = expansion.corners.size();
    const std::size_t stride = count < 50 ? 1 : count / 7 + seed % 13;
    Progress progress{std::vector<bool>(table.triangle_count()), std::vector<bool>(table.vertex_count)};
    for (std::size_t n = 0; n <= count; n += n == count ? 1 : std::min(stride, count - n)) {
        CAPTURE(n);
        progress.advance(table, expansion, n);
        {
            INFO("a triangle is settled once its vertices are reached or all steps are done");
            for (std::uint32_t t = 0; t < steps.size(); ++t) {
                const bool settled = (steps[t] & ~kNeverInvaded) < n;
                REQUIRE(progress.invaded[t] == ((steps[t] & kNeverInvaded) == 0 && settled));
                const bool reached =
                    n > 0 && !table.degenerate(TriangleId{t}) && progress.reached_all_of(table, TriangleId{t});
                REQUIRE(settled == ((reached || n == count) && count > 0));
            }
        }
        INFO("no vertex is inside a ring's region: its boundary has an edge per vertex");
        const std::size_t boundary = progress.boundary(table);
        REQUIRE(boundary == static_cast<std::size_t>(std::ranges::count(progress.reached, true)));
        if (n == count) REQUIRE(boundary == rings.edges.size());
    }
}

void check_expansion(const Mesh& mesh, const RingOptions& options) {
    CAPTURE(options.seeds);
    CAPTURE(options.random_seed);
    CAPTURE(options.k);
    CAPTURE(options.one_per_shell);
    const Result<CornerTable> table = build_corner_table(mesh.indices, mesh.vertex_count);
    REQUIRE(table);
    Expansion expansion;
    const Rings rings = expand_rings(*table, options, &expansion);
    {
        INFO("recording the expansion does not change the rings");
        const Rings plain = expand_rings(*table, options);
        REQUIRE(plain.first == rings.first);
        for (std::size_t i = 0; i < rings.edges.size(); ++i) REQUIRE(plain.edges[i].left == rings.edges[i].left);
    }
    if (options.start.value < table->corners.size() && !table->degenerate(triangle(options.start))) {
        INFO("a single seed is options.start");
        if (options.seeds == 1) REQUIRE(expansion.corners.front() == options.start);
    }
    check_order(*table, rings, expansion);
    check_steps(*table, rings, expansion, options.random_seed);
}

}  // namespace

TEST_CASE("the expansion of named meshes invades the triangles left of their rings") {
    for (const auto& [name, mesh] : test::named_meshes()) {
        CAPTURE_COPY(name);
        check_expansion(mesh, {});
        check_expansion(mesh, {.seeds = 6, .random_seed = 3});
        check_expansion(mesh, {.seeds = 3, .random_seed = 2, .k = 7});
        check_expansion(mesh, {.k = 1});
        check_expansion(mesh, {.seeds = 2, .one_per_shell = true});
        const auto corners = static_cast<std::uint32_t>(mesh.indices.size());
        for (const std::uint32_t start : {corners / 2, corners - 1, corners}) {
            check_expansion(mesh, {.start = CornerId{start}});
            check_expansion(mesh, {.seeds = 3, .k = 3, .one_per_shell = true, .start = CornerId{start}});
        }
    }
}

TEST_CASE("the expansion of random soups invades the triangles left of their rings") {
    std::random_device device;
    const std::uint64_t begin = device();
    for (std::uint64_t seed = begin; seed < begin + 100; ++seed) {
        CAPTURE(seed);
        const auto vertices = 4 + static_cast<std::uint32_t>(seed % 23);
        const auto seeds = 1 + static_cast<std::uint32_t>(seed % 9), k = static_cast<std::uint32_t>(seed % 4);
        check_expansion(test::random_soup(vertices, 1 + static_cast<std::uint32_t>(seed % 71), seed),
                        {.seeds = seeds, .random_seed = seed, .k = k});
        check_expansion(test::random_gluing(40, 120, seed), {.seeds = seeds, .random_seed = seed, .k = k});
        const CornerId start{static_cast<std::uint32_t>(seed % 400)};
        check_expansion(test::random_gluing(40, 120, seed), {.random_seed = seed, .k = k, .start = start});
    }
}

TEST_CASE("with one seed and k = 1 the expansion begins at the first triangle and is breadth first") {
    const Result<Mesh> sphere = [] {
        for (auto& [name, mesh] : test::named_meshes()) {
            if (name.find("sphere") != std::string::npos) return Result<Mesh>(mesh);
        }
        return Result<Mesh>(Error{ErrorCode::invalid_argument, "no sphere"});
    }();
    REQUIRE(sphere);
    const Result<CornerTable> table = build_corner_table(sphere->indices, sphere->vertex_count);
    REQUIRE(table);
    Expansion expansion;
    expand_rings(*table, {.k = 1}, &expansion);
    REQUIRE(!expansion.corners.empty());
    CHECK(triangle(expansion.corners.front()).value == 0);
    INFO("breadth first: the triangles that steps enter from come in the order of the steps");
    std::vector<std::size_t> at(table->triangle_count());
    for (std::size_t i = 0; i < expansion.corners.size(); ++i) at[triangle(expansion.corners[i]).value] = i;
    std::size_t parent = 0;
    for (std::size_t i = 1; i < expansion.first[1]; ++i) {
        const std::size_t from = at[triangle(table->opposite(expansion.corners[i])).value];
        CHECK(from >= parent);
        parent = from;
    }
}
