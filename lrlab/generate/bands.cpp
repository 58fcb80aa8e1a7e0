// The torus and the Moebius strip: grids closed to a band.

#include <algorithm>

#include "lrlab/generate/detail.h"

namespace lacedring::detail {
namespace {

struct Grid {
    std::uint64_t length = 3;
    std::uint64_t width = 3;
};

/// The best grid of about `quads` cells that is about `aspect` times as long as wide.
Grid fit(std::uint64_t quads, std::uint64_t aspect, std::uint64_t least_width, std::uint64_t least_length) {
    Grid best{least_length, least_width};
    double best_score = 1e9;
    const std::uint64_t ideal = std::max(square_root(quads / aspect), least_width);
    const std::uint64_t first = std::max(ideal - ideal / 4, least_width);
    for (std::uint64_t width = first; width <= ideal + ideal / 4 + 1; ++width) {
        for (const std::uint64_t length : {quads / width, quads / width + 1}) {
            if (length < least_length || !within_limit(2 * length * width, 2 * quads)) continue;
            const double score = misfit(length * width, quads) + 0.002 * misfit(width, ideal);
            if (score < best_score) {
                best = {length, width};
                best_score = score;
            }
        }
    }
    return best;
}

}  // namespace

Result<Mesh> make_torus(std::uint64_t triangles, std::uint64_t) {
    const Grid grid = fit(std::max<std::uint64_t>(triangles / 2, 9), 2, 3, 3);
    if (grid.length * grid.width > kMostVertices) return too_many_generated();
    const auto length = static_cast<std::uint32_t>(grid.length);
    const auto width = static_cast<std::uint32_t>(grid.width);
    Builder builder;
    builder.reserve(grid.length * grid.width, 2 * grid.length * grid.width);
    for (std::uint32_t i = 0; i < length; ++i) {
        const Turn around = turn(i, length);
        for (std::uint32_t j = 0; j < width; ++j) {
            const Turn section = turn(j, width);
            const double radius = 1 + 0.45 * section.cos;
            builder.vertex({radius * around.cos, radius * around.sin, 0.45 * section.sin});
        }
    }
    for (std::uint32_t i = 0; i < length; ++i) {
        const std::uint32_t here = i * width;
        const std::uint32_t there = (i + 1) % length * width;
        for (std::uint32_t j = 0; j < width; ++j) {
            const std::uint32_t k = (j + 1) % width;
            builder.quad(here + j, there + j, there + k, here + k);
        }
    }
    return builder.finish();
}

Result<Mesh> make_moebius(std::uint64_t triangles, std::uint64_t) {
    const Grid grid = fit(std::max<std::uint64_t>(triangles / 2, 5), 12, 1, 5);
    if (grid.length * (grid.width + 1) > kMostVertices) return too_many_generated();
    const auto length = static_cast<std::uint32_t>(grid.length);
    const auto width = static_cast<std::uint32_t>(grid.width);
    Builder builder;
    builder.reserve(grid.length * (grid.width + 1), 2 * grid.length * grid.width);
    for (std::uint32_t i = 0; i < length; ++i) {
        const Turn around = turn(i, length);
        const Turn twist = turn(i, 2 * std::uint64_t{length});
        for (std::uint32_t j = 0; j <= width; ++j) {
            const double across = 0.4 * (2 * static_cast<double>(j) / static_cast<double>(width) - 1);
            const double radius = 1 + across * twist.cos;
            builder.vertex({radius * around.cos, radius * around.sin, across * twist.sin});
        }
    }
    const auto at = [&](std::uint32_t i, std::uint32_t j) {
        return i < length ? i * (width + 1) + j : width - j;  // the last column joins the first one upside down
    };
    for (std::uint32_t i = 0; i < length; ++i) {
        for (std::uint32_t j = 0; j < width; ++j) builder.quad(at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
    }
    return builder.finish();
}

}  // namespace lacedring::detail
