// Compares shaders/include/lacedring_operators.glsl with Operators at every corner and vertex, and the normals that it
// computes with the corner table's.

#include <cstdint>
#include <random>

#include "lacedring/operators.hpp"
#include "shaders/include/lacedring_operators.glsl"
#include "spirv/operators_table_comp.h"
#include "tests/gpu/adjacency_test.h"

using namespace lacedring;
using namespace lacedring::test;

static_assert(LR_TABLE_TIP == word::kTip && LR_TABLE_WART == word::kWart && LR_TABLE_IRREGULAR == word::kIrregular &&
              LR_TABLE_FLIP == word::kFlip && LR_TABLE_SPECIAL == word::kSpecial && LR_TABLE_T0_FLIP == word::kT0Flip);
static_assert(LR_TABLE_REDUNDANT == word::kRedundant && LR_TABLE_BORDER == word::kBorder &&
              LR_TABLE_CLOSING == word::kClosing && LR_TABLE_KIND == word::kKind &&
              LR_TABLE_HEADER_WORDS == kLrHeaderWords && LR_TABLE_NULL == kNullCorner.value);

namespace {

struct OperatorTest : AdjacencyTest {
    OperatorTest()
        : at_corners(pipeline(spirv_operators_table_comp, 0)), at_vertices(pipeline(spirv_operators_table_comp, 1)) {}

    /// Counts the device's results, computed from `words`, that differ from those of Operators on `view`.
    std::size_t differences(std::span<const std::uint32_t> words, const LrView& view) {
        const Operators<LrView> ops(view);
        const gpu::Buffer tables = buffer(words);
        constexpr std::uint32_t kBatch = 1U << 18, kResults = 10;
        const std::uint32_t corners = 4 * view.triangle_numbers();
        const gpu::Buffer results = buffer(std::size_t{4} * kResults * std::min(kBatch, corners));
        std::size_t wrong = 0;
        for (std::uint32_t first = 0; first < corners; first += kBatch) {
            const std::uint32_t push[2] = {first, std::min(corners, first + kBatch)};
            run(at_corners, {&tables, &results, &tables, &results}, push, sizeof(push), push[1] - first);
            const auto got = read<std::uint32_t>(results, std::size_t{kResults} * (push[1] - first));
            for (std::uint32_t i = first; i < push[1]; ++i) {
                if (i % 4 == 3) continue;
                const CornerId c{i};
                const std::uint32_t expected[kResults] = {
                    ops.next(c).value,       ops.previous(c).value,
                    ops.vertex(c).value,     ops.canonical(c).value,
                    ops.opposite(c).value,   ops.left(c).value,
                    ops.right(c).value,      ops.swing(c).value,
                    ops.swing_back(c).value, ops.is_canonical(ops.triangle(c)) ? 1U : 0U};
                for (std::size_t k = 0; k < kResults; ++k) {
                    wrong += got[std::size_t{kResults} * (i - first) + k] != expected[k] ? 1 : 0;
                }
            }
            measured.corners += (push[1] - first) / 4 * 3;
        }
        for (std::uint32_t first = 0; first < view.vertices; first += kBatch) {
            const std::uint32_t push[2] = {first, std::min(view.vertices, first + kBatch)};
            std::vector<std::uint32_t> begins{0}, neighbors, expected;
            for (std::uint32_t v = first; v < push[1]; ++v) {
                CornerId star = kNullCorner;
                ops.star(VertexId{v}, [&](CornerId c) { star = star.is_null() ? c : star; });
                ops.neighbors(VertexId{v}, [&](VertexId u) { neighbors.push_back(u.value); });
                begins.push_back(static_cast<std::uint32_t>(neighbors.size()));
                const std::uint32_t valence = ops.valence(VertexId{v});
                expected.insert(expected.end(), {ops.corner(VertexId{v}).value, star.value, valence, valence});
            }
            const gpu::Buffer out = buffer(4 * expected.size()), starts = buffer(begins),
                              found = buffer(4 * neighbors.size());
            run(at_vertices, {&tables, &out, &starts, &found}, push, sizeof(push), push[1] - first);
            const auto got = read<std::uint32_t>(out, expected.size());
            const auto got_neighbors = read<std::uint32_t>(found, neighbors.size());
            for (std::size_t i = 0; i < got.size(); ++i) wrong += got[i] != expected[i] ? 1 : 0;
            for (std::size_t i = 0; i < neighbors.size(); ++i) wrong += got_neighbors[i] != neighbors[i] ? 1 : 0;
        }
        measured.vertices += view.vertices;
        ++measured.meshes;
        return wrong;
    }

    gpu::PipelineHandle at_corners, at_vertices;
};

}  // namespace

TEST_CASE_FIXTURE(OperatorTest, "operators in shaders equal the CPU's at every corner and vertex") {
    every_mesh([&](const Mesh& mesh, std::uint32_t) {
        for (const bool warts : {true, false}) {
            const auto tables = tables_of(mesh, {}, warts);
            if (tables == nullptr) continue;
            CHECK(differences(tables->encoded.words, tables->view) == 0);
        }
    });
    MESSAGE(measured.meshes, " tables, ", measured.corners, " corners, ", measured.vertices, " vertices");
}

TEST_CASE_FIXTURE(OperatorTest, "the comparison finds a wrong word in the tables") {
    const auto tables = tables_of(generated("genus", 2000), {}, true);
    CHECK(tables->encoded.words[LR_TABLE_WORD_MAGIC] == LR_TABLE_MAGIC);
    CHECK(tables->encoded.words[LR_TABLE_WORD_VERSION] == LR_TABLE_VERSION);
    CHECK(differences(tables->encoded.words, tables->view) == 0);
    std::mt19937 random(5);
    const std::size_t last = kLrHeaderWords + tables->view.references();
    for (std::size_t i = 0; i < 20; ++i) {
        std::vector<std::uint32_t> words = tables->encoded.words;
        const std::size_t at = kLrHeaderWords + random() % (last - kLrHeaderWords);
        // Changes a bit of a tip or a reference. No operator reads the flip bit.
        words[at] ^= 1U << random() % 10;
        CAPTURE(at);
        CHECK(differences(words, tables->view) > 0);
    }
}

