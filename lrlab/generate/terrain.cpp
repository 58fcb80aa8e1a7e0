// The kind `terrain`: a height field with holes.

#include <algorithm>
#include <cmath>
#include <vector>

#include "lrlab/generate/detail.h"

namespace lacedring::detail {
namespace {

/// An ellipse of cells that fills its bounding box. Its inequality is f(x) + g(y) <= r. So of four cells around a
/// vertex, two diagonal ones are never the only ones inside: the hole never touches itself at a vertex.
struct Hole {
    std::uint64_t x = 0, y = 0, width = 1, height = 1;

    bool contains(std::uint64_t cell_x, std::uint64_t cell_y) const {
        if (cell_x - x >= width || cell_y - y >= height) return false;
        const auto dx = static_cast<std::int64_t>(2 * (cell_x - x) + 1) - static_cast<std::int64_t>(width);
        const auto dy = static_cast<std::int64_t>(2 * (cell_y - y) + 1) - static_cast<std::int64_t>(height);
        const std::int64_t a = dx * static_cast<std::int64_t>(height);
        const std::int64_t b = dy * static_cast<std::int64_t>(width);
        const std::int64_t r = static_cast<std::int64_t>(width * height);
        return a * a + b * b <= r * r;
    }
    std::uint64_t cells() const {
        std::uint64_t sum = 0;
        for (std::uint64_t row = y; row < y + height; ++row) {
            std::uint64_t low = x;  // bisection of the left half for the first cell inside
            std::uint64_t high = x + (width - 1) / 2;
            if (!contains(high, row)) continue;
            while (low < high) {
                const std::uint64_t middle = (low + high) / 2;
                if (contains(middle, row)) {
                    high = middle;
                } else {
                    low = middle + 1;
                }
            }
            sum += width - 2 * (low - x);
        }
        return sum;
    }
};

/// The grid is divided into equal tiles. Each tile has a hole, at least a cell from the tile's border.
struct Ground {
    std::uint64_t width = 8;
    std::uint64_t height = 5;
    std::uint64_t tiles_x = 2;
    std::uint64_t tiles_y = 1;
    std::vector<Hole> holes;

