// The storage form of vertex streams restores every stream bit for bit; damaged words are refused or decode the same in
// C.
#include <doctest/doctest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <memory>
#include <random>

#include "lacedring/vertices.hpp"
#include "lrcore/base/crc32.h"
#include "lrcore/codec/storage/vertex_storage.h"
#include "lrcore/codec/storage/vertex_walk.h"
#include "tests/support/capture.h"
#include "tests/support/check_stored_in_c.h"
#include "tests/support/damage.h"
#include "tests/support/meshes.h"

using namespace lacedring;

namespace {

using Words = std::vector<std::uint32_t>;
using Bytes = std::vector<std::byte>;

template <class T>
Bytes storage_bytes(const std::vector<T>& values) {
    const auto bytes = std::as_bytes(std::span(values));
    return {bytes.begin(), bytes.end()};
}

/// Stores a stream and returns the words. Checks that they restore the stream, but not with a limit of fewer words, and
/// that C decodes them. Buffers have exactly their size.
Words stored(const Words& stream, std::span<const std::uint32_t> triangles) {
    const Result<VertexView> view = validate_vertices(stream);
    REQUIRE_MESSAGE(view, view.error().message);
    const auto out = storage::store_vertices(*view, triangles);
    REQUIRE(out);
    const auto exact = std::make_unique<std::uint32_t[]>(out->size());
    std::copy(out->begin(), out->end(), exact.get());
    const auto back = storage::restore_vertices({exact.get(), out->size()}, triangles, view->vertices, stream.size());
    REQUIRE_MESSAGE(back, back.error().message);
    CHECK_MESSAGE(*back == stream, "the stored form restores the stream");
    const auto small =
        storage::restore_vertices({exact.get(), out->size()}, triangles, view->vertices, stream.size() - 1);
    REQUIRE_FALSE(small);
    CHECK(small.error().code == ErrorCode::memory_limit);
    test::check_in_c(*out, triangles, *view);
    return *out;
}

Words encoded(const VertexValues& values, const VertexOptions& options) {
    const Result<EncodedVertices> out = encode_vertices(values, options);
    REQUIRE_MESSAGE(out, out.error().message);
    return out->words;
}

/// A kind of attribute. Its values are smooth with some noise, and some are random bits.
struct Kind {
    ComponentType type;
    std::uint8_t components;
    VertexMapping mapping;
    std::uint32_t bits;
    bool normalized = false;
};
constexpr Kind kAttributes[] = {
    {ComponentType::f32, 3, VertexMapping::lattice, 14},      {ComponentType::f32, 3, VertexMapping::lattice, 22},
    {ComponentType::f64, 3, VertexMapping::lattice, 10},      {ComponentType::f32, 2, VertexMapping::lattice, 12},
    {ComponentType::f32, 3, VertexMapping::octahedral, 10},   {ComponentType::f32, 4, VertexMapping::octahedral, 8},
    {ComponentType::f32, 3, VertexMapping::floats, 0},        {ComponentType::f32, 1, VertexMapping::floats, 0},
    {ComponentType::f64, 3, VertexMapping::doubles, 0},       {ComponentType::f64, 8, VertexMapping::doubles, 0},
    {ComponentType::u8, 4, VertexMapping::integers, 0, true}, {ComponentType::i8, 1, VertexMapping::integers, 0},
    {ComponentType::i16, 2, VertexMapping::integers, 0},      {ComponentType::u16, 5, VertexMapping::integers, 0},
    {ComponentType::i32, 3, VertexMapping::integers, 0},      {ComponentType::u32, 16, VertexMapping::integers, 0},
};

Bytes values_of(const Kind& a, std::uint32_t vertices, std::uint32_t seed) {
    std::mt19937 random(seed);
    Bytes out(std::size_t{vertices} * a.components * size_of(a.type));
    std::vector<double> at(a.components, 0);
    for (std::uint32_t v = 0; v < vertices; ++v) {
        const bool jumps = random() % 50 == 0, stays = random() % 3 == 0;
        double length = 0;
        for (std::uint32_t c = 0; c < a.components; ++c) {
            if (!stays) at[c] += static_cast<double>(random() % 2001) / 1000 - 1;
            if (jumps) at[c] = static_cast<double>(random() % 200000) / 10 - 10000;
            length += at[c] * at[c];
        }
        for (std::uint32_t c = 0; c < a.components; ++c) {
            std::byte* to = out.data() + (std::size_t{v} * a.components + c) * size_of(a.type);
            double x = at[c];
            if (a.mapping == VertexMapping::octahedral) {
                x = length > 0 ? x / std::sqrt(length) : c == 0 ? 1 : 0;
                if (c == 3) x = at[c] < 0 ? -1 : 1;
            }
            if (a.type == ComponentType::f32) {
                auto f = static_cast<float>(x);
                // Random bits, some of them NaNs, where floats are stored unmapped.
                if (a.mapping == VertexMapping::floats && random() % 40 == 0)
                    f = std::bit_cast<float>(static_cast<std::uint32_t>(random()));
                std::memcpy(to, &f, 4);
            } else if (a.type == ComponentType::f64) {
                std::memcpy(to, &x, 8);
            } else {
                const std::uint32_t integer = random() % 60 == 0 ? static_cast<std::uint32_t>(random())
                                                                 : static_cast<std::uint32_t>(std::int64_t(x * 4));
                std::memcpy(to, &integer, size_of(a.type));
            }
        }
    }
    return out;
}

Words stream_of(const Kind& a, std::uint32_t vertices, std::uint32_t seed) {
    VertexOptions options;
    options.mapping = a.mapping;
    options.bits = a.bits;
    const Bytes values = values_of(a, vertices, seed);
    return encoded({a.type, a.components, a.normalized, values}, options);
}

void mend_checksum(Words& stream) {
    const std::uint32_t header = crc32(std::as_bytes(std::span(stream).first(3)));
    stream[3] = crc32(std::as_bytes(std::span(stream).subspan(4)), header);
}

/// Triangles of a grid of width * height vertices.
Words grid_triangles(std::uint32_t width, std::uint32_t height) {
    Words out;
    for (std::uint32_t y = 0; y + 1 < height; ++y) {
        for (std::uint32_t x = 0; x + 1 < width; ++x) {
            const std::uint32_t a = y * width + x, b = a + 1, c = a + width, d = c + 1;
            out.insert(out.end(), {a, b, c, b, d, c});
        }
    }
    return out;
}

}  // namespace

