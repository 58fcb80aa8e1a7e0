#include "renderer/mesh/model.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstring>
#include <limits>

#include "lacedring/lacedring.hpp"
#include "lacedring/ring.hpp"
#include "lacedring/topology.hpp"
#include "lacedring/vertices.hpp"
#include "renderer/vk/try.h"

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

Result<void> normalize(Model& model) {
    Point low, high;
    low.fill(std::numeric_limits<double>::infinity());
    high.fill(-std::numeric_limits<double>::infinity());
    // Vertices that no triangle uses may lie anywhere: the bounding box leaves them out.
    for (const std::uint32_t v : model.indices) {
        const Point p = point(model.positions, v);
        for (std::size_t i = 0; i < 3; ++i) {
            low[i] = std::min(low[i], p[i]);
            high[i] = std::max(high[i], p[i]);
        }
    }
    for (std::size_t i = 0; i < 3; ++i) model.center[i] = static_cast<float>(0.5 * (low[i] + high[i]));
    double squared = 0;
    for (const std::uint32_t v : model.indices) {
        const Point d = minus(point(model.positions, v), model.center);
        squared = std::max(squared, dot(d, d));
    }
    model.radius = std::sqrt(squared);
    if (!std::isfinite(model.radius) || model.radius <= 0) {
        return Error{ErrorCode::unsupported, "all triangles lie in one point, or past what 32-bit floats hold"};
    }
    // Keeps the scale a normal float: a device may flush denormal floats to 0.
    const float scale = std::clamp(static_cast<float>(1 / model.radius), 0x1p-126F, 0x1p126F);
    model.radius = 1 / static_cast<double>(scale);
    for (std::size_t i = 0; i < 3; ++i) model.unit[i] = static_cast<float>(model.center[i]);
    model.unit[3] = scale;
    for (std::size_t i = 0; i < model.positions.size(); ++i) {
        // Doubles, so that no compiler fuses the two steps. The result is the same: a single float sum or product
        // computed in double and then rounded to float is correctly rounded.
        const auto moved = static_cast<float>(static_cast<double>(model.positions[i]) - model.center[i % 3]);
        const auto scaled = static_cast<float>(static_cast<double>(moved) * static_cast<double>(scale));
        model.positions[i] = std::clamp(scaled, -1e6F, 1e6F);
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

/// The file's normals; if it has none, normals of the surface, which do not crease at seams.
std::vector<float> surface_normals(const Mesh& mesh, const lacedring::Surface& surface) {
    const Attribute* own = find_attribute(mesh, "NORMAL");
    if (own != nullptr && own->type == ComponentType::f32 && own->components == 3) return normals_f32(mesh);
    const std::vector<float> normals = normals_f32(surface_mesh(mesh, surface));
    std::vector<float> out;
    out.reserve(std::size_t{3} * mesh.vertex_count);
    for (const std::uint32_t v : surface.vertex_of) {
        const auto from = normals.begin() + std::ptrdiff_t{3} * v;
        out.insert(out.end(), from, from + 3);
    }
    return out;
}

/// Encodes the positions as floats, in the packed stream's order. If the encoding is lossy, all of the model (not just
/// the stream) gets the decoded positions.
Result<void> encode_positions(Model& model, const Mesh& mesh, const VertexOptions& options) {
    const std::vector<std::uint32_t>& order = model.packed.vertex_order;
    const std::vector<std::uint32_t> of_surface = first_vertices(model.surface);
    std::vector<float> positions = positions_f32(mesh), ordered;
    ordered.reserve(3 * order.size());
    for (const std::uint32_t surface_vertex : order) {
        const float* position = &positions[3 * std::size_t{of_surface[surface_vertex]}];
        ordered.insert(ordered.end(), position, position + 3);
    }
    const VertexValues values{ComponentType::f32, 3, false, std::as_bytes(std::span(ordered))};
    Result<EncodedVertices> encoded = encode_vertices(values, options);
    if (!encoded && encoded.error().code == ErrorCode::invalid_argument) {
        model.exact = encoded.error().message;
        encoded = encode_vertices(values, {.threads = options.threads});
    }
    LR_ASSIGN(model.vertices, std::move(encoded));
    if (model.vertices.largest_error == 0) return {};
    LR_ASSIGN(const VertexView view, view_vertices(model.vertices.words));
    decode_vertices(view, std::as_writable_bytes(std::span(ordered)));
    std::vector<std::uint32_t> place(order.size());
    for (std::uint32_t i = 0; i < order.size(); ++i) place[order[i]] = i;
    for (std::uint32_t v = 0; v < mesh.vertex_count; ++v) {
        const std::size_t i = place[model.surface_of(v)];
        std::copy_n(&ordered[3 * i], 3, &positions[3 * std::size_t{v}]);
    }
    Mesh decoded = mesh;
    Attribute attribute{"POSITION", ComponentType::f32, 3, false, {}};
    const auto bytes = std::as_bytes(std::span(positions));
    attribute.data.assign(bytes.begin(), bytes.end());
    for (Attribute& a : decoded.attributes) {
        if (a.name == attribute.name) a = std::move(attribute);
    }
    LR_ASSIGN(const Model moved, make_surface(decoded, model.surface));
    model.positions = moved.positions;
    model.normals = moved.normals;
    model.center = moved.center;
    model.radius = moved.radius;
    model.unit = moved.unit;
    model.mean_edge = moved.mean_edge;
    return {};
}

}  // namespace

std::vector<std::uint32_t> surface_triangles(const Model& model) {
    std::vector<std::uint32_t> out(model.indices.begin(), model.indices.end());
    for (std::uint32_t& v : out) v = model.surface_of(v);
    return out;
}

std::vector<float> surface_positions(const Model& model) {
    if (!model.surface.has_seams()) return model.positions;
    std::vector<float> out;
    out.reserve(std::size_t{3} * model.surface.vertex_count);
    for (const std::uint32_t v : first_vertices(model.surface)) {
        const auto from = model.positions.begin() + std::ptrdiff_t{3} * v;
        out.insert(out.end(), from, from + 3);
    }
    return out;
}

Result<Model> make_surface(const Mesh& mesh, const lacedring::Surface& surface) {
    if (mesh.indices.empty()) return Error{ErrorCode::unsupported, "the mesh has no triangles to draw"};
    Model model;
    model.indices = mesh.indices;
    model.positions = positions_f32(mesh);
    model.surface = surface;
    if (!surface.has_seams()) {
        model.surface.vertex_count = mesh.vertex_count;
        model.normals = normals_f32(mesh);
    } else {
        const std::vector<std::uint32_t>& vertex_of = surface.vertex_of;
        if (vertex_of.size() != mesh.vertex_count || std::ranges::max(vertex_of) >= surface.vertex_count) {
            return Error{ErrorCode::invalid_argument, "the surface is not of this mesh"};
        }
        model.normals = surface_normals(mesh, surface);
    }
    LR_TRY(normalize(model));
    model.mean_edge = mean_edge(model);
    return model;
}

void add_materials(Model& model, const Mesh& mesh, const Materials& materials) {
    static std::atomic<std::uint64_t> last = 0;
    model.materials = materials.of_triangle.empty() ? nullptr : &materials;
    model.materials_number = ++last;
    constexpr std::uint16_t kOne = UINT16_MAX;
    model.shading.assign(mesh.vertex_count, {{0, 0, 0, 0}, {kOne, kOne, kOne, kOne}});
    const auto floats_of = [&](const char* name, std::uint8_t components) -> const std::byte* {
        const Attribute* a = find_attribute(mesh, name);
        return a != nullptr && a->type == ComponentType::f32 && a->components == components ? a->data.data() : nullptr;
    };
    const std::byte *first = floats_of("TEXCOORD_0", 2), *second = floats_of("TEXCOORD_1", 2),
                    *colors = floats_of("COLOR_0", 4);
    for (std::size_t v = 0; v < mesh.vertex_count; ++v) {
        Shading& to = model.shading[v];
        if (first != nullptr) std::memcpy(to.texture, first + 8 * v, 8);
        if (second != nullptr) std::memcpy(to.texture + 2, second + 8 * v, 8);
        if (colors == nullptr) continue;
        std::array<float, 4> color;
        std::memcpy(color.data(), colors + sizeof color * v, sizeof color);
        for (std::size_t c = 0; c < 4; ++c) {
            const float part = color[c] >= 0 ? std::min(color[c], 1.0F) : 0.0F;
            to.color[c] = static_cast<std::uint16_t>(part * static_cast<float>(kOne) + 0.5F);
        }
    }
}

Result<void> encode_seams(Model& model) {
    model.lean_seams = model.packed_seams = {};
    if (!model.surface.has_seams()) return {};
    LR_ASSIGN(model.lean_seams,
              lacedring::encode_seams(as_encoded(EncodedLean(model.lean)), model.indices, model.surface.vertex_of));
    if (model.packed.words.empty()) return {};
    LR_ASSIGN(model.packed_seams,
              lacedring::encode_seams(as_encoded(EncodedPacked(model.packed)), model.indices, model.surface.vertex_of));
    return {};
}

Result<Model> make_model(const Mesh& mesh, const ModelOptions& options) {
    LR_ASSIGN(Model model, make_surface(mesh, options.surface));
    LR_ASSIGN(const CornerTable table, build_corner_table(surface_triangles(model), model.surface.vertex_count));
    const Rings rings = expand_rings(table, options.ring);
    OptimizeOptions optimize = options.optimize;
    optimize.cost = kLeanRingCost;
    LR_ASSIGN(model.lean, encode_lean(table, optimize_rings(table, rings, optimize), options.lean));
    if (options.packed) {
        optimize.cost = kPackedRingCost;
        LR_ASSIGN(PackedChoice packed, encode_smallest_packed(table, options.ring, optimize));
        model.packed = std::move(packed.stream);
        if (options.vertices) LR_TRY(encode_positions(model, mesh, *options.vertices));
    }
    LR_TRY(encode_seams(model));
    return model;
}

}  // namespace lacedring::gpu
