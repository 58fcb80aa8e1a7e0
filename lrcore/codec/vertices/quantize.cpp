#include "lrcore/codec/vertices/quantize.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "lacedring/lacedring_vertices.h"
#include "lrcore/base/message.h"
#include "lrcore/base/try.h"

namespace lacedring {

constexpr std::uint32_t kLatticeBits = 22;  // bits of the largest integer; leaves two bits for the step

float lattice_step(double step, double largest) {
    step = std::max({step, std::ldexp(largest, -static_cast<int>(kLatticeBits)), 0x1p-126});
    int exponent = 0;
    const auto width = [&] { return std::bit_width(static_cast<std::uint32_t>(std::ceil(largest / step)) + 1); };
    const int bits = 24 - static_cast<int>(width());  // bits of the step; integer and step together have 24
    const double fraction = std::ceil(std::ldexp(std::frexp(step, &exponent), bits));
    step = std::ldexp(fraction, exponent - bits);
    return step < 0x1p104 ? static_cast<float>(step) : 0.0F;
}

namespace {

Error invalid(std::string message) {
    return {ErrorCode::invalid_argument, std::move(message)};
}

template <class T>
T value_at(const VertexValues& values, std::size_t i) {
    T out;
    std::memcpy(&out, values.data.data() + i * sizeof(T), sizeof(T));
    return out;
}

/// Value i of an attribute of floats or doubles.
double number_at(const VertexValues& values, std::size_t i) {
    if (values.type == ComponentType::f64) return value_at<double>(values, i);
    return static_cast<double>(value_at<float>(values, i));
}

std::uint32_t integer_at(const VertexValues& values, std::size_t i) {
    switch (values.type) {
        case ComponentType::i8:
            return static_cast<std::uint32_t>(value_at<std::int8_t>(values, i));
        case ComponentType::u8:
            return value_at<std::uint8_t>(values, i);
        case ComponentType::i16:
            return static_cast<std::uint32_t>(value_at<std::int16_t>(values, i));
        case ComponentType::u16:
            return value_at<std::uint16_t>(values, i);
        default:
            return value_at<std::uint32_t>(values, i);
    }
}

/// Maps the bits of a float, or the upper half of a double, to an unsigned number, monotonically.
std::uint32_t monotone(std::uint32_t bits) {
    return bits ^ ((bits >> 31) != 0 ? UINT32_MAX : 0x80000000U);
}

Result<VertexIntegers> to_lattice(const VertexValues& values, const VertexOptions& options) {
    if (values.type != ComponentType::f32 && values.type != ComponentType::f64)
        return invalid("a lattice takes floats");
    if (options.step == 0 && (options.bits < 1 || options.bits > kLatticeBits))
        return invalid("a lattice takes 1 to 22 bits");
    if (!(options.step >= 0) || !std::isfinite(options.step)) return invalid("a step must be positive");
    const std::size_t n = values.components, size = values.data.size() / size_of(values.type);
    double extent = 0, largest = 0;
    for (std::size_t c = 0; c < n; ++c) {
        double low = INFINITY, high = -INFINITY;
        for (std::size_t i = c; i < size; i += n) {
            const double value = number_at(values, i);
            if (!std::isfinite(static_cast<float>(value))) return invalid("a value is not finite as a float");
            low = std::min(low, value);
            high = std::max(high, value);
        }
        if (size == 0) break;
        extent = std::max(extent, high - low);
        largest = std::max({largest, std::abs(low), std::abs(high)});
    }
    VertexIntegers out;
    const double wanted =
        options.step > 0 ? static_cast<double>(options.step) : extent / ((std::uint32_t{1} << options.bits) - 1);
    out.step = lattice_step(wanted, largest);
    if (out.step == 0) return invalid("values are too large for a lattice");
    out.mapping = VertexMapping::lattice;
    out.components = static_cast<std::uint32_t>(n);
    out.values.resize(size);
    const auto step = static_cast<double>(out.step);
    for (std::size_t i = 0; i < size; ++i) {
        const double value = number_at(values, i);
        double nearest = std::nearbyint(value / step);
        const double error = value - nearest * step;
        if (2 * std::abs(error) > step) nearest += error > 0 ? 1 : -1;  // the quotient was rounded to a tie
        out.values[i] = static_cast<std::uint32_t>(static_cast<std::int32_t>(nearest));
        out.largest_error = std::max(out.largest_error, std::abs(value - nearest * step));
    }
    return out;
}

/// The octahedral integers whose vector is nearest to v. v is not 0.
void nearest_octahedral(const double v[3], std::uint32_t bits, std::int32_t out[2]) {
    const double sum = std::abs(v[0]) + std::abs(v[1]) + std::abs(v[2]);
    const auto most = static_cast<std::int32_t>((std::uint32_t{1} << (bits - 1)) - 1);
    double x = v[0] / sum, y = v[1] / sum;
    if (v[2] < 0) {
        const double folded = std::copysign(1 - std::abs(y), x);
        y = std::copysign(1 - std::abs(x), y);
        x = folded;
    }
    double least = INFINITY;
    for (int i = 0; i < 4; ++i) {
        const auto corner = [&](double at, int up) {
            return std::clamp(static_cast<std::int32_t>(std::floor(at * most)) + up, -most, most);
        };
        const std::int32_t a = corner(x, i & 1), b = corner(y, i >> 1);
        float unit[3];
        lacedring_octahedral(a, b, bits, unit);
        // Squared sine of the angle; the cosine is too imprecise for small angles.
        double sine = 0;
        for (int c = 0; c < 3; ++c) {
            const int d = (c + 1) % 3;
            const double across = v[c] * static_cast<double>(unit[d]) - v[d] * static_cast<double>(unit[c]);
            sine += across * across;
        }
        if (sine >= least) continue;
        least = sine;
        out[0] = a;
        out[1] = b;
    }
}

Result<VertexIntegers> to_octahedral(const VertexValues& values, const VertexOptions& options) {
    const std::uint32_t n = values.components;
    if (values.type != ComponentType::f32 || (n != 3 && n != 4)) return invalid("octahedral takes 3 or 4 floats");
    if (options.bits < 2 || options.bits > 16) return invalid("octahedral takes 2 to 16 bits");
    VertexIntegers out;
    out.mapping = VertexMapping::octahedral;
    out.components = n - 1;
    out.bits = options.bits;
    const std::size_t vertices = values.data.size() / values.stride();
    out.values.resize(vertices * out.components);
    for (std::size_t i = 0; i < vertices; ++i) {
        double v[3];
        for (std::size_t c = 0; c < 3; ++c) v[c] = static_cast<double>(value_at<float>(values, n * i + c));
        if (!std::isfinite(v[0]) || !std::isfinite(v[1]) || !std::isfinite(v[2]))
            return invalid("a vector is not finite");
        std::int32_t square[2] = {0, 0};
        if (v[0] != 0 || v[1] != 0 || v[2] != 0) nearest_octahedral(v, options.bits, square);
        float unit[3];
        lacedring_octahedral(square[0], square[1], options.bits, unit);
        for (std::size_t c = 0; c < 3; ++c) {
            out.largest_error = std::max(out.largest_error, std::abs(v[c] - static_cast<double>(unit[c])));
        }
        out.values[i * out.components] = static_cast<std::uint32_t>(square[0]);
        out.values[i * out.components + 1] = static_cast<std::uint32_t>(square[1]);
        if (n == 3) continue;
        const auto w = value_at<float>(values, 4 * i + 3);
        if (w != 1 && w != -1) return invalid("the w of a tangent is neither 1 nor -1");
        out.values[i * out.components + 2] = w < 0 ? 1 : 0;
    }
    return out;
}

Result<VertexIntegers> to_exact(const VertexValues& values) {
    VertexIntegers out;
    const std::size_t size = values.data.size() / size_of(values.type);
    out.components = values.components;
    if (values.type == ComponentType::f64) {
        out.mapping = VertexMapping::doubles;
        out.components *= 2;
        out.values.resize(2 * size);
        for (std::size_t i = 0; i < size; ++i) {
            const auto bits = value_at<std::uint64_t>(values, i);
            out.values[2 * i] = monotone(static_cast<std::uint32_t>(bits >> 32));
            out.values[2 * i + 1] = static_cast<std::uint32_t>(bits);
        }
        return out;
    }
    out.mapping = values.type == ComponentType::f32 ? VertexMapping::floats : VertexMapping::integers;
    out.values.resize(size);
    for (std::size_t i = 0; i < size; ++i) {
        out.values[i] =
            values.type == ComponentType::f32 ? monotone(value_at<std::uint32_t>(values, i)) : integer_at(values, i);
    }
    return out;
}

constexpr double kPowers[] = {1, 10, 100, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9};

/// The integer n for which the float is n / power; none if there is no such n.
std::optional<std::int32_t> decimal(float value, double power) {
    const double nearest = std::nearbyint(static_cast<double>(value) * power);
    if (!(std::abs(nearest) <= 0x7fffffff)) return {};
    const auto integer = static_cast<std::int32_t>(nearest);
    const auto back = static_cast<float>(integer / power);  // -0 becomes 0, which differs
    if (std::bit_cast<std::uint32_t>(back) != std::bit_cast<std::uint32_t>(value)) return {};
    return integer;
}

}  // namespace

std::optional<VertexIntegers> to_decimals(const VertexValues& values) {
    const std::size_t size = values.data.size() / 4, step = 1 + size / 65536;
    if (values.type != ComponentType::f32 || size == 0 || size > UINT32_MAX) return {};
    double least = INFINITY;
    std::uint32_t digits = 0;
    for (std::uint32_t d = 0; d < std::size(kPowers); ++d) {
        std::size_t exceptions = 0, looked_at = 0;
        for (std::size_t i = 0; i < size; i += step, ++looked_at) {
            if (!decimal(value_at<float>(values, i), kPowers[d])) ++exceptions;
        }
        // A digit takes 3.32 bits per value, an exception two words.
        const double bits = 3.32 * d + 64 * static_cast<double>(exceptions) / static_cast<double>(looked_at);
        if (4 * exceptions > looked_at || bits >= least) continue;
        least = bits;
        digits = d;
    }
    if (!std::isfinite(least)) return {};
    VertexIntegers out;
    out.mapping = VertexMapping::decimals;
    out.components = values.components;
    out.digits = digits;
    out.values.resize(size);
    for (std::size_t i = 0; i < size; ++i) {
        const auto value = value_at<float>(values, i);
        if (const auto found = decimal(value, kPowers[digits])) {
            out.values[i] = static_cast<std::uint32_t>(*found);
            continue;
        }
        // An exception may have any integer: the nearest if it fits, else that of the previous vertex.
        const double nearest = std::nearbyint(static_cast<double>(value) * kPowers[digits]);
        if (std::abs(nearest) <= 0x7fffffff) {
            out.values[i] = static_cast<std::uint32_t>(static_cast<std::int32_t>(nearest));
        } else if (i >= values.components) {
            out.values[i] = out.values[i - values.components];
        }
        out.exceptions.push_back(static_cast<std::uint32_t>(i));
        out.exceptions.push_back(value_at<std::uint32_t>(values, i));
    }
    return out;
}

Result<VertexIntegers> to_integers(const VertexValues& values, const VertexOptions& options) {
    if (values.type > ComponentType::f64 || values.components == 0 || values.data.size() % values.stride() != 0 ||
        values.data.size() / values.stride() > UINT32_MAX || (values.normalized && values.type > ComponentType::u32)) {
        return invalid("not a whole number of vertices");
    }
    const std::uint32_t each = values.type == ComponentType::f64 && options.mapping != VertexMapping::lattice ? 2 : 1;
    if (each * values.components > LACEDRING_VERTICES_MAX_COMPONENTS)
        return invalid("more than 16 integers per vertex");
    if (options.mapping != VertexMapping::lattice && options.mapping != VertexMapping::octahedral)
        return to_exact(values);
    Result<VertexIntegers> out =
        options.mapping == VertexMapping::lattice ? to_lattice(values, options) : to_octahedral(values, options);
    if (out) out->largest_error = std::max(out->largest_error, options.lost_before);
    return out;
}

Result<double> quantize_vertices(std::span<std::byte> values, std::uint8_t components, const VertexOptions& options) {
    if (options.mapping != VertexMapping::lattice && options.mapping != VertexMapping::octahedral)
        return invalid("the mapping is lossless");
    LR_ASSIGN(const VertexIntegers integers, to_integers({ComponentType::f32, components, false, values}, options));
    const auto put = [&](std::size_t i, float value) { std::memcpy(values.data() + 4 * i, &value, 4); };
    if (integers.mapping == VertexMapping::lattice) {
        for (std::size_t i = 0; i < integers.values.size(); ++i) {
            put(i, static_cast<float>(static_cast<std::int32_t>(integers.values[i])) * integers.step);
        }
        return integers.largest_error;
    }
    for (std::size_t i = 0, n = integers.components; i < integers.values.size() / n; ++i) {
        const std::uint32_t* from = integers.values.data() + i * n;
        float unit[3];
        lacedring_octahedral(static_cast<std::int32_t>(from[0]), static_cast<std::int32_t>(from[1]), options.bits,
                             unit);
        for (std::size_t c = 0; c < 3; ++c) put(i * components + c, unit[c]);
        if (n == 3) put(i * components + 3, from[2] == 0 ? 1.0F : -1.0F);
    }
    return integers.largest_error;
}

}  // namespace lacedring
