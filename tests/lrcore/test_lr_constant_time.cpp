// Operators take constant time: the words that each reads have the same bound on every mesh.

#include <doctest/doctest.h>

#include <algorithm>

#include "lacedring/lacedring.hpp"
#include "lacedring/operators.hpp"
#include "lacedring/streams.hpp"
#include "lacedring/topology.hpp"
#include "lrlab/generate/generate.h"
#include "tests/support/capture.h"
#include "tests/support/meshes.h"

using namespace lacedring;

namespace {

/// A store that counts its reads. It has no shortcuts (plain_opposite, plain_fan), so that Operators takes the general
/// path.
template <class View>
struct Counting {
    const View* view;
    std::uint32_t ring_vertices;
    std::size_t* reads;

    const View& read() const {
        ++*reads;
        return *view;
    }
    std::uint32_t kind(std::uint32_t v, std::uint32_t side) const { return read().kind(v, side); }
    bool closes(std::uint32_t v) const { return read().closes(v); }
    std::uint32_t first(std::uint32_t v) const { return read().first(v); }
    std::uint32_t tip(std::uint32_t v, std::uint32_t side) const { return read().tip(v, side); }
    std::uint32_t star_opposite(std::uint32_t v, std::uint32_t side, std::uint32_t end) const {
        return read().star_opposite(v, side, end);
    }
    std::uint32_t t0_vertex(std::uint32_t i) const { return read().t0_vertex(i); }
    std::uint32_t t0_opposite(std::uint32_t i) const { return read().t0_opposite(i); }
    std::uint32_t isolated_corner(std::uint32_t i) const { return read().isolated_corner(i); }
    std::uint32_t used_vertices() const { return view->used_vertices(); }
};

/// The largest number of reads per operator.
struct Most {
    std::size_t vertex = 0, opposite = 0, swing = 0, canonical = 0, corner = 0;
};

template <class View>
void count(const View& view, Most& most) {
    std::size_t reads = 0;
    const Operators<Counting<View>> ops({&view, view.ring_vertices, &reads});
    const auto measure = [&](std::size_t& bound, const auto& operation) {
        reads = 0;
        operation();
        bound = std::max(bound, reads);
    };
    for (std::uint32_t t = 0; t < view.triangle_numbers(); ++t) {
        for (std::uint32_t k = 0; k < 3; ++k) {
            const CornerId c{4 * t + k};
            measure(most.vertex, [&] { ops.vertex(c); });
            measure(most.opposite, [&] { ops.opposite(c); });
            measure(most.swing, [&] { ops.swing(c); });
            measure(most.canonical, [&] { ops.canonical(c); });
        }
    }
    for (std::uint32_t v = 0; v < view.used_vertices(); ++v) measure(most.corner, [&] { ops.corner(VertexId{v}); });
}

void count(const Mesh& mesh, std::uint32_t k, Most& most) {
    Result<CornerTable> table = build_corner_table(mesh.indices, mesh.vertex_count);
    REQUIRE(table);
    split_fans(*table);
    const Result<LrTable> lr = build_lr(*table, expand_rings(*table, {.k = k, .one_per_shell = true}));
    REQUIRE(lr);
    count(lr->view(), most);
    const Result<CompactLrTable> compact = build_compact_lr(lr->view());
    REQUIRE(compact);
    count(compact->view(), most);
}

/// A read is at most three words: a word of L or R, an entry of VO* and the entry beside it.
void check_most(const Most& most) {
    CHECK(most.vertex <= 6);
    CHECK(most.canonical <= 6);
    CHECK(most.corner <= 6);
    CHECK(most.opposite <= 40);
    CHECK(most.swing <= 40);
}

}  // namespace

TEST_CASE("LR operators read a bounded number of words on every mesh") {
    for (const auto& [name, mesh] : test::named_meshes()) {
        CAPTURE_COPY(name);
        Most most;
        count(mesh, 0, most);
        count(mesh, 4, most);
        check_most(most);
    }
}

TEST_CASE("LR operators read no more on larger meshes") {
    for (const char* kind : {"blob", "genus", "terrain", "soup"}) {
        for (const std::uint64_t triangles : {1000U, 10000U, 100000U}) {
            CAPTURE(kind);
            CAPTURE(triangles);
            const Result<Mesh> mesh = generate(kind, triangles, 3);
            REQUIRE(mesh);
            Most most;
            count(*mesh, 0, most);
            check_most(most);
        }
    }
}