TEST_CASE_FIXTURE(OperatorTest, "operators terminate on random tables") {
    const auto tables = tables_of(generated("blob", 2000), {}, true);
    std::mt19937 random(7);
    for (const std::uint32_t mask : {UINT32_MAX, 0x7ffU, 0xf00007ffU}) {
        std::vector<std::uint32_t> words = tables->encoded.words;
        for (std::size_t i = kLrHeaderWords; i < words.size(); ++i)
            words[i] = static_cast<std::uint32_t>(random()) & mask;
        const std::uint32_t corners[2] = {0, 4 * tables->view.triangle_numbers()},
                            vertices[2] = {0, tables->view.vertices};
        const gpu::Buffer stream = buffer(words), out = buffer(std::size_t{40} * corners[1]),
                          begins = buffer(std::vector<std::uint32_t>(vertices[1] + 1));
        run(at_corners, {&stream, &out, &stream, &out}, corners, sizeof(corners), corners[1]);
        run(at_vertices, {&stream, &out, &begins, &out}, vertices, sizeof(vertices), vertices[1]);
    }
}

namespace {

/// Normals with more cancellation than this factor are not compared. The device computes with about 46 bits, the CPU
/// with 53, and cancellation by 2^n loses n of them; from n = 28 the device's error may reach 1e-5. In all meshes
/// tested, no n is between 20 and 54: the excluded sums are zero, and their directions are rounding errors on the CPU,
/// too.
constexpr double kMostCanceled = 1 << 28;

struct NormalTest : AdjacencyTest {
    NormalTest() {
        auto made = gpu::VertexNormals::create(*context);
        REQUIRE(made);
        normals = std::move(*made);
    }

    /// For each vertex of the corner table, the cancellation in the sum of its triangles' cross products: the size of
    /// the terms divided by the size of the sum. Infinite if the sum is zero.
    static std::vector<double> canceled(const Tables& tables) {
        const CornerTable& table = tables.table;
        const Positions positions{std::span<const float>(tables.positions)};
        std::vector<Point3> sums(table.vertex_count);
        std::vector<double> products(table.vertex_count);
        for (std::uint32_t t = 0; t < table.triangle_count(); ++t) {
            Point3 p[3];
            for (std::uint32_t k = 0; k < 3; ++k) p[k] = positions[table.vertex(corner(TriangleId{t}, k))];
            const Point3 n = cross(minus(p[1], p[0]), minus(p[2], p[0]));
            double longest = 0;
            for (std::size_t k = 0; k < 3; ++k) longest = std::max(longest, length(minus(p[k], p[(k + 1) % 3])));
            for (std::uint32_t k = 0; k < 3; ++k) {
                const std::uint32_t v = table.vertex(corner(TriangleId{t}, k)).value;
                for (std::size_t i = 0; i < 3; ++i) sums[v][i] += n[i];
                products[v] += longest * longest;
            }
        }
        for (std::uint32_t v = 0; v < table.vertex_count; ++v) {
            if (products[v] > 0) products[v] /= length(sums[v]);
        }
        return products;
    }

    void check(const Tables& tables) {
        const auto adjacency = gpu::upload_adjacency(*context, *transfer, tables.encoded, tables.positions);
        REQUIRE_MESSAGE(adjacency, adjacency.error().message);
        const auto made = normals.compute(*commands, *adjacency);
        REQUIRE_MESSAGE(made, made.error().message);
        const auto got = read<float>(*made, std::size_t{3} * adjacency->vertices);
        const std::vector<float> expected =
            vertex_normals(tables.table, Positions{std::span<const float>(tables.positions)});
        const std::vector<double> lost = canceled(tables);
        for (std::uint32_t v = 0; v < adjacency->vertices; ++v) {
            const std::size_t u = tables.map.vertex[v].value;
            Point3 a{}, b{};
            for (std::size_t i = 0; i < 3; ++i) {
                a[i] = got[3 * std::size_t{v} + i];
                b[i] = expected[3 * u + i];
            }
            if (std::abs(length(a) - 1) > 1e-6) REQUIRE(length(a) == doctest::Approx(1));
            ++measured.vertices;
            const double error = length(minus(a, b));
            if (!(lost[u] <= kMostCanceled)) {
                ++measured.excluded;
                measured.rounded += std::isfinite(lost[u]) ? 1 : 0;
                continue;
            }
            measured.worst = std::max(measured.worst, error);
            if (error > 1e-5) CHECK_MESSAGE(error <= 1e-5, "vertex ", v, " canceled ", lost[u]);
        }
        ++measured.meshes;
    }

    gpu::VertexNormals normals;
};

}  // namespace

TEST_CASE_FIXTURE(NormalTest, "normals that the device computes from tables and positions equal the CPU's") {
    every_mesh([&](const Mesh& mesh, std::uint32_t seed) {
        std::vector<float> positions = model_positions(mesh);
        if (positions.empty()) return;
        const auto tables = tables_of(mesh, std::move(positions), seed % 2 == 1);
        if (tables != nullptr) check(*tables);
    });
    CHECK(measured.excluded * 100 < measured.vertices);
    MESSAGE(measured.meshes, " meshes, ", measured.vertices, " vertices; ", measured.excluded,
            " canceled and not compared, of which ", measured.rounded, " not exactly zero; worst ", measured.worst);
}
