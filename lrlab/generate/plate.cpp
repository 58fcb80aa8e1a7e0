// The kind `genus`: a plate with holes, which is a closed surface of any genus.

#include <algorithm>
#include <vector>

#include "lrlab/generate/detail.h"

namespace lacedring::detail {
namespace {

/// Holes are in columns and rows with bars between them: of 2 * columns + 1 columns, the odd ones have holes.
struct Plate {
    std::uint64_t genus = 2;
    std::uint64_t columns = 2;
    std::uint64_t rows = 1;
    std::uint64_t width = 5;   ///< in cells
    std::uint64_t height = 3;  ///< in cells

    std::uint64_t x(std::uint64_t k) const { return k * width / (2 * columns + 1); }
    std::uint64_t y(std::uint64_t k) const { return k * height / (2 * rows + 1); }
    std::uint64_t triangles() const {
        std::uint64_t cells = width * height;
        std::uint64_t walls = 2 * (width + height);
        for (std::uint64_t h = 0; h < genus; ++h) {
            const std::uint64_t c = h % columns;
            const std::uint64_t r = h / columns;
            const std::uint64_t w = x(2 * c + 2) - x(2 * c + 1);
            const std::uint64_t l = y(2 * r + 2) - y(2 * r + 1);
            cells -= w * l;
            walls += 2 * (w + l);
        }
        return 4 * cells + 2 * walls;
    }
    /// Euler: V - T/2 = 2 - 2 genus.
    std::uint64_t vertices() const { return triangles() / 2 + 2 - 2 * genus; }
};

Plate fit(std::uint64_t triangles, std::uint64_t genus) {
    Plate plate;
    plate.genus = genus;
    plate.columns = square_root(genus);
    if (plate.columns * plate.columns < genus) ++plate.columns;
    plate.rows = (genus + plate.columns - 1) / plate.columns;
    plate.width = 2 * plate.columns + 1;
    plate.height = 2 * plate.rows + 1;
    const std::uint64_t least_width = plate.width;
    const std::uint64_t least_height = plate.height;
    triangles = std::max(triangles, plate.triangles());

    // A cell has four triangles, and at most a quarter of the cells is in holes. The number of triangles grows with
    // width and height.
    Plate best = plate;
    double best_score = 1e9;
    const std::uint64_t ideal = std::max(square_root(triangles * least_height / (3 * least_width)), least_height);
    const std::uint64_t first = std::max(ideal - ideal / 3, least_height);
    const std::uint64_t step = std::max<std::uint64_t>(ideal / 200, 1);
    for (std::uint64_t height = first; height <= ideal + ideal / 3 + 1; height += step) {
        plate.height = height;
        std::uint64_t low = least_width;  // bisection: the largest width with at most `triangles`
        std::uint64_t high = triangles / height + least_width;
        while (low < high) {
            plate.width = (low + high + 1) / 2;
            if (plate.triangles() <= triangles) {
                low = plate.width;
            } else {
                high = plate.width - 1;
            }
        }
        plate.width = low;
        if (!within_limit(plate.triangles(), triangles)) continue;
        const double score = misfit(plate.triangles(), triangles) + 0.01 * misfit(height, ideal);
        if (score < best_score) {
            best = plate;
            best_score = score;
        }
    }
    return best;
}

}  // namespace

Result<Mesh> make_genus(std::uint64_t triangles, std::uint64_t seed) {
    const Plate plate = fit(triangles, 2 + seed % 30);
    if (plate.vertices() > kMostVertices) return too_many_generated();
    const auto width = static_cast<std::uint32_t>(plate.width);
    const auto height = static_cast<std::uint32_t>(plate.height);

    constexpr std::uint32_t no_hole = UINT32_MAX;
    std::vector<std::uint32_t> hole_column(width, no_hole);
    std::vector<std::uint32_t> hole_row(height, no_hole);
    for (std::uint32_t c = 0; c < plate.columns; ++c) {
        for (std::uint64_t x = plate.x(2 * c + 1); x < plate.x(2 * c + 2); ++x) hole_column[x] = c;
    }
    for (std::uint32_t r = 0; r < plate.rows; ++r) {
        for (std::uint64_t y = plate.y(2 * r + 1); y < plate.y(2 * r + 2); ++y) hole_row[y] = r;
    }
    const auto solid = [&](std::uint32_t x, std::uint32_t y) {  // x or y may be -1 (UINT32_MAX)
        if (x >= width || y >= height) return false;
        if (hole_column[x] == no_hole || hole_row[y] == no_hole) return true;
        return hole_row[y] * plate.columns + hole_column[x] >= plate.genus;
    };

    Builder builder;
    builder.reserve(plate.vertices(), plate.triangles());
    const double scale = 2.0 / static_cast<double>(std::max(width, height));
    const double middle_x = 0.5 * static_cast<double>(width);
    const double middle_y = 0.5 * static_cast<double>(height);
    const double thick = 0.6 / static_cast<double>(2 * plate.columns + 1);
    // The top vertex of each grid point of the last two rows; the bottom vertex has the next index.
    std::vector<std::uint32_t> rows[2];
    rows[0].resize(std::size_t{width} + 1);
    rows[1].resize(std::size_t{width} + 1);
    for (std::uint32_t y = 0; y <= height; ++y) {
        std::vector<std::uint32_t>& here = rows[y % 2];
        const std::vector<std::uint32_t>& before = rows[(y + 1) % 2];
        for (std::uint32_t x = 0; x <= width; ++x) {
            if (!solid(x, y) && !solid(x - 1, y) && !solid(x, y - 1) && !solid(x - 1, y - 1)) continue;
            const double px = scale * (static_cast<double>(x) - middle_x);
            const double py = scale * (static_cast<double>(y) - middle_y);
            const double dome = 0.15 * fractal_noise({1.5 * px, 1.5 * py, 0}, 3, seed) - 0.2 * (px * px + py * py);
            here[x] = builder.vertex({px, py, dome + thick});
            builder.vertex({px, py, dome - thick});
        }
        const auto wall = [&](std::uint32_t p, std::uint32_t q) { builder.quad(q, p, p + 1, q + 1); };
        for (std::uint32_t x = 0; y > 0 && x < width; ++x) {
            if (!solid(x, y - 1)) continue;
            const std::uint32_t a = before[x];
            const std::uint32_t b = before[x + 1];
            const std::uint32_t c = here[x + 1];
            const std::uint32_t d = here[x];
            builder.quad(a, b, c, d);
            builder.quad(d + 1, c + 1, b + 1, a + 1);
            if (!solid(x, y - 2)) wall(a, b);
            if (!solid(x + 1, y - 1)) wall(b, c);
            if (!solid(x, y)) wall(c, d);
            if (!solid(x - 1, y - 1)) wall(d, a);
        }
    }
    return builder.finish();
}

}  // namespace lacedring::detail
