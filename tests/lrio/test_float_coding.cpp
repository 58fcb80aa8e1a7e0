// Tests the lossless coding of rows of floats.

#include <doctest/doctest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <random>

#include "lrio/scene/deflate.h"
#include "lrio/scene/float_coding.h"
#include "tests/support/capture.h"
#include "tests/support/damage.h"

using namespace lacedring;

namespace {

using FloatBytes = std::vector<std::byte>;

FloatBytes float_bytes(const std::vector<float>& values) {
    const auto bytes = std::as_bytes(std::span(values));
    return {bytes.begin(), bytes.end()};
}

FloatBytes must_code(const FloatBytes& bytes, std::uint32_t width, bool quaternions = false) {
    const auto coded = detail::encode_floats(bytes, width, quaternions);
    REQUIRE(coded);
    return *coded;
}

void check_floats(const FloatBytes& bytes, std::uint32_t width, bool quaternions = false) {
    const FloatBytes coded = must_code(bytes, width, quaternions);
    const auto decoded = detail::decode_floats(coded, bytes.size());
    REQUIRE(decoded);
    REQUIRE(*decoded == bytes);
    CHECK_FALSE(detail::decode_floats(coded, bytes.size() + 4 * width));
    CHECK_FALSE(detail::decode_floats(coded, bytes.size() + 1));
    if (!bytes.empty()) CHECK_FALSE(detail::decode_floats(coded, bytes.size() - 4 * width));
}

constexpr std::uint32_t kFloatKinds = 7;

/// The bits of a float of a kind: any bits, infinities and NaNs, subnormal numbers, zeros, a line, a sine, or any of
/// these.
std::uint32_t float_bits(std::mt19937& random, std::uint32_t kind, std::size_t row) {
    const auto any = static_cast<std::uint32_t>(random());
    switch (kind) {
        case 0:
            return any;
        case 1:
            return 0x7f800000U | (any & 0x807fffffU);  // infinities and NaNs
        case 2:
            return any & 0x807fffffU;  // subnormal numbers and zeros
        case 3:
            return (any & 1) << 31;  // 0 and -0
        case 4:
            return std::bit_cast<std::uint32_t>(static_cast<float>(row) * 0.25F);
        case 5:
            return std::bit_cast<std::uint32_t>(std::sin(static_cast<float>(row) * 0.1F));
        default:
            return float_bits(random, any % (kFloatKinds - 1), row);
    }
}

FloatBytes random_floats(std::uint32_t width, std::size_t rows, std::uint32_t kind, std::uint32_t seed) {
    std::mt19937 random(seed);
    std::vector<std::uint32_t> out;
    for (std::size_t i = 0; i < rows * width; ++i) out.push_back(float_bits(random, kind, i / width));
    const auto bytes = std::as_bytes(std::span(out));
    return {bytes.begin(), bytes.end()};
}

/// A sequence of unit quaternions that mostly differ little; some are negated.
std::vector<float> random_quaternions(std::size_t rows, std::uint32_t seed) {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    std::vector<float> out;
    double q[4] = {0, 0, 0, 1};
    for (std::size_t i = 0; i < rows; ++i) {
        double length = 0;
        for (double& x : q) x += (random() % 16 == 0 ? 1 : 0.02) * normal(random);
        if (random() % 16 == 0) q[random() % 4] = 0;
        for (const double x : q) length += x * x;
        const double scale = (random() % 16 == 0 ? -1 : 1) / std::sqrt(length);
        for (double& x : q) out.push_back(static_cast<float>(x *= scale));
    }
    return out;
}

/// The fields of coded floats, to be changed and joined again.
struct CodedFloats {
    std::uint32_t head = 0;
    FloatBytes lengths, tail;

    explicit CodedFloats(const FloatBytes& coded) {
        std::uint32_t size = 0;
        std::memcpy(&head, coded.data(), 4);
        std::memcpy(&size, coded.data() + 4, 4);
        lengths = detail::inflate_bytes(std::span(coded).subspan(8, size), 1 << 20).value();
        const auto rest = std::span(coded).subspan(8 + size);
        tail.assign(rest.begin(), rest.end());
    }
    FloatBytes bytes() const {
        const FloatBytes packed = detail::deflate_bytes(lengths).value();
        const std::uint32_t words[] = {head, static_cast<std::uint32_t>(packed.size())};
        const auto begin = std::as_bytes(std::span(words));
        FloatBytes out(begin.begin(), begin.end());
        out.insert(out.end(), packed.begin(), packed.end());
        out.insert(out.end(), tail.begin(), tail.end());
        return out;
    }
};

/// Returns whether the coded floats are refused or decode to the requested size.
bool is_safe(const FloatBytes& coded, std::size_t size) {
    const auto decoded = detail::decode_floats(coded, size);
    return !decoded || decoded->size() == size;
}

}  // namespace

TEST_CASE("coded floats of every kind and width decode bit for bit") {
    std::uint32_t seed = 0;
    for (std::uint32_t width = 1; width <= 16; ++width) {
        for (const std::size_t rows : {0U, 1U, 2U, 3U, 40U}) {
            for (std::uint32_t kind = 0; kind < kFloatKinds; ++kind) {
                CAPTURE(width);
                CAPTURE(rows);
                CAPTURE(kind);
                check_floats(random_floats(width, rows, kind, ++seed), width);
                if (width == 4) check_floats(random_floats(width, rows, kind, ++seed), width, true);
            }
        }
    }
}

