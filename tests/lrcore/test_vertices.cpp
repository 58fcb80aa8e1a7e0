#include <doctest/doctest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <random>

#include "lacedring/vertices.hpp"
#include "lrcore/base/crc32.h"
#include "tests/support/capture.h"
#include "tests/support/damage.h"

using namespace lacedring;

namespace {

using Bytes = std::vector<std::byte>;

constexpr std::uint32_t kSizes[] = {0, 1, 2, 3, 4, 5, 17, 33, 127, 128, 129, 256, 2047, 2048, 2049, 5000};

template <class T>
Bytes bytes_of(const std::vector<T>& values) {
    const auto bytes = std::as_bytes(std::span(values));
    return {bytes.begin(), bytes.end()};
}

std::vector<float> floats_of(const Bytes& bytes) {
    std::vector<float> out(bytes.size() / 4);
    if (!out.empty()) std::memcpy(out.data(), bytes.data(), bytes.size());
    return out;
}

/// Validates and decodes a stream in buffers of exactly its size. Checks that decoding while validating gives the same
/// values, and that blocks give the same integers in any order.
Bytes decoded(const std::vector<std::uint32_t>& words) {
    const auto exact = std::make_unique<std::uint32_t[]>(words.size());
    std::copy(words.begin(), words.end(), exact.get());
    const Result<VertexView> view = validate_vertices(std::span<const std::uint32_t>(exact.get(), words.size()));
    REQUIRE_MESSAGE(view, view.error().message);
    Bytes out(view->decoded_bytes());
    decode_vertices(*view, out);
    Bytes at_once(out.size());
    CHECK(decode_vertices_checked(*view, at_once));
    CHECK_MESSAGE(at_once == out, "decoding while validating gives the same values");
    std::vector<std::uint32_t> forward, backward;
    std::vector<std::uint32_t> block(std::size_t{kVertexBlock} * view->integers);
    const auto used = [&](std::uint32_t b) {
        return std::size_t{view->integers} * std::min(view->vertices - b * kVertexBlock, kVertexBlock);
    };
    for (std::uint32_t b = 0; b < view->blocks(); ++b) {
        decode_vertex_block(*view, b, std::span(block).first(used(b)));
        forward.insert(forward.end(), block.begin(), block.begin() + static_cast<std::ptrdiff_t>(used(b)));
    }
    for (std::uint32_t b = view->blocks(); b-- > 0;) {
        decode_vertex_block(*view, b, std::span(block).first(used(b)));
        backward.insert(backward.begin(), block.begin(), block.begin() + static_cast<std::ptrdiff_t>(used(b)));
    }
    CHECK_MESSAGE(forward == backward, "blocks give the same integers in any order");
    return out;
}

/// A random walk that alternates between constant, smooth, noisy and linear runs, with jumps.
class Walk {
  public:
    explicit Walk(std::uint32_t seed) : random_(seed) {}
    double next() {
        if (random_() % 64 == 0) kind_ = random_() % 4;
        if (random_() % 200 == 0) at_ = static_cast<double>(random_() % 20000) - 10000;
        if (kind_ == 1) at_ += speed_ = 0.9 * speed_ + noise(1);
        if (kind_ == 2) at_ += noise(20);
        if (kind_ == 3) at_ += 3;
        return at_;
    }
    std::uint32_t bits() { return static_cast<std::uint32_t>(random_()); }

  private:
    double noise(double size) { return size * (static_cast<double>(random_() % 2001) - 1000) / 1000; }