TEST_CASE("vertex storage: opposite_corners joins consecutive triangles first, then by edge and corner") {
    for (const test::NamedMesh& named : test::named_meshes()) {
        const auto& name = named.name;
        const Mesh& mesh = named.mesh;
        CAPTURE(name);
        const auto& t = mesh.indices;
        const Words opposite = storage::opposite_corners(t, mesh.vertex_count);
        REQUIRE(opposite.size() == t.size());
        const auto edge = [&](std::uint32_t c) {
            const std::uint32_t f = c / 3 * 3, x = t[f + (c + 1) % 3], y = t[f + (c + 2) % 3];
            return std::pair(std::min(x, y), std::max(x, y));
        };
        std::vector<std::pair<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t>> all;
        for (std::uint32_t c = 0; c < t.size(); ++c) {
            const std::uint32_t f = c / 3 * 3;
            if (t[f] == t[f + 1] || t[f + 1] == t[f + 2] || t[f + 2] == t[f]) {
                CHECK(opposite[c] == storage::kNone);
            } else {
                all.push_back({edge(c), c});
            }
        }
        // First joins consecutive triangles that share two vertices, then the remaining corners of an edge in order.
        Words expected(t.size(), storage::kNone);
        const auto join = [&](std::uint32_t a, std::uint32_t b) {
            expected[a] = b;
            expected[b] = a;
        };
        for (std::size_t i = 0; i < all.size(); ++i) {
            for (std::size_t j = i < 5 ? 0 : i - 5; j < i; ++j) {
                const auto [a, b] = std::pair(all[j], all[i]);
                std::uint32_t vertices = 0;  // shared by both triangles
                for (std::uint32_t k = 0; k < 9; ++k)
                    vertices += t[a.second / 3 * 3 + k / 3] == t[b.second / 3 * 3 + k % 3];
                if (a.first == b.first && b.second / 3 == a.second / 3 + 1 && vertices == 2 &&
                    expected[a.second] == storage::kNone)
                    join(a.second, b.second);
            }
        }
        std::erase_if(all, [&](const auto& a) { return expected[a.second] != storage::kNone; });
        std::sort(all.begin(), all.end());
        for (std::size_t i = 0; i + 1 < all.size(); ++i) {
            if (all[i].first != all[i + 1].first) continue;
            join(all[i].second, all[i + 1].second);
            ++i;
        }
        CHECK(opposite == expected);
    }
}