TEST_CASE("coded quaternions decode bit for bit and take less than as floats") {
    for (std::uint32_t seed = 0; seed < 20; ++seed) {
        CAPTURE(seed);
        const std::vector<float> turning = random_quaternions(300, seed);
        const FloatBytes bytes = float_bytes(turning);
        check_floats(bytes, 4, true);
        check_floats(bytes, 4, false);
        CHECK(must_code(bytes, 4, true).size() < must_code(bytes, 4, false).size());
        std::vector<float> long_ones = turning;  // scaled: not of unit length
        for (float& x : long_ones) x *= 3;
        check_floats(float_bytes(long_ones), 4, true);
    }
    for (const float big : {1.0F, -1.0F}) {
        for (std::size_t c = 0; c < 4; ++c) {
            std::vector<float> axis(4, -0.0F);
            axis[c] = big;
            check_floats(float_bytes(axis), 4, true);
        }
    }
}

TEST_CASE("floats on a line take no bits after the first two rows") {
    std::vector<float> line;
    for (int i = 0; i < 1000; ++i)
        line.insert(line.end(), {0.5F * static_cast<float>(i), 7, -2.0F * static_cast<float>(i)});
    const CodedFloats coded(must_code(float_bytes(line), 3));
    REQUIRE(coded.lengths.size() == line.size());
    for (std::size_t c = 0; c < 3; ++c) {
        CHECK(std::all_of(coded.lengths.begin() + static_cast<std::ptrdiff_t>(1000 * c + 2),
                          coded.lengths.begin() + static_cast<std::ptrdiff_t>(1000 * c + 1000),
                          [](std::byte length) { return length == std::byte{0}; }));
    }
}

TEST_CASE("cut and damaged coded floats are refused or decode to the requested size") {
    for (const bool quaternions : {false, true}) {
        CAPTURE(quaternions);
        const FloatBytes bytes = quaternions ? float_bytes(random_quaternions(20, 3)) : random_floats(4, 20, 6, 3);
        const FloatBytes good = must_code(bytes, 4, quaternions);
        test::for_each_cut(good, [&](auto cut) { CHECK_FALSE(detail::decode_floats(cut, bytes.size())); });
        FloatBytes longer = good;
        longer.push_back(std::byte{0});
        CHECK_FALSE(detail::decode_floats(longer, bytes.size()));
        test::for_each_flip(good, [&](const FloatBytes& bad, std::size_t) { CHECK(is_safe(bad, bytes.size())); });
        const CodedFloats parts(good);
        REQUIRE(parts.bytes() == good);
        for (std::size_t i = 0; i < parts.lengths.size(); ++i) {
            for (const unsigned value : {0U, 1U, 2U, 7U, 8U, 31U, 32U, 33U, 255U}) {
                CAPTURE(i);
                CAPTURE(value);
                CodedFloats bad = parts;
                bad.lengths[i] = static_cast<std::byte>(value);
                CHECK(is_safe(bad.bytes(), bytes.size()));
                const bool component = quaternions && i < 20;
                if (value > (component ? 7 : 32)) CHECK_FALSE(detail::decode_floats(bad.bytes(), bytes.size()));
            }
        }
    }
}

TEST_CASE("coded floats with a wrong header, size or length are refused") {
    const FloatBytes bytes = random_floats(3, 10, 0, 9);
    const CodedFloats good(must_code(bytes, 3));
    const auto refused = [&](const CodedFloats& changed, std::size_t size) {
        return !detail::decode_floats(changed.bytes(), size).has_value();
    };
    CHECK_FALSE(refused(good, bytes.size()));
    for (const std::uint32_t head : {0U, 17U, 127U, 3U | 128U, 3U | 256U, 3U | 1U << 31}) {
        CAPTURE(head);
        CodedFloats bad = good;
        bad.head = head;
        CHECK(refused(bad, bytes.size()));
        CHECK(refused(bad, 0));
    }
    CHECK_MESSAGE(refused(good, 0), "a size of 0");
    CHECK_MESSAGE(refused(good, std::size_t{1} << 40), "a size of 2^40, which is not allocated");
    CodedFloats bad = good;
    bad.lengths.push_back(std::byte{0});
    CHECK_MESSAGE(refused(bad, bytes.size()), "a length too many");
    bad.lengths.resize(bad.lengths.size() - 2);
    CHECK_MESSAGE(refused(bad, bytes.size()), "a length too few");
    const CodedFloats zeros(must_code(FloatBytes(12), 3));
    CHECK(zeros.tail.empty());
    CodedFloats more = zeros;
    more.tail.push_back(std::byte{1});
    CHECK_MESSAGE(refused(more, 12), "a byte after the last bit");
    FloatBytes coded = must_code(bytes, 3);
    const std::uint32_t far = UINT32_MAX;
    std::memcpy(coded.data() + 4, &far, 4);
    CHECK_MESSAGE(!detail::decode_floats(coded, bytes.size()), "compressed lengths beyond the end");
}
