#include "tests/support/shapes.h"

#include <algorithm>
#include <map>
#include <utility>

namespace lacedring::test {

Shape grid(std::uint32_t width, std::uint32_t height, bool close_x, bool close_y, bool twist) {
    const std::uint32_t columns = close_x ? width : width + 1;
    const std::uint32_t rows = close_y ? height : height + 1;
    const auto at = [&](std::uint32_t x, std::uint32_t y) {
        if (close_x && x == width) {
            x = 0;
            if (twist) y = height - y;
        }
        return y % rows * columns + x;
    };
    Shape shape{columns * rows, {}};
    for (std::uint32_t y = 0; y < height; ++y) {
        for (std::uint32_t x = 0; x < width; ++x) {
            shape.triangles.push_back({at(x, y), at(x + 1, y), at(x + 1, y + 1)});
            shape.triangles.push_back({at(x, y), at(x + 1, y + 1), at(x, y + 1)});
        }
    }
    return shape;
}

Shape grid_with_holes(std::uint32_t width, std::uint32_t height) {
    const Shape full = grid(width, height, false, false, false);
    Shape shape{full.vertices, {}};
    for (std::uint32_t y = 0; y < height; ++y) {
        for (std::uint32_t x = 0; x < width; ++x) {
            if (x % 2 == 1 && y % 2 == 1) continue;
            const std::size_t t = std::size_t{2} * (y * width + x);
            shape.triangles.push_back(full.triangles[t]);
            shape.triangles.push_back(full.triangles[t + 1]);
        }
    }
    return shape;
}

Shape plate(std::uint32_t holes) {
    const Shape top = grid_with_holes(2 * holes + 1, 3);
    Shape shape{2 * top.vertices, top.triangles};
    std::map<std::pair<std::uint32_t, std::uint32_t>, bool> edges;
    for (const Triangle& t : top.triangles) {
        shape.triangles.push_back({t[0] + top.vertices, t[2] + top.vertices, t[1] + top.vertices});
        for (std::size_t i = 0; i < 3; ++i) edges[{t[i], t[(i + 1) % 3]}] = true;
    }
    for (const auto& [edge, _] : edges) {
        const auto [p, q] = edge;
        if (edges.count({q, p}) != 0) continue;
        shape.triangles.push_back({q, p, p + top.vertices});
        shape.triangles.push_back({q, p + top.vertices, q + top.vertices});
    }
    return shape;
}

Shape fan(std::uint32_t triangles, bool closed) {
    const std::uint32_t rim = closed ? triangles : triangles + 1;
    Shape shape{rim + 1, {}};
    for (std::uint32_t i = 0; i < triangles; ++i) shape.triangles.push_back({0, 1 + i, 1 + (i + 1) % rim});
    return shape;
}

Shape strip(std::uint32_t triangles) {
    Shape shape{triangles + 2, {}};
    for (std::uint32_t i = 0; i < triangles; ++i) shape.triangles.push_back({i, i + 1 + i % 2, i + 2 - i % 2});
    return shape;
}

Shape tetrahedron() {
    return {4, {{0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}}};
}

Shape octahedron() {
    return bipyramid(4);
}

Shape cube() {
    return {8,
            {{0, 2, 3},
             {0, 3, 1},
             {4, 5, 7},
             {4, 7, 6},
             {0, 1, 5},
             {0, 5, 4},
             {2, 6, 7},
             {2, 7, 3},
             {0, 4, 6},
             {0, 6, 2},
             {1, 3, 7},
             {1, 7, 5}}};
}

Shape bipyramid(std::uint32_t n) {
    Shape shape{n + 2, {}};
    for (std::uint32_t i = 0; i < n; ++i) {
        const std::uint32_t a = 2 + i;
        const std::uint32_t b = 2 + (i + 1) % n;
        shape.triangles.push_back({0, a, b});
        shape.triangles.push_back({1, b, a});
    }
    return shape;
}

Shape double_fan(std::uint32_t n) {
    Shape shape{n + 3, {}};
    for (std::uint32_t i = 0; i < n; ++i) {
        shape.triangles.push_back({0, 2 + i, 3 + i});
        shape.triangles.push_back({1, 3 + i, 2 + i});
    }
    shape.triangles.push_back({0, 1, 2});
    shape.triangles.push_back({1, 0, 2 + n});
    return shape;
}

Shape projective_plane() {
    return {
        6,
        {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 5}, {0, 5, 1}, {1, 2, 4}, {2, 3, 5}, {3, 4, 1}, {4, 5, 2}, {5, 1, 3}}};
}