TEST_CASE("vertex storage: a walk visits each vertex once, predicted from visited vertices") {
    struct Visitor {
        const Mesh& mesh;
        std::vector<bool> known;
        std::uint32_t visited = 0, predictions = 0;

        void learn(std::uint32_t v) {
            CHECK_FALSE(known[v]);
            known[v] = true;
            ++visited;
        }
        void start(std::uint32_t v, std::uint32_t from) {
            if (from != storage::kNone) CHECK(known[from]);
            learn(v);
        }
        void predicted(std::uint32_t v, const storage::Parallelograms& by) {
            for (const auto& [x, y, z] : by) CHECK((known[x] && known[y] && known[z]));
            learn(v);
            ++predictions;
        }
    };
    for (const test::NamedMesh& named : test::named_meshes()) {
        const auto& name = named.name;
        const Mesh& mesh = named.mesh;
        CAPTURE(name);
        Visitor visitor{mesh, std::vector<bool>(mesh.vertex_count)};
        storage::VertexWalk(mesh.indices, mesh.vertex_count).run(visitor);
        CHECK(visitor.visited == mesh.vertex_count);
    }
}

TEST_CASE("vertex storage: round trip of every mapping on every topology") {
    const std::uint32_t seed = std::random_device{}();
    CAPTURE(seed);
    std::uint32_t i = 0;
    for (const test::NamedMesh& named : test::named_meshes()) {
        const auto& name = named.name;
        const Mesh& mesh = named.mesh;
        if (mesh.vertex_count > 1200 && i % 8 != 0 && test::kSanitized) continue;
        CAPTURE(name);
        stored(stream_of(kAttributes[0], mesh.vertex_count, seed + i), mesh.indices);
        const Kind& other = kAttributes[i++ % std::size(kAttributes)];
        CAPTURE(i);
        stored(stream_of(other, mesh.vertex_count, seed + i), mesh.indices);
    }
}

TEST_CASE("vertex storage: round trip of numbers of vertices around a block, and of every component count") {
    for (const std::uint32_t vertices : {0U, 1U, 2U, 5U, 128U, 129U, 130U, 2049U}) {
        CAPTURE(vertices);
        for (const Kind& a : kAttributes) {
            CAPTURE(static_cast<int>(a.mapping));
            const Words stream = stream_of(a, vertices, 7);
            stored(stream, {});
            Words strip;
            for (std::uint32_t v = 2; v + 10 < vertices; ++v) strip.insert(strip.end(), {v - 2, v - 1, v});
            stored(stream, strip);  // the last vertices are isolated
        }
    }
}

TEST_CASE("vertex storage: round trip of random triangles") {
    for (std::uint32_t seed = 0; seed < 12; ++seed) {
        CAPTURE(seed);
        const Mesh soup = test::random_soup(60 + 40 * seed, 400, seed);
        stored(stream_of(kAttributes[seed % 2], soup.vertex_count, seed), soup.indices);
        const Mesh glued = test::random_gluing(60 + 40 * seed, 600, seed);
        stored(stream_of(kAttributes[0], glued.vertex_count, seed), glued.indices);
    }
}

TEST_CASE("vertex storage: a smooth surface takes less than two thirds of its stream") {
    const std::uint32_t side = 100;
    std::vector<float> positions;
    std::mt19937 random(5);
    for (std::uint32_t y = 0; y < side; ++y) {
        for (std::uint32_t x = 0; x < side; ++x) {
            const double u = 0.06 * x, v = 0.05 * y, noise = 1e-4 * static_cast<double>(random() % 21);
            positions.push_back(static_cast<float>(u + noise));
            positions.push_back(static_cast<float>(v + 0.1 * std::sin(u)));
            positions.push_back(static_cast<float>(std::sin(u) * std::cos(v)));
        }
    }
    VertexOptions options;
    options.mapping = VertexMapping::lattice;
    const Words stream = encoded({ComponentType::f32, 3, false, std::as_bytes(std::span(positions))}, options);
    CHECK(3 * stored(stream, grid_triangles(side, side)).size() < 2 * stream.size());
}

