// Makes .lr files from encoded meshes, serializes and writes them.

#include <algorithm>

#include "lacedring/file.hpp"
#include "lacedring/streams.hpp"
#include "lrcore/base/try.h"
#include "lrcore/codec/storage/packed_storage.h"
#include "lrcore/codec/storage/seam_storage.h"
#include "lrcore/codec/storage/vertex_storage.h"
#include "lrio/file/lr_layout.h"

namespace lacedring {
namespace {

using namespace detail;  // lr_layout.h's

/// The input corner with which each decoded triangle begins. `triangles` are the input's triangles in decoded order.
std::vector<std::uint32_t> find_corners(const Mesh& mesh, const LrFile& file, std::span<const std::uint32_t> triangles,
                                        std::span<const std::uint32_t> vertex_order) {
    const Result<DecodedLr> decoded = decode_connectivity(view_of(file), false);
    std::vector<std::uint32_t> out;
    if (!decoded) return out;
    out.reserve(decoded->indices.size() / 3);
    for (const std::uint32_t t : triangles) {
        const std::uint32_t* now = decoded->indices.data() + 3 * out.size();
        const std::uint32_t* before = mesh.indices.data() + std::size_t{3} * t;
        std::uint32_t place = 0;  // a triangle's vertices differ, so exactly one place has the same vertex
        while (place < 2 && before[place] != vertex_order[now[0]]) ++place;
        out.push_back(3 * t + place);
    }
    return out;
}

/// Do all copies of each surface vertex have the same value? first[v] is the first copy of surface vertex v.
bool agrees_on_surface(const Attribute& attribute, const Surface& surface, std::span<const std::uint32_t> first) {
    const std::size_t stride = attribute.stride();
    for (std::size_t v = 0; v < surface.vertex_of.size(); ++v) {
        const std::byte* other = attribute.data.data() + first[surface.vertex_of[v]] * stride;
        if (std::memcmp(attribute.data.data() + v * stride, other, stride) != 0) return false;
    }
    return true;
}

/// Makes the file of a mesh; if it has no seams, `surface` is the identity and `seams` is empty.
LrFile make_file(const Mesh& mesh, const Surface& surface, Encoded encoded, EncodedSeams seams, bool keep_order) {
    LrFile file;
    file.vertex_count = static_cast<std::uint32_t>(encoded.vertex_order.size());
    file.copy_count = static_cast<std::uint32_t>(seams.copy_order.size());
    file.input_triangles = static_cast<std::uint32_t>(mesh.triangle_count());
    file.format = encoded.format;
    file.words = std::move(encoded.words);
    file.seams = std::move(seams.words);
    const std::vector<std::uint32_t> first = first_vertices(surface);
    std::vector<std::uint32_t> vertices = std::move(encoded.vertex_order);
    for (std::uint32_t& v : vertices) v = first[v];
    for (const Attribute& attribute : mesh.attributes) {
        const bool per_copy = attribute.name != "POSITION" && !agrees_on_surface(attribute, surface, first);
        std::vector<Attribute> values = permute_attributes({&attribute, 1}, per_copy ? seams.copy_order : vertices);
        file.attributes.push_back({std::move(values[0]), {}, per_copy});
    }
    if (keep_order) {
        file.vertex_order = std::move(surface.has_seams() ? seams.copy_order : vertices);
        file.corner_order = find_corners(mesh, file, encoded.triangle_order, file.vertex_order);
    }
    return file;
}

}  // namespace

Result<LrFile> make_lr_file(const Mesh& mesh, const Surface& surface, Encoded encoded, bool keep_order) {
    if (!surface.has_seams()) return make_lr_file(mesh, std::move(encoded), keep_order);
    LR_ASSIGN(EncodedSeams seams, encode_seams(encoded, mesh.indices, surface.vertex_of));
    return make_file(mesh, surface, std::move(encoded), std::move(seams), keep_order);
}

LrFile make_lr_file(const Mesh& mesh, Encoded encoded, bool keep_order) {
    return make_file(mesh, {mesh.vertex_count, {}}, std::move(encoded), {}, keep_order);
}

namespace {

/// The storage form of each stream of a file; empty: the stream has none that is smaller.
struct StoredStreams {
    std::vector<std::uint32_t> connectivity, seams;
    std::vector<std::vector<std::uint32_t>> attributes;  ///< one for each attribute; or none if all are resident
};

StoredStreams store_streams(const LrFile& file) {
    StoredStreams out;
    const auto take = [](std::optional<std::vector<std::uint32_t>> made, std::size_t before) {
        return made && made->size() < before ? std::move(*made) : std::vector<std::uint32_t>();
    };
    if (file.format == Format::packed) {
        if (const Result<PackedView> view = view_packed(file.words)) {
            out.connectivity = take(storage::store_packed(*view), file.words.size());
        }
    }
    const Result<DecodedLr> decoded = decode_connectivity(view_of(file), false);
    if (!decoded) return out;
    if (const Result<StreamView> stream = view_stream(file.words); stream && !file.seams.empty()) {
        const Result<SeamView> seams = view_seams(file.seams, stream->slots(), stream->vertices());
        if (seams) out.seams = take(storage::store_seams(*seams, slot_triangles(*stream)), file.seams.size());
    }
    std::vector<std::uint32_t> of_vertices;
    const std::vector<std::uint32_t> positions = position_integers(file);
    for (const LrAttribute& attribute : file.attributes) {
        std::vector<std::uint32_t>& stored = out.attributes.emplace_back();
        if (attribute.words.empty()) continue;
        const Result<VertexView> view = view_vertices(attribute.words);
        if (!view) continue;
        const auto triangles = triangles_of(*decoded, attribute.per_copy, of_vertices);
        const storage::VertexPlaces places = places_of(positions, *decoded, attribute.per_copy);
        stored = take(storage::store_vertices(*view, triangles, places), attribute.words.size());
    }
    return out;
}

}  // namespace

std::vector<std::byte> serialize_lr(const LrFile& file, LrForm form) {
    StoredStreams stored;
    if (form == LrForm::stored) stored = store_streams(file);
    std::vector<Section> sections;
    std::vector<std::vector<std::byte>> names;  // a padded name for each section; empty if it is not an attribute
    std::vector<std::span<const std::byte>> contents;
    const auto add = [&](Kind kind, std::span<const std::byte> data) {
        sections.push_back({kind, kResident, 0, 0, 0, 0, 0});
        names.emplace_back();
        contents.push_back(data);
    };
    const auto set_stored = [&](std::span<const std::uint32_t> words) {
        if (words.empty()) return;
        sections.back().coding = kStored;
        contents.back() = std::as_bytes(words);
    };
    add(kind_of(file.format), std::as_bytes(std::span(file.words)));
    set_stored(stored.connectivity);
    if (!file.seams.empty()) {
        add(kSeams, std::as_bytes(std::span(file.seams)));
        set_stored(stored.seams);
    }
    for (const LrAttribute& attribute : file.attributes) {
        const bool stream = !attribute.words.empty();
        add(stream ? kVertices : kAttribute, stream ? std::as_bytes(std::span(attribute.words)) : attribute.data);
        if (!stored.attributes.empty())
            set_stored(stored.attributes[static_cast<std::size_t>(&attribute - file.attributes.data())]);
        sections.back().layout = (attribute.v_up ? kVUp : 0U) | (attribute.per_copy ? kPerCopy : 0U);
        if (!stream) {
            sections.back().layout |= static_cast<std::uint32_t>(attribute.type) |
                                      std::uint32_t{attribute.components} << 8 |
                                      (attribute.normalized ? kNormalized : 0U);
        }
        sections.back().name_length = static_cast<std::uint32_t>(attribute.name.size());
        names.back().resize(align8(attribute.name.size()));
        std::memcpy(names.back().data(), attribute.name.data(), attribute.name.size());
    }
    if (!file.vertex_order.empty()) add(kVertexOrder, std::as_bytes(std::span(file.vertex_order)));
    if (!file.corner_order.empty()) add(kCornerOrder, std::as_bytes(std::span(file.corner_order)));

    std::size_t end = sizeof(FileHeader) + sections.size() * sizeof(Section);
    for (std::size_t i = 0; i < sections.size(); ++i) {
        sections[i].offset = align8(end);
        sections[i].size = names[i].size() + contents[i].size();
        sections[i].crc = crc32(contents[i], crc32(names[i]));
        end = sections[i].offset + sections[i].size;
    }
    // parse_lr must be able to read the file within its default memory limit.
    const std::uint64_t memory = std::max(memory_to_restore(file.input_triangles, file.vertex_count),
                                          memory_to_restore(std::max(file.vertex_count, file.copy_count)));
    if (form == LrForm::stored && memory > default_memory(end)) return serialize_lr(file, LrForm::resident);
    FileHeader header{
        magic::kLrFile,       kLrVersion,      static_cast<std::uint32_t>(sections.size()), file.vertex_count,
        file.input_triangles, file.copy_count, crc32(std::as_bytes(std::span(sections))),   0};
    header.header_crc = crc32(std::as_bytes(std::span(&header, 1)).first(28));
    std::vector<std::byte> out(end);
    const auto put = [&](std::size_t offset, std::span<const std::byte> data) {
        if (!data.empty()) std::memcpy(out.data() + offset, data.data(), data.size());
    };
    put(0, std::as_bytes(std::span(&header, 1)));
    put(sizeof header, std::as_bytes(std::span(sections)));
    for (std::size_t i = 0; i < sections.size(); ++i) {
        put(sections[i].offset, names[i]);
        put(sections[i].offset + names[i].size(), contents[i]);
    }
    return out;
}

Result<void> write_lr(const LrFile& file, const std::filesystem::path& path, LrForm form) {
    const std::vector<std::byte> bytes = serialize_lr(file, form);
    const std::span<const std::byte> parts[] = {bytes};
    return write_file(path, parts);
}

}  // namespace lacedring
