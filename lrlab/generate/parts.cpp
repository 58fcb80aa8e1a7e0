// The kind `parts`: many small unconnected pieces.

#include <algorithm>
#include <array>

#include "lrlab/generate/detail.h"

namespace lacedring::detail {
namespace {

/// The transform of a piece: scale, random rotation, translation.
class Frame {
  public:
    Frame(Random& random, Point center, double size) : center_(center) {
        double q[4];
        double norm = 0;
        do {  // a uniformly distributed quaternion; the norm is divided out below
            norm = 0;
            for (double& c : q) {
                c = random.signed_unit();
                norm += c * c;
            }
        } while (norm > 1 || norm < 0.01);
        const double s = 2 / norm;
        const double w = q[0], x = q[1], y = q[2], z = q[3];
        const double rows[3][3] = {{1 - s * (y * y + z * z), s * (x * y - w * z), s * (x * z + w * y)},
                                   {s * (x * y + w * z), 1 - s * (x * x + z * z), s * (y * z - w * x)},
                                   {s * (x * z - w * y), s * (y * z + w * x), 1 - s * (x * x + y * y)}};
        for (int i = 0; i < 3; ++i) {
            for (int j = 0; j < 3; ++j) m_[i][j] = size * rows[i][j];
        }
    }
    Point operator()(double x, double y, double z) const {
        return {m_[0][0] * x + m_[0][1] * y + m_[0][2] * z + center_[0],
                m_[1][0] * x + m_[1][1] * y + m_[1][2] * z + center_[1],
                m_[2][0] * x + m_[2][1] * y + m_[2][2] * z + center_[2]};
    }