    std::mt19937 random_;
    std::uint32_t kind_ = 2;
    double at_ = 0, speed_ = 0;
};

template <class T>
Bytes walked(std::uint32_t vertices, std::uint32_t components, std::uint32_t seed, double scale = 1) {
    std::vector<Walk> walks;
    for (std::uint32_t c = 0; c < components; ++c) walks.emplace_back(seed + c);
    std::vector<T> out;
    for (std::uint32_t v = 0; v < vertices; ++v) {
        for (Walk& walk : walks) {
            const double value = walk.next() * scale;
            if constexpr (std::is_floating_point_v<T>) {
                out.push_back(static_cast<T>(value));
            } else {
                out.push_back(static_cast<T>(static_cast<std::int64_t>(value)));
            }
        }
    }
    return bytes_of(out);
}

Bytes walked_of(ComponentType type, std::uint32_t vertices, std::uint32_t components, std::uint32_t seed) {
    switch (type) {
        case ComponentType::i8:
            return walked<std::int8_t>(vertices, components, seed);
        case ComponentType::u8:
            return walked<std::uint8_t>(vertices, components, seed);
        case ComponentType::i16:
            return walked<std::int16_t>(vertices, components, seed);
        case ComponentType::u16:
            return walked<std::uint16_t>(vertices, components, seed);
        case ComponentType::i32:
            return walked<std::int32_t>(vertices, components, seed, 10000);
        case ComponentType::u32:
            return walked<std::uint32_t>(vertices, components, seed, 10000);
        case ComponentType::f32:
            return walked<float>(vertices, components, seed, 0.37);
        default:
            return walked<double>(vertices, components, seed, 0.37);
    }
}

std::vector<std::uint32_t> encoded(const VertexValues& values, const VertexOptions& options = {}) {
    Result<EncodedVertices> out = encode_vertices(values, options);
    REQUIRE_MESSAGE(out, out.error().message);
    return out->words;
}

void mend(std::vector<std::uint32_t>& words) {
    const std::uint32_t header = crc32(std::as_bytes(std::span(words).first(3)));
    words[3] = crc32(std::as_bytes(std::span(words).subspan(4)), header);
}

}  // namespace

TEST_CASE("vertex streams decode to the encoded values of every type and size") {
    for (std::uint32_t type = 0; type < 8; ++type) {
        for (const std::uint32_t components : {1U, 2U, 3U, 4U, 8U}) {
            for (const std::uint32_t vertices : kSizes) {
                const auto of = static_cast<ComponentType>(type);
                CAPTURE(type);
                CAPTURE(components);
                CAPTURE(vertices);
                const Bytes data = walked_of(of, vertices, components, 1 + vertices);
                const VertexValues values{of, static_cast<std::uint8_t>(components), type < 6 && vertices % 2 != 0,
                                          data};
                const std::vector<std::uint32_t> words = encoded(values);
                CHECK(decoded(words) == data);
                const Result<VertexView> view = view_vertices(words);
                CHECK(view->type == of);
                CHECK(view->components == components);
                CHECK(view->normalized == values.normalized);
                CHECK(view->largest_error == 0);
                if (vertices == 5000) CHECK(encoded(values, {.threads = 3}) == words);
            }
        }
    }
}

TEST_CASE("vertex streams of noise whose width and slopes change every 16 vertices decode to the encoded values") {
    std::mt19937 random(5);
    const auto below = [&](std::uint32_t n) { return static_cast<std::int32_t>(random() % n); };
    std::vector<std::int32_t> values;
    std::int32_t at[3] = {0, 0, 0}, bits[3] = {1, 1, 1}, slopes[2] = {0, 0};
    for (std::uint32_t v = 0; v < 60 * kVertexBlock; ++v) {
        if (v % 16 == 1) {
            // Each run needs the longest codes: a width that changes by much, two that fall by one, and new slopes.
            bits[0] = 1 + (bits[0] + 4) % 10;
            for (std::size_t c = 1; c < 3; ++c) bits[c] = bits[c] > 4 ? bits[c] - 1 : 14;
            for (std::int32_t& s : slopes) s = below(8) - 4;
        }
        std::int32_t step[3];
        for (std::size_t c = 0; c < 3; ++c) step[c] = below(2U << bits[c]) - (1 << bits[c]);
        step[0] += (slopes[0] * step[1] + slopes[1] * step[2]) / 4;
        for (std::size_t c = 0; c < 3; ++c) values.push_back(at[c] += step[c]);
    }
    const Bytes data = bytes_of(values);
    CHECK(decoded(encoded({ComponentType::i32, 3, false, data})) == data);
}

