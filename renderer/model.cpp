#include "renderer/model.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "lrcore/corner_table/corner_table.h"
#include "lrcore/ring/ring.h"
#include "renderer/try.h"

namespace lr::gpu {
namespace {

using Point = std::array<double, 3>;

Point point(std::span<const float> values, std::uint32_t v) {
    return {values[3 * std::size_t{v}], values[3 * std::size_t{v} + 1], values[3 * std::size_t{v} + 2]};
}

Point minus(const Point& a, const Point& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
double dot(const Point& a, const Point& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Point cross(const Point& a, const Point& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

Result<void> normalise(Model& model) {
    Point low, high;
    low.fill(std::numeric_limits<double>::infinity());
    high.fill(-std::numeric_limits<double>::infinity());
    // Vertices that no triangle uses may lie anywhere, and are not seen.
    for (const std::uint32_t v : model.indices) {
        const Point p = point(model.positions, v);
        for (std::size_t i = 0; i < 3; ++i) {
            low[i] = std::min(low[i], p[i]);
            high[i] = std::max(high[i], p[i]);
        }
    }
    for (std::size_t i = 0; i < 3; ++i) model.centre[i] = 0.5 * (low[i] + high[i]);
    double squared = 0;
    for (const std::uint32_t v : model.indices) {
        const Point d = minus(point(model.positions, v), model.centre);
        squared = std::max(squared, dot(d, d));
    }
    model.radius = std::sqrt(squared);
    if (!std::isfinite(model.radius) || model.radius <= 0) {
        return Error{ErrorCode::invalid_argument, "all triangles lie in one point, or past what 32-bit floats hold"};
    }
    for (std::size_t i = 0; i < model.positions.size(); ++i) {
        const double scaled = (static_cast<double>(model.positions[i]) - model.centre[i % 3]) / model.radius;
        model.positions[i] = static_cast<float>(std::clamp(scaled, -1e6, 1e6));
    }
    return {};
}

void measure(Model& model) {
    double length = 0, agreement = 0;
    for (std::size_t i = 0; i < model.indices.size(); i += 3) {
        const std::uint32_t a = model.indices[i], b = model.indices[i + 1], c = model.indices[i + 2];
        const Point p = point(model.positions, a), q = point(model.positions, b), r = point(model.positions, c);
        const Point e = minus(q, p), f = minus(r, p), g = minus(r, q);
        length += std::sqrt(dot(e, e)) + std::sqrt(dot(f, f)) + std::sqrt(dot(g, g));
        agreement += dot(cross(e, f), point(model.normals, a));
    }
    model.mean_edge = length / static_cast<double>(model.indices.size());
    model.normal_sign = agreement < 0 ? -1.0F : 1.0F;
}

}  // namespace

Result<Model> make_model(const Mesh& mesh) {
    if (mesh.indices.empty()) return Error{ErrorCode::invalid_argument, "the mesh has no triangles to draw"};
    Model model;
    model.indices = mesh.indices;
    model.positions = positions_f32(mesh);
    model.normals = normals_f32(mesh);
    LR_TRY(normalise(model));
    measure(model);
    LR_ASSIGN(const CornerTable table, build_corner_table(mesh.indices, mesh.vertex_count));
    model.lean = encode_lean(table, expand_rings(table));
    return model;
}

}  // namespace lr::gpu
