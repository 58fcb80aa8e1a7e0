#include "lrcore/codec/storage/normal_base.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "lrcore/base/compiler.h"
#include "lrcore/codec/storage/rans.h"

namespace lacedring::storage {
namespace {

// Results must be the same on every machine. All numbers are integers except lengths and quotients, which are IEEE
// doubles. No rounded product is a term of a sum, so fused operations do not change results.

using Sums = std::array<std::uint64_t, 3>;  // modulo 2^64: no overflow with any input

constexpr std::int32_t kHalfTurn = 1 << 14;  // unit of angles
constexpr std::int32_t kTangents = 1 << 12;  // table of angles: steps between tangents 0 and 1
constexpr double kUnit = 1 << 15;            // length of normals that are not weighted by area
constexpr std::size_t kBatch = 64;           // triangles per batch

/// Rounded angles with tangent i / kTangents.
constexpr auto kAngles = [] {
    std::array<std::uint16_t, kTangents + 1> out{};
    for (std::size_t i = 0; i < out.size(); ++i) {
        const double x = static_cast<double>(i) / kTangents, y = x * x / (1 + x * x);
        double term = x / (1 + x * x), sum = term;  // Euler's series
        for (int k = 1; k < 60; ++k) sum += term *= y * (2 * k) / (2 * k + 1);
        out[i] = static_cast<std::uint16_t>(sum * kHalfTurn / 3.14159265358979323846 + 0.5);
    }
    return out;
}();

using PaddedPlace = std::array<std::int32_t, 4>;

/// A batch of triangles (p, q, r), as a structure of arrays for vectorization.
struct TriangleBatch {
    using Numbers = std::array<double, kBatch>;
    using Integers = std::array<std::int32_t, kBatch>;

    std::array<Integers, 3> from_p, from_q;
    std::array<Numbers, 3> a, b;  // q - p and r - q
    // a x b, later scaled to its term of the sums before the factor of the angle.
    std::array<Numbers, 3> normal;
    Numbers length;  // length of the normal
    // Cosines of the angles at p, q and r, scaled so that their sines are `length`.
    std::array<Numbers, 3> cosine;
    std::array<Integers, 3> tangent;  // tangent of the angle or of its complement

