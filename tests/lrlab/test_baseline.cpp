// Limits of meshoptimizer's orders and meshlets.

#include <doctest/doctest.h>

#include <limits>

#include "lrlab/generate/generate.h"
#include "lrlab/rivals/codecs.h"
#include "lrlab/rivals/limit.h"
#include "lrlab/rivals/strips.h"
#include "tests/support/meshes.h"

using namespace lacedring;

namespace {

std::vector<std::uint32_t> fan(std::uint32_t triangles) {
    std::vector<std::uint32_t> out;
    for (std::uint32_t i = 0; i < triangles; ++i) out.insert(out.end(), {0, i + 1, i + 2});
    return out;
}

template <class T>
void check_too_large(const Result<T>& result) {
    REQUIRE_FALSE(result);
    CHECK(result.error().code == ErrorCode::too_large);
}

}  // namespace

TEST_CASE("valences are counted") {
    const Valences valences = count_valences(fan(10), 12);
    CHECK(valences.triangles == 10);
    CHECK(valences.most == 10);
    CHECK(valences.squares == 10 * 10 + 9 * 2 * 2 + 2);
    CHECK(count_valences({}, 5).squares == 0);
}

TEST_CASE("meshoptimizer's orders are left out if a vertex has too many triangles") {
    const std::uint32_t many = 3000;
    const std::vector<std::uint32_t> hub = fan(many);
    const std::vector<float> positions(std::size_t{3} * (many + 2), 1.0F);
    check_too_large(check_valences(hub, many + 2));
    check_too_large(make_strips(hub, many + 2));
    check_too_large(make_restart_strip(hub, many + 2));
    check_too_large(best_cache_order(hub, many + 2));
    check_too_large(encode_meshopt_indices(hub, many + 2));
    check_too_large(make_meshlets(hub, positions));
    const std::vector<std::uint32_t> few = fan(1500);
    CHECK(make_strips(few, 1502));
    CHECK(best_cache_order(few, 1502));
    CHECK(encode_meshopt_indices(few, 1502));
    CHECK(make_strips({}, 0));
    for (const char* kind : {"sphere", "torus", "genus", "terrain", "blob", "parts", "moebius", "soup"}) {
        CAPTURE(kind);
        const Mesh mesh = generate(kind, 100000, 1).value();
        CHECK(count_valences(mesh.indices, mesh.vertex_count).squares < 48 * mesh.triangle_count());
        CHECK(check_valences(mesh.indices, mesh.vertex_count));
        CHECK(check_places(mesh.indices, positions_f32(mesh)));
    }
}

TEST_CASE("meshlets are left out if too many unconnected triangles are at one position") {
    std::vector<std::uint32_t> indices(std::size_t{3} * 5000);
    std::vector<float> piled, apart;
    for (std::uint32_t i = 0; i < indices.size(); ++i) {
        indices[i] = i;
        piled.insert(piled.end(), {i % 3 == 1 ? 1.0F : 0.0F, i % 3 == 2 ? 1.0F : 0.0F, 0.0F});
        apart.insert(apart.end(), {static_cast<float>(i), i % 3 == 2 ? 1.0F : 0.0F, 0.0F});
    }
    check_too_large(make_meshlets(indices, piled));
    CHECK(make_meshlets(indices, apart));
    // In one component the next triangle is a neighbor, which needs no spatial search.
    std::vector<std::uint32_t> strip;
    for (std::uint32_t i = 0; i < 5000; ++i) strip.insert(strip.end(), {i, i + 1, i + 2});
    CHECK(make_meshlets(strip, std::vector<float>(std::size_t{3} * 5002, 0.0F)));
}

TEST_CASE("meshlets of huge coordinates equal those of small ones") {
    const Mesh mesh = generate("blob", 3000, 2).value();
    const std::vector<float> positions = positions_f32(mesh);
    const Result<Meshlets> small = make_meshlets(mesh.indices, positions);
    REQUIRE(small);
    CHECK(small->indices.size() == mesh.indices.size());
    for (const float scale : {0x1p20F, 0x1p40F, 0x1p66F, 0x1p100F, 0x1p120F}) {
        CAPTURE(scale);
        std::vector<float> scaled = positions;
        for (float& x : scaled) x *= scale;
        const Result<Meshlets> large = make_meshlets(mesh.indices, scaled);
        REQUIRE(large);
        CHECK(test::oriented_triangles(large->indices) == test::oriented_triangles(mesh.indices));
        CHECK(large->bytes == small->bytes);
    }
    const std::vector<float> infinite(
        positions.size(),
        std::numeric_limits<float>::infinity());  // like doubles beyond the range of floats
    const Result<Meshlets> beyond = make_meshlets(mesh.indices, infinite);
    CHECK((!beyond || beyond->indices.size() == mesh.indices.size()));
}
