// Tests CornerCopies, which finds the vertex copy of a single corner, and seams together with the LR operators.

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

#include "lacedring/lacedring.hpp"
#include "lacedring/seams.hpp"
#include "lrlab/generate/generate.h"
#include "tests/support/cuts.h"
#include "tests/support/meshes.h"
#include "tests/support/named_streams.h"
#include "tests/support/shapes.h"

using namespace lacedring;

namespace {

using Numbers = std::vector<std::uint32_t>;

struct Seen {
    std::size_t redundant = 0, border = 0, flipped = 0, fans = 0;
};

/// Compares CornerCopies at every corner of the tables with `wanted`, the copies that decode_seams writes.
template <class View>
void check_corners(const LrStreamView<View>& tables, const Numbers& slots, const Numbers& wanted, CornerCopies& copies,
                   Seen& seen) {
    const Operators ops(tables.view, tables.copies);
    bool right = true;
    for (std::uint32_t c = 0; c < 4 * tables.view.triangle_numbers() && right; ++c) {
        if (c % 4 == 3) continue;
        const CornerId own = ops.canonical(CornerId(c));
        if (own.is_null()) {
            right = copies.copy(CornerId(c)) == UINT32_MAX;
            ++seen.border;
            continue;
        }
        const VertexId v = ops.vertex(CornerId(c)), original = ops.original(v);
        const auto slot = slots.begin() + std::ptrdiff_t{3} * ops.triangle(own).value;
        const auto place = std::find(slot, slot + 3, original.value);
        REQUIRE(place != slot + 3);
        right = copies.copy(CornerId(c)) == wanted[static_cast<std::size_t>(place - slots.begin())];
        seen.redundant += own != CornerId(c) ? 1 : 0;
        seen.flipped += tables.view.flipped(own.value / 4) ? 1 : 0;
        seen.fans += v != original ? 1 : 0;
    }
    REQUIRE_MESSAGE(right, "each corner has the copy that decode_seams writes");
    REQUIRE_MESSAGE(copies.copy(kNullCorner) == UINT32_MAX, "the null corner has no copy");
}

/// Compares CornerCopies and copy_vertices with decode_seams, for the way `how` to cut (cuts.h).
void check_copies(const StreamView& stream, std::uint32_t how, std::uint64_t seed, Seen& seen) {
    const Numbers slots = slot_triangles(stream);
    const test::CutSurface mesh = test::cut(slots, stream.vertices(), how, seed);
    const Result<EncodedSeams> seams = encode_seams(slots, stream.vertices(), mesh.copies);
    REQUIRE_MESSAGE(seams, seams.error().message);
    const Result<SeamView> view = validate_seams(seams->words, slots, stream.vertices());
    REQUIRE_MESSAGE(view, view.error().message);
    Numbers wanted(slots.size()), vertices(view->copies, UINT32_MAX), first(std::size_t{view->vertices} + 1);
    decode_seams(*view, slots, wanted);

    first_copies(*view, first);
    copy_vertices(*view, slots, vertices);
    bool right = true;
    for (std::uint32_t v = 0; v < view->vertices; ++v) right &= vertices[first[v]] == v;
    for (std::size_t k = 0; k < slots.size(); ++k) right &= slots[k] == UINT32_MAX || vertices[wanted[k]] == slots[k];
    right &= std::ranges::all_of(vertices, [&](std::uint32_t v) { return v < view->vertices; });
    REQUIRE_MESSAGE(right, "copy_vertices names the vertex of each copy");

    for (std::uint32_t b = 0; b < view->blocks(); ++b) {
        const auto begin = slots.begin() + std::ptrdiff_t{3} * kSeamBlock * b;
        Numbers alone(std::min(std::size_t{3} * kSeamBlock, static_cast<std::size_t>(slots.end() - begin)));
        slot_triangles(stream, b, alone);
        REQUIRE_MESSAGE(std::ranges::equal(alone, std::span(begin, alone.size())),
                        "a block has the slots of the whole");
    }

    CornerCopies copies(stream, *view);
    test::SplitMix64 random(seed);
    for (std::uint32_t n = 0; n < std::min(stream.slots(), 2000U); ++n) {
        const std::uint32_t slot = random.below(stream.slots());
        for (std::uint32_t k = 0; k < 3; ++k) right &= copies.copy(slot, k) == wanted[std::size_t{3} * slot + k];
    }
    REQUIRE_MESSAGE(right, "random slots have the copies that decode_seams writes");
    if (const auto* lr = stream.get<LrStreamView<LrView>>()) check_corners(*lr, slots, wanted, copies, seen);
    if (const auto* compact = stream.get<LrStreamView<CompactLrView>>()) {
        check_corners(*compact, slots, wanted, copies, seen);
    }
}

// On a lattice, the mean of the neighbors does not depend on their order.
using LatticePoint = std::array<std::int64_t, 3>;
using LatticePoints = std::vector<LatticePoint>;

struct Mean {
    LatticePoint sum{};
    std::int64_t count = 0;

