// The order in which RING-EXPANDER invades triangles, against the rings that it gives.
#include <doctest/doctest.h>

#include <algorithm>
#include <random>

#include "lacedring/ring.hpp"
#include "tests/support/capture.h"
#include "tests/support/meshes.h"

using namespace lacedring;

namespace {

/// The triangles on the left of the rings: those with a ring edge there, and what can be reached from them without
/// crossing a ring.
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

void check_order(const CornerTable& table, const Rings& rings, const Expansion& expansion) {
    REQUIRE(expansion.first.size() == rings.first.size());
    REQUIRE(expansion.first.front() == 0);
    REQUIRE(expansion.first.back() == expansion.corners.size());
    std::vector<bool> invaded(table.triangle_count()), reached(table.vertex_count);
    for (std::size_t r = 0; r < rings.count(); ++r) {
        const std::size_t begin = expansion.first[r], end = expansion.first[r + 1];
        REQUIRE(end - begin == rings.ring(r).size() - 2);
        const auto ours = [&, from = reached](VertexId v) { return reached[v.value] && !from[v.value]; };
        for (std::size_t i = begin; i < end; ++i) {
            const CornerId c = expansion.corners[i];
            REQUIRE_FALSE(invaded[triangle(c).value]);
            invaded[triangle(c).value] = true;
            REQUIRE_FALSE(reached[table.vertex(c).value]);
            if (i == begin) {
                for (const CornerId x : {next(c), previous(c)}) {
                    REQUIRE_FALSE(reached[table.vertex(x).value]);
                    reached[table.vertex(x).value] = true;
                }
            } else {  // entered from a triangle of this ring that was invaded before
                REQUIRE_FALSE(table.opposite(c).is_null());
                REQUIRE(invaded[triangle(table.opposite(c)).value]);
                REQUIRE(ours(table.vertex(next(c))));
                REQUIRE(ours(table.vertex(previous(c))));
            }
            reached[table.vertex(c).value] = true;
        }
        for (const RingEdge& edge : rings.ring(r)) REQUIRE(ours(edge.start));
    }
    REQUIRE(invaded == left_side(table, rings));
}

/// After every number of triangles if there are few, else after some: sides by counting what is reached.
void check_steps(const CornerTable& table, const Rings& rings, const Expansion& expansion, std::uint64_t seed) {
    const std::vector<std::uint32_t> steps = settling_steps(table, expansion);
    REQUIRE(steps.size() == table.triangle_count());
    const std::size_t count = expansion.corners.size();
    const std::size_t stride = count < 50 ? 1 : count / 7 + seed % 13;
    std::vector<bool> invaded(table.triangle_count()), reached(table.vertex_count);
    std::size_t done = 0, r = 0;
    for (std::size_t n = 0; n <= count; n += n == count ? 1 : std::min(stride, count - n)) {
        for (; done < n; ++done) {
            const CornerId c = expansion.corners[done];
            invaded[triangle(c).value] = true;
            reached[table.vertex(c).value] = true;
            if (done != expansion.first[r]) continue;
            ++r;
            for (const CornerId x : {next(c), previous(c)}) reached[table.vertex(x).value] = true;
        }
        std::size_t boundary = 0;
        for (std::uint32_t t = 0; t < steps.size(); ++t) {
            const bool settled = (steps[t] & ~kNeverInvaded) < n;
            REQUIRE(invaded[t] == ((steps[t] & kNeverInvaded) == 0 && settled));
            bool all = n > 0 && !table.degenerate(TriangleId{t});
            for (std::uint32_t k = 0; k < 3; ++k) {
                const CornerId c = corner(TriangleId{t}, k), o = table.opposite(c);
                all = all && reached[table.vertex(c).value];
                if (invaded[t] && (o.is_null() || !invaded[triangle(o).value])) ++boundary;
            }
            REQUIRE(settled == ((all || n == count) && count > 0));
        }
        // The region of each ring has no vertex inside: its boundary has an edge for each.
        REQUIRE(boundary == static_cast<std::size_t>(std::count(reached.begin(), reached.end(), true)));
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
    // Asking for it changes nothing.
    const Rings plain = expand_rings(*table, options);
    REQUIRE(plain.first == rings.first);
    for (std::size_t i = 0; i < rings.edges.size(); ++i) REQUIRE(plain.edges[i].left == rings.edges[i].left);
    if (options.start.value < table->corners.size() && !table->degenerate(triangle(options.start))) {
        if (options.seeds == 1) REQUIRE(expansion.corners.front() == options.start);
    }
    check_order(*table, rings, expansion);
    check_steps(*table, rings, expansion, options.random_seed);
}

}  // namespace

TEST_CASE("the expansion of named meshes is what their rings enclose") {
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

TEST_CASE("the expansion of random soups") {
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

TEST_CASE("with one seed the expansion begins at the first triangle, and is breadth first where k is 1") {
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
    // Breadth first: the triangles that others were entered from come in order.
    std::vector<std::size_t> at(table->triangle_count());
    for (std::size_t i = 0; i < expansion.corners.size(); ++i) at[triangle(expansion.corners[i]).value] = i;
    std::size_t parent = 0;
    for (std::size_t i = 1; i < expansion.first[1]; ++i) {
        const std::size_t from = at[triangle(table->opposite(expansion.corners[i])).value];
        CHECK(from >= parent);
        parent = from;
    }
}
