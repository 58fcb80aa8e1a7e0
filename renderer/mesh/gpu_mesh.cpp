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

constexpr std::uint64_t kSmallestRange = 4096;  // a packed block's indices, or its record with alignment, fit
constexpr std::uint64_t kSlotStep = 256;        // in bytes, the coarsest alignment of a descriptor that Vulkan allows

constexpr VkBufferUsageFlags kAddress = VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT;

std::uint64_t padded_slots(std::uint32_t slots) {
    constexpr std::uint64_t kStep = LR_TRIANGLES_PER_INVOCATION;
    return (std::uint64_t{slots} + kStep - 1) / kStep * kStep;
}

std::uint64_t slots_of(const Model& model, Source source) {
    if (source == Source::plain) return model.triangle_count();
    return source == Source::lean ? model.lean.slot_triangle.size() : model.packed.triangle_order.size();
}

std::uint32_t vertices_of(const Model& model, Source source) {
    const EncodedSeams* seams = seams_of(model, source);
    return seams == nullptr ? model.vertex_count() : static_cast<std::uint32_t>(seams->copy_order.size());
}

/// Bytes of a vertex in GpuMesh::vertices.
constexpr std::size_t vertex_stride(Source source, Path path) {
    const bool pulled = source == Source::packed_vertices && path != Path::compute;
    return sizeof(Vertex) - (pulled ? sizeof(Vertex::position) : 0);
}

constexpr std::uint64_t kStreamTail = 64;  // the lean decoder loads a few words past the ones that it needs