TEST_CASE("vertex storage: streams that our encoder does not write are restored, or have no stored form") {
    const Words triangles = grid_triangles(20, 20);
    Words stream = stream_of(kAttributes[0], 400, 3);
    SUBCASE("a lower origin and more bits") {
        // The first value takes a bit more in each block. A stream of one value is easy to change by hand.
        stream = stream_of(kAttributes[10], 1, 3);
        stream[7] -= 1;  // low
        const std::uint32_t bits = stream[8] & 63;
        REQUIRE(bits == 0);
        // A block begins with a bit per predictor, then 2 bits for s, then F bits for this component.
        stream[8] |= 1;
        Words bits_of(stream.end() - 3, stream.end());
        bits_of[0] = 1U << 6;
        std::copy(bits_of.begin(), bits_of.end(), stream.end() - 3);
        mend_checksum(stream);
        CHECK(validate_vertices(stream));
        stored(stream, {});
    }
    SUBCASE("the table's fields one bit wider") {
        const std::uint32_t field = stream[2] >> 18 & 31;
        const std::uint32_t words = (15 * field + 31) / 32;
        if (field < 31 && (15 * (field + 1) + 31) / 32 == words) {
            const std::size_t at = 7 + 6 + 1;
            std::uint64_t in[15], k = 0;
            for (std::uint64_t& f : in) {
                const std::size_t bit = k++ * field;
                std::uint64_t window = stream[at + bit / 32];
                if (bit % 32 + field > 32) window |= std::uint64_t{stream[at + bit / 32 + 1]} << 32;
                f = window >> bit % 32 & ((std::uint64_t{1} << field) - 1);
            }
            std::fill_n(stream.begin() + at, words, 0);
            k = 0;
            for (const std::uint64_t f : in) {
                const std::size_t bit = k++ * (field + 1);
                stream[at + bit / 32] |= static_cast<std::uint32_t>(f << bit % 32);
                if (bit % 32 + field + 1 > 32)
                    stream[at + bit / 32 + 1] |= static_cast<std::uint32_t>(f >> (32 - bit % 32));
            }
            stream[2] += 1U << 18;
            mend_checksum(stream);
            CHECK(validate_vertices(stream));
            stored(stream, triangles);
        }
    }
    SUBCASE("the header's usual predictor is another") {
        stream[8] = (stream[8] & ~(31U << 11)) | ((stream[8] >> 11 & 31) + 1) % 32 << 11;
        // Blocks with the usual predictor now decode to other values, which may be invalid.
        mend_checksum(stream);
        if (validate_vertices(stream)) {
            const auto view = view_vertices(stream);
            if (const auto out = storage::store_vertices(*view, triangles)) {
                const auto back = storage::restore_vertices(*out, triangles, 400, stream.size());
                CHECK((back && *back == stream));
            }
        }
    }
}

TEST_CASE("vertex storage: streams that are cut, longer or of other triangles are refused") {
    const Words triangles = grid_triangles(12, 12);
    for (const Kind& a : kAttributes) {
        const Words all = stored(stream_of(a, 144, 11), triangles);
        test::for_each_cut(all, [&](auto cut) {
            CHECK_FALSE(storage::restore_vertices(cut, triangles, 144, 1 << 20));
            CHECK_FALSE(test::attribute_in_c(cut, triangles, 144).has_value());
        });
        Words longer = all;
        longer.push_back(0);
        CHECK_FALSE(test::attribute_in_c(longer, triangles, 144).has_value());
        CHECK_FALSE(storage::restore_vertices(longer, triangles, 144, 1 << 20));
    }
    const Words all = stored(stream_of(kAttributes[0], 144, 11), triangles);
    const Words outside{0, 1, 144};
    CHECK_FALSE(storage::restore_vertices(all, outside, 144, 1 << 20));
    CHECK_FALSE(test::attribute_in_c(all, outside, 144).has_value());
    CHECK_FALSE(storage::restore_vertices(all, std::span(triangles).first(4), 144, 1 << 20));
}

TEST_CASE("vertex storage: damaged streams are refused or decode the same in C") {
    const std::uint32_t seed = std::random_device{}();
    const Words triangles = grid_triangles(12, 13);
    for (const Kind& a : kAttributes) {
        const auto use = [&](const Words& damaged, auto& random) {
            const std::uint32_t vertices = random.below(4) == 0 ? 156 + random.below(3000) : 156;
            test::check_damaged_in_c(damaged, triangles, vertices, 4000);
        };
        // Half of the damage goes to the states and the raw bits of the header.
        test::for_each_damage(stored(stream_of(a, 156, 13), triangles), seed, test::kSanitized ? 300 : 2000, use,
                              {0, 12});
    }
}
