#include "lrio/scene/scene_stream.h"

#include <algorithm>
#include <cstring>
#include <numeric>
#include <optional>

#include "lacedring/lacedring.hpp"
#include "lacedring/surface.hpp"
#include "lrcore/base/try.h"
#include "lrio/file/lr_layout.h"
#include "lrio/mesh/read_formats.h"
#include "lrio/scene/part_codes.h"

namespace lacedring::detail {
namespace {

/// The concatenated sets, and their surfaces.
struct Joined {
    Mesh mesh;
    Surface surface;
    std::vector<std::uint32_t> part_of;  ///< part of each triangle
    std::size_t parts = 0;
};

Joined join_sets(std::vector<CodedSet>& sets, bool keep_order) {
    Joined out;
    std::vector<std::uint32_t> vertex_of;
    for (CodedSet& coded : sets) {
        Mesh& mesh = coded.set.mesh;
        Surface surface = find_surface(mesh);
        if (surface.has_seams()) move_to_surface(mesh, surface);
        if (!keep_order) mesh = merge_copies(mesh, surface);
        const std::uint32_t first = out.mesh.vertex_count;
        for (std::uint32_t v = 0; v < mesh.vertex_count; ++v) {
            vertex_of.push_back(out.surface.vertex_count + (surface.has_seams() ? surface.vertex_of[v] : v));
        }
        out.surface.vertex_count += surface.vertex_count;
        if (out.mesh.attributes.empty()) {
            out.mesh.attributes = std::move(mesh.attributes);
        } else {
            for (std::size_t a = 0; a < mesh.attributes.size(); ++a) {
                std::vector<std::byte>& to = out.mesh.attributes[a].data;
                to.insert(to.end(), mesh.attributes[a].data.begin(), mesh.attributes[a].data.end());
            }
        }
        out.mesh.vertex_count += mesh.vertex_count;
        for (const std::uint32_t v : mesh.indices) out.mesh.indices.push_back(first + v);
        for (std::size_t part = 0; part < coded.part_numbers.size(); ++part, ++out.parts) {
            const std::uint32_t triangles = coded.set.first_triangle[part + 1] - coded.set.first_triangle[part];
            out.part_of.insert(out.part_of.end(), triangles, coded.part_numbers[part]);
        }
        mesh = {};
    }
    if (out.surface.vertex_count < out.mesh.vertex_count) out.surface.vertex_of = std::move(vertex_of);
    return out;
}

Result<void> compress(LrFile& file, const std::vector<VertexOptions>& options, unsigned threads) {
    for (std::size_t i = 0; i < file.attributes.size(); ++i) {
        LrAttribute& a = file.attributes[i];
        VertexOptions how = options[i];
        how.threads = threads;
        auto encoded = encode_vertices({a.type, a.components, a.normalized, a.data}, how);
        if (!encoded) {
            if (encoded.error().code != ErrorCode::invalid_argument) return encoded.error();
            continue;  // stays plain
        }
        a.words = std::move(encoded->words);
        a.data = {};
    }
    return {};
}

struct StreamChoice {
    LrFile file;
    std::vector<std::byte> bytes;
    std::vector<std::uint32_t> triangle_order;
    std::uint32_t degenerate = 0;
};

Result<StreamChoice> make_choice(const Mesh& mesh, const Surface& surface, const std::vector<VertexOptions>& options,
                                 bool keep_order, LrForm form, unsigned threads) {
    const Mesh bare = surface_mesh(mesh, surface);
    EncodeOptions how;
    how.threads = threads;
    LR_ASSIGN(Encoded encoded, encode(bare.indices, bare.vertex_count, how));
    StreamChoice out;
    out.triangle_order = encoded.triangle_order;
    out.degenerate = encoded.report.topology.degenerate;
    LR_ASSIGN(LrFile file, make_lr_file(mesh, surface, std::move(encoded), keep_order));
    out.file = std::move(file);
    LR_TRY(compress(out.file, options, threads));
    out.bytes = serialize_lr(out.file, form);
    return out;
}

}  // namespace

Result<SceneStream> encode_scene_stream(std::vector<CodedSet> sets, bool keep_order, LrForm form, unsigned threads) {
    const std::vector<VertexOptions> options = sets.front().options;
    const bool several = sets.size() > 1;
    Joined joined = join_sets(sets, keep_order);
    Result<StreamChoice> best = make_choice(joined.mesh, joined.surface, options, keep_order, form, threads);
    if (!best) return best.error();
    if (several) {
        // Sets of a model often meet: joining equal positions across sets then stores them once. But many equal sets
        // may overlap until their nodes move them apart; joining these does not help. So the smaller stream is taken.
        const Surface across = find_surface(joined.mesh);
        if (across.vertex_count < joined.surface.vertex_count - joined.surface.vertex_count / 20) {
            Mesh moved = joined.mesh;
            move_to_surface(moved, across);
            Result<StreamChoice> other = make_choice(moved, across, options, keep_order, form, threads);
            if (other && other->bytes.size() < best->bytes.size()) best = std::move(other);
        }
    }
    SceneStream out;
    out.degenerate = best->degenerate;
    out.file = std::move(best->bytes);
    std::vector<std::uint32_t> parts;
    parts.reserve(best->triangle_order.size());
    for (const std::uint32_t t : best->triangle_order) parts.push_back(joined.part_of[t]);
    if (joined.parts > 1) {
        LR_ASSIGN(auto codes, encode_part_codes(parts));
        out.parts = std::move(codes);
    }
    return out;
}

}  // namespace lacedring::detail