TEST_CASE("vertex streams keep the bits of NaNs, subnormal numbers, infinities and signed zeros") {
    Walk walk(7);
    std::vector<float> values;
    for (std::uint32_t i = 0; i < 3000; ++i) {
        const std::uint32_t bits = walk.bits();
        constexpr std::uint32_t kSpecial[] = {0x7fc00001U, 0xffc12345U, 0x80000000U, 0U,
                                              1U,          0x807fffffU, 0x7f800000U, 0xff800000U};
        values.push_back(std::bit_cast<float>(bits % 3 == 0 ? kSpecial[bits / 3 % 8] : walk.bits()));
    }
    const Bytes data = bytes_of(values);
    CHECK(decoded(encoded({ComponentType::f32, 3, false, data})) == data);
    CHECK(decoded(encoded({ComponentType::f32, 1, false, data})) == data);
    CHECK(decoded(encoded({ComponentType::f64, 3, false, std::span(data).first(12000)})) ==
          Bytes(data.begin(), data.begin() + 12000));
}

TEST_CASE("floats that were decimal text are stored as decimals, others among them as exceptions") {
    Walk walk(3);
    std::vector<float> values;
    for (std::uint32_t i = 0; i < 3000; ++i) {
        values.push_back(static_cast<float>(std::round(walk.next() * 100) / 1e4));
        if (i % 100 == 50) values.back() = static_cast<float>(walk.next() / 300);
        if (i == 77) values.back() = -0.0F;
        if (i == 99) values.back() = 1e30F;
    }
    const Bytes data = bytes_of(values);
    const std::vector<std::uint32_t> words = encoded({ComponentType::f32, 3, false, data});
    const Result<VertexView> view = view_vertices(words);
    CHECK(view->mapping == VertexMapping::decimals);
    CHECK(view->digits == 4);
    CHECK(view->exceptions > 10);
    CHECK(view->exceptions <= 33);
    CHECK(decoded(words) == data);
}

TEST_CASE("quantized values are multiples of the step, at most half a step away") {
    for (const std::uint32_t bits : {1U, 8U, 12U, 14U, 16U, 22U}) {
        for (const double offset : {0.0, -3.7, 1e6, 1e-20}) {
            for (const double scale : {1.0, 1e-7, 1e24, 1e-36}) {
                CAPTURE(bits);
                CAPTURE(offset);
                CAPTURE(scale);
                std::vector<float> values = floats_of(walked<float>(2000, 3, bits, 0.37));
                for (float& value : values) value = static_cast<float>((static_cast<double>(value) + offset) * scale);
                const Bytes data = bytes_of(values);
                const Result<EncodedVertices> out = encode_vertices({ComponentType::f32, 3, false, data},
                                                                    {.mapping = VertexMapping::lattice, .bits = bits});
                REQUIRE_MESSAGE(out, out.error().message);
                const Result<VertexView> view = view_vertices(out->words);
                REQUIRE(view->mapping == VertexMapping::lattice);
                const std::vector<float> back = floats_of(decoded(out->words));
                const auto step = static_cast<double>(view->step);
                double largest = 0, low = INFINITY, high = -INFINITY;
                for (std::size_t i = 0; i < back.size(); ++i) {
                    const double integer = static_cast<double>(back[i]) / step;
                    REQUIRE(integer == std::round(integer));
                    // The product is exact.
                    REQUIRE(std::fma(integer, step, -static_cast<double>(back[i])) == 0);
                    largest =
                        std::max(largest, std::abs(static_cast<double>(back[i]) - static_cast<double>(values[i])));
                }
                for (std::size_t c = 0; c < 3; ++c) {
                    double least = INFINITY, most = -INFINITY;
                    for (std::size_t i = c; i < values.size(); i += 3) {
                        least = std::min(least, static_cast<double>(values[i]));
                        most = std::max(most, static_cast<double>(values[i]));
                    }
                    if (!(most - least <= high - low)) low = least, high = most;
                }
                CHECK(largest == out->largest_error);
                CHECK(largest <= step / 2);
                CHECK(static_cast<double>(view->largest_error) >= largest);
                // The step is at least the wanted one, and hardly more near the origin.
                const double wanted = (high - low) / ((1U << bits) - 1);
                CHECK(step >= wanted);
                if (offset == 0 && bits <= 14 && wanted > 1e-37) CHECK(step <= wanted * 1.02);
            }
        }
    }
}

