#pragma once
// The layout of .lr files: header, section table, and where contents lie. Internal to lrio/file; docs/lr-file.md has
// it.

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <utility>

#include "lacedring/lr_file.hpp"
#include "lrcore/base/crc32.h"
#include "lrcore/base/signature.h"
#include "lrcore/codec/storage/vertex_places.h"

namespace lacedring::detail {

constexpr std::uint32_t kLrVersion = 4;

enum Kind : std::uint16_t {
    kLean = 1,
    kAttribute = 2,
    kVertexOrder = 3,
    kCornerOrder = 4,
    kLr = 5,
    kLrCompact = 6,
    kPacked = 7,
    kVertices = 8,
    kSeams = 9
};
constexpr const char* kKindNames[] = {"",   "lean",       "attribute", "vertex_order", "corner_order",
                                      "lr", "lr_compact", "packed",    "vertices",     "seams"};

/// How a section's contents are coded.
enum Coding : std::uint16_t {
    kResident = 0,  // as they lie in memory
    kStored = 1,    // in storage form: packed streams, vertex streams and seams (docs/storage-format.md)
};

struct FileHeader {
    std::uint32_t magic, version, sections, vertices, input_triangles, copies;
    std::uint32_t table_crc;   // of the section table
    std::uint32_t header_crc;  // of the seven words before

    /// Values of an attribute.
    std::uint32_t values(bool per_copy) const { return per_copy ? copies : vertices; }
};
static_assert(sizeof(FileHeader) == 32);

// Bits of Section::layout: of attributes, but for what a stream says itself.
constexpr std::uint32_t kNormalized = 1U << 16, kVUp = 1U << 17, kPerCopy = 1U << 18;

struct Section {
    std::uint16_t kind;
    std::uint16_t coding;  // of the contents
    std::uint32_t crc;     // of the contents
    std::uint64_t offset, size;
    std::uint32_t layout;       // type | components << 8 | the bits above
    std::uint32_t name_length;  // attributes: the contents begin with the name, padded with zeros to 8 bytes
};
static_assert(sizeof(Section) == 32);

constexpr std::size_t align8(std::size_t size) {
    return (size + 7) / 8 * 8;
}

/// Bytes that packed streams and attributes in storage form may take while they are restored, unless parse_lr is told.
constexpr std::uint64_t default_memory(std::uint64_t file_bytes) {
    return std::max<std::uint64_t>(512 << 20, 128 * file_bytes);
}
/// Bytes that a packed stream takes while it is restored.
constexpr std::uint64_t memory_to_restore(std::uint32_t triangles, std::uint32_t vertices) {
    return std::uint64_t{60} * triangles + std::uint64_t{8} * vertices;
}
/// The same of an attribute of so many values.
constexpr std::uint64_t memory_to_restore(std::uint32_t values) {
    return std::uint64_t{128} * values;
}

/// The section kind of a format's words.
constexpr Kind kKinds[] = {kLean, kPacked, kLr, kLrCompact};

inline Kind kind_of(Format format) {
    return kKinds[static_cast<std::size_t>(format)];
}
/// The format of a section kind, one of kKinds.
Format format_of(std::uint32_t kind);

Error malformed_lr(std::string message);

/// Empty if the bytes begin as an .lr file, else an error message that names their kind if it is known.
std::string not_an_lr_file(std::span<const std::byte> bytes);

/// Takes the name off the contents' begin; empty if that is sound.
std::string view_name(const Section& section, std::span<const std::byte>& contents, AttributeView& out);

/// Fills `out`; empty if the section is an attribute of the file's vertices or copies, else what is wrong.
std::string view_attribute(const FileHeader& header, const Section& section, std::span<const std::byte> contents,
                           AttributeView& out);

/// The same of an attribute that is a vertex stream in storage form: `words`, which say what its values are, are not
/// looked at. `contents` may lie anywhere.
std::string view_stored_of(const FileHeader& header, const Section& section, std::span<const std::byte> contents,
                           AttributeView& out);

/// The same of an attribute that is a vertex stream. Reads no more of it than its header; `contents` may lie anywhere.
std::string view_stream_of(const FileHeader& header, const Section& section, std::span<const std::byte> contents,
                           AttributeView& out);

/// Checks header and section table and calls visit(header, section, contents) for each section; what visit returns, if
/// not empty, is an error. The contents' checksums are visit's to look at.
template <class Visit>
Result<FileHeader> visit_sections(std::span<const std::byte> bytes, Visit visit) {
    FileHeader header;
    if (std::string why = not_an_lr_file(bytes); !why.empty()) return Error{ErrorCode::malformed, std::move(why)};
    if (bytes.size() < sizeof header) return malformed_lr("shorter than its header");
    std::memcpy(&header, bytes.data(), sizeof header);
    if (header.version != kLrVersion) {
        return malformed_lr(fmt::format("version {} is not {}", header.version, kLrVersion));
    }
    if (header.header_crc != crc32(bytes.first(28)) || (header.copies != 0 && header.copies < header.vertices)) {
        return malformed_lr("damaged header");
    }
    const std::uint64_t table = std::uint64_t{header.sections} * sizeof(Section);
    if (table > bytes.size() - sizeof header) return malformed_lr("shorter than its section table");
    const auto table_bytes = bytes.subspan(sizeof header, table);
    if (header.table_crc != crc32(table_bytes)) return malformed_lr("damaged section table");
    std::size_t end = sizeof header + table;
    for (std::uint32_t i = 0; i < header.sections; ++i) {
        Section section;
        std::memcpy(&section, table_bytes.data() + std::size_t{i} * sizeof section, sizeof section);
        if (section.offset != align8(end) || section.offset > bytes.size() ||
            section.size > bytes.size() - section.offset) {
            return malformed_lr(fmt::format("section {} lies outside the file", i));
        }
        for (; end < section.offset; ++end) {
            if (bytes[end] != std::byte{0}) return malformed_lr(fmt::format("padding before section {}", i));
        }
        end = section.offset + section.size;
        const bool named = section.kind == kAttribute || section.kind == kVertices;
        if (!named && (section.layout != 0 || section.name_length != 0)) {
            return malformed_lr(fmt::format("section {}: it has no layout and no name", i));
        }
        const bool has_stored = section.kind == kPacked || section.kind == kVertices || section.kind == kSeams;
        if (section.coding > kStored || (section.coding == kStored && !has_stored)) {
            return malformed_lr(fmt::format("section {}: unknown coding {}", i, section.coding));
        }
        if (std::string why = visit(header, section, bytes.subspan(section.offset, section.size)); !why.empty()) {
            return malformed_lr(fmt::format("section {}: {}", i, why));
        }
    }
    if (end != bytes.size()) return malformed_lr("bytes behind the last section");
    return header;
}

/// The triangles that a file's connectivity holds, empty slots left out, and what its numbers stand for.
struct DecodedLr {
    std::uint32_t vertices = 0;
    std::vector<std::uint32_t> indices;  ///< of copies where the file has seams
    /// The vertex of each copy, where the file has seams.
    std::vector<std::uint32_t> vertex_of;
    /// Vertices that LR tables have more than the mesh (copies where the file has seams). Empty if there is none.
    std::vector<bool> extra;

