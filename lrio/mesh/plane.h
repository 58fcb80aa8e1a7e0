#pragma once
// Points of a plane, and exact orientations. Internal to lrio.

namespace lacedring::detail {

struct PlanePoint {
    double u = 0;
    double v = 0;

    bool operator==(const PlanePoint&) const = default;
};

/// The computed sign of x * y - z * w, where x, y, z and w are rounded differences, is right if |x * y - z * w| exceeds
/// this times |x * y| + |z * w|. It is Shewchuk's (3 + 16 e) e for e = 2^-53.
inline constexpr double kSureOrientation = 3.3306690738754716e-16;

/// The sign of twice the area of the triangle: 1 counterclockwise, 0 collinear, -1 clockwise. Exact for coordinates
/// that are 0 or have magnitudes from 2^-400 to 2^400.
int orientation(const PlanePoint& a, const PlanePoint& b, const PlanePoint& c);

}  // namespace lacedring::detail
