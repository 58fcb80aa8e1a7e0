#include "renderer/gpu_mesh.h"

#include <algorithm>
#include <cstring>

#include "renderer/context.h"
#include "renderer/triangle_class.h"
#include "renderer/try.h"
#include "shaders/shared.h"

namespace lr::gpu {
namespace {

constexpr std::uint64_t kSmallestRange = 2048;
constexpr std::uint64_t kSlotStep = 256;  // in bytes, the coarsest alignment of a descriptor that Vulkan allows

std::uint64_t padded_slots(std::uint32_t slots) {
    constexpr std::uint64_t kStep = LR_TRIANGLES_PER_INVOCATION;
    return (std::uint64_t{slots} + kStep - 1) / kStep * kStep;
}

/// What both sources need.
Result<GpuMesh> prepare(Context& context, const Model& model, std::uint64_t slots, const UploadOptions& options) {
    GpuMesh mesh;
    mesh.max_range = options.max_range == 0 ? context.limits().maxStorageBufferRange : options.max_range;
    if (mesh.max_range < kSmallestRange) return Error{ErrorCode::invalid_argument, "descriptor range below 2048 bytes"};
    if (slots == 0) return Error{ErrorCode::unsupported, "the mesh has no triangles to draw"};
    if (slots > UINT32_MAX / 3) return Error{ErrorCode::too_large, "more than 2^32 indices"};
    if (model.vertex_count() - 1 > context.info().max_index) {
        return Error{ErrorCode::too_large, std::to_string(model.vertex_count()) +
                                               " vertices; the device's indices go to " +
                                               std::to_string(context.info().max_index)};
    }
    mesh.vertex_count = model.vertex_count();
    mesh.slots = static_cast<std::uint32_t>(slots);
    mesh.draw_slots = static_cast<std::uint32_t>(
        std::min<std::uint64_t>(mesh.max_range / sizeof(std::uint32_t), std::uint64_t{1} << 30) / kSlotStep *
        kSlotStep);
    mesh.draws = (mesh.slots + mesh.draw_slots - 1) / mesh.draw_slots;
    LR_ASSIGN(mesh.vertices, Buffer::create(context, "vertices", sizeof(Vertex) * std::uint64_t{mesh.vertex_count},
                                            VK_BUFFER_USAGE_VERTEX_BUFFER_BIT));
    LR_ASSIGN(mesh.indices, Buffer::create(context, "indices", 12 * padded_slots(mesh.slots),
                                           VK_BUFFER_USAGE_INDEX_BUFFER_BIT | VK_BUFFER_USAGE_STORAGE_BUFFER_BIT));
    return mesh;
}

/// `original(i)` is the mesh's vertex at place i, `ring(i)` its place on the rings.
template <class Original, class Ring>
Result<void> upload_vertices(Transfer& transfer, const GpuMesh& mesh, const Model& model, const Original& original,
                             const Ring& ring) {
    return transfer.upload(mesh.vertices, 0, sizeof(Vertex) * std::size_t{mesh.vertex_count}, sizeof(Vertex),
                           [&](std::byte* to, std::size_t from, std::size_t size) {
                               const std::size_t first = from / sizeof(Vertex);
                               for (std::size_t i = 0; i < size / sizeof(Vertex); ++i) {
                                   const auto place = static_cast<std::uint32_t>(first + i);
                                   const std::size_t v = original(place);
                                   Vertex vertex;
                                   std::memcpy(vertex.position, &model.positions[3 * v], sizeof(vertex.position));
                                   std::memcpy(vertex.normal, &model.normals[3 * v], sizeof(vertex.normal));
                                   vertex.ring = ring(place);
                                   std::memcpy(to + i * sizeof(Vertex), &vertex, sizeof(Vertex));
                               }
                           });
}

Result<void> upload_classes(Context& context, Transfer& transfer, GpuMesh& mesh,
                            std::span<const std::uint8_t> classes) {
    // The shader reads whole words.
    const std::uint64_t bytes = (classes.size() + 3) / 4 * 4;
    LR_ASSIGN(mesh.classes, Buffer::create(context, "triangle classes", bytes, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT));
    return transfer.upload(mesh.classes, classes);
}

/// The lines in the vertex numbers of `mesh`. They come in the same order and direction for both sources, so that they
/// are drawn alike.
Result<void> upload_lines(Context& context, Transfer& transfer, GpuMesh& mesh, const Model& model, const LeanView& lean,
                          UploadOptions::Lines kind) {
    if (kind == UploadOptions::Lines::none) return {};
    std::vector<std::uint32_t> lines;
    const std::vector<std::uint32_t>& order = model.lean.vertex_order;
    if (kind == UploadOptions::Lines::ring) {
        lines = ring_lines(lean);
        if (mesh.source == Source::plain) {
            for (std::uint32_t& v : lines) v = order[v];
        }
    } else {
        lines = mesh_edges(model.indices);
        if (mesh.source == Source::lean) {
            std::vector<std::uint32_t> place(order.size());
            for (std::uint32_t i = 0; i < order.size(); ++i) place[order[i]] = i;
            for (std::uint32_t& v : lines) v = place[v];
        }
    }
    if (lines.size() > UINT32_MAX) return Error{ErrorCode::too_large, "more than 2^31 lines"};
    LR_ASSIGN(mesh.lines, Buffer::create(context, "lines", 4 * lines.size(), VK_BUFFER_USAGE_INDEX_BUFFER_BIT));
    mesh.line_indices = static_cast<std::uint32_t>(lines.size());
    return transfer.upload(mesh.lines, std::span<const std::uint32_t>(lines));
}

float ring_place(std::uint32_t rank, std::uint32_t rings) {
    return rank < rings ? static_cast<float>(rank) / static_cast<float>(rings) : -1.0F;
}

}  // namespace

Result<GpuMesh> upload_plain(Context& context, Transfer& transfer, const Model& model, const UploadOptions& options) {
    LR_ASSIGN(GpuMesh mesh, prepare(context, model, model.triangle_count(), options));
    const auto indices = std::as_bytes(model.indices);
    LR_TRY(transfer.upload(
        mesh.indices, 0, mesh.indices.size(), 4, [&](std::byte* to, std::size_t from, std::size_t size) {
            const std::size_t real = from < indices.size() ? std::min(size, indices.size() - from) : 0;
            if (real != 0) std::memcpy(to, indices.data() + from, real);
            std::memset(to + real, 0, size - real);
        }));
    mesh.decoded = true;
    const auto identity = [](std::uint32_t v) { return v; };
    LR_ASSIGN(const LeanView lean, view_lean(model.lean.words));
    LR_TRY(upload_lines(context, transfer, mesh, model, lean, options.lines));
    if (!options.ring) {
        LR_TRY(upload_vertices(transfer, mesh, model, identity, [](std::uint32_t) { return -1.0F; }));
        return mesh;
    }
    const std::uint32_t rings = lean.rings2 + lean.rings1;
    std::vector<std::uint32_t> rank(mesh.vertex_count, UINT32_MAX);
    for (std::uint32_t i = 0; i < rings; ++i) rank[model.lean.vertex_order[i]] = i;
    LR_TRY(
        upload_vertices(transfer, mesh, model, identity, [&](std::uint32_t v) { return ring_place(rank[v], rings); }));
    const std::vector<std::uint8_t> by_slot = options.offsets ? slot_offset_bits(lean) : slot_classes(lean);
    std::vector<std::uint8_t> classes(mesh.slots, LR_CLASS_NONE);
    for (std::uint32_t slot = 0; slot < by_slot.size(); ++slot) {
        const std::uint32_t t = model.lean.slot_triangle[slot];
        if (t < mesh.slots) classes[t] = by_slot[slot];
    }
    LR_TRY(upload_classes(context, transfer, mesh, classes));
    return mesh;
}

Result<GpuMesh> upload_lean(Context& context, Transfer& transfer, const Model& model, const UploadOptions& options) {
    const LeanStream& stream = model.lean;
    LR_ASSIGN(const LeanView lean, view_lean(stream.words));
    if (lean.vertices != model.vertex_count() || stream.vertex_order.size() != lean.vertices ||
        stream.slot_triangle.size() != lean.slots()) {
        return Error{ErrorCode::invalid_argument, "the lean stream is not of this mesh"};
    }
    LR_ASSIGN(GpuMesh mesh, prepare(context, model, lean.slots(), options));
    mesh.source = Source::lean;
    constexpr VkBufferUsageFlags kStorage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
    const std::uint64_t bytes = stream.words.size() * sizeof(std::uint32_t);
    // The decoder loads a few words past the ones that it needs.
    LR_ASSIGN(mesh.stream, Buffer::create(context, "lean stream", bytes + 64, kStorage));
    LR_TRY(transfer.upload(mesh.stream, std::span<const std::uint32_t>(stream.words)));
    LR_ASSIGN(mesh.commands,
              Buffer::create(context, "draw commands", mesh.draws * std::uint64_t{sizeof(VkDrawIndexedIndirectCommand)},
                             kStorage | VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT));
    LR_ASSIGN(mesh.slot_triangle,
              Buffer::create(context, "slot triangles", stream.slot_triangle.size() * sizeof(std::uint32_t), kStorage));
    LR_TRY(transfer.upload(mesh.slot_triangle, std::span<const std::uint32_t>(stream.slot_triangle)));
    LR_ASSIGN(mesh.vertex_order,
              Buffer::create(context, "vertex order", stream.vertex_order.size() * sizeof(std::uint32_t), kStorage));
    LR_TRY(transfer.upload(mesh.vertex_order, std::span<const std::uint32_t>(stream.vertex_order)));
    const std::uint32_t rings = lean.rings2 + lean.rings1;
    LR_TRY(upload_vertices(
        transfer, mesh, model, [&](std::uint32_t v) { return stream.vertex_order[v]; },
        [&](std::uint32_t v) { return ring_place(v, rings); }));
    LR_TRY(upload_lines(context, transfer, mesh, model, lean, options.lines));
    if (options.ring) {
        LR_TRY(upload_classes(context, transfer, mesh, options.offsets ? slot_offset_bits(lean) : slot_classes(lean)));
    }
    return mesh;
}

}  // namespace lr::gpu
