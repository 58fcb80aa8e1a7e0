#include "lrcore/codec/storage/normal_base.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "lrcore/base/compiler.h"
#include "lrcore/codec/storage/rans.h"

namespace lacedring::storage {
namespace {

// All is defined on integers, and so the same on every machine. Quotients and roots are computed as doubles and cut:
// exact, because both operands are doubles, and no quotient is nearer to the next integer than doubles tell apart.

using Vector = std::array<std::int64_t, 3>;
using Sums = std::array<std::uint64_t, 3>;  // modulo 2^64: nothing overflows, whatever is stored

constexpr std::uint32_t kPlaceBits = 18;           // of a coordinate
constexpr std::int32_t kNormalBits = 24;           // of a normal's largest component
constexpr std::int64_t kHalfTurn = 1 << 14;        // of angles
constexpr double kMostExact = 4503599627370496.0;  // 2^52

/// floor(x / y) of integers: x from 0 to 2^49, y from 1 to 2^52.
std::int64_t quotient(double x, double y) {
    return static_cast<std::int64_t>(x / y);
}

/// The places of vertices from their least coordinates, in kPlaceBits bits.
class ScaledPlaces {
  public:
    explicit ScaledPlaces(std::span<const std::uint32_t> positions) : positions_(positions) {
        std::array<std::int32_t, 3> high;
        low_.fill(INT32_MAX);
        high.fill(INT32_MIN);
        for (std::size_t i = 0; i + 3 <= positions.size(); i += 3) {
            for (std::size_t c = 0; c < 3; ++c) {
                const auto x = static_cast<std::int32_t>(positions[i + c]);
                low_[c] = std::min(low_[c], x);
                high[c] = std::max(high[c], x);
            }
        }
        std::uint32_t extent = 0;
        for (std::size_t c = 0; c < 3; ++c)
            extent |= static_cast<std::uint32_t>(high[c]) - static_cast<std::uint32_t>(low_[c]);
        const auto width = static_cast<std::uint32_t>(std::bit_width(extent));
        shift_ = width > kPlaceBits ? width - kPlaceBits : 0;
    }

    LACEDRING_INLINE Vector operator[](std::uint32_t v) const {
        const std::uint32_t* p = positions_.data() + std::size_t{3} * v;
        Vector out;
        for (std::size_t c = 0; c < 3; ++c) out[c] = (p[c] - static_cast<std::uint32_t>(low_[c])) >> shift_;
        return out;
    }

