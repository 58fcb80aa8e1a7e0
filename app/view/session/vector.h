#pragma once
// Points and directions in the mesh's coordinates.

#include <array>
#include <cmath>

namespace lacedring::view {

using Vector = std::array<double, 3>;

inline Vector operator+(const Vector& a, const Vector& b) {
    return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
inline Vector operator-(const Vector& a, const Vector& b) {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
inline Vector operator*(const Vector& a, double s) {
    return {a[0] * s, a[1] * s, a[2] * s};
}
inline double dot(const Vector& a, const Vector& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
inline Vector cross(const Vector& a, const Vector& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
inline double length(const Vector& a) {
    return std::sqrt(dot(a, a));
}
inline Vector unit(const Vector& a) {
    const double l = length(a);
    return l > 0 ? a * (1 / l) : Vector{0, 0, 1};
}

}  // namespace lacedring::view
