#include "lrlab/generate/detail.h"

#include <cmath>
#include <cstring>

namespace lacedring::detail {

Turn turn(std::uint64_t k, std::uint64_t n) {
    // Reduces the angle to at most pi/4 in integers, then sums the Taylor series. The error is below 2^-52.
    k %= n;
    const std::uint64_t octant = 8 * k / n;
    std::uint64_t rest = 8 * k - octant * n;
    if (octant % 2 == 1) rest = n - rest;
    const double x = 0.78539816339744830962 * (static_cast<double>(rest) / static_cast<double>(n));
    const double y = x * x;
    double sine = 0;
    double cosine = 0;
    for (int i = 17; i >= 1; i -= 2) sine = 1 - y * sine / static_cast<double>((i + 1) * (i + 2));
    for (int i = 16; i >= 0; i -= 2) cosine = 1 - y * cosine / static_cast<double>((i + 1) * (i + 2));
    sine *= x;
    const bool swap = octant == 1 || octant == 2 || octant == 5 || octant == 6;
    const double c = swap ? sine : cosine;
    const double s = swap ? cosine : sine;
    return {octant >= 2 && octant <= 5 ? -c : c, octant >= 4 ? -s : s};
}

namespace {

double lattice(std::int64_t x, std::int64_t y, std::int64_t z, std::uint64_t seed) {
    const std::uint64_t h = static_cast<std::uint64_t>(x) * 0x9e3779b97f4a7c15ULL ^
                            static_cast<std::uint64_t>(y) * 0xc2b2ae3d27d4eb4fULL ^
                            static_cast<std::uint64_t>(z) * 0x165667b19e3779f9ULL;
    return static_cast<double>(mix(h + seed) >> 40) * (1.0 / 8388608.0) - 1.0;
}

double fade(double t) {
    return t * t * (3 - 2 * t);
}
double blend(double t, double a, double b) {
    return a + t * (b - a);
}

}  // namespace

double noise(Point p, std::uint64_t seed) {
    const double fx = std::floor(p[0]);
    const double fy = std::floor(p[1]);
    const double fz = std::floor(p[2]);
    const auto x = static_cast<std::int64_t>(fx);
    const auto y = static_cast<std::int64_t>(fy);
    const auto z = static_cast<std::int64_t>(fz);
    const double u = fade(p[0] - fx);
    const double v = fade(p[1] - fy);
    const double w = fade(p[2] - fz);
    double plane[2];
    for (int i = 0; i < 2; ++i) {
        plane[i] = blend(v, blend(u, lattice(x, y, z + i, seed), lattice(x + 1, y, z + i, seed)),
                         blend(u, lattice(x, y + 1, z + i, seed), lattice(x + 1, y + 1, z + i, seed)));
    }
    return blend(w, plane[0], plane[1]);
}

double fractal_noise(Point p, int octaves, std::uint64_t seed) {
    double sum = 0;
    double height = 1;
    for (int i = 0; i < octaves; ++i) {
        sum += height * noise(p, seed + static_cast<std::uint64_t>(i));
        height *= 0.5;
        p = {2 * p[0] + 0.37, 2 * p[1] + 0.61, 2 * p[2] + 0.83};
    }
    return sum;
}

void Builder::reserve(std::uint64_t vertices, std::uint64_t triangles) {
    positions_.reserve(static_cast<std::size_t>(vertices) * 12);
    mesh_.indices.reserve(static_cast<std::size_t>(triangles) * 3);
}

std::uint32_t Builder::vertex(Point p) {
    const float xyz[3] = {static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2])};
    std::byte bytes[sizeof xyz];
    std::memcpy(bytes, xyz, sizeof xyz);
    positions_.insert(positions_.end(), bytes, bytes + sizeof bytes);
    return mesh_.vertex_count++;
}

Mesh Builder::finish() {
    Attribute position{"POSITION", ComponentType::f32, 3, false, {}};
    position.data = std::move(positions_);
    mesh_.attributes.push_back(std::move(position));
    return std::move(mesh_);
}

std::uint64_t square_root(std::uint64_t n) {
    auto root = static_cast<std::uint64_t>(std::sqrt(static_cast<double>(n)));
    while (root * root > n) --root;
    while ((root + 1) * (root + 1) <= n) ++root;
    return root;
}

Error too_many_generated() {
    return {ErrorCode::invalid_argument, "the mesh would have more than 2^29 vertices"};
}

}  // namespace lacedring::detail
