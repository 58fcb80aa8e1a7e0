#pragma once
// Node transforms of glTF. The order of all operations is fixed (docs/formats-read.md), so that other programs can
// compute the same bits. C++20 without extensions never contracts a multiplication and an addition into a fused one.
// Internal to lrio.

#include <array>
#include <cmath>
#include <cstddef>

#include "lrcore/base/vec3.h"

namespace lacedring::detail {

/// A 4 x 4 matrix in column-major order, as in glTF.
struct Transform {
    std::array<double, 16> m{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};

    bool is_identity() const { return m == Transform{}.m; }

    /// The cofactor matrix of the linear part (determinant times inverse transpose): entry [3 * column + row].
    std::array<double, 9> cofactors() const {
        return {m[5] * m[10] - m[6] * m[9], m[6] * m[8] - m[4] * m[10], m[4] * m[9] - m[5] * m[8],
                m[2] * m[9] - m[1] * m[10], m[0] * m[10] - m[2] * m[8], m[1] * m[8] - m[0] * m[9],
                m[1] * m[6] - m[2] * m[5],  m[2] * m[4] - m[0] * m[6],  m[0] * m[5] - m[1] * m[4]};
    }
    double determinant() const {
        const std::array<double, 9> c = cofactors();
        return (m[0] * c[0] + m[1] * c[1]) + m[2] * c[2];
    }
};

using Vector3 = Vec3<double>;

inline Transform operator*(const Transform& a, const Transform& b) {
    Transform out;
    for (std::size_t column = 0; column < 4; ++column) {
        const double* v = b.m.data() + column * 4;
        for (std::size_t row = 0; row < 4; ++row) {
            out.m[column * 4 + row] =
                ((a.m[row] * v[0] + a.m[4 + row] * v[1]) + a.m[8 + row] * v[2]) + a.m[12 + row] * v[3];
        }
    }
    return out;
}

/// Translation * rotation * scale. The rotation is a quaternion x y z w, used without normalizing it.
inline Transform from_parts(const Vector3& t, const std::array<double, 4>& q, const Vector3& s) {
    const auto [x, y, z, w] = q;
    return {{(1 - 2 * (y * y + z * z)) * s[0], 2 * (x * y + z * w) * s[0], 2 * (x * z - y * w) * s[0], 0,
             2 * (x * y - z * w) * s[1], (1 - 2 * (x * x + z * z)) * s[1], 2 * (y * z + x * w) * s[1], 0,
             2 * (x * z + y * w) * s[2], 2 * (y * z - x * w) * s[2], (1 - 2 * (x * x + y * y)) * s[2], 0, t[0], t[1],
             t[2], 1}};
}

inline Vector3 transform_point(const Transform& a, const Vector3& p) {
    Vector3 out{};
    for (std::size_t row = 0; row < 3; ++row) {
        out[row] = ((a.m[row] * p[0] + a.m[4 + row] * p[1]) + a.m[8 + row] * p[2]) + a.m[12 + row];
    }
    return out;
}

inline Vector3 transform_direction(const Transform& a, const Vector3& d) {
    Vector3 out{};
    for (std::size_t row = 0; row < 3; ++row) {
        out[row] = (a.m[row] * d[0] + a.m[4 + row] * d[1]) + a.m[8 + row] * d[2];
    }
    return out;
}

/// Transforms a normal by the inverse transpose, up to its length. Of the division of the cofactors by the determinant,
/// only the determinant's sign (`mirrors`) affects the direction.
inline Vector3 transform_normal(const std::array<double, 9>& cofactors, bool mirrors, const Vector3& n) {
    Vector3 out{};
    for (std::size_t row = 0; row < 3; ++row) {
        const double sum = (cofactors[row] * n[0] + cofactors[3 + row] * n[1]) + cofactors[6 + row] * n[2];
        out[row] = mirrors ? -sum : sum;
    }
    return out;
}

/// Normalizes a vector. A zero vector, or one that is not finite, stays unchanged.
inline Vector3 normalized(const Vector3& v) {
    const double size = length(v);
    if (!(size > 0) || !std::isfinite(size)) return v;
    return {v[0] / size, v[1] / size, v[2] / size};
}

}  // namespace lacedring::detail
