// Tests quantize_vertices, which rounds values before encoding, and lattice_step.

#include <doctest/doctest.h>

#include <cmath>
#include <cstring>
#include <random>

#include "lacedring/vertices.hpp"
#include "tests/support/capture.h"

using namespace lacedring;

namespace {

std::vector<float> random_values(std::size_t count, double size, double offset, std::uint32_t seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> any(-size, size);
    std::vector<float> out;
    for (std::size_t i = 0; i < count; ++i) out.push_back(static_cast<float>(any(random) + offset));
    return out;
}

/// Random unit vectors, the first 27 to the faces, edges and corners of a cube. With w: tangents.
std::vector<float> random_directions(std::size_t count, bool has_w, std::uint32_t seed) {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    std::vector<float> out;
    for (std::size_t i = 0; i < count; ++i) {
        double v[3];
        for (std::size_t c = 0; c < 3; ++c) {
            v[c] = i < 27 ? static_cast<double>(i / (c == 0 ? 1 : c == 1 ? 3 : 9) % 3) - 1 : normal(random);
        }
        if (i == 13) v[2] = 1;  // instead of (0, 0, 0)
        const double length = std::hypot(v[0], v[1], v[2]);
        for (const double x : v) out.push_back(static_cast<float>(x / length));
        if (has_w) out.push_back(random() % 2 == 0 ? 1.0F : -1.0F);
    }
    return out;
}

struct Quantized {
    std::vector<float> values;
    double error = 0;
};

Quantized must_quantize(std::vector<float> values, std::uint8_t components, const VertexOptions& options) {
    const Result<double> error = quantize_vertices(std::as_writable_bytes(std::span(values)), components, options);
    REQUIRE_MESSAGE(error, error.error().message);
    return {std::move(values), *error};
}

bool same_bits(const std::vector<float>& a, const std::vector<float>& b) {
    return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), 4 * a.size()) == 0);
}

double largest_difference(const std::vector<float>& a, const std::vector<float>& b) {
    double out = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        out = std::max(out, std::abs(static_cast<double>(a[i]) - static_cast<double>(b[i])));
    }
    return out;
}

/// Encodes and decodes the values.
std::vector<float> through_stream(const std::vector<float>& values, std::uint8_t components,
                                  const VertexOptions& options, float* step = nullptr) {
    const auto encoded =
        encode_vertices({ComponentType::f32, components, false, std::as_bytes(std::span(values))}, options);
    REQUIRE_MESSAGE(encoded, encoded.error().message);
    const Result<VertexView> view = validate_vertices(encoded->words);
    REQUIRE(view);
    if (step != nullptr) *step = view->step;
    std::vector<float> out(values.size());
    decode_vertices(*view, std::as_writable_bytes(std::span(out)));
    return out;
}

}  // namespace

TEST_CASE("values quantized to a lattice equal those decoded from a stream, and stay when quantized again") {
    std::uint32_t seed = 0;
    for (const std::uint32_t bits : {1U, 2U, 8U, 14U, 22U}) {
        for (const double size : {1.0, 1e-6, 1e20, 3e-38}) {
            for (const double offset : {0.0, 0.9, -70.0}) {
                CAPTURE(++seed);
                CAPTURE(bits);
                const auto components = static_cast<std::uint8_t>(1 + seed % 4);
                const std::vector<float> values = random_values(300 * components, size, size * offset, seed);
                const VertexOptions options{.mapping = VertexMapping::lattice, .bits = bits};
                const Quantized once = must_quantize(values, components, options);
                float step = 0;
                REQUIRE(same_bits(once.values, through_stream(values, components, options, &step)));
                REQUIRE(once.error == largest_difference(values, once.values));
                REQUIRE(once.error <= static_cast<double>(step) / 2);
                const VertexOptions same_step{.mapping = VertexMapping::lattice, .step = step};
                REQUIRE(same_bits(must_quantize(values, components, same_step).values, once.values));
                const Quantized twice = must_quantize(once.values, components, same_step);
                REQUIRE(same_bits(twice.values, once.values));
                REQUIRE(twice.error == 0);
                float kept = 0;
                REQUIRE(same_bits(through_stream(once.values, components, same_step, &kept), once.values));
                REQUIRE(kept == step);
            }
        }
    }
}