    void add(const LatticePoint& p) {
        for (std::size_t i = 0; i < 3; ++i) sum[i] += p[i];
        ++count;
    }
    LatticePoint get() const { return {sum[0] / count, sum[1] / count, sum[2] / count}; }
};

constexpr std::uint32_t kSteps = 3;

/// Moves each vertex to the mean of its neighbors, kSteps times. `points` are in the order of the stream; the operators
/// find the neighbors.
template <class View>
LatticePoints smooth(const LrStreamView<View>& tables, LatticePoints points) {
    const Operators ops(tables.view, tables.copies);
    for (std::uint32_t step = 0; step < kSteps; ++step) {
        std::vector<Mean> means(points.size());
        for (const VertexId v : IdRange<VertexTag>(tables.view.vertices)) {
            Mean& mean = means[ops.original(v).value];
            ops.neighbors(v, [&](VertexId u) { mean.add(points[ops.original(u).value]); });
        }
        for (std::size_t v = 0; v < points.size(); ++v) {
            if (means[v].count > 0) points[v] = means[v].get();
        }
    }
    return points;
}
LatticePoints smooth(const StreamView& stream, const LatticePoints& points) {
    const auto* lr = stream.get<LrStreamView<LrView>>();
    return lr != nullptr ? smooth(*lr, points) : smooth(*stream.get<LrStreamView<CompactLrView>>(), points);
}

/// Moves each vertex to the mean of its neighbors, kSteps times. Finds the neighbors in an index list.
LatticePoints smooth(const Numbers& indices, LatticePoints points) {
    std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
    for (std::size_t c = 0; c < indices.size(); ++c) {
        const std::uint32_t a = indices[c], b = indices[c % 3 == 2 ? c - 2 : c + 1];
        edges.insert({{a, b}, {b, a}});
    }
    for (std::uint32_t step = 0; step < kSteps; ++step) {
        std::vector<Mean> means(points.size());
        for (const auto& [a, b] : edges) means[a].add(points[b]);
        for (std::size_t v = 0; v < points.size(); ++v) points[v] = means[v].get();
    }
    return points;
}

/// A mesh whose vertices at chart borders have one copy, with its own texture coordinate, per chart.
struct CutMesh {
    Numbers indices;
    LatticePoints points;
    std::vector<std::array<std::uint32_t, 2>> texcoords;
    Numbers whole;  ///< by copy: its vertex in the mesh before cutting
};

/// Cuts at the coordinate planes. A texture coordinate is the chart and the vertex.
CutMesh cut_into_octants(const Numbers& indices, const LatticePoints& points) {
    CutMesh out;
    std::map<std::array<std::uint32_t, 2>, std::uint32_t> numbers;
    std::uint32_t chart = 0;
    for (std::size_t c = 0; c < indices.size(); ++c) {
        const std::uint32_t v = indices[c];
        if (c % 3 == 0) chart = (points[v][0] < 0 ? 1 : 0) + (points[v][1] < 0 ? 2 : 0) + (points[v][2] < 0 ? 4 : 0);
        const std::array texcoord{chart, v};
        const auto [found, is_new] = numbers.emplace(texcoord, static_cast<std::uint32_t>(numbers.size()));
        out.indices.push_back(found->second);
        if (!is_new) continue;
        out.points.push_back(points[v]);
        out.texcoords.push_back(texcoord);
        out.whole.push_back(v);
    }
    return out;
}

/// A mesh's LR tables with the vertex order of their stream.
struct Tables {
    Encoded encoded;
    StreamView stream;