    bool is_extra(std::size_t i) const { return i < extra.size() && extra[i]; }
    /// Leaves out of `values`, one for each vertex or copy, those of extra ones.
    void remove_extra(std::vector<std::uint32_t>& values) const;
};

/// A file in memory as one that lies somewhere; holds no copy.
LrFileView view_of(const LrFile& file);

/// view_lr_file, and the sections' checksums.
Result<LrFileView> view_checked_lr(std::span<const std::byte> bytes);

/// Is the first attribute POSITION, of one float or double for each coordinate of each vertex? Errors: malformed.
Result<void> check_position(const LrFileView& file);

/// Errors: malformed (a coordinate that is not finite as a float: what draws or exports a mesh has no other).
Result<void> check_finite(ComponentType type, std::span<const std::byte> coordinates);

/// A file's seams that are in storage form: their words, which become the resident section's, and the bytes of memory
/// that this may take.
struct StoredSeams {
    std::vector<std::uint32_t>& words;
    std::uint64_t max_bytes;
};

/// Decodes the connectivity and the seams: `stored`, if that is not null, which it restores, else the file's. Errors:
/// malformed; of files that are valid none, if `untrusted` is false; memory_limit of stored seams.
Result<DecodedLr> decode_connectivity(const LrFileView& file, bool untrusted, const StoredSeams* stored = nullptr);

/// Mesh and surface in stream order, as decode_lr's; takes what is decoded.
Result<Mesh> decode_mesh(const LrFile& file, DecodedLr& decoded, Surface* surface);

/// parse_lr, and the connectivity that it decoded to check it.
Result<LrFile> parse_lr(std::span<const std::byte> bytes, std::uint64_t max_bytes, DecodedLr& decoded,
                        unsigned threads);

/// Three vertices of each triangle that an attribute's stream goes with: copies, if it has a value for each, or if
/// there are no seams, else vertices, which go into `of_vertices` unless they are there.
std::span<const std::uint32_t> triangles_of(const DecodedLr& decoded, bool per_copy,
                                            std::vector<std::uint32_t>& of_vertices);

/// The integers of the positions' stream, three a vertex, if it has such of a common scale: a lattice's, or decimals;
/// else none. The stream is valid.
std::vector<std::uint32_t> position_integers(const LrFile& file);

/// Where the values of an attribute are, by position_integers.
storage::VertexPlaces places_of(std::span<const std::uint32_t> positions, const DecodedLr& decoded, bool per_copy);

/// The attribute with its values. Of a stream, which is valid, they are decoded.
Attribute decode_attribute(const LrAttribute& attribute);

}  // namespace lacedring::detail
