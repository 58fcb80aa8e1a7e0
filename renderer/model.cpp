#include "renderer/model.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "lacedring/lacedring.hpp"
#include "lacedring/ring.hpp"
#include "lacedring/topology.hpp"
#include "renderer/try.h"

namespace lacedring::gpu {
namespace {

using Point = std::array<double, 3>;

Point point(std::span<const float> values, std::uint32_t v) {
    return {values[3 * std::size_t{v}], values[3 * std::size_t{v} + 1], values[3 * std::size_t{v} + 2]};
}

Point minus(const Point& a, const Point& b) {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
double dot(const Point& a, const Point& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
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
        return Error{ErrorCode::unsupported, "all triangles lie in one point, or past what 32-bit floats hold"};
    }
    for (std::size_t i = 0; i < model.positions.size(); ++i) {
        const double scaled = (static_cast<double>(model.positions[i]) - model.centre[i % 3]) / model.radius;
        model.positions[i] = static_cast<float>(std::clamp(scaled, -1e6, 1e6));
    }
    return {};
}

double mean_edge(const Model& model) {
    double length = 0;
    for (std::size_t i = 0; i < model.indices.size(); ++i) {
        const std::uint32_t b = model.indices[i % 3 == 2 ? i - 2 : i + 1];
        const Point e = minus(point(model.positions, model.indices[i]), point(model.positions, b));
        length += std::sqrt(dot(e, e));
    }
    return length / static_cast<double>(model.indices.size());
}

}  // namespace

Result<Model> make_surface(const Mesh& mesh) {
    if (mesh.indices.empty()) return Error{ErrorCode::unsupported, "the mesh has no triangles to draw"};
    Model model;
    model.indices = mesh.indices;
    model.positions = positions_f32(mesh);
    model.normals = normals_f32(mesh);
    LR_TRY(normalise(model));
    model.mean_edge = mean_edge(model);
    return model;
}

Result<Model> make_model(const Mesh& mesh, const ModelOptions& options) {
    LR_ASSIGN(Model model, make_surface(mesh));
    LR_ASSIGN(const CornerTable table, build_corner_table(mesh.indices, mesh.vertex_count));
    const Rings rings = expand_rings(table, options.ring);
    OptimizeOptions optimize = options.optimize;
    optimize.cost = kLeanRingCost;
    LR_ASSIGN(model.lean, encode_lean(table, optimize_rings(table, rings, optimize), options.lean));
    if (options.packed) {
        optimize.cost = kPackedRingCost;
        LR_ASSIGN(PackedChoice packed, encode_smallest_packed(table, options.ring, optimize));
        model.packed = std::move(packed.stream);
    }
    return model;
}

}  // namespace lacedring::gpu
