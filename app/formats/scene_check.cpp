#include "app/formats/scene_check.h"

#include <fmt/format.h>

#include <cstring>
#include <vector>

#include "app/formats/formats.h"
#include "app/formats/whole_file.h"
#include "lacedring/lr_file.hpp"

namespace lacedring::app {
namespace {

bool alike(const Attribute& a, const Attribute& b) {
    return a.name == b.name && a.type == b.type && a.components == b.components && a.normalized == b.normalized;
}

/// Compares the triangles of `part` with those of `joined` that begin at `first`. Returns the first difference.
std::string compare_corners(const Mesh& joined, std::size_t first, const Mesh& part,
                            const std::vector<float>& joined_positions) {
    const std::vector<float> positions = positions_f32(part);
    struct Pair {
        const Attribute *joined, *part;
    };
    std::vector<Pair> pairs;
    for (const Attribute& attribute : part.attributes) {
        const Attribute* other = find_attribute(joined, attribute.name);
        if (attribute.name != "POSITION" && other != nullptr && alike(attribute, *other)) {
            pairs.push_back({other, &attribute});
        }
    }
    for (std::size_t i = 0; i < part.indices.size(); ++i) {
        const std::size_t a = joined.indices[3 * first + i], b = part.indices[i];
        for (std::size_t c = 0; c < 3; ++c) {
            if (joined_positions[3 * a + c] == positions[3 * b + c]) continue;  // 0 and -0 are joined
            return fmt::format("triangle {}: another position", i / 3);
        }
        for (const Pair& pair : pairs) {
            const std::size_t stride = pair.part->stride();
            if (std::memcmp(pair.joined->data.data() + a * stride, pair.part->data.data() + b * stride, stride) == 0) {
                continue;
            }
            return fmt::format("triangle {}: another {}", i / 3, printable(pair.part->name));
        }
    }
    return "";
}

}  // namespace

PlacedDifference check_placed(const LoadedScene& scene, double tolerance) {
    const Mesh& joined = scene.joined.mesh;
    std::vector<std::vector<const LoadedPrimitive*>> by_mesh;
    for (const LoadedPrimitive& primitive : scene.primitives) {
        if (primitive.mesh >= by_mesh.size()) by_mesh.resize(primitive.mesh + 1);
        by_mesh[primitive.mesh].push_back(&primitive);
    }
    const std::vector<float> positions = tolerance == 0 ? positions_f32(joined) : std::vector<float>();
    std::size_t at = 0;  // triangles compared so far
    for (std::size_t place_number = 0; place_number < scene.placed.size(); ++place_number) {
        const PlacedMesh& placed = scene.placed[place_number];
        if (placed.mesh >= by_mesh.size()) continue;  // a mesh without triangles
        for (const LoadedPrimitive* primitive : by_mesh[placed.mesh]) {
            const std::size_t triangles = primitive->geometry.triangle_count();
            std::string why;
            if (triangles > joined.triangle_count() - at) {
                why = fmt::format("{} triangles instead of {}", joined.triangle_count() - at, triangles);
            } else if (tolerance == 0) {
                why = compare_corners(joined, at, place(primitive->geometry, placed.placement), positions);
            }
            if (!why.empty()) return {primitive, fmt::format("in the joined mesh (place {}): {}", place_number, why)};
            at += triangles;
        }
    }
    if (at == joined.triangle_count()) return {};
    return {nullptr, fmt::format("the joined mesh has {} triangles, the primitives where they are placed {}",
                                 joined.triangle_count(), at)};
}

std::size_t count_triangles(const LoadedScene& scene) {
    std::size_t count = 0;
    for (const LoadedPrimitive& primitive : scene.primitives) count += primitive.geometry.triangle_count();
    return count;
}

std::string check_file(const Mesh& mesh, const Surface& surface, std::uint32_t threads) {
    Result<CornerTable> table = surface_table({mesh, surface, {}});
    if (!table) return table.error().message;
    if (without_degenerate(surface_mesh(mesh, surface).indices).empty()) return "";  // encode refuses such a mesh
    EncodeOptions how{.format = Format::packed, .effort = 0};
    how.threads = thread_count(threads);
    const Result<WholeFile> whole = make_file(mesh, surface, std::move(*table), how, {}, true);
    if (!whole) return whole.error().message;
    const Result<LrFile> file = parse_lr(serialize_lr(whole->file, LrForm::stored));
    if (!file) return file.error().message;
    const Result<Mesh> decoded = decode_lr_original_order(*file);
    if (!decoded) return decoded.error().message;
    if (decoded->vertex_count != mesh.vertex_count || decoded->indices != without_degenerate(mesh.indices)) {
        return "other triangles";
    }
    if (decoded->attributes.size() != mesh.attributes.size()) return "another number of attributes";
    for (std::size_t i = 0; i < mesh.attributes.size(); ++i) {
        const Attribute &got = decoded->attributes[i], &expected = mesh.attributes[i];
        if (!alike(got, expected) || got.data != expected.data) return "other values of " + printable(expected.name);
    }
    return "";
}

}  // namespace lacedring::app