TEST_CASE("equal positions of two meshes stay equal if both have the same step") {
    const std::vector<float> left = floats_of(walked<float>(1000, 3, 5, 0.01));
    std::vector<float> right(left.begin(), left.begin() + 300);  // the shared border
    for (std::uint32_t i = 0; i < 900; ++i) right.push_back(left[i] + 500);
    const VertexOptions options{.mapping = VertexMapping::lattice, .step = 0x1p-9F};
    const Bytes a = bytes_of(left), b = bytes_of(right);
    const Bytes first = decoded(encoded({ComponentType::f32, 3, false, a}, options));
    const Bytes second = decoded(encoded({ComponentType::f32, 3, false, b}, options));
    CHECK(std::memcmp(first.data(), second.data(), 1200) == 0);
}

TEST_CASE("decoded normals and tangents are unit vectors near the encoded ones") {
    Walk walk(9);
    std::vector<float> normals, tangents;
    const auto component = [&] { return static_cast<float>(static_cast<double>(walk.bits() % 2001) / 1000 - 1); };
    for (std::uint32_t i = 0; i < 3000; ++i) {
        float v[3] = {component(), component(), component()};
        if (i < 27) {  // to the corners, edges and faces of a cube
            v[0] = static_cast<float>(i % 3) - 1, v[1] = static_cast<float>(i / 3 % 3) - 1,
            v[2] = static_cast<float>(i / 9) - 1;
        }
        const float length = std::hypot(v[0], v[1], v[2]);
        for (const float x : v) normals.push_back(length > 0 ? x / length : x);
        for (const float x : v) tangents.push_back(length > 0 ? x / length : x);
        tangents.push_back(walk.bits() % 2 == 0 ? 1.0F : -1.0F);
    }
    for (std::uint32_t bits = 2; bits <= 16; ++bits) {
        CAPTURE(bits);
        const VertexOptions options{.mapping = VertexMapping::octahedral, .bits = bits};
        const Bytes data = bytes_of(normals), with_w = bytes_of(tangents);
        const Result<EncodedVertices> out = encode_vertices({ComponentType::f32, 3, false, data}, options);
        REQUIRE_MESSAGE(out, out.error().message);
        const std::vector<float> back = floats_of(decoded(out->words));
        for (std::size_t i = 0; i < back.size(); i += 3) {
            CHECK(std::abs(std::hypot(back[i], back[i + 1], back[i + 2]) - 1) < 2e-7F);
            const bool zero = normals[i] == 0 && normals[i + 1] == 0 && normals[i + 2] == 0;
            double distance = 0;
            for (std::size_t c = 0; c < 3; ++c)
                distance = std::hypot(distance, static_cast<double>(back[i + c] - normals[i + c]));
            if (!zero && bits > 2) CHECK(distance < 2.2 / ((1U << (bits - 1)) - 1));
        }
        const std::vector<float> tangent = floats_of(decoded(encoded({ComponentType::f32, 4, false, with_w}, options)));
        for (std::size_t i = 0; i < tangent.size(); i += 4) {
            CHECK(std::memcmp(&tangent[i], &back[i / 4 * 3], 12) == 0);
            CHECK(tangent[i + 3] == tangents[i + 3]);
        }
    }
}