    LatticePoints in_order(const LatticePoints& points) const {
        LatticePoints out;
        for (const std::uint32_t old : encoded.vertex_order) out.push_back(points[old]);
        return out;
    }
};
Tables tables_of(const Numbers& indices, std::size_t vertices, Format format) {
    Result<Encoded> out = encode(indices, static_cast<std::uint32_t>(vertices), {.format = format, .effort = 0});
    REQUIRE_MESSAGE(out, out.error().message);
    const Result<StreamView> stream = validate(out->words);
    REQUIRE_MESSAGE(stream, stream.error().message);
    return {std::move(*out), *stream};
}

/// For each corner of the stream's slots, its vertex in the cut mesh.
Numbers corners_of(const Tables& surface, const Numbers& slots, const Numbers& joined, const Numbers& cut_indices) {
    Numbers out(slots.size(), UINT32_MAX);
    auto triangle = surface.encoded.triangle_order.begin();
    for (std::size_t k = 0; k < slots.size(); k += 3) {
        if (slots[k] == UINT32_MAX) continue;
        const std::size_t first = std::size_t{3} * *triangle++;
        for (std::size_t i = k; i < k + 3; ++i) {
            std::size_t c = first;
            while (joined[c] != surface.encoded.vertex_order[slots[i]]) ++c;
            REQUIRE(c < first + 3);
            out[i] = cut_indices[c];
        }
    }
    return out;
}

/// Counts the copies whose position differs from the first copy's of their vertex.
std::size_t apart(const CutMesh& mesh, const LatticePoints& points) {
    std::map<std::uint32_t, LatticePoint> place;
    std::size_t count = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        count += place.emplace(mesh.whole[i], points[i]).first->second != points[i] ? 1 : 0;
    }
    return count;
}

/// Checks the texture coordinates at the corners of every star: they name the star's vertex, and one chart per
/// triangle.
template <class View>
void check_texcoords(const LrStreamView<View>& tables, const StreamView& stream, const SeamView& seams,
                     const std::vector<std::array<std::uint32_t, 2>>& texcoords, const Numbers& whole) {
    const Operators ops(tables.view, tables.copies);
    CornerCopies copies(stream, seams);
    std::size_t corners = 0, wrong = 0;
    for (const VertexId v : IdRange<VertexTag>(stream.vertices())) {
        ops.star(v, [&](CornerId c) {
            const auto [chart, vertex] = texcoords[copies.copy(c)];
            wrong += vertex != whole[v.value] || chart != texcoords[copies.copy(ops.next(c))][0] ? 1 : 0;
            ++corners;
        });
    }
    CHECK_MESSAGE(wrong == 0, "texture coordinates name the star's vertex and one chart per triangle");
    CHECK_MESSAGE(corners == 3 * stream.triangles(), "the stars have all corners");
}

}  // namespace

TEST_CASE("a corner's copy at random access equals that of the decoded section") {
    std::uint32_t seed = 0;
    Seen seen;
    test::for_each_named_stream([&](const StreamView& stream) {
        check_copies(stream, seed % test::kCuts, seed, seen);
        ++seed;
    });
    CHECK(seen.redundant > 0);
    CHECK(seen.border > 0);
    CHECK(seen.flipped > 0);
    CHECK(seen.fans > 0);
}

TEST_CASE("a corner's copy is found in a section of more blocks than CornerCopies caches") {
    const Mesh mesh = generate("terrain", 12000).value();
    Seen seen;
    for (const Format format : {Format::lean, Format::packed, Format::lr, Format::lr_compact}) {
        const Tables tables = tables_of(mesh.indices, mesh.vertex_count, format);
        check_copies(tables.stream, 1, 1, seen);
    }
}