    LACEDRING_INLINE void set(std::size_t i, const PaddedPlace& p, const PaddedPlace& q, const PaddedPlace& r) {
        for (std::size_t c = 0; c < 3; ++c) {
            from_p[c][i] = q[c] - p[c];
            from_q[c][i] = r[c] - q[c];
        }
    }
    void find_normals() {
        for (std::size_t c = 0; c < 3; ++c) {
            for (std::size_t i = 0; i < kBatch; ++i) {
                a[c][i] = from_p[c][i];
                b[c][i] = from_q[c][i];
            }
        }
        for (std::size_t i = 0; i < kBatch; ++i) {
            normal[0][i] = a[1][i] * b[2][i] - a[2][i] * b[1][i];
            normal[1][i] = a[2][i] * b[0][i] - a[0][i] * b[2][i];
            normal[2][i] = a[0][i] * b[1][i] - a[1][i] * b[0][i];
        }
    }
    void find_lengths() {
        for (std::size_t i = 0; i < kBatch; ++i) {
            const double square = rounded_square(normal[0][i], normal[1][i], normal[2][i]);
            length[i] = square < 1 ? 1 : square;
        }
        for (double& l : length) l = std::sqrt(l);
    }
    void find_angles() {
        for (std::size_t i = 0; i < kBatch; ++i) {
            const double ab = a[0][i] * b[0][i] + a[1][i] * b[1][i] + a[2][i] * b[2][i];
            cosine[0][i] = a[0][i] * a[0][i] + a[1][i] * a[1][i] + a[2][i] * a[2][i] + ab;
            cosine[1][i] = -ab;
            cosine[2][i] = b[0][i] * b[0][i] + b[1][i] * b[1][i] + b[2][i] * b[2][i] + ab;
        }
        for (std::size_t k = 0; k < 3; ++k) {
            for (std::size_t i = 0; i < kBatch; ++i) {
                const double x = std::abs(cosine[k][i]);
                const double shorter = std::min(x, length[i]), longer = std::max(x, length[i]);
                tangent[k][i] = static_cast<std::int32_t>(kTangents * shorter / longer + 0.5);
            }
        }
    }
    LACEDRING_INLINE std::int32_t angle(std::size_t k, std::size_t i) const {
        const std::int32_t arc = kAngles[static_cast<std::size_t>(tangent[k][i])];
        const std::int32_t acute = std::abs(cosine[k][i]) < length[i] ? kHalfTurn / 2 - arc : arc;
        return cosine[k][i] < 0 ? kHalfTurn - acute : acute;
    }
    void scale_normals() {
        for (std::size_t i = 0; i < kBatch; ++i) {
            const double by = kUnit / length[i];
            for (std::size_t c = 0; c < 3; ++c)
                normal[c][i] = static_cast<double>(static_cast<std::int32_t>(normal[c][i] * by));
        }
    }
};

/// Adds the normals of triangles to the sums of their corners.
template <bool kByAngle, bool kByArea>
void add_triangles(const VertexPlaces& places, std::span<const std::uint32_t> triangles, std::uint32_t copies,
                   bool of_vertex, std::span<Sums> sums) {
    const ScaledPlaces scaled(places.positions);
    std::vector<PaddedPlace> place_of(copies);
    for (std::uint32_t i = 0; i < copies; ++i) {
        const Place place = scaled[places.vertex(i)];
        place_of[i] = {place[0], place[1], place[2], 0};
    }
    TriangleBatch batch{};
    for (std::size_t first = 0; first < triangles.size(); first += 3 * kBatch) {
        const std::uint32_t* v = triangles.data() + first;
        const std::size_t count = std::min(kBatch, (triangles.size() - first) / 3);
        for (std::size_t i = 0; i < count; ++i)
            batch.set(i, place_of[v[3 * i]], place_of[v[3 * i + 1]], place_of[v[3 * i + 2]]);
        batch.find_normals();
        if (kByAngle || !kByArea) batch.find_lengths();
        if (kByAngle) batch.find_angles();
        if (!kByArea) batch.scale_normals();
        for (std::size_t i = 0; i < count; ++i) {
            std::array<std::int64_t, 3> normal;
            for (std::size_t c = 0; c < 3; ++c) normal[c] = static_cast<std::int64_t>(batch.normal[c][i]);
            for (std::size_t k = 0; k < 3; ++k) {
                const std::int64_t weight = kByAngle ? batch.angle(k, i) : 1;
                Sums& sum = sums[of_vertex ? places.vertex(v[3 * i + k]) : v[3 * i + k]];
                for (std::size_t c = 0; c < 3; ++c) sum[c] += static_cast<std::uint64_t>(normal[c] * weight);
            }
        }
    }
}

LACEDRING_INLINE std::array<std::int32_t, 2> octahedral(const Sums& sum, std::int32_t most) {
    std::array<std::uint64_t, 3> size;
    for (std::size_t i = 0; i < 3; ++i) size[i] = sum[i] >> 63 != 0 ? 0 - sum[i] : sum[i];
    const auto width = static_cast<std::uint32_t>(std::bit_width(size[0] | size[1] | size[2]));
    for (std::uint64_t& s : size) s >>= width > 32 ? width - 32 : 0;
    const auto all = static_cast<double>(static_cast<std::int64_t>(size[0] + size[1] + size[2]));
    if (all == 0) return {0, 0};
    std::array<std::int32_t, 2> out;
    for (std::size_t i = 0; i < 2; ++i) {
        const double part = most * static_cast<double>(static_cast<std::int64_t>(size[i]));
        out[i] = static_cast<std::int32_t>(part / all + 0.5);
    }
    if (sum[2] >> 63 != 0) out = {most - out[1], most - out[0]};
    for (std::size_t i = 0; i < 2; ++i) {
        if (sum[i] >> 63 != 0) out[i] = -out[i];
    }
    return out;
}

/// Turns the octahedral square inside out: points of the lower half move to its middle. A bijection, its own inverse.
LACEDRING_INLINE void turn_over(std::uint32_t& x, std::uint32_t& y, std::uint32_t most) {
    const bool left = x >> 31 != 0, below = y >> 31 != 0;
    const std::uint32_t across = most + 1 - (below ? 0 - y : y), up = most + 1 - (left ? 0 - x : x);
    x = left ? 0 - across : across;
    y = below ? 0 - up : up;
}

bool points_down(std::uint32_t x, std::uint32_t y, std::uint32_t most) {
    return (x >> 31 != 0 ? 0 - x : x) + (y >> 31 != 0 ? 0 - y : y) > most;
}

std::uint32_t largest_octahedral(std::uint32_t bits) {
    return (1U << (bits - 1)) - 1;
}

}  // namespace

std::vector<std::uint32_t> surface_normals(const VertexPlaces& places, std::span<const std::uint32_t> triangles,
                                           std::uint32_t copies, const NormalBase& base, std::uint32_t bits) {
    const bool of_vertex = base.of_vertex && !places.vertex_of.empty();
    std::vector<Sums> sums(of_vertex ? places.positions.size() / 3 : copies, Sums{});
    const auto add = base.by_angle  ? base.by_area ? add_triangles<true, true> : add_triangles<true, false>
                      : base.by_area ? add_triangles<false, true>
                                    : add_triangles<false, false>;
    add(places, triangles, copies, of_vertex, sums);
    std::vector<std::uint32_t> out(std::size_t{2} * copies);
    const auto most = static_cast<std::int32_t>(largest_octahedral(bits));
    for (std::size_t i = 0; i < copies; ++i) {
        const auto at = octahedral(sums[of_vertex ? places.vertex_of[i] : i], most);
        for (std::size_t c = 0; c < 2; ++c) out[2 * i + c] = static_cast<std::uint32_t>(at[c]);
    }
    return out;
}

void subtract_normals(std::span<std::uint32_t> values, std::span<const std::uint32_t> base, std::uint32_t bits) {
    const std::uint32_t most = largest_octahedral(bits);
    for (std::size_t i = 0; i < values.size(); i += 2) {
        std::uint32_t x = base[i], y = base[i + 1];
        if (points_down(x, y, most)) {
            turn_over(x, y, most);
            turn_over(values[i], values[i + 1], most);
        }
        values[i] -= x;
        values[i + 1] -= y;
    }
}

void add_normals(std::span<std::uint32_t> values, std::span<const std::uint32_t> base, std::uint32_t bits) {
    const std::uint32_t most = largest_octahedral(bits);
    for (std::size_t i = 0; i < values.size(); i += 2) {
        std::uint32_t x = base[i], y = base[i + 1];
        const bool down = points_down(x, y, most);
        if (down) turn_over(x, y, most);
        values[i] += x;
        values[i + 1] += y;
        if (down) turn_over(values[i], values[i + 1], most);
    }
}

NormalBase nearest_base(const VertexPlaces& places, std::span<const std::uint32_t> triangles,
                        std::span<const std::uint32_t> values, std::uint32_t bits) {
    NormalBase best;
    std::uint64_t least = UINT64_MAX;
    std::vector<std::uint32_t> differences;
    for (std::uint32_t i = 0; i < (places.vertex_of.empty() ? 4U : 8U); ++i) {
        const NormalBase base{(i & 1) != 0, (i & 2) != 0, (i & 4) != 0};
        differences.assign(values.begin(), values.end());
        const auto copies = static_cast<std::uint32_t>(values.size() / 2);
        subtract_normals(differences, surface_normals(places, triangles, copies, base, bits), bits);
        std::uint64_t size = 0;
        for (const std::uint32_t d : differences) size += static_cast<std::uint64_t>(std::bit_width(fold(d)));
        if (size >= least) continue;
        least = size;
        best = base;
    }
    return best;
}

}  // namespace lacedring::storage