TEST_CASE("encode_vertices refuses values that are not of the mapping, type or size") {
    const Bytes data = bytes_of(std::vector<float>{0, 1, std::numeric_limits<float>::infinity()});
    const auto code = [](const Result<EncodedVertices>& result) {
        return result ? -1 : static_cast<int>(result.error().code);
    };
    const int invalid = static_cast<int>(ErrorCode::invalid_argument);
    const VertexOptions lattice{.mapping = VertexMapping::lattice}, octahedral{.mapping = VertexMapping::octahedral};
    CHECK(code(encode_vertices({ComponentType::f32, 3, false, data}, lattice)) == invalid);
    CHECK(code(encode_vertices({ComponentType::f32, 3, false, data}, octahedral)) == invalid);
    CHECK(code(encode_vertices({ComponentType::u8, 3, false, data}, lattice)) == invalid);
    CHECK(code(encode_vertices({ComponentType::f32, 1, false, data}, octahedral)) == invalid);
    CHECK(code(encode_vertices({ComponentType::f32, 2, false, data})) == invalid);
    CHECK(code(encode_vertices({ComponentType::f32, 0, false, data})) == invalid);
    CHECK(code(encode_vertices({ComponentType::f32, 17, false, {}})) == invalid);
    CHECK(code(encode_vertices({ComponentType::f64, 9, false, {}})) == invalid);
    CHECK(code(encode_vertices({ComponentType::f32, 1, true, data})) == invalid);
    CHECK(code(encode_vertices({ComponentType::f32, 3, false, data},
                               {.mapping = VertexMapping::lattice, .bits = 23})) == invalid);
    const Bytes tangent = bytes_of(std::vector<float>{1, 0, 0, 0.5F});
    CHECK(code(encode_vertices({ComponentType::f32, 4, false, tangent}, octahedral)) == invalid);
}

TEST_CASE("cut and damaged vertex streams are refused or decode within bounds") {
    const Bytes data = walked<float>(300, 3, 11, 0.37);
    for (const VertexMapping mapping : {VertexMapping::floats, VertexMapping::lattice, VertexMapping::octahedral}) {
        CAPTURE(static_cast<int>(mapping));
        const std::vector<std::uint32_t> good =
            encoded({ComponentType::f32, 3, false, data}, {.mapping = mapping, .bits = 12});
        const Bytes want = decoded(good);
        test::for_each_cut(good, [](auto cut) { CHECK_FALSE(validate_vertices(cut)); });
        std::size_t accepted = 0, same = 0;
        test::for_each_flip(good, [&](std::vector<std::uint32_t>& bad, std::size_t bit) {
            CHECK_FALSE(validate_vertices(bad));
            if (bit / 32 == 3) return;
            mend(bad);
            const bool valid = validate_vertices(bad).has_value();
            if (const Result<VertexView> view = view_vertices(bad); view && view->decoded_bytes() < 1 << 16) {
                Bytes values(view->decoded_bytes());
                CHECK(decode_vertices_checked(*view, values).has_value() == valid);
            }
            if (!valid) return;
            ++accepted;
            // Every bit changes the decoded values, except header bits of defaults that no block has, and slopes that
            // make no difference.
            if (bit / 32 < 13 && bit / 32 % 2 == 0 && bit % 32 >= 6) return;
            if (bit / 32 >= 7 && decoded(bad) == want) ++same;
        });
        CHECK_MESSAGE(accepted > 0, "changed low bits of residuals are valid");
        CHECK(100 * same < accepted);
    }
}

TEST_CASE("golden bytes: vertex streams have the stored checksum") {
    std::vector<float> values;
    for (std::uint32_t i = 0; i < 600; ++i)
        values.push_back(static_cast<float>(i * i % 97) * 0.125F + static_cast<float>(i));
    const Bytes data = bytes_of(values);
    const auto sum = [&](const VertexOptions& options) {
        return encoded({ComponentType::f32, 3, false, data}, options)[3];
    };
    CHECK(sum({}) == 2691912312U);
    CHECK(sum({.mapping = VertexMapping::lattice, .bits = 10}) == 3012023295U);
    CHECK(sum({.mapping = VertexMapping::octahedral, .bits = 8}) == 1947867978U);
}
