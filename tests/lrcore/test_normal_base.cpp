// Compares the base of normals with docs/storage-format.md, and checks that differences from it restore the normals.
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <random>

#include "lacedring/vertices.hpp"
#include "lrcore/codec/storage/normal_base.h"
#include "lrcore/codec/storage/vertex_storage.h"
#include "tests/support/capture.h"
#include "tests/support/check_stored_in_c.h"
#include "tests/support/damage.h"
#include "tests/support/meshes.h"

using namespace lacedring;
using storage::NormalBase;
using storage::VertexPlaces;

namespace {

using Words = std::vector<std::uint32_t>;

constexpr NormalBase base_of(std::uint32_t i) {
    return {(i & 1) != 0, (i & 2) != 0, (i & 4) != 0};
}

/// The base as docs/storage-format.md defines it, computed triangle by triangle.
Words documented_base(const VertexPlaces& places, const Words& triangles, std::uint32_t copies, NormalBase base,
                      std::uint32_t bits) {
    const auto vertex = [&](std::uint32_t copy) { return places.vertex_of.empty() ? copy : places.vertex_of[copy]; };
    std::int64_t low[3] = {INT32_MAX, INT32_MAX, INT32_MAX}, extent = 0;
    const auto at = [&](std::size_t i) { return std::int64_t{static_cast<std::int32_t>(places.positions[i])}; };
    for (std::size_t i = 0; i < places.positions.size(); ++i) low[i % 3] = std::min(low[i % 3], at(i));
    for (std::size_t i = 0; i < places.positions.size(); ++i) extent = std::max(extent, at(i) - low[i % 3]);
    int shift = 0;
    while (extent >> shift >= 1 << 20) ++shift;
    std::vector<std::array<std::uint64_t, 3>> sums(std::max<std::size_t>(copies, places.positions.size() / 3));
    for (std::size_t t = 0; t < triangles.size(); t += 3) {
        std::int64_t p[3][3], normal[3];
        for (std::size_t k = 0; k < 3; ++k) {
            for (std::size_t c = 0; c < 3; ++c) p[k][c] = (at(3 * vertex(triangles[t + k]) + c) - low[c]) >> shift;
        }
        double square = 0;
        for (std::size_t c = 0; c < 3; ++c) {
            const std::size_t u = (c + 1) % 3, w = (c + 2) % 3;
            normal[c] = (p[1][u] - p[0][u]) * (p[2][w] - p[0][w]) - (p[1][w] - p[0][w]) * (p[2][u] - p[0][u]);
            const double rounded = static_cast<float>(normal[c]);
            square += rounded * rounded;
        }
        if (square == 0) continue;
        const double length = std::sqrt(square), by = 32768 / length;
        for (std::int64_t& n : normal) {
            if (!base.by_area) n = static_cast<std::int64_t>(static_cast<double>(n) * by);
        }
        for (std::size_t k = 0; k < 3; ++k) {
            std::int64_t cosine = 0, weight = 1;
            for (std::size_t c = 0; c < 3; ++c) cosine += (p[(k + 1) % 3][c] - p[k][c]) * (p[(k + 2) % 3][c] - p[k][c]);
            if (base.by_angle) {
                const auto x = static_cast<double>(cosine < 0 ? -cosine : cosine);
                const double tangent = std::floor(4096 * std::min(x, length) / std::max(x, length) + 0.5);
                weight = std::lround(std::atan(tangent / 4096) * 16384 / 3.14159265358979323846);
                if (x < length) weight = 8192 - weight;
                if (cosine < 0) weight = 16384 - weight;
            }
            const std::uint32_t copy = triangles[t + k];
            for (std::size_t c = 0; c < 3; ++c)
                sums[base.of_vertex ? vertex(copy) : copy][c] += static_cast<std::uint64_t>(normal[c] * weight);
        }
    }
    Words out;
    const std::int64_t most = (1 << (bits - 1)) - 1;
    for (std::uint32_t copy = 0; copy < copies; ++copy) {
        std::uint64_t size[3], any = 0;
        bool negative[3];
        for (std::size_t c = 0; c < 3; ++c) {
            const std::uint64_t s = sums[base.of_vertex ? vertex(copy) : copy][c];
            negative[c] = s >> 63 != 0;
            any |= size[c] = negative[c] ? 0 - s : s;
        }
        while (any >> 32 != 0) {
            any >>= 1;
            for (std::uint64_t& s : size) s >>= 1;
        }
        const std::uint64_t sum = size[0] + size[1] + size[2];
        std::int64_t x[2] = {0, 0};
        for (std::size_t c = 0; c < 2 && sum != 0; ++c) {
            const auto part = static_cast<double>(static_cast<std::uint64_t>(most) * size[c]);
            x[c] = static_cast<std::int64_t>(part / static_cast<double>(sum) + 0.5);
        }
        if (negative[2]) {
            std::swap(x[0], x[1]);
            for (std::int64_t& i : x) i = most - i;
        }
        for (std::size_t c = 0; c < 2; ++c) out.push_back(static_cast<std::uint32_t>(negative[c] ? -x[c] : x[c]));
    }
    return out;
}

/// Two wavy sheets with known normals, the second facing down. With a seam, the vertices of the middle column have two
/// copies.
struct Waves {
    Words triangles, vertex_of, positions, normals;
    std::uint32_t vertices = 0;