TEST_CASE("smoothing a cut mesh with the operators keeps the copies of a vertex together") {
    for (const char* kind : {"blob", "torus", "terrain"}) {
        const Mesh whole = generate(kind, 3000).value();
        LatticePoints points;
        const Positions positions = positions_of(whole);
        for (std::uint32_t v = 0; v < whole.vertex_count; ++v) {
            LatticePoint& p = points.emplace_back();
            for (std::size_t i = 0; i < 3; ++i) p[i] = std::llround(std::ldexp(positions[VertexId(v)][i], 20));
        }
        const CutMesh mesh = cut_into_octants(whole.indices, points);
        REQUIRE(mesh.points.size() > points.size() + 50);
        REQUIRE(apart(mesh, mesh.points) == 0);

        // The surface joins vertices of equal position.
        std::map<LatticePoint, std::uint32_t> numbers;
        LatticePoints surface_points;
        Numbers joined;
        for (const std::uint32_t i : mesh.indices) {
            const auto [found, is_new] = numbers.emplace(mesh.points[i], static_cast<std::uint32_t>(numbers.size()));
            joined.push_back(found->second);
            if (is_new) surface_points.push_back(mesh.points[i]);
        }
        REQUIRE(surface_points.size() == points.size());

        for (const Format format : {Format::lr, Format::lr_compact}) {
            CAPTURE(kind);
            CAPTURE(name_of(format));
            const Tables surface = tables_of(joined, surface_points.size(), format);
            const Numbers slots = slot_triangles(surface.stream);
            const Result<EncodedSeams> seams =
                encode_seams(slots, surface.stream.vertices(), corners_of(surface, slots, joined, mesh.indices));
            REQUIRE_MESSAGE(seams, seams.error().message);
            const Result<SeamView> view = validate_seams(seams->words, slots, surface.stream.vertices());
            REQUIRE_MESSAGE(view, view.error().message);
            REQUIRE(view->copies == mesh.points.size());

            const LatticePoints smoothed = smooth(surface.stream, surface.in_order(surface_points));
            Numbers vertices(view->copies);
            copy_vertices(*view, slots, vertices);
            LatticePoints expanded(view->copies);
            for (std::size_t i = 0; i < expanded.size(); ++i) expanded[seams->copy_order[i]] = smoothed[vertices[i]];
            CHECK(apart(mesh, expanded) == 0);
            const LatticePoints wanted = smooth(whole.indices, points);
            std::size_t wrong = 0;
            for (std::size_t i = 0; i < expanded.size(); ++i) wrong += expanded[i] != wanted[mesh.whole[i]] ? 1 : 0;
            CHECK(wrong == 0);

            std::vector<std::array<std::uint32_t, 2>> texcoords;
            for (const std::uint32_t old : seams->copy_order) texcoords.push_back(mesh.texcoords[old]);
            Numbers whole_of(surface.stream.vertices());
            for (std::size_t i = 0; i < vertices.size(); ++i) whole_of[vertices[i]] = texcoords[i][1];
            if (const auto* lr = surface.stream.get<LrStreamView<LrView>>()) {
                check_texcoords(*lr, surface.stream, *view, texcoords, whole_of);
            } else {
                check_texcoords(*surface.stream.get<LrStreamView<CompactLrView>>(), surface.stream, *view, texcoords,
                                whole_of);
            }

            // The cut mesh smoothed without its surface comes apart at the charts' borders.
            const Tables torn = tables_of(mesh.indices, mesh.points.size(), format);
            const LatticePoints alone = smooth(torn.stream, torn.in_order(mesh.points));
            LatticePoints torn_points(mesh.points.size());
            for (std::size_t v = alone.size(); v-- > 0;) torn_points[torn.encoded.vertex_order[v]] = alone[v];
            CHECK(apart(mesh, torn_points) > 50);
        }
    }
}
