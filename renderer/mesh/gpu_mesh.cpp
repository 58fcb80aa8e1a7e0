#include "renderer/mesh/gpu_mesh.h"

#include <algorithm>
#include <cstring>

#include "lacedring/lacedring.hpp"
#include "lacedring/streams.hpp"
#include "lacedring/vertices.hpp"
#include "renderer/mesh/triangle_class.h"
#include "renderer/vk/context.h"
#include "renderer/vk/device_error.h"
#include "renderer/vk/try.h"
#include "shaders/shared.h"

namespace lacedring::gpu {
namespace {

constexpr std::uint64_t kSmallestRange = 4096;  // fits a packed block's indices, or its record with alignment
constexpr std::uint64_t kSlotStep = 256;        // 256 bytes (classes) is the largest descriptor alignment in Vulkan

constexpr VkBufferUsageFlags kAddress = VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT;
constexpr VkBufferUsageFlags kStorage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;

std::uint64_t padded_slots(std::uint32_t slots) {
    constexpr std::uint64_t kStep = LR_TRIANGLES_PER_INVOCATION;
    return (std::uint64_t{slots} + kStep - 1) / kStep * kStep;
}

/// Bytes per vertex in GpuMesh::vertices.
constexpr std::size_t vertex_stride(Source source, Path path) {
    const bool pulled = source == Source::packed_vertices && path != Path::compute;
    return sizeof(Vertex) - (pulled ? sizeof(Vertex::position) : 0);
}

constexpr std::uint64_t kStreamTail = 64;  // the lean decoder loads a few words past the ones that it needs

/// Checks the options and creates the parts that every source has.
Result<GpuMesh> prepare(const Upload& upload) {
    const auto& [context, transfer, model, source, options, views] = upload;
    const std::uint64_t slots = slots_of(model, source);
    GpuMesh mesh;
    mesh.source = source;
    mesh.max_range = options.max_range == 0 ? context.limits().maxStorageBufferRange : options.max_range;
    if (mesh.max_range < kSmallestRange) return Error{ErrorCode::invalid_argument, "descriptor range below 4096 bytes"};
    if (slots == 0) return Error{ErrorCode::unsupported, "the mesh has no triangles to draw"};
    if (slots > UINT32_MAX / 3) return Error{ErrorCode::too_large, "more than 2^32 indices"};
    mesh.vertex_count = vertices_of(model, source);
    mesh.surface_vertices = model.surface.vertex_count;
    if (mesh.vertex_count - 1 > context.info().max_index) {
        return Error{kNoDevice, std::to_string(mesh.vertex_count) + " vertices; the device's indices go to " +
                                    std::to_string(context.info().max_index)};
    }
    mesh.path = options.path;
    if (mesh.path == Path::mesh && context.info().max_mesh_groups == 0) {
        return Error{kNoDevice, "the device has no mesh shaders (VK_EXT_mesh_shader)"};
    }
    const MeshBytes bytes = mesh_bytes(model, source, options);
    LR_TRY(context.arena().check_room(bytes.all, bytes.largest));
    mesh.slots = static_cast<std::uint32_t>(slots);
    mesh.draw_slots = static_cast<std::uint32_t>(
        std::min<std::uint64_t>(mesh.max_range / sizeof(std::uint32_t), std::uint64_t{1} << 30) / kSlotStep *
        kSlotStep);
    if (mesh.path == Path::mesh) {
        const std::uint64_t most = std::uint64_t{context.info().max_mesh_groups} * LR_MESH_TRIANGLES;
        mesh.draw_slots =
            static_cast<std::uint32_t>(std::min<std::uint64_t>(mesh.draw_slots, most / kSlotStep * kSlotStep));
    }
    mesh.draws = (mesh.slots + mesh.draw_slots - 1) / mesh.draw_slots;
    LR_ASSIGN(mesh.vertices,
              Buffer::create(context, "vertices", vertex_stride(source, mesh.path) * std::uint64_t{mesh.vertex_count},
                             VK_BUFFER_USAGE_VERTEX_BUFFER_BIT | VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | kAddress));
    if (mesh.path != Path::compute && seams_of(model, source) == nullptr) return mesh;
    LR_ASSIGN(mesh.indices, Buffer::create(context, "indices", 12 * padded_slots(mesh.slots),
                                           VK_BUFFER_USAGE_INDEX_BUFFER_BIT | VK_BUFFER_USAGE_STORAGE_BUFFER_BIT));
    return mesh;
}

/// Creates a buffer and uploads the values.
template <class T>
Result<void> put(const Upload& upload, Buffer& to, const char* name, std::span<const T> values,
                 VkBufferUsageFlags usage) {
    LR_ASSIGN(to, Buffer::create(upload.context, name, values.size_bytes(), usage));
    return upload.transfer.upload(to, values);
}

/// Uploads GpuMesh::vertices, without positions that are decoded from a vertex stream. `original(i)` is the mesh
/// vertex of uploaded vertex i, `ring(i)` its position along the rings.
template <class Original, class Ring>
Result<void> upload_vertices(const Upload& upload, const GpuMesh& mesh, const Original& original, const Ring& ring) {
    const std::span<const float> positions = upload.model.positions;
    const std::span<const float> normals =
        upload.options.normals.empty() ? std::span<const float>(upload.model.normals) : upload.options.normals;
    const std::size_t stride = vertex_stride(mesh.source, mesh.path);
    const bool decoded = mesh.source == Source::packed_vertices;
    return upload.transfer.upload(mesh.vertices, 0, stride * mesh.vertex_count, stride,
                                  [&](std::byte* to, std::size_t from, std::size_t size) {
                                      const std::size_t first = from / stride;
                                      for (std::size_t i = 0; i < size / stride; ++i) {
                                          const auto place = static_cast<std::uint32_t>(first + i);
                                          const std::size_t v = original(place);
                                          Vertex vertex{};
                                          if (!decoded)
                                              std::memcpy(vertex.position, &positions[3 * v], sizeof(vertex.position));
                                          std::memcpy(vertex.normal, &normals[3 * v], sizeof(vertex.normal));
                                          vertex.ring = ring(place);
                                          const auto* bytes = reinterpret_cast<const std::byte*>(&vertex);
                                          std::memcpy(to + i * stride, bytes + sizeof(Vertex) - stride, stride);
                                      }
                                  });
}

/// Uploads one byte per slot: the class or offset bits of the mesh's triangle `triangle_of(slot)`.
template <class TriangleOf>
Result<void> upload_classes(const Upload& upload, GpuMesh& mesh, const TriangleOf& triangle_of) {
    const LeanView& lean = upload.views.lean;
    const std::vector<std::uint8_t> by_triangle =
        of_triangles(upload.options.offsets ? slot_offset_bits(lean) : slot_classes(lean),
                     upload.model.lean.slot_triangle, upload.model.triangle_count());
    std::vector<std::uint8_t> classes((mesh.slots + 3) / 4 * 4, LR_CLASS_NONE);  // the shader reads whole words
    for (std::uint32_t slot = 0; slot < mesh.slots; ++slot) {
        const std::uint32_t t = triangle_of(slot);
        if (t < by_triangle.size()) classes[slot] = by_triangle[t];
    }
    return put(upload, mesh.classes, "triangle classes", std::span<const std::uint8_t>(classes), kStorage);
}

/// Uploads the lines in the vertex numbers of a source; `order` is its vertex order, empty for the mesh's own. All
/// sources get the lines in the same order and direction, so that they draw the same pixels. At a seam, a line ends at
/// any of the copies.
Result<void> upload_lines(const Upload& upload, GpuMesh& mesh, std::span<const std::uint32_t> order) {
    const Model& model = upload.model;
    const UploadOptions::Lines kind = upload.options.lines;
    if (kind == UploadOptions::Lines::none) return {};
    std::vector<std::uint32_t> lines;
    if (kind == UploadOptions::Lines::ring) {
        lines = ring_lines(upload.views.lean);
        const std::vector<std::uint32_t> of_surface = first_vertices(model.surface);
        for (std::uint32_t& v : lines) v = of_surface[model.lean.vertex_order[v]];
    } else {
        lines = kind == UploadOptions::Lines::edges ? mesh_edges(model.indices)
                                                    : seam_lines(model.indices, model.surface.vertex_of);
    }
    if (lines.empty()) return {};
    if (!order.empty()) {
        std::vector<std::uint32_t> place(model.surface.vertex_count);
        for (std::uint32_t i = 0; i < order.size(); ++i) place[model.surface_of(order[i])] = i;
        for (std::uint32_t& v : lines) v = place[model.surface_of(v)];
    }
    if (lines.size() > UINT32_MAX) return Error{ErrorCode::too_large, "more than 2^31 lines"};
    mesh.line_indices = static_cast<std::uint32_t>(lines.size());
    return put(upload, mesh.lines, "lines", std::span<const std::uint32_t>(lines), VK_BUFFER_USAGE_INDEX_BUFFER_BIT);
}

/// Uploads texture coordinates and colors of the vertices. `original(i)` is the mesh vertex of uploaded vertex i.
template <class Original>
Result<void> upload_shading(const Upload& upload, GpuMesh& mesh, const Original& original) {
    static_assert(sizeof(Shading) == LR_SHADING_WORDS * sizeof(std::uint32_t));
    constexpr std::size_t kStride = sizeof(Shading);
    const Model& model = upload.model;
    mesh.materials = *upload.options.materials;
    LR_ASSIGN(mesh.shading, Buffer::create(upload.context, "shading", kStride * std::uint64_t{mesh.vertex_count},
                                           VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | kAddress));
    return upload.transfer.upload(
        mesh.shading, 0, kStride * mesh.vertex_count, kStride, [&](std::byte* to, std::size_t from, std::size_t size) {
            for (std::size_t i = 0; i < size / kStride; ++i) {
                const std::size_t v = original(static_cast<std::uint32_t>(from / kStride + i));
                const Shading shading = v < model.shading.size() ? model.shading[v] : Shading{};
                std::memcpy(to + i * kStride, &shading, kStride);
            }
        });
}

/// Uploads vertices, lines, shading and classes. `original(i)` is the mesh vertex of uploaded vertex i.
template <class Original, class TriangleOf>
Result<void> upload_rest(const Upload& upload, GpuMesh& mesh, std::span<const std::uint32_t> order,
                         const Original& original, const TriangleOf& triangle_of) {
    LR_TRY(upload_lines(upload, mesh, order));
    if (upload.options.materials) LR_TRY(upload_shading(upload, mesh, original));
    if (!upload.options.ring) return upload_vertices(upload, mesh, original, [](std::uint32_t) { return -1.0F; });
    const Model& model = upload.model;
    const std::uint32_t rings = upload.views.lean.rings2 + upload.views.lean.rings1;
    std::vector<float> ring(model.surface.vertex_count, -1.0F);
    for (std::uint32_t i = 0; i < rings; ++i) {
        ring[model.lean.vertex_order[i]] = static_cast<float>(i) / static_cast<float>(rings);
    }
    LR_TRY(
        upload_vertices(upload, mesh, original, [&](std::uint32_t v) { return ring[model.surface_of(original(v))]; }));
    return upload_classes(upload, mesh, triangle_of);
}

/// A stream, with the mesh's vertex of each drawn vertex and the mesh's triangle of each slot.
struct Stream {
    std::span<const std::uint32_t> words, vertex_order, slot_triangle;
    std::array<std::uint32_t, 4> layout;
};

Stream stream_of(const Upload& upload) {
    const Model& model = upload.model;
    if (upload.source == Source::lean) {
        const LeanView& view = upload.views.lean;
        return {model.lean.words,
                model.lean.vertex_order,
                model.lean.slot_triangle,
                {view.rings2, view.rings1, view.verbatim, 0}};
    }
    const PackedView& view = upload.views.packed;
    return {model.packed.words,
            model.packed.vertex_order,
            model.packed.triangle_order,
            {view.own, static_cast<std::uint32_t>(view.table_word()), static_cast<std::uint32_t>(view.groups_word()),
             view.vertex_bits}};
}

Result<void> upload_seams(const Upload& upload, GpuMesh& mesh, const EncodedSeams& seams) {
    Context& context = upload.context;
    const SeamView& view = upload.views.seams;
    constexpr VkBufferUsageFlags kBoth = kStorage | kAddress;
    LR_TRY(put(upload, mesh.seams, "seams", std::span<const std::uint32_t>(seams.words), kBoth));
    LR_ASSIGN(mesh.homes,
              Buffer::create(context, "homes", (std::uint64_t{view.vertices} + 1) * sizeof(std::uint32_t), kBoth));
    LR_ASSIGN(mesh.copies,
              Buffer::create(context, "copies", mesh.indices.size(), kBoth | VK_BUFFER_USAGE_INDEX_BUFFER_BIT));
    LR_ASSIGN(mesh.copy_vertices,
              Buffer::create(context, "vertices of copies", std::uint64_t{view.copies} * sizeof(std::uint32_t), kBoth));
    if (mesh.source != Source::packed_vertices || mesh.path != Path::compute) return {};
    LR_ASSIGN(mesh.positions, Buffer::create(context, "positions of the surface",
                                             std::uint64_t{view.vertices} * sizeof(Vertex::position), kBoth));
    return {};
}

Result<GpuMesh> upload_stream(const Upload& upload) {
    const auto& [context, transfer, model, source, options, views] = upload;
    Stream stream = stream_of(upload);
    LR_ASSIGN(GpuMesh mesh, prepare(upload));
    if (const EncodedSeams* seams = seams_of(model, source)) {
        stream.vertex_order = seams->copy_order;
        LR_TRY(upload_seams(upload, mesh, *seams));
    }
    if (source == Source::packed_vertices) {
        mesh.unit = model.unit;
        LR_TRY(put(upload, mesh.vertex_stream, "vertex stream", std::span<const std::uint32_t>(model.vertices.words),
                   kStorage | kAddress));
    }
    mesh.stream_layout = stream.layout;
    LR_ASSIGN(mesh.stream,
              Buffer::create(context, "stream", stream.words.size_bytes() + kStreamTail, kStorage | kAddress));
    LR_TRY(transfer.upload(mesh.stream, stream.words));
    if (mesh.indices) {
        LR_ASSIGN(mesh.commands, Buffer::create(context, "draw commands",
                                                mesh.draws * std::uint64_t{sizeof(VkDrawIndexedIndirectCommand)},
                                                kStorage | VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT));
    }
    LR_TRY(put(upload, mesh.slot_triangle, "slot triangles", stream.slot_triangle, kStorage));
    LR_TRY(put(upload, mesh.vertex_order, "vertex order", stream.vertex_order, kStorage | kAddress));
    LR_TRY(upload_rest(
        upload, mesh, stream.vertex_order, [&](std::uint32_t i) { return stream.vertex_order[i]; },
        [&](std::uint32_t slot) { return stream.slot_triangle[slot]; }));
    return mesh;
}

Result<GpuMesh> upload_plain(const Upload& upload) {
    if (upload.options.path != Path::compute)
        return Error{ErrorCode::invalid_argument, "the pull, geometry and mesh paths draw streams, not an index list"};
    LR_ASSIGN(GpuMesh mesh, prepare(upload));
    const auto indices = std::as_bytes(upload.model.indices);
    LR_TRY(upload.transfer.upload(
        mesh.indices, 0, mesh.indices.size(), 4, [&](std::byte* to, std::size_t from, std::size_t size) {
            const std::size_t real = from < indices.size() ? std::min(size, indices.size() - from) : 0;
            if (real != 0) std::memcpy(to, indices.data() + from, real);
            std::memset(to + real, 0, size - real);
        }));
    mesh.decoded = true;
    const auto itself = [](std::uint32_t i) { return i; };
    LR_TRY(upload_rest(upload, mesh, {}, itself, itself));
    return mesh;
}

}  // namespace

MeshBytes mesh_bytes(const Model& model, Source source, const UploadOptions& options) {
    constexpr std::uint64_t kWord = sizeof(std::uint32_t);
    const std::uint64_t slots = slots_of(model, source);
    MeshBytes out;
    const auto add = [&](std::uint64_t bytes) {
        out.all += bytes;
        out.largest = std::max(out.largest, bytes);
    };
    const bool seams = seams_of(model, source) != nullptr, indices = options.path == Path::compute || seams;
    const std::uint64_t vertices = vertices_of(model, source), surface_vertices = model.surface.vertex_count;
    const std::uint64_t index_bytes = 3 * kWord * padded_slots(static_cast<std::uint32_t>(slots));
    add(vertex_stride(source, options.path) * vertices);
    if (indices) add(index_bytes);
    if (seams) {
        add(index_bytes);
        add(kWord * (surface_vertices + 1));
        add(kWord * vertices);
        if (source == Source::packed_vertices && options.path == Path::compute) add(3 * kWord * surface_vertices);
    }
    if (source != Source::plain) {
        add(connectivity_bytes(model, source) + kStreamTail);
        if (source == Source::packed_vertices) add(kWord * model.vertices.words.size());
        add(kWord * slots);
        add(kWord * vertices);
        if (indices) add(sizeof(VkDrawIndexedIndirectCommand) * (slots / kSlotStep + 1));
    }
    if (options.ring) add((slots + 3) / 4 * 4);
    if (options.materials) add(sizeof(Shading) * vertices);
    if (options.lines == UploadOptions::Lines::ring) add(2 * kWord * model.vertex_count());
    if (options.lines == UploadOptions::Lines::edges || (options.lines == UploadOptions::Lines::seams && seams)) {
        add(6 * kWord * model.triangle_count());
    }
    return out;
}

Result<GpuMesh> upload_mesh(const Upload& upload) {
    return upload.source == Source::plain ? upload_plain(upload) : upload_stream(upload);
}

}  // namespace lacedring::gpu