  private:
    double m_[3][3];
    Point center_;
};

double fraction(std::uint32_t i, std::uint32_t n) {
    return 2 * static_cast<double>(i) / static_cast<double>(n) - 1;
}

void add_patch(Builder& builder, const Frame& frame, std::uint32_t width, std::uint32_t height) {
    const std::uint32_t first = builder.vertices();
    const double aspect = static_cast<double>(height) / static_cast<double>(width);
    for (std::uint32_t j = 0; j <= height; ++j) {
        for (std::uint32_t i = 0; i <= width; ++i) {
            const double x = fraction(i, width);
            const double y = fraction(j, height) * std::min(aspect, 1.0);
            builder.vertex(frame(x, y, 0.2 * x * x - 0.3 * x * y));
        }
    }
    for (std::uint32_t j = 0; j < height; ++j) {
        for (std::uint32_t i = 0; i < width; ++i) {
            const std::uint32_t v = first + j * (width + 1) + i;
            builder.quad(v, v + 1, v + width + 2, v + width + 1, (i + j) % 3 == 0);
        }
    }
}

void add_triangle(Builder& builder, const Frame& frame) {
    const std::uint32_t v = builder.vertex(frame(-1, -0.6, 0));
    builder.vertex(frame(1, -0.6, 0));
    builder.vertex(frame(0, 1, 0));
    builder.triangle(v, v + 1, v + 2);
}

void add_strip(Builder& builder, const Frame& frame, std::uint32_t triangles) {
    const std::uint32_t v = builder.vertices();
    for (std::uint32_t i = 0; i < triangles + 2; ++i) {
        const double x = fraction(i, triangles + 1);
        builder.vertex(frame(x, i % 2 == 0 ? -0.2 : 0.2, 0.5 * x * x));
    }
    for (std::uint32_t i = 0; i < triangles; ++i) {
        builder.triangle(v + i, v + i + 1 + i % 2, v + i + 2 - i % 2);
    }
}

/// Adds a fan of triangles around a hub; a closed fan is a disk.
void add_fan(Builder& builder, const Frame& frame, std::uint32_t triangles, bool closed) {
    const std::uint32_t rim = closed ? triangles : triangles + 1;
    const std::uint32_t hub = builder.vertex(frame(0, 0, 0.3));
    for (std::uint32_t i = 0; i < rim; ++i) {
        const Turn t = turn(i, triangles + (closed ? 0 : 2));
        builder.vertex(frame(t.cos, t.sin, 0));
    }
    for (std::uint32_t i = 0; i < triangles; ++i) builder.triangle(hub, hub + 1 + i, hub + 1 + (i + 1) % rim);
}

void add_tetrahedron(Builder& builder, const Frame& frame) {
    const std::uint32_t v = builder.vertex(frame(1, 1, 1));
    builder.vertex(frame(-1, -1, 1));
    builder.vertex(frame(-1, 1, -1));
    builder.vertex(frame(1, -1, -1));
    for (const auto& t : {std::array{0U, 2U, 1U}, {0U, 1U, 3U}, {0U, 3U, 2U}, {1U, 2U, 3U}}) {
        builder.triangle(v + t[0], v + t[1], v + t[2]);
    }
}

void add_octahedron(Builder& builder, const Frame& frame) {
    const std::uint32_t v = builder.vertices();
    for (int axis = 0; axis < 3; ++axis) {
        for (const double side : {-1.0, 1.0}) {
            builder.vertex(frame(axis == 0 ? side : 0, axis == 1 ? side : 0, axis == 2 ? side : 0));
        }
    }
    for (std::uint32_t i = 0; i < 8; ++i) {
        const std::uint32_t x = v + (i & 1);
        const std::uint32_t y = v + 2 + (i >> 1 & 1);
        const std::uint32_t z = v + 4 + (i >> 2 & 1);
        const bool even = ((i & 1) + (i >> 1 & 1) + (i >> 2 & 1)) % 2 == 0;
        builder.triangle(x, even ? z : y, even ? y : z);
    }
}

void add_box(Builder& builder, const Frame& frame) {
    const std::uint32_t v = builder.vertices();
    for (std::uint32_t i = 0; i < 8; ++i) {
        builder.vertex(frame((i & 1) != 0 ? 0.8 : -0.8, (i & 2) != 0 ? 0.5 : -0.5, (i & 4) != 0 ? 0.4 : -0.4));
    }
    constexpr std::uint32_t faces[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                           {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
    for (const auto& f : faces) builder.quad(v + f[0], v + f[1], v + f[2], v + f[3]);
}

}  // namespace

Result<Mesh> make_parts(std::uint64_t triangles, std::uint64_t seed) {
    triangles = std::max<std::uint64_t>(triangles, 1);
    Random random(seed);
    Builder builder;
    builder.reserve(triangles, triangles);
    // A piece has eight triangles on average. Pieces fill a cubic grid layer by layer.
    std::uint64_t side = 1;
    while (side * side * side * 8 < triangles) ++side;
    for (std::uint64_t piece = 0; builder.triangles() < triangles; ++piece) {
        if (builder.vertices() + 200 > kMostVertices) return too_many_generated();
        const Point center{static_cast<double>(piece % side) + 0.25 * random.signed_unit(),
                           static_cast<double>(piece / side % side) + 0.25 * random.signed_unit(),
                           static_cast<double>(piece / side / side) + 0.25 * random.signed_unit()};
        const Frame frame(random, center, 0.3 + 0.1 * random.signed_unit());
        const std::uint64_t left = triangles - builder.triangles();
        const std::uint32_t kind = random.below(10);
        const std::uint32_t size = random.between(1, 5);
        const std::uint32_t other_size = random.between(1, 4);
        const auto fits = [&](std::uint64_t count) { return count <= left; };
        if (kind == 1 && fits(2)) {
            add_patch(builder, frame, 1, 1);
        } else if (kind == 2 && fits(3 * size)) {
            add_strip(builder, frame, 3 * size);
        } else if (kind == 3 && fits(2 * size * other_size)) {
            add_patch(builder, frame, size, other_size);
        } else if (kind == 4 && fits(size + 2)) {
            add_fan(builder, frame, size + 2, false);
        } else if (kind == 5 && fits(size + 2)) {
            add_fan(builder, frame, size + 2, true);
        } else if (kind == 6 && fits(4)) {
            add_tetrahedron(builder, frame);
        } else if (kind == 7 && fits(8)) {
            add_octahedron(builder, frame);
        } else if (kind == 8 && fits(12)) {
            add_box(builder, frame);
        } else if (kind == 9 && fits(2 * 5 * (4 + size))) {
            add_patch(builder, frame, 5, 4 + size);
        } else {
            add_triangle(builder, frame);
        }
    }
    return builder.finish();
}

}  // namespace lacedring::detail