TEST_CASE("quantized directions equal those decoded from a stream, and stay when quantized again") {
    for (std::uint32_t bits = 2; bits <= 16; ++bits) {
        for (const bool has_w : {false, true}) {
            CAPTURE(bits);
            CAPTURE(has_w);
            const std::uint8_t components = has_w ? 4 : 3;
            const std::vector<float> values = random_directions(500, has_w, bits);
            const VertexOptions options{.mapping = VertexMapping::octahedral, .bits = bits};
            const Quantized once = must_quantize(values, components, options);
            REQUIRE(same_bits(once.values, through_stream(values, components, options)));
            REQUIRE(std::abs(once.error - largest_difference(values, once.values)) < 1e-6);
            // Half a step along each axis of the octahedron; the sphere scales it by at most sqrt(3).
            REQUIRE(once.error <= std::sqrt(1.5 * 3) / ((1U << (bits - 1)) - 1) + 1e-6);
            const Quantized twice = must_quantize(once.values, components, options);
            REQUIRE(same_bits(twice.values, once.values));
            REQUIRE(twice.error < 1e-6);
        }
    }
}

TEST_CASE("values that cannot be quantized are refused and unchanged") {
    const std::vector<float> good = random_values(12, 1, 0, 1);
    const auto refused = [](std::vector<float> values, std::uint8_t components, const VertexOptions& options) {
        const std::vector<float> before = values;
        const auto done = quantize_vertices(std::as_writable_bytes(std::span(values)), components, options);
        return !done && done.error().code == ErrorCode::invalid_argument && same_bits(values, before);
    };
    std::vector<float> infinite = good, far = good, sideways = good;
    infinite[5] = INFINITY;
    far[5] = 3e38F;
    const VertexOptions lattice{.mapping = VertexMapping::lattice, .bits = 10};
    CHECK_FALSE(refused(good, 3, lattice));
    CHECK(refused(infinite, 3, lattice));
    CHECK(refused(far, 3, {.mapping = VertexMapping::lattice, .bits = 1}));
    CHECK(refused(good, 5, lattice));
    CHECK(refused(good, 3, {.mapping = VertexMapping::lattice, .bits = 0}));
    CHECK(refused(good, 3, {.mapping = VertexMapping::lattice, .bits = 23}));
    CHECK(refused(good, 3, {.mapping = VertexMapping::lattice, .step = -1}));
    CHECK(refused(good, 3, {.mapping = VertexMapping::floats}));
    CHECK(refused(good, 2, {.mapping = VertexMapping::octahedral, .bits = 8}));
    CHECK_MESSAGE(refused(good, 4, {.mapping = VertexMapping::octahedral, .bits = 8}), "w is not 1 or -1");
    CHECK(refused(good, 3, {.mapping = VertexMapping::octahedral, .bits = 17}));
}

TEST_CASE("products of a lattice's step with its integers are exact floats") {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> exponent(-150, 125), fraction(1, 2), count(-3, 25);
    for (int i = 0; i < 20000; ++i) {
        const double wanted = std::ldexp(fraction(random), static_cast<int>(exponent(random)));
        const double largest = wanted * std::exp2(count(random));
        CAPTURE(wanted);
        CAPTURE(largest);
        const float made = lattice_step(wanted, largest);
        if (made == 0) {
            REQUIRE_MESSAGE(std::max(wanted, largest * 0x1p-22) > 0x1p103, "no step only beyond a float's exponents");
            continue;
        }
        const auto step = static_cast<double>(made);
        REQUIRE(step >= wanted);
        const double most = std::ceil(largest / step);
        REQUIRE(most <= 0x1p22);
        for (int k = 0; k < 20; ++k) {
            const double integer = k == 0 ? most : std::floor(most * (fraction(random) - 1));
            const double product = integer * step;  // exact: 22 + 24 bits
            REQUIRE((std::abs(product) > 3.4e38 || static_cast<double>(static_cast<float>(product)) == product));
        }
        if (wanted >= 0x1p-126 && largest / wanted <= 1000) REQUIRE(step <= wanted * (1 + 0x1p-11));
    }
}

TEST_CASE("a power of two is its own lattice step") {
    for (int e = -126; e < 104; ++e) {
        CAPTURE(e);
        for (const double integers : {0.0, 0.5, 1.0, 1000.0, 0x1p22}) {
            const double step = std::ldexp(1.0, e);
            CHECK(static_cast<double>(lattice_step(step, integers * step)) == step);
        }
    }
    // Products of smaller steps would be subnormal.
    CHECK(lattice_step(1e-45, 0) == 0x1p-126F);
    CHECK(lattice_step(0x1p104, 0) == 0);
}
