#pragma once
// The layout of .lr files (docs/lr-file.md): header, section table, contents; and helpers of readers and writers.
// Internal to lrio/file.

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
    kResident = 0,  // LrForm::resident
    kStored = 1,    // LrForm::stored, of packed streams, vertex streams and seams (docs/storage-format.md)
};

struct FileHeader {
    std::uint32_t magic, version, sections, vertices, input_triangles, copies;
    std::uint32_t table_crc;   // CRC-32 of the section table
    std::uint32_t header_crc;  // CRC-32 of the seven words before

    /// Number of values of an attribute.
    std::uint32_t values(bool per_copy) const { return per_copy ? copies : vertices; }
};
static_assert(sizeof(FileHeader) == 32);

// Bits of Section::layout, for attributes. In sections of vertex streams, type, components and kNormalized are 0: the
// streams' headers have them.
constexpr std::uint32_t kNormalized = 1U << 16, kVUp = 1U << 17, kPerCopy = 1U << 18;

struct Section {
    std::uint16_t kind;
    std::uint16_t coding;  // Coding of the contents
    std::uint32_t crc;     // CRC-32 of the contents
    std::uint64_t offset, size;
    std::uint32_t layout;       // type | components << 8 | the bits above
    std::uint32_t name_length;  // attributes: the contents begin with the name, padded with zeros to 8 bytes
};
static_assert(sizeof(Section) == 32);

constexpr std::size_t align8(std::size_t size) {
    return (size + 7) / 8 * 8;
}

/// Default limit of the memory in bytes to restore streams from storage form.
constexpr std::uint64_t default_memory(std::uint64_t file_bytes) {
    return std::max<std::uint64_t>(512 << 20, 128 * file_bytes);
}
/// Bytes of memory to restore a packed stream.
constexpr std::uint64_t memory_to_restore(std::uint32_t triangles, std::uint32_t vertices) {
    return std::uint64_t{60} * triangles + std::uint64_t{8} * vertices;
}
/// Bytes of memory to restore an attribute of `values` values.
constexpr std::uint64_t memory_to_restore(std::uint32_t values) {
    return std::uint64_t{128} * values;
}

/// The section kind of each Format's words.
constexpr Kind kKinds[] = {kLean, kPacked, kLr, kLrCompact};

inline Kind kind_of(Format format) {
    return kKinds[static_cast<std::size_t>(format)];
}
/// The format of a section kind, which is one of kKinds.
Format format_of(std::uint32_t kind);

Error malformed_lr(std::string message);

/// Empty if the bytes begin like an .lr file, else an error message that names their file format if it is known.
std::string not_an_lr_file(std::span<const std::byte> bytes);

/// Removes the name from the front of `contents` and sets out.name. Returns an error message, or empty.
std::string view_name(const Section& section, std::span<const std::byte>& contents, AttributeView& out);

/// Fills `out` from a section of plain attribute values. Returns an error message, or empty.
std::string view_attribute(const FileHeader& header, const Section& section, std::span<const std::byte> contents,
                           AttributeView& out);

/// Fills `out` from a section with a vertex stream in storage form. Does not read the words, so the type, components
/// and normalized of `out` are not set. Returns an error message, or empty. `contents` may have any alignment.
std::string view_stored_of(const FileHeader& header, const Section& section, std::span<const std::byte> contents,
                           AttributeView& out);

/// Fills `out` from a section with a vertex stream; checks only its header. Returns an error message, or empty.
std::string view_stream_of(const FileHeader& header, const Section& section, std::span<const std::byte> contents,
                           AttributeView& out);

/// Checks the header and the section table, and calls visit(header, section, contents) for each section. `visit`
/// returns an error message, or empty; it has to check the contents' checksum itself.
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
    if (end != bytes.size()) return malformed_lr("bytes after the last section");
    return header;
}

/// The decoded connectivity and seams of a file.
struct DecodedLr {
    std::uint32_t vertices = 0;
    /// Triangles, without empty slots: indices of copies if the file has seams, else of vertices.
    std::vector<std::uint32_t> indices;
    std::vector<std::uint32_t> vertex_of;  ///< the vertex of each copy; empty: no seams
    /// Marks the extra vertices of LR tables (with seams: the copies of extra vertices). Empty if there are none.
    std::vector<bool> extra;

    bool is_extra(std::size_t i) const { return i < extra.size() && extra[i]; }
    /// Removes the elements of extra vertices or copies from `values`.
    void remove_extra(std::vector<std::uint32_t>& values) const;
};

/// A view of `file`; copies nothing.
LrFileView view_of(const LrFile& file);

/// view_lr_file that also checks the sections' checksums.
Result<LrFileView> view_checked_lr(std::span<const std::byte> bytes);

/// Checks that the first attribute is POSITION, with 3 floats or doubles a vertex. Errors: malformed.
Result<void> check_position(const LrFileView& file);

/// Checks that all coordinates are finite as floats, since meshes are drawn and exported as floats. Errors: malformed.
Result<void> check_finite(ComponentType type, std::span<const std::byte> coordinates);

/// Seams in storage form.
struct StoredSeams {
    std::vector<std::uint32_t>& words;  ///< in storage form; replaced by the resident section's words
    std::uint64_t max_bytes;            ///< memory limit for restoring them
};

/// Decodes the connectivity and the seams. Restores and decodes `stored` if it is not null, else decodes file.seams.
/// `untrusted`: checks everything. If it is false, the file is valid. Errors: malformed, memory_limit (stored seams).
Result<DecodedLr> decode_connectivity(const LrFileView& file, bool untrusted, const StoredSeams* stored = nullptr);

/// Mesh and surface in stream order, as by decode_lr; moves from `decoded`.
Result<Mesh> decode_mesh(const LrFile& file, DecodedLr& decoded, Surface* surface);

/// parse_lr that also returns the connectivity that it decoded for its checks.
Result<LrFile> parse_lr(std::span<const std::byte> bytes, std::uint64_t max_bytes, DecodedLr& decoded,
                        unsigned threads);

/// The triangles that index an attribute's values: of copies if it is per copy or there are no seams, else of vertices.
/// The latter are computed into `of_vertices` unless it has them already.
std::span<const std::uint32_t> triangles_of(const DecodedLr& decoded, bool per_copy,
                                            std::vector<std::uint32_t>& of_vertices);

/// The integers of the positions' vertex stream, 3 a vertex, if its mapping has one scale for all (lattice or
/// decimals); else empty. The stream is valid.
std::vector<std::uint32_t> position_integers(const LrFile& file);

/// The positions from which an attribute's values are predicted; `positions` is position_integers' result.
storage::VertexPlaces places_of(std::span<const std::uint32_t> positions, const DecodedLr& decoded, bool per_copy);

/// The attribute as plain values; decodes a stream, which must be valid.
Attribute decode_attribute(const LrAttribute& attribute);

}  // namespace lacedring::detail
