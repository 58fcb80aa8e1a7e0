#pragma once
// Vectors of three numbers. Sums are evaluated from left to right, so results are the same on every platform.

#include <array>
#include <cmath>

namespace lacedring::detail {

template <class T>
using Vec3 = std::array<T, 3>;

template <class T>
Vec3<T> minus(const Vec3<T>& a, const Vec3<T>& b) {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

template <class T>
T dot(const Vec3<T>& a, const Vec3<T>& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

template <class T>
T length(const Vec3<T>& a) {
    return std::sqrt(dot(a, a));
}

template <class T>
Vec3<T> cross(const Vec3<T>& a, const Vec3<T>& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

}  // namespace lacedring::detail