/// What every source needs.
Result<GpuMesh> prepare(Context& context, const Model& model, Source source, const UploadOptions& options) {
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

/// `original(i)` is the mesh's vertex at place i, `ring(i)` its place on the rings. Positions are left out where they
/// are decoded.
template <class Original, class Ring>
Result<void> upload_vertices(Transfer& transfer, const GpuMesh& mesh, std::span<const float> positions,
                             std::span<const float> normals, const Original& original, const Ring& ring) {
    const std::size_t stride = vertex_stride(mesh.source, mesh.path);
    const bool decoded = mesh.source == Source::packed_vertices;
    return transfer.upload(mesh.vertices, 0, stride * mesh.vertex_count, stride,
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

/// One byte a slot, of the triangle that `triangle_of(slot)` says.
template <class TriangleOf>
Result<void> upload_classes(Context& context, Transfer& transfer, GpuMesh& mesh, const Model& model,
                            const LeanView& lean, bool offsets, const TriangleOf& triangle_of) {
    const std::vector<std::uint8_t> by_triangle = of_triangles(offsets ? slot_offset_bits(lean) : slot_classes(lean),
                                                               model.lean.slot_triangle, model.triangle_count());
    std::vector<std::uint8_t> classes((mesh.slots + 3) / 4 * 4, LR_CLASS_NONE);  // the shader reads whole words
    for (std::uint32_t slot = 0; slot < mesh.slots; ++slot) {
        const std::uint32_t t = triangle_of(slot);
        if (t < by_triangle.size()) classes[slot] = by_triangle[t];
    }
    LR_ASSIGN(mesh.classes,
              Buffer::create(context, "triangle classes", classes.size(), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT));
    return transfer.upload(mesh.classes, std::span<const std::uint8_t>(classes));
}

/// The lines in the vertex numbers of a source: `order` is its vertex order, empty for the mesh's own. They come in the
/// same order and direction for all sources, so that they are drawn alike. Any vertex at the place does.
Result<void> upload_lines(Context& context, Transfer& transfer, GpuMesh& mesh, const Model& model, const LeanView& lean,
                          UploadOptions::Lines kind, std::span<const std::uint32_t> order) {
    if (kind == UploadOptions::Lines::none) return {};
    std::vector<std::uint32_t> lines;
    if (kind == UploadOptions::Lines::ring) {
        lines = ring_lines(lean);
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
    LR_ASSIGN(mesh.lines, Buffer::create(context, "lines", 4 * lines.size(), VK_BUFFER_USAGE_INDEX_BUFFER_BIT));
    mesh.line_indices = static_cast<std::uint32_t>(lines.size());
    return transfer.upload(mesh.lines, std::span<const std::uint32_t>(lines));
}

/// What materials are drawn with at the vertices. `original(i)` is the mesh's vertex at place i.
template <class Original>
Result<void> upload_shading(Context& context, Transfer& transfer, GpuMesh& mesh, const Model& model,
                            const std::array<std::uint32_t, 2>& materials, const Original& original) {
    static_assert(sizeof(Shading) == LR_SHADING_WORDS * sizeof(std::uint32_t));
    constexpr std::size_t kStride = sizeof(Shading);
    mesh.materials = materials;
    LR_ASSIGN(mesh.shading, Buffer::create(context, "shading", kStride * std::uint64_t{mesh.vertex_count},
                                           VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | kAddress));
    return transfer.upload(mesh.shading, 0, kStride * mesh.vertex_count, kStride,
                           [&](std::byte* to, std::size_t from, std::size_t size) {
                               for (std::size_t i = 0; i < size / kStride; ++i) {
                                   const std::size_t v = original(static_cast<std::uint32_t>(from / kStride + i));
                                   const Shading shading = v < model.shading.size() ? model.shading[v] : Shading{};
                                   std::memcpy(to + i * kStride, &shading, kStride);
                               }
                           });
}

/// What is drawn beside the triangles, and the vertices. `original(i)` is the mesh's vertex at place i.
template <class Original, class TriangleOf>
Result<void> upload_rest(Context& context, Transfer& transfer, GpuMesh& mesh, const Model& model,
                         const UploadOptions& options, std::span<const std::uint32_t> order, const Original& original,
                         const TriangleOf& triangle_of) {
    LeanView lean;
    if (options.ring || options.lines == UploadOptions::Lines::ring) {
        LR_ASSIGN(lean, view_lean(model.lean.words));
    }
    LR_TRY(upload_lines(context, transfer, mesh, model, lean, options.lines, order));
    if (options.materials) LR_TRY(upload_shading(context, transfer, mesh, model, *options.materials, original));
    const std::span<const float> normals = options.normals.empty() ? model.normals : options.normals;
    const auto vertices_with = [&](const auto& ring) {
        return upload_vertices(transfer, mesh, model.positions, normals, original, ring);
    };
    if (!options.ring) return vertices_with([](std::uint32_t) { return -1.0F; });
    const std::uint32_t rings = lean.rings2 + lean.rings1;
    std::vector<float> ring(model.surface.vertex_count, -1.0F);
    for (std::uint32_t i = 0; i < rings; ++i) {
        ring[model.lean.vertex_order[i]] = static_cast<float>(i) / static_cast<float>(rings);
    }
    LR_TRY(vertices_with([&](std::uint32_t v) { return ring[model.surface_of(original(v))]; }));
    return upload_classes(context, transfer, mesh, model, lean, options.offsets, triangle_of);
}

/// A stream, the mesh's vertex of each one that is drawn, and the mesh's triangle of each slot.
struct Stream {
    std::span<const std::uint32_t> words, vertex_order, slot_triangle;
    std::array<std::uint32_t, 4> layout;
};

Result<Stream> lean_stream(const Model& model) {
    const EncodedLean& stream = model.lean;
    LR_ASSIGN(const LeanView view, view_lean(stream.words));
    if (view.vertices != model.surface.vertex_count || stream.vertex_order.size() != view.vertices ||
        stream.slot_triangle.size() != view.slots()) {
        return Error{ErrorCode::invalid_argument, "the lean stream is not of this mesh"};
    }
    return Stream{
        stream.words, stream.vertex_order, stream.slot_triangle, {view.rings2, view.rings1, view.verbatim, 0}};
}

Result<Stream> packed_stream(const Model& model) {
    const EncodedPacked& stream = model.packed;
    if (stream.words.empty()) return Error{ErrorCode::invalid_argument, "the model was made without a packed stream"};
    LR_ASSIGN(const PackedView view, view_packed(stream.words));
    if (view.vertices != model.surface.vertex_count || stream.vertex_order.size() != view.vertices ||
        stream.triangle_order.size() != view.triangles) {
        return Error{ErrorCode::invalid_argument, "the packed stream is not of this mesh"};
    }
    return Stream{stream.words,
                  stream.vertex_order,
                  stream.triangle_order,
                  {view.own, static_cast<std::uint32_t>(view.table_word()),
                   static_cast<std::uint32_t>(view.groups_word()), view.vertex_bits}};
}

Result<void> upload_vertex_stream(Context& context, Transfer& transfer, GpuMesh& mesh, const Model& model) {
    const std::span<const std::uint32_t> words = model.vertices.words;
    if (words.empty()) return Error{ErrorCode::invalid_argument, "the model was made without a vertex stream"};
    LR_ASSIGN(const VertexView view, view_vertices(words));
    if (view.vertices != model.surface.vertex_count || view.integers != 3 || view.type != ComponentType::f32 ||
        view.mapping == VertexMapping::octahedral) {
        return Error{ErrorCode::invalid_argument, "the vertex stream is not of this mesh's positions"};
    }
    mesh.unit = model.unit;
    LR_ASSIGN(mesh.vertex_stream, Buffer::create(context, "vertex stream", words.size_bytes(),
                                                 VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | kAddress));
    return transfer.upload(mesh.vertex_stream, words);
}

Result<void> upload_seams(Context& context, Transfer& transfer, GpuMesh& mesh, const EncodedSeams& seams) {
    LR_ASSIGN(const SeamView view, view_seams(seams.words, mesh.slots, mesh.surface_vertices));
    if (view.copies != seams.copy_order.size())
        return Error{ErrorCode::invalid_argument, "the seam section is not of this mesh"};
    constexpr VkBufferUsageFlags kStorage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | kAddress;
    const std::span<const std::uint32_t> words = seams.words;
    LR_ASSIGN(mesh.seams, Buffer::create(context, "seams", words.size_bytes(), kStorage));
    LR_ASSIGN(mesh.homes,
              Buffer::create(context, "homes", (std::uint64_t{view.vertices} + 1) * sizeof(std::uint32_t), kStorage));
    LR_ASSIGN(mesh.copies,
              Buffer::create(context, "copies", mesh.indices.size(), kStorage | VK_BUFFER_USAGE_INDEX_BUFFER_BIT));
    LR_ASSIGN(mesh.copy_vertices, Buffer::create(context, "vertices of copies",
                                                 std::uint64_t{view.copies} * sizeof(std::uint32_t), kStorage));
    if (mesh.source == Source::packed_vertices && mesh.path == Path::compute) {
        LR_ASSIGN(mesh.positions, Buffer::create(context, "positions of the surface",
                                                 std::uint64_t{view.vertices} * sizeof(Vertex::position), kStorage));
    }
    return transfer.upload(mesh.seams, words);
}

Result<GpuMesh> upload_stream(Context& context, Transfer& transfer, const Model& model, Source source,
                              const UploadOptions& options) {
    LR_ASSIGN(Stream stream, source == Source::lean ? lean_stream(model) : packed_stream(model));
    LR_ASSIGN(GpuMesh mesh, prepare(context, model, source, options));
    if (const EncodedSeams* seams = seams_of(model, source)) {
        stream.vertex_order = seams->copy_order;
        LR_TRY(upload_seams(context, transfer, mesh, *seams));
    }
    if (source == Source::packed_vertices) LR_TRY(upload_vertex_stream(context, transfer, mesh, model));
    mesh.stream_layout = stream.layout;
    constexpr VkBufferUsageFlags kStorage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
    LR_ASSIGN(mesh.stream,
              Buffer::create(context, "stream", stream.words.size_bytes() + kStreamTail, kStorage | kAddress));
    LR_TRY(transfer.upload(mesh.stream, stream.words));
    if (mesh.indices) {
        LR_ASSIGN(mesh.commands, Buffer::create(context, "draw commands",
                                                mesh.draws * std::uint64_t{sizeof(VkDrawIndexedIndirectCommand)},
                                                kStorage | VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT));
    }
    LR_ASSIGN(mesh.slot_triangle,
              Buffer::create(context, "slot triangles", stream.slot_triangle.size_bytes(), kStorage));
    LR_TRY(transfer.upload(mesh.slot_triangle, stream.slot_triangle));
    LR_ASSIGN(mesh.vertex_order,
              Buffer::create(context, "vertex order", stream.vertex_order.size_bytes(), kStorage | kAddress));
    LR_TRY(transfer.upload(mesh.vertex_order, stream.vertex_order));
    LR_TRY(upload_rest(
        context, transfer, mesh, model, options, stream.vertex_order,
        [&](std::uint32_t i) { return stream.vertex_order[i]; },
        [&](std::uint32_t slot) { return stream.slot_triangle[slot]; }));
    return mesh;
}

Result<GpuMesh> upload_plain(Context& context, Transfer& transfer, const Model& model, const UploadOptions& options) {
    if (options.path != Path::compute)
        return Error{ErrorCode::invalid_argument, "the pull, geometry and mesh paths draw streams, not an index list"};
    LR_ASSIGN(GpuMesh mesh, prepare(context, model, Source::plain, options));
    const auto indices = std::as_bytes(model.indices);
    LR_TRY(transfer.upload(
        mesh.indices, 0, mesh.indices.size(), 4, [&](std::byte* to, std::size_t from, std::size_t size) {
            const std::size_t real = from < indices.size() ? std::min(size, indices.size() - from) : 0;
            if (real != 0) std::memcpy(to, indices.data() + from, real);
            std::memset(to + real, 0, size - real);
        }));
    mesh.decoded = true;
    const auto itself = [](std::uint32_t i) { return i; };
    LR_TRY(upload_rest(context, transfer, mesh, model, options, {}, itself, itself));
    return mesh;
}

}  // namespace

std::optional<Path> path_named(std::string_view name) {
    for (const NamedPath& named : kPaths) {
        if (named.name == name) return named.path;
    }
    return std::nullopt;
}

std::optional<Source> source_named(std::string_view name) {
    for (const NamedSource& named : kSources) {
        if (named.name == name) return named.source;
    }
    return std::nullopt;
}

std::vector<std::string> path_names() {
    std::vector<std::string> out;
    for (const NamedPath& named : kPaths) out.emplace_back(named.name);
    return out;
}

std::vector<std::string> source_names() {
    std::vector<std::string> out;
    for (const NamedSource& named : kSources) out.emplace_back(named.name);
    return out;
}

bool has_source(const Model& model, Source source) {
    if (source == Source::packed_vertices && model.vertices.words.empty()) return false;
    return !is_packed(source) || !model.packed.words.empty();
}

const EncodedSeams* seams_of(const Model& model, Source source) {
    if (source == Source::plain || !model.surface.has_seams()) return nullptr;
    return source == Source::lean ? &model.lean_seams : &model.packed_seams;
}

std::uint64_t connectivity_bytes(const Model& model, Source source) {
    if (source == Source::plain) return 0;
    const EncodedSeams* seams = seams_of(model, source);
    return sizeof(std::uint32_t) * ((is_packed(source) ? model.packed.words : model.lean.words).size() +
                                    (seams == nullptr ? 0 : seams->words.size()));
}

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

Result<GpuMesh> upload_mesh(Context& context, Transfer& transfer, const Model& model, Source source,
                            const UploadOptions& options) {
    return source == Source::plain ? upload_plain(context, transfer, model, options)
                                   : upload_stream(context, transfer, model, source, options);
}

}  // namespace lacedring::gpu
