// The kind `sphere`, from which the blob is made, too.

#include <algorithm>

#include "lrlab/generate/detail.h"

namespace lacedring::detail {

SphereShape sphere_shape(std::uint64_t triangles) {
    triangles = std::max<std::uint64_t>(triangles, 8);
    SphereShape best{4, 1, 0};
    double best_score = 1e9;
    for (const std::uint64_t sectors : {5U, 4U, 6U}) {
        const std::uint64_t ideal = square_root(triangles / (4 * sectors));
        const std::uint64_t last = ideal + ideal / 4 + 1;
        for (std::uint64_t cap = std::max<std::uint64_t>(ideal - ideal / 4, 1); cap <= last; ++cap) {
            const std::uint64_t rows = triangles / (2 * sectors * cap);  // cap + band, rounded down
            for (const std::uint64_t sum : {rows, rows + 1}) {
                const SphereShape shape{sectors, cap, sum > cap ? sum - cap : 0};
                if (!within_limit(shape.triangles(), triangles)) continue;
                const double stretch = misfit(shape.band + 1, cap + 1);  // 0: all triangles have similar shapes
                const double score = misfit(shape.triangles(), triangles) + 0.002 * stretch;
                if (score < best_score) {
                    best = shape;
                    best_score = score;
                }
            }
        }
    }
    return best;
}

Builder build_sphere(const SphereShape& shape) {
    Builder builder;
    builder.reserve(shape.vertices(), shape.triangles());
    const std::uint64_t rows = shape.rows();
    std::uint32_t upper = 0;  // first vertex of the ring above
    for (std::uint64_t i = 0; i <= rows; ++i) {
        const Turn latitude = turn(i, 2 * rows);
        const auto size = static_cast<std::uint32_t>(shape.ring_size(i));
        const std::uint32_t lower = builder.vertices();
        // Shifts each row of the band by half an edge, so that the triangles are nearly equilateral.
        const std::uint64_t shift = std::min(i < shape.cap ? 0 : i - shape.cap, shape.band);
        for (std::uint32_t j = 0; j < std::max(size, 1U); ++j) {
            const std::uint64_t equator = shape.sectors * shape.cap;
            const Turn longitude = size == 0 ? Turn{} : turn(2 * equator * j + shift * size, 2 * equator * size);
            builder.vertex({latitude.sin * longitude.cos, latitude.sin * longitude.sin, latitude.cos});
        }
        if (i == 0) continue;
        const auto above = static_cast<std::uint32_t>(shape.ring_size(i - 1));
        const auto sector_above = static_cast<std::uint32_t>(above / shape.sectors);
        const auto sector_below = static_cast<std::uint32_t>(size / shape.sectors);
        const auto up = [&](std::uint32_t j) { return upper + (above == 0 ? 0 : j % above); };
        const auto down = [&](std::uint32_t j) { return lower + (size == 0 ? 0 : j % size); };
        for (std::uint32_t s = 0; s < static_cast<std::uint32_t>(shape.sectors); ++s) {
            const std::uint32_t a = s * sector_above;
            const std::uint32_t b = s * sector_below;
            const std::uint32_t steps = std::max(sector_above, sector_below);
            for (std::uint32_t j = 0; j < steps; ++j) {
                // In the upper cap and the band, the triangles with an edge on the lower ring come first.
                if (sector_below >= sector_above) {
                    if (sector_below == sector_above) {
                        builder.triangle(up(a + j), down(b + j), up(a + j + 1));
                        builder.triangle(up(a + j + 1), down(b + j), down(b + j + 1));
                    } else {
                        builder.triangle(up(a + j), down(b + j), down(b + j + 1));
                        if (j < sector_above) builder.triangle(up(a + j), down(b + j + 1), up(a + j + 1));
                    }
                } else {
                    builder.triangle(up(a + j), down(b + j), up(a + j + 1));
                    if (j < sector_below) builder.triangle(up(a + j + 1), down(b + j), down(b + j + 1));
                }
            }
        }
        upper = lower;
    }
    return builder;
}

Result<Mesh> make_sphere(std::uint64_t triangles, std::uint64_t) {
    const SphereShape shape = sphere_shape(triangles);
    if (shape.vertices() > kMostVertices) return too_many_generated();
    return build_sphere(shape).finish();
}

}  // namespace lacedring::detail
