#include "lrio/mesh/plane.h"

#include <cmath>
#include <cstddef>
#include <span>

namespace lacedring::detail {
namespace {

/// The exact sign of a sum of doubles. Keeps the partial sums as nonoverlapping doubles (Shewchuk 1997).
int sign_of_sum(std::span<const double> terms) {
    double parts[12];
    std::size_t count = 0;
    for (double sum : terms) {
        for (std::size_t i = 0; i < count; ++i) {
            const double part = parts[i];
            const double rounded = sum + part;
            const double virtual_part = rounded - sum;
            parts[i] = (sum - (rounded - virtual_part)) + (part - virtual_part);
            sum = rounded;
        }
        parts[count++] = sum;
    }
    while (count != 0) {
        const double part = parts[--count];  // the largest nonzero part exceeds the sum of the smaller ones
        if (part != 0) return part > 0 ? 1 : -1;
    }
    return 0;
}

int exact_orientation(const PlanePoint& a, const PlanePoint& b, const PlanePoint& c) {
    double terms[12];
    std::size_t count = 0;
    const auto add_product = [&](double x, double y) {
        const double product = x * y;
        terms[count++] = std::fma(x, y, -product);
        terms[count++] = product;
    };
    add_product(a.u, b.v);
    add_product(-a.v, b.u);
    add_product(b.u, c.v);
    add_product(-b.v, c.u);
    add_product(c.u, a.v);
    add_product(-c.v, a.u);
    return sign_of_sum(terms);
}

int sign(double value) {
    return (value > 0 ? 1 : 0) - (value < 0 ? 1 : 0);
}

}  // namespace

int orientation(const PlanePoint& a, const PlanePoint& b, const PlanePoint& c) {
    const double left = (a.u - c.u) * (b.v - c.v);
    const double right = (a.v - c.v) * (b.u - c.u);
    const double area = left - right;
    if (left == 0 || right == 0 || std::abs(area) > kSureOrientation * (std::abs(left) + std::abs(right)))
        return sign(area);
    return exact_orientation(a, b, c);
}

}  // namespace lacedring::detail
