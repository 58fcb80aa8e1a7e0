// The kind `soup`: all defects that a mesh may have.

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "lrlab/generate/detail.h"

namespace lacedring::detail {
namespace {

using Triangles = std::vector<std::array<std::uint32_t, 3>>;

/// A grid of width x height cells; vertices are numbered from 0.
Triangles grid(std::uint32_t width, std::uint32_t height) {
    Triangles out;
    for (std::uint32_t j = 0; j < height; ++j) {
        for (std::uint32_t i = 0; i < width; ++i) {
            const std::uint32_t v = j * (width + 1) + i;
            out.push_back({v, v + 1, v + width + 2});
            out.push_back({v, v + width + 2, v + width + 1});
        }
    }
    return out;
}

/// A Moebius strip of length x width cells.
Triangles moebius(std::uint32_t length, std::uint32_t width) {
    Triangles out;
    const auto at = [&](std::uint32_t i, std::uint32_t j) { return i < length ? i * (width + 1) + j : width - j; };
    for (std::uint32_t i = 0; i < length; ++i) {
        for (std::uint32_t j = 0; j < width; ++j) {
            out.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
            out.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
        }
    }
    return out;
}

struct Piece {
    std::uint32_t vertices = 0;  ///< some may be unused
    Triangles triangles;
};

constexpr std::uint32_t piece_kinds = 10;

Piece make_piece(std::uint32_t kind, Random& random) {
    Piece piece;
    const std::uint32_t n = random.between(3, 7);
    Triangles& t = piece.triangles;
    switch (kind) {
        case 0:  // an ordinary patch
            piece.vertices = (n + 1) * (n + 2);
            t = grid(n, n + 1);
            break;
        case 1:  // n triangles at the edge 0, 1, half of them with the opposite orientation
            piece.vertices = n + 2;
            for (std::uint32_t i = 0; i < n; ++i) {
                t.push_back(i % 2 == 0 ? std::array{0U, 1U, i + 2} : std::array{1U, 0U, i + 2});
            }
            break;
        case 2: {  // fans that share only vertex 0
            piece.vertices = 1;
            for (std::uint32_t f = 0; f < 3; ++f) {
                for (std::uint32_t i = 0; i < n; ++i) t.push_back({0, piece.vertices + i, piece.vertices + i + 1});
                piece.vertices += n + 1;
            }
            break;
        }
        case 3: {  // a patch with duplicate triangles of the same and of opposite orientation
            piece.vertices = (n + 1) * 4;
            t = grid(n, 3);
            for (std::uint32_t i = 0; i < n; ++i) {
                auto copy = t[random.below(6 * n)];
                if (i % 2 == 1) std::swap(copy[0], copy[1]);
                t.push_back(copy);
            }
            break;
        }
        case 4: {  // a patch with degenerate triangles
            piece.vertices = (n + 1) * 3;
            t = grid(n, 2);
            for (std::uint32_t i = 0; i < 4; ++i) {
                auto copy = t[random.below(4 * n)];
                copy[i % 3] = copy[(i + 1) % 3];
                if (i == 0) copy[1] = copy[2] = copy[0];
                t.push_back(copy);
            }
            break;
        }
        case 5: {  // a patch of triangles with random orientation
            piece.vertices = (n + 1) * (n + 1);
            t = grid(n, n);
            for (auto& abc : t) {
                if (random.below(2) == 0) std::swap(abc[1], abc[2]);
            }
            break;
        }
        case 6: {  // a Moebius strip with some triangles reversed
            const std::uint32_t width = random.between(1, 3);
            piece.vertices = (n + 2) * (width + 1);
            t = moebius(n + 2, width);
            for (auto& abc : t) {
                if (random.below(8) == 0) std::swap(abc[1], abc[2]);
            }
            break;
        }
        case 7:  // random triangles of few vertices
            piece.vertices = n + 2;
            for (std::uint32_t i = 0; i < 4 * n; ++i) {
                const std::uint32_t a = random.below(n + 2);
                const std::uint32_t b = random.below(n + 2);
                const std::uint32_t c = random.below(n + 2);
                t.push_back({a, b, c});
            }
            break;
        case 8:  // two tetrahedra that share an edge, and unused vertices
            piece.vertices = 6 + n;
            t = {{0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}, {0, 1, 4}, {0, 5, 1}, {0, 4, 5}, {1, 5, 4}};
            break;
        default:  // three patches that share a straight line of n edges
            piece.vertices = 3 * 2 * (n + 1);
            for (std::uint32_t p = 0; p < 3; ++p) {
                for (auto abc : grid(n, 1)) {
                    for (std::uint32_t& v : abc) v = v <= n ? v : v + p * (n + 1);
                    t.push_back(abc);
                }
            }
            break;
    }
    return piece;
}

}  // namespace

Result<Mesh> make_soup(std::uint64_t triangles, std::uint64_t seed) {
    triangles = std::max<std::uint64_t>(triangles, 1);
    Random random(seed);
    Builder builder;
    builder.reserve(triangles, triangles);
    std::uint64_t side = 1;
    while (side * side * side * 20 < triangles) ++side;
    std::vector<std::uint32_t> number;  // mesh vertex of each vertex of the piece
    for (std::uint64_t i = 0; builder.triangles() < triangles; ++i) {
        // First each kind once, so that a mesh of 400 triangles or more has all kinds; then random kinds.
        const auto kind = i < piece_kinds ? static_cast<std::uint32_t>(i) : random.below(piece_kinds);
        Piece piece = make_piece(kind, random);
        if (builder.vertices() + std::uint64_t{piece.vertices} > kMostVertices) return too_many_generated();
        const Point center{static_cast<double>(i % side), static_cast<double>(i / side % side),
                           static_cast<double>(i / side / side)};
        number.clear();
        for (std::uint32_t v = 0; v < piece.vertices; ++v) {
            // Sometimes reuses a vertex of an earlier piece, so that pieces are connected at vertices and some edges.
            if (builder.vertices() > 0 && random.below(40) == 0) {
                number.push_back(builder.vertices() - 1 - random.below(std::min(builder.vertices(), 100U)));
                continue;
            }
            const double x = center[0] + 0.45 * random.signed_unit();
            const double y = center[1] + 0.45 * random.signed_unit();
            const double z = center[2] + 0.45 * random.signed_unit();
            number.push_back(builder.vertex({x, y, z}));
        }
        for (std::size_t t = piece.triangles.size(); t > 1; --t) {
            std::swap(piece.triangles[t - 1], piece.triangles[random.below(t)]);
        }
        for (const auto& abc : piece.triangles) {
            if (builder.triangles() == triangles) break;
            const std::uint32_t turn_by = random.below(3);
            builder.triangle(number[abc[turn_by]], number[abc[(turn_by + 1) % 3]], number[abc[(turn_by + 2) % 3]]);
        }
    }
    return builder.finish();
}

}  // namespace lacedring::detail