    void dig(std::uint64_t seed) {
        tiles_x = std::clamp<std::uint64_t>(width / 8, 2, 4);
        tiles_y = std::clamp<std::uint64_t>(height / 8, 1, 4);
        holes.clear();
        Random random(seed);  // the same random numbers for all sizes
        for (std::uint64_t i = 0; i < tiles_x * tiles_y; ++i) {
            const std::uint64_t left = (i % tiles_x) * width / tiles_x + 1;
            const std::uint64_t right = (i % tiles_x + 1) * width / tiles_x - 1;
            const std::uint64_t low = (i / tiles_x) * height / tiles_y + 1;
            const std::uint64_t high = (i / tiles_x + 1) * height / tiles_y - 1;
            Hole hole;
            hole.width = std::max<std::uint64_t>((right - left) * random.between(100, 700) / 1000, 1);
            hole.height = std::max<std::uint64_t>((high - low) * random.between(100, 700) / 1000, 1);
            hole.x = left + (right - left - hole.width) * random.below(1001) / 1000;
            hole.y = low + (high - low - hole.height) * random.below(1001) / 1000;
            holes.push_back(hole);
        }
    }
    std::uint64_t triangles() const {
        std::uint64_t cells = width * height;
        for (const Hole& hole : holes) cells -= hole.cells();
        return 2 * cells;
    }
    bool solid(std::uint64_t x, std::uint64_t y) const {  // x or y may be -1 (UINT64_MAX)
        if (x >= width || y >= height) return false;
        // Tile borders are rounded down, so this tile may be one too low.
        std::uint64_t i = x * tiles_x / width;
        std::uint64_t j = y * tiles_y / height;
        if ((i + 1) * width / tiles_x <= x) ++i;
        if ((j + 1) * height / tiles_y <= y) ++j;
        return !holes[j * tiles_x + i].contains(x, y);
    }
};

Ground fit(std::uint64_t triangles, std::uint64_t seed) {
    Ground ground;
    ground.dig(seed);
    triangles = std::max(triangles, ground.triangles());
    Ground best = ground;
    double best_score = 1e9;
    // The holes' share of the area hardly depends on the size: starts from a guess and searches around it.
    const std::uint64_t ideal = std::max<std::uint64_t>(square_root(triangles * 2 / 5), 5);
    const std::uint64_t step = std::max<std::uint64_t>(ideal / 20, 1);
    for (std::uint64_t height = std::max<std::uint64_t>(ideal - ideal / 4, 5); height <= ideal + ideal / 4 + 1;
         height += step) {
        ground.height = height;
        ground.width = std::max<std::uint64_t>(triangles / (2 * height), 8);
        for (int i = 0; i < 6; ++i) {
            ground.dig(seed);
            const std::uint64_t made = ground.triangles();
            const double score = misfit(made, triangles) + 0.005 * misfit(height, ideal);
            if (within_limit(made, triangles) && score < best_score) {
                best = ground;
                best_score = score;
            }
            // Rounds down and up alternately, since a width that is one too large may exceed the limit.
            const double wanted = static_cast<double>(ground.width) * static_cast<double>(triangles) /
                                  static_cast<double>(std::max<std::uint64_t>(made, 1));
            ground.width =
                std::max<std::uint64_t>(static_cast<std::uint64_t>(wanted) + static_cast<std::uint64_t>(i % 2), 8);
        }
    }
    return best;
}

}  // namespace

Result<Mesh> make_terrain(std::uint64_t triangles, std::uint64_t seed) {
    const Ground ground = fit(triangles, seed);
    if (ground.triangles() / 2 > kMostVertices) return too_many_generated();
    Builder builder;
    builder.reserve(ground.triangles() / 2 + 4 * (ground.width + ground.height), ground.triangles());
    const double scale = 2.0 / static_cast<double>(std::max(ground.width, ground.height));
    std::vector<std::uint32_t> vertex[2];
    std::vector<double> level[2];
    std::vector<char> filled[2];  // with a guard cell at each end
    for (int i = 0; i < 2; ++i) {
        vertex[i].resize(ground.width + 1);
        level[i].resize(ground.width + 1);
        filled[i].assign(ground.width + 2, 0);
    }
    for (std::uint64_t y = 0; y <= ground.height; ++y) {
        std::vector<std::uint32_t>& here = vertex[y % 2];
        std::vector<std::uint32_t>& before = vertex[(y + 1) % 2];
        std::vector<double>& z = level[y % 2];
        std::vector<double>& z_before = level[(y + 1) % 2];
        std::vector<char>& above = filled[y % 2];  // the row of cells that begins here
        const std::vector<char>& below = filled[(y + 1) % 2];
        for (std::uint64_t x = 0; x < ground.width; ++x) above[x + 1] = ground.solid(x, y) ? 1 : 0;
        for (std::uint64_t x = 0; x <= ground.width; ++x) {
            if ((above[x] | above[x + 1] | below[x] | below[x + 1]) == 0) continue;
            const double px = scale * static_cast<double>(x) - 1;
            const double py = scale * static_cast<double>(y) - 1;
            z[x] = 0.3 * fractal_noise({2 * px, 2 * py, 0.5}, 6, mix(seed));
            if (builder.vertices() == kMostVertices) return too_many_generated();
            here[x] = builder.vertex({px, py, z[x]});
        }
        for (std::uint64_t x = 0; y > 0 && x < ground.width; ++x) {
            if (below[x + 1] == 0) continue;
            // Chooses the diagonal with the smaller height difference, so that valences are irregular.
            const double ac = std::fabs(z_before[x] - z[x + 1]);
            const double bd = std::fabs(z_before[x + 1] - z[x]);
            builder.quad(before[x], before[x + 1], here[x + 1], here[x], bd < ac);
        }
    }
    return builder.finish();
}

}  // namespace lacedring::detail