Shape smallest_torus() {
    Shape shape{7, {}};
    for (std::uint32_t i = 0; i < 7; ++i) {
        shape.triangles.push_back({i, (i + 1) % 7, (i + 3) % 7});
        shape.triangles.push_back({i, (i + 3) % 7, (i + 2) % 7});
    }
    return shape;
}

Shape subdivide(const Shape& shape) {
    Shape out{shape.vertices, {}};
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
        const auto [at, is_new] = middles.try_emplace(std::minmax(a, b), out.vertices);
        if (is_new) ++out.vertices;
        return at->second;
    };
    for (const Triangle& t : shape.triangles) {
        const std::uint32_t ab = middle(t[0], t[1]);
        const std::uint32_t bc = middle(t[1], t[2]);
        const std::uint32_t ca = middle(t[2], t[0]);
        for (const Triangle& part : {Triangle{t[0], ab, ca}, {t[1], bc, ab}, {t[2], ca, bc}, {ab, bc, ca}}) {
            out.triangles.push_back(part);
        }
    }
    return out;
}

Shape stack_all(const Shape& shape) {
    Shape out{shape.vertices, {}};
    for (const auto& [a, b, c] : shape.triangles) {
        const std::uint32_t v = out.vertices++;
        for (const Triangle& part : {Triangle{a, b, v}, {b, c, v}, {c, a, v}}) out.triangles.push_back(part);
    }
    return out;
}

Shape stack_random(Shape shape, std::uint32_t count, std::uint64_t seed) {
    SplitMix64 random(seed);
    for (std::uint32_t i = 0; i < count; ++i) {
        const std::uint32_t t = random.below(static_cast<std::uint32_t>(shape.triangles.size()));
        const auto [a, b, c] = shape.triangles[t];
        const std::uint32_t v = shape.vertices++;
        shape.triangles[t] = {a, b, v};
        shape.triangles.push_back({b, c, v});
        shape.triangles.push_back({c, a, v});
    }
    return shape;
}

Shape stack_spiral(Shape shape, std::uint32_t count) {
    for (std::uint32_t i = 0; i < count; ++i) {
        const auto [a, b, c] = shape.triangles.back();
        const std::uint32_t v = shape.vertices++;
        shape.triangles.back() = {a, b, v};
        shape.triangles.push_back({c, a, v});
        shape.triangles.push_back({b, c, v});
    }
    return shape;
}

Shape beside(const Shape& a, const Shape& b) {
    Shape out = a;
    out.vertices += b.vertices;
    for (const Triangle& t : b.triangles) {
        out.triangles.push_back({t[0] + a.vertices, t[1] + a.vertices, t[2] + a.vertices});
    }
    return out;
}

Shape pinch(Shape shape, std::uint32_t from, std::uint32_t to) {
    for (Triangle& t : shape.triangles) std::replace(t.begin(), t.end(), from, to);
    return shape;
}

Shape turn_some(Shape shape, std::uint32_t k) {
    for (std::size_t t = 0; t < shape.triangles.size(); t += k) std::swap(shape.triangles[t][1], shape.triangles[t][2]);
    return shape;
}

Shape double_some(Shape shape, std::uint32_t k, bool turned) {
    for (std::size_t t = 0, end = shape.triangles.size(); t < end; t += k) {
        const auto [a, b, c] = shape.triangles[t];
        shape.triangles.push_back(turned ? Triangle{b, a, c} : Triangle{b, c, a});
    }
    return shape;
}

Shape shuffle(Shape shape, std::uint64_t seed) {
    SplitMix64 random(seed);
    std::vector<std::uint32_t> number(shape.vertices);
    for (std::uint32_t v = 0; v < shape.vertices; ++v) number[v] = v;
    for (std::uint32_t i = shape.vertices; i > 1; --i) std::swap(number[i - 1], number[random.below(i)]);
    for (auto i = static_cast<std::uint32_t>(shape.triangles.size()); i > 1; --i) {
        std::swap(shape.triangles[i - 1], shape.triangles[random.below(i)]);
    }
    for (Triangle& t : shape.triangles) {
        for (std::uint32_t& v : t) v = number[v];
        std::rotate(t.begin(), t.begin() + random.below(3), t.end());
    }
    return shape;
}

}  // namespace lacedring::test
