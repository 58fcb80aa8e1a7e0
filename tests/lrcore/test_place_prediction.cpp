// Texture coordinates predicted from positions (docs/storage-format.md) take few bits and are restored bit for bit.
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <random>

#include "lacedring/vertices.hpp"
#include "lrcore/codec/storage/place_prediction.h"
#include "lrcore/codec/storage/vertex_storage.h"
#include "tests/support/capture.h"
#include "tests/support/check_stored_in_c.h"
#include "tests/support/damage.h"
#include "tests/support/meshes.h"

using namespace lacedring;
using storage::VertexPlaces;

namespace {

using Words = std::vector<std::uint32_t>;

/// One corner's prediction of one component as docs/storage-format.md defines it, for places that need no scaling.
std::uint32_t documented_prediction(const std::int32_t (&p)[4][3], const std::uint32_t (&values)[3]) {
    std::int64_t e[3], f[3], g[3], ee = 0, fe = 0, ge = 0;
    for (std::size_t c = 0; c < 3; ++c) {
        e[c] = p[1][c] - p[0][c];
        f[c] = p[3][c] - p[0][c];
        g[c] = p[2][c] - p[0][c];
        ee += e[c] * e[c];
        fe += f[c] * e[c];
        ge += g[c] * e[c];
    }
    const auto square = [&](const std::int64_t(&b)[3]) {
        double sum = 0;
        for (std::size_t c = 0; c < 3; ++c) {
            const std::size_t u = (c + 1) % 3, w = (c + 2) % 3;
            const double n = static_cast<float>(e[u] * b[w] - e[w] * b[u]);
            sum += n * n;
        }
        return sum;
    };
    const double height = square(g), most = 1 << 20;
    std::int64_t a = 65536, across = 65536;
    if (height > 0) {
        across = static_cast<std::int64_t>(std::min(std::floor(65536 * std::sqrt(square(f) / height) + 0.5), most));
        const auto along = static_cast<double>(65536 * fe + across * ge) / static_cast<double>(ee);
        a = static_cast<std::int64_t>(std::max(-most, std::min(std::trunc(along), most)));
    }
    const std::int64_t y = static_cast<std::int32_t>(values[1] - values[0]);
    const std::int64_t z = static_cast<std::int32_t>(values[2] - values[0]);
    const std::int64_t moved = a * y - across * z + 32768;
    return values[0] + static_cast<std::uint32_t>((moved - (moved & 65535)) / 65536);
}

/// A wavy sheet of unequal triangles, textured by its rotated projection to the ground. With a seam, the vertices of
/// the middle column have two copies.
struct Sheet {
    Words triangles, vertex_of, positions, texture;

    explicit Sheet(bool seam) {
        constexpr std::uint32_t kSide = 50, kMiddle = kSide / 2;
        std::mt19937 random(3);
        std::vector<float> coordinates;
        const auto add = [&](double x, double y) {
            coordinates.insert(coordinates.end(),
                               {static_cast<float>(0.004 * (x + 2 * y)), static_cast<float>(0.005 * (3 * y - x))});
        };
        std::vector<std::array<double, 2>> places;
        for (std::uint32_t i = 0; i < kSide * kSide; ++i) {
            const auto somewhat = [&] { return 0.0008 * static_cast<double>(random() % 1000); };
            const double x = i % kSide + somewhat(), y = i / kSide + somewhat();
            places.push_back({x, y});
            for (const double c : {x, y, 4 * std::sin(0.05 * x)})
                positions.push_back(static_cast<std::uint32_t>(static_cast<std::int32_t>(300 * c) - 5000));
            vertex_of.push_back(i);
            add(x, y);
        }
        for (std::uint32_t y = 0; seam && y < kSide; ++y) {
            vertex_of.push_back(kSide * y + kMiddle);
            add(places[vertex_of.back()][0] + 100, places[vertex_of.back()][1]);
        }
        for (std::uint32_t y = 0; y + 1 < kSide; ++y) {
            for (std::uint32_t x = 0; x + 1 < kSide; ++x) {
                const auto copy = [&](std::uint32_t i, std::uint32_t j) {
                    return seam && x >= kMiddle && i == kMiddle ? kSide * kSide + j : kSide * j + i;
                };
                const Words quad{copy(x, y),     copy(x + 1, y),     copy(x, y + 1),
                                 copy(x + 1, y), copy(x + 1, y + 1), copy(x, y + 1)};
                triangles.insert(triangles.end(), quad.begin(), quad.end());
            }
        }
        const VertexOptions options{.mapping = VertexMapping::lattice, .bits = 14};
        texture =
            encode_vertices({ComponentType::f32, 2, false, std::as_bytes(std::span(coordinates))}, options)->words;
        if (!seam) vertex_of.clear();
    }
    VertexPlaces where() const { return {positions, vertex_of}; }
};

}  // namespace

TEST_CASE("place prediction: as documented, for random places") {
    const std::uint32_t seed = std::random_device{}();
    CAPTURE(seed);
    std::mt19937 random(seed);
    for (std::uint32_t i = 0; i < 20000; ++i) {
        std::int32_t p[4][3];
        Words positions, values;
        const std::uint32_t bits = 1 + i % 20;
        for (auto& place : p) {
            for (std::int32_t& c : place) {
                c = static_cast<std::int32_t>(random() % (1U << bits));
                positions.push_back(static_cast<std::uint32_t>(c - 77));
            }
            for (int c = 0; c < 2; ++c) values.push_back(static_cast<std::uint32_t>(random()) >> i % 3 * 9);
        }
        const storage::PlacePrediction prediction({positions, {}});
        const storage::Parallelogram by{0, 1, 2};
        const auto found = prediction.predict(3, {by, by}, values);
        for (std::size_t c = 0; c < 2; ++c)
            CHECK(found[c] == documented_prediction(p, {values[c], values[2 + c], values[4 + c]}));
        const auto both = prediction.predict(3, {by, {1, 0, 2}}, values);
        const storage::Parallelogram turned{1, 0, 2};
        const auto other = prediction.predict(3, {turned, turned}, values);
        for (std::size_t c = 0; c < 2; ++c) {
            const auto apart = static_cast<std::int32_t>(other[c] - found[c]);
            CHECK(both[c] == found[c] + static_cast<std::uint32_t>((std::int64_t{apart} + 1) >> 1));
        }
    }
}

TEST_CASE("place prediction: texture coordinates take less, with and without seams") {
    for (const bool seam : {false, true}) {
        CAPTURE(seam);
        const Sheet sheet(seam);
        const VertexView view = *validate_vertices(sheet.texture);
        const Words without = storage::store_vertices(view, sheet.triangles).value();
        const Words with = test::check_stored_by_places(sheet.texture, sheet.triangles, sheet.where());
        CHECK(4 * with.size() < 3 * without.size());
    }
}

TEST_CASE("place prediction: damaged streams are refused or decode the same in C") {
    const Sheet sheet(true);
    const VertexView view = *validate_vertices(sheet.texture);
    const Words all = storage::store_vertices(view, sheet.triangles, sheet.where()).value();
    const auto use = [&](const Words& damaged, auto&) {
        test::check_damaged_in_c(damaged, sheet.triangles, view.vertices, 100000, sheet.where());
    };
    // Half of the damage goes to the raw bits of the header, after the words of symbols.
    test::for_each_damage(all, std::random_device{}(), test::kSanitized ? 100 : 400, use, {all[0] + 1, 8});
}