    explicit Waves(bool seam) {
        constexpr std::uint32_t kSide = 40;
        std::vector<float> places, directions;
        const auto add = [&](std::uint32_t x, std::uint32_t y, double up) {
            const double u = 0.1 * x, v = 0.13 * y;
            places.insert(places.end(), {static_cast<float>(u), static_cast<float>(v),
                                         static_cast<float>(std::sin(u) * std::cos(v) - 2 * up)});
        };
        const auto add_normal = [&](std::uint32_t x, std::uint32_t y, double up) {
            const double u = 0.1 * x, v = 0.13 * y;
            directions.insert(directions.end(),
                              {static_cast<float>(-up * std::cos(u) * std::cos(v)),
                               static_cast<float>(up * std::sin(u) * std::sin(v)), static_cast<float>(up)});
        };
        for (const double up : {1.0, -1.0}) {
            const std::uint32_t first = vertices, first_copy = static_cast<std::uint32_t>(vertex_of.size());
            for (std::uint32_t i = 0; i < kSide * kSide; ++i, ++vertices) {
                add(i % kSide, i / kSide, up);
                add_normal(i % kSide, i / kSide, up);
                vertex_of.push_back(first + i);
            }
            const auto second_copy = static_cast<std::uint32_t>(vertex_of.size());
            for (std::uint32_t y = 0; seam && y < kSide; ++y) {
                add_normal(kSide / 2, y, up);
                vertex_of.push_back(first + kSide * y + kSide / 2);
            }
            for (std::uint32_t y = 0; y + 1 < kSide; ++y) {
                for (std::uint32_t x = 0; x + 1 < kSide; ++x) {
                    const auto copy = [&](std::uint32_t i, std::uint32_t j) {
                        return seam && x >= kSide / 2 && i == kSide / 2 ? second_copy + j : first_copy + kSide * j + i;
                    };
                    Words quad{copy(x, y),     copy(x + 1, y),     copy(x, y + 1),
                               copy(x + 1, y), copy(x + 1, y + 1), copy(x, y + 1)};
                    if (up < 0) std::reverse(quad.begin(), quad.end());
                    triangles.insert(triangles.end(), quad.begin(), quad.end());
                }
            }
        }
        const auto encode = [](const std::vector<float>& values, VertexMapping mapping, std::uint32_t bits) {
            const VertexOptions options{.mapping = mapping, .bits = bits};
            return encode_vertices({ComponentType::f32, 3, false, std::as_bytes(std::span(values))}, options)->words;
        };
        const VertexView lattice = *view_vertices(place_words = encode(places, VertexMapping::lattice, 16));
        positions.resize(std::size_t{3} * vertices);
        for (std::uint32_t b = 0; b < lattice.blocks(); ++b)
            decode_vertex_block(lattice, b, std::span(positions).subspan(std::size_t{3} * kVertexBlock * b));
        normals = encode(directions, VertexMapping::octahedral, 10);
        if (!seam) vertex_of.clear();
    }
    VertexPlaces where() const { return {positions, vertex_of}; }

