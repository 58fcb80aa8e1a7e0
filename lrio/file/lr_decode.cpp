// Decodes an .lr file in memory to a mesh.

#include <algorithm>
#include <numeric>

#include "lrcore/base/try.h"
#include "lrcore/codec/storage/seam_storage.h"
#include "lrio/file/lr_layout.h"

namespace lacedring {
namespace detail {
namespace {

/// Restores seams from storage form: the words of the resident section, the copies, and the copies' vertices.
Result<storage::RestoredSeams> restore(const StoredSeams& stored, std::span<const std::uint32_t> slots,
                                       std::uint32_t vertices) {
    constexpr std::uint64_t kCorner = 50, kVertex = 50;  // bytes of memory during the call
    if (kCorner * slots.size() + kVertex * vertices > stored.max_bytes) {
        return Error{ErrorCode::memory_limit, fmt::format("lr file: seams of {} triangles in storage form would take "
                                                          "more than {} MiB",
                                                          slots.size() / 3, stored.max_bytes >> 20)};
    }
    return storage::restore_seams(stored.words, slots, vertices);
}

/// Sets out.indices to the copies of the slots' corners and out.vertex_of to the vertex of each copy.
Result<void> decode_copies(const LrFileView& file, const StreamView& stream, bool untrusted, const StoredSeams* stored,
                           DecodedLr& out) {
    const std::vector<std::uint32_t> slots = slot_triangles(stream);
    std::vector<std::uint32_t> copies;
    if (stored != nullptr) {
        LR_ASSIGN(storage::RestoredSeams restored, restore(*stored, slots, stream.vertices()));
        stored->words = std::move(restored.words);
        copies = std::move(restored.copies);
        out.vertex_of = std::move(restored.vertices);
    } else {
        LR_ASSIGN(const SeamView seams, view_seams(file.seams, stream.slots(), stream.vertices()));
        copies.resize(slots.size());
        if (untrusted) {
            LR_TRY(decode_seams_checked(file.seams, slots, stream.vertices(), copies, out.vertex_of));
        } else {
            decode_seams(seams, slots, copies);
            out.vertex_of.resize(seams.copies);
            copy_vertices(seams, slots, out.vertex_of);
        }
    }
    if (out.vertex_of.size() != file.copy_count) {
        return malformed_lr("seams and file have different numbers of copies");
    }
    std::erase(copies, UINT32_MAX);
    out.indices = std::move(copies);
    return {};
}

}  // namespace

void DecodedLr::remove_extra(std::vector<std::uint32_t>& values) const {
    if (extra.empty()) return;
    std::size_t kept = 0;
    for (std::size_t i = 0; i < values.size(); ++i) {
        if (!is_extra(i)) values[kept++] = values[i];
    }
    values.resize(kept);
}

Result<DecodedLr> decode_connectivity(const LrFileView& file, bool untrusted, const StoredSeams* stored) {
    LR_ASSIGN(const StreamView view, untrusted ? validate(file.words) : view_stream(file.words));
    if (view.format() != file.format) return malformed_lr("the stream is of another format than its section");
    if (view.vertices() != file.vertex_count) {
        return malformed_lr("connectivity and file have different vertex counts");
    }
    DecodedLr out;
    out.vertices = view.vertices();
    if (file.seams.empty()) {
        out.indices = decode(view);
    } else if (const Result<void> decoded = decode_copies(file, view, untrusted, stored, out); !decoded) {
        return decoded.error();
    }
    const auto mark_extra = [&](const auto* stream) {
        if (stream == nullptr || stream->copies.empty()) return;
        out.extra.assign(stream->view.used_vertices(), false);
        for (std::size_t i = 0; i < stream->copies.size(); i += 2) out.extra[stream->copies[i]] = true;
        if (file.seams.empty()) return;
        std::vector<bool> copies(out.vertex_of.size());
        for (std::size_t i = 0; i < copies.size(); ++i) copies[i] = out.is_extra(out.vertex_of[i]);
        out.extra = std::move(copies);
    };
    mark_extra(view.get<LrStreamView<LrView>>());
    mark_extra(view.get<LrStreamView<CompactLrView>>());
    return out;
}

std::span<const std::uint32_t> triangles_of(const DecodedLr& decoded, bool per_copy,
                                            std::vector<std::uint32_t>& of_vertices) {
    if (per_copy || decoded.vertex_of.empty()) return decoded.indices;
    if (of_vertices.empty()) {
        of_vertices.reserve(decoded.indices.size());
        for (const std::uint32_t copy : decoded.indices) of_vertices.push_back(decoded.vertex_of[copy]);
    }
    return of_vertices;
}

std::vector<std::uint32_t> position_integers(const LrFile& file) {
    if (file.attributes.empty() || file.attributes[0].name != "POSITION") return {};
    const Result<VertexView> view = view_vertices(file.attributes[0].words);
    if (!view || view->integers != 3 || view->vertices != file.vertex_count ||
        (view->mapping != VertexMapping::lattice && view->mapping != VertexMapping::decimals))
        return {};
    std::vector<std::uint32_t> out(std::size_t{3} * view->vertices);
    for (std::uint32_t b = 0; b < view->blocks(); ++b)
        decode_vertex_block(*view, b, std::span(out).subspan(std::size_t{3} * kVertexBlock * b));
    return out;
}

storage::VertexPlaces places_of(std::span<const std::uint32_t> positions, const DecodedLr& decoded, bool per_copy) {
    if (!per_copy) return {positions, {}};
    return {positions, decoded.vertex_of};
}

Attribute decode_attribute(const LrAttribute& attribute) {
    if (attribute.words.empty()) return attribute;
    Attribute out{attribute.name, attribute.type, attribute.components, attribute.normalized, {}, attribute.v_up};
    if (const Result<VertexView> view = view_vertices(attribute.words)) {
        out.data.resize(view->decoded_bytes());
        decode_vertices(*view, out.data);
    }
    return out;
}

Result<Mesh> decode_mesh(const LrFile& file, DecodedLr& decoded, Surface* surface) {
    // The mesh's vertices are the copies if there are seams, else the connectivity's vertices, without the extra ones,
    // which no triangle names.
    std::vector<std::uint32_t> kept(decoded.vertex_of.empty() ? decoded.vertices : decoded.vertex_of.size());
    std::iota(kept.begin(), kept.end(), 0U);
    const std::size_t all = kept.size();
    decoded.remove_extra(kept);
    Mesh mesh;
    mesh.vertex_count = static_cast<std::uint32_t>(kept.size());
    std::vector<std::uint32_t> of_vertex = kept;  // the same as indices into per-vertex attributes
    for (std::uint32_t& i : of_vertex) i = decoded.vertex_of.empty() ? i : decoded.vertex_of[i];
    const bool as_it_is = decoded.vertex_of.empty() && kept.size() == all;
    for (const LrAttribute& attribute : file.attributes) {
        Attribute values = decode_attribute(attribute);
        if (!as_it_is) values = std::move(permute_attributes({&values, 1}, attribute.per_copy ? kept : of_vertex)[0]);
        mesh.attributes.push_back(std::move(values));
    }
    std::vector<bool> used;
    if (surface != nullptr && !decoded.vertex_of.empty()) {
        used.assign(all, false);
        for (const std::uint32_t v : decoded.indices) used[v] = true;
    }
    if (kept.size() < all) {
        std::vector<std::uint32_t> number(all, 0);
        for (std::uint32_t i = 0; i < kept.size(); ++i) number[kept[i]] = i;
        for (std::uint32_t& v : decoded.indices) v = number[v];
    }
    mesh.indices = std::move(decoded.indices);
    if (surface == nullptr) return mesh;
    *surface = {mesh.vertex_count, {}};
    if (decoded.vertex_of.empty()) return mesh;
    std::vector<std::uint32_t> number(decoded.vertices, UINT32_MAX);
    surface->vertex_count = 0;
    for (std::size_t i = 0; i < kept.size(); ++i) {  // copies without triangles are not joined, as in find_surface
        std::uint32_t alone = UINT32_MAX, &joined = used[kept[i]] ? number[of_vertex[i]] : alone;
        if (joined == UINT32_MAX) joined = surface->vertex_count++;
        surface->vertex_of.push_back(joined);
    }
    return mesh;
}

}  // namespace detail

Result<Mesh> decode_lr(const LrFile& file, Surface* surface) {
    LR_ASSIGN(detail::DecodedLr decoded, detail::decode_connectivity(detail::view_of(file), false));
    return detail::decode_mesh(file, decoded, surface);
}

Result<Mesh> decode_lr_original_order(const LrFile& file) {
    LR_ASSIGN(detail::DecodedLr decoded, detail::decode_connectivity(detail::view_of(file), false));
    const std::size_t triangles = decoded.indices.size() / 3;
    const std::size_t vertices = decoded.vertex_of.empty() ? decoded.vertices : decoded.vertex_of.size();
    if (file.vertex_order.size() != vertices || file.corner_order.size() != triangles) {
        return Error{ErrorCode::invalid_argument,
                     "the file does not keep the input's order (encode --keep-order does)"};
    }
    std::vector<std::uint32_t> vertex_order = file.vertex_order;
    decoded.remove_extra(vertex_order);
    Result<Mesh> stream = detail::decode_mesh(file, decoded, nullptr);
    if (!stream) return stream;
    // The inverse of the order: the stream's number of each input vertex.
    std::vector<std::uint32_t> number(vertex_order.size());
    for (std::uint32_t i = 0; i < number.size(); ++i) number[vertex_order[i]] = i;
    Mesh mesh;
    mesh.vertex_count = stream->vertex_count;
    mesh.attributes = permute_attributes(stream->attributes, number);
    std::vector<std::uint32_t> by_input(file.corner_order.size());
    std::iota(by_input.begin(), by_input.end(), 0U);
    std::sort(by_input.begin(), by_input.end(),
              [&](std::uint32_t a, std::uint32_t b) { return file.corner_order[a] < file.corner_order[b]; });
    mesh.indices.resize(stream->indices.size());
    std::uint32_t* out = mesh.indices.data();
    for (const std::uint32_t i : by_input) {
        const std::uint32_t first = file.corner_order[i] % 3;
        for (std::uint32_t k = 0; k < 3; ++k) {
            out[(first + k) % 3] = vertex_order[stream->indices[std::size_t{3} * i + k]];
        }
        out += 3;
    }
    return mesh;
}

}  // namespace lacedring