  private:
    std::span<const std::uint32_t> positions_;
    std::array<std::int32_t, 3> low_;
    std::uint32_t shift_;
};

LACEDRING_INLINE Vector minus(const Vector& a, const Vector& b) {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
LACEDRING_INLINE std::int64_t dot(const Vector& a, const Vector& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
LACEDRING_INLINE Vector cross(const Vector& a, const Vector& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
LACEDRING_INLINE std::int64_t shifted(std::int64_t x, std::int32_t left) {
    return left >= 0 ? static_cast<std::int64_t>(static_cast<std::uint64_t>(x) << left) : x >> -left;
}

/// The angle whose sine and cosine are as `sine`, positive, and `cosine`.
LACEDRING_INLINE std::int64_t angle_of(std::int64_t sine, std::int64_t cosine) {
    const auto y = static_cast<double>(sine),
               x = std::min(static_cast<double>(cosine < 0 ? -cosine : cosine), kMostExact);
    const std::int64_t q = quotient(65536 * std::min(x, y), std::max(x, y)), square = q * q >> 16;
    // The arc tangent of q / 65536, an eighth of a turn being 65536.
    std::int64_t t = 1738;
    for (const std::int64_t next : {7105, 15032, 27562, 83432}) t = next - (square * t >> 16);
    const std::int64_t arc = (q * t + 524288) >> 20;
    const std::int64_t acute = y > x ? kHalfTurn / 2 - arc : arc;
    return cosine < 0 ? kHalfTurn - acute : acute;
}

/// Adds the normals of triangles to the sums of their corners.
template <bool kByAngle, bool kByArea>
void add_triangles(const VertexPlaces& places, std::span<const std::uint32_t> triangles, bool of_vertex,
                   std::span<Sums> sums) {
    const ScaledPlaces scaled(places.positions);
    for (std::size_t t = 0; t < triangles.size(); t += 3) {
        std::array<std::uint32_t, 3> at{triangles[t], triangles[t + 1], triangles[t + 2]}, v = at;
        if (!places.vertex_of.empty()) {
            for (std::uint32_t& i : v) i = places.vertex_of[i];
            if (of_vertex) at = v;
        }
        const Vector p = scaled[v[0]], q = scaled[v[1]], r = scaled[v[2]];
        const Vector a = minus(q, p), b = minus(r, q), c = minus(p, r);
        Vector normal = cross(c, a);
        const auto largest =
            static_cast<std::uint64_t>(std::max({std::abs(normal[0]), std::abs(normal[1]), std::abs(normal[2])}));
        if (largest == 0) continue;
        std::array<std::int64_t, 3> weight{1, 1, 1};
        if constexpr (kByAngle || !kByArea) {
            const std::int32_t up = kNormalBits - static_cast<std::int32_t>(std::bit_width(largest));
            Vector scaled_normal;
            for (std::size_t k = 0; k < 3; ++k) scaled_normal[k] = shifted(normal[k], up);
            const auto length =
                static_cast<std::int64_t>(std::sqrt(static_cast<double>(dot(scaled_normal, scaled_normal))));
            if constexpr (kByAngle) {
                weight = {angle_of(length, shifted(-dot(c, a), up)), angle_of(length, shifted(-dot(a, b), up)),
                          angle_of(length, shifted(-dot(b, c), up))};
            }
            if constexpr (!kByArea) {
                const std::int64_t by = quotient(0x1p39, static_cast<double>(length));
                for (std::size_t k = 0; k < 3; ++k) normal[k] = scaled_normal[k] * by >> 24;
            }
        }
        for (std::size_t k = 0; k < 3; ++k) {
            Sums& sum = sums[at[k]];
            for (std::size_t i = 0; i < 3; ++i) sum[i] += static_cast<std::uint64_t>(normal[i] * weight[k]);
        }
    }
}

/// The octahedral integers of a vector.
LACEDRING_INLINE std::array<std::int32_t, 2> octahedral(const Sums& sum, std::int32_t most) {
    std::array<std::uint64_t, 3> size;
    for (std::size_t i = 0; i < 3; ++i) size[i] = sum[i] >> 63 != 0 ? 0 - sum[i] : sum[i];
    const auto width = static_cast<std::uint32_t>(std::bit_width(size[0] | size[1] | size[2]));
    for (std::uint64_t& s : size) s >>= width > 32 ? width - 32 : 0;
    const auto all = static_cast<double>(size[0] + size[1] + size[2]);
    if (all == 0) return {0, 0};
    std::array<std::int32_t, 2> out;
    for (std::size_t i = 0; i < 2; ++i) {
        const double twice = 2 * static_cast<double>(most) * static_cast<double>(size[i]);
        out[i] = static_cast<std::int32_t>(quotient(twice + all, 2 * all));
    }
    if (sum[2] >> 63 != 0) out = {most - out[1], most - out[0]};
    for (std::size_t i = 0; i < 2; ++i) {
        if (sum[i] >> 63 != 0) out[i] = -out[i];
    }
    return out;
}

/// Turns a point of the square over: the lower half's lie in the middle then, each at a place of its own. It is its own
/// inverse.
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

bool has_places(const VertexPlaces& places, std::uint32_t copies) {
    if (places.vertex_of.empty()) return places.positions.size() == std::size_t{3} * copies;
    return places.vertex_of.size() == copies &&
           std::ranges::all_of(places.vertex_of, [&](std::uint32_t v) { return v < places.positions.size() / 3; });
}

std::vector<std::uint32_t> surface_normals(const VertexPlaces& places, std::span<const std::uint32_t> triangles,
                                           std::uint32_t copies, const NormalBase& base, std::uint32_t bits) {
    const bool of_vertex = base.of_vertex && !places.vertex_of.empty();
    std::vector<Sums> sums(of_vertex ? places.positions.size() / 3 : copies, Sums{});
    const auto add = base.by_angle  ? base.by_area ? add_triangles<true, true> : add_triangles<true, false>
                      : base.by_area ? add_triangles<false, true>
                                    : add_triangles<false, false>;
    add(places, triangles, of_vertex, sums);
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