  private:
    Words place_words;
};

}  // namespace

TEST_CASE("normal base: as documented, for random triangles and positions") {
    const std::uint32_t seed = std::random_device{}();
    CAPTURE(seed);
    std::mt19937 random(seed);
    for (std::uint32_t i = 0; i < 64; ++i) {
        CAPTURE(i);
        const std::uint32_t vertices = 1 + static_cast<std::uint32_t>(random()) % 60, copies = vertices + i % 2 * 20;
        Words positions(std::size_t{3} * vertices), triangles(300), vertex_of;
        for (std::uint32_t& p : positions)
            p = (static_cast<std::uint32_t>(random()) >> (i / 8 * 4)) - (i % 3 == 0 ? 1000 : 0);
        for (std::uint32_t& t : triangles) t = static_cast<std::uint32_t>(random()) % copies;
        for (std::uint32_t c = 0; i % 2 != 0 && c < copies; ++c)
            vertex_of.push_back(static_cast<std::uint32_t>(random()) % vertices);
        const VertexPlaces places{positions, vertex_of};
        REQUIRE(storage::has_places(places, copies));
        CHECK_FALSE(storage::has_places(places, copies + 1));
        const std::uint32_t bits = 2 + i % 15;
        const Words base = storage::surface_normals(places, triangles, copies, base_of(i % 8), bits);
        CHECK(base == documented_base(places, triangles, copies, base_of(i % 8), bits));
    }
    const Words positions(9), outside{0, 3};
    CHECK_FALSE(storage::has_places({positions, outside}, 2));
    CHECK_FALSE(storage::has_places({}, 2));
    CHECK(storage::surface_normals({}, {}, 0, {}, 8).empty());
}

TEST_CASE("normal base: adding a difference restores every point from every base") {
    for (const std::uint32_t bits : {2U, 3U, 4U}) {
        const std::int32_t most = (1 << (bits - 1)) - 1;
        Words points;
        for (std::int32_t i = 0; i < (2 * most + 1) * (2 * most + 1); ++i) {
            points.push_back(static_cast<std::uint32_t>(i % (2 * most + 1) - most));
            points.push_back(static_cast<std::uint32_t>(i / (2 * most + 1) - most));
        }
        for (std::size_t b = 0; b < points.size(); b += 2) {
            Words base, values = points;
            for (std::size_t i = 0; i < points.size(); i += 2) base.insert(base.end(), {points[b], points[b + 1]});
            storage::subtract_normals(values, base, bits);
            storage::add_normals(values, base, bits);
            CHECK(values == points);
        }
    }
    // Words of a damaged stream may be any, but cause no signed overflow.
    Words wild{0x80000000U, 0x7fffffffU, UINT32_MAX, 0x80000000U};
    storage::add_normals(wild, Words{511, 511, 0, 0}, 10);
}

TEST_CASE("normal base: normals of a surface take less, with and without seams") {
    for (const bool seam : {false, true}) {
        CAPTURE(seam);
        const Waves waves(seam);
        const VertexView view = *validate_vertices(waves.normals);
        const Words without = storage::store_vertices(view, waves.triangles).value();
        const Words with = test::check_stored_by_places(waves.normals, waves.triangles, waves.where());
        CHECK(3 * with.size() < 2 * without.size());
        // Normals stored without a base are restored without positions; positions that are given are ignored.
        CHECK(storage::restore_vertices(without, waves.triangles, view.vertices, 1 << 20, waves.where()));
    }
}

TEST_CASE("normal base: damaged streams are refused or decode the same in C") {
    const Waves waves(true);
    const VertexView view = *validate_vertices(waves.normals);
    const Words all = storage::store_vertices(view, waves.triangles, waves.where()).value();
    const auto use = [&](const Words& damaged, auto&) {
        test::check_damaged_in_c(damaged, waves.triangles, view.vertices, 100000, waves.where());
    };
    // Half of the damage goes to the raw bits of the header, after the words of symbols.
    test::for_each_damage(all, std::random_device{}(), test::kSanitized ? 100 : 400, use, {all[0] + 1, 8});
}
