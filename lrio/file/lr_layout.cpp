#include "lrio/file/lr_layout.h"

#include <algorithm>
#include <bit>
#include <iterator>
#include <string_view>

namespace lacedring::detail {

static_assert(std::endian::native == std::endian::little, ".lr files are little-endian");

Format format_of(std::uint32_t kind) {
    return static_cast<Format>(std::find(std::begin(kKinds), std::end(kKinds), kind) - std::begin(kKinds));
}

Error malformed_lr(std::string message) {
    return {ErrorCode::malformed, "lr file: " + std::move(message)};
}

std::string not_an_lr_file(std::span<const std::byte> bytes) {
    if (is_lr(bytes)) return {};
    const std::string_view kind = kind_by_signature(bytes);
    return kind.empty() ? "not an .lr file" : fmt::format("not an .lr file: it looks like {}", kind);
}

std::string view_name(const Section& section, std::span<const std::byte>& contents, AttributeView& out) {
    const std::uint64_t name = align8(section.name_length);
    if (name > contents.size()) return "attribute of the wrong size";
    for (std::size_t i = section.name_length; i < name; ++i) {
        if (contents[i] != std::byte{0}) return "attribute name not padded with zeros";
    }
    out.name = {reinterpret_cast<const char*>(contents.data()), section.name_length};
    contents = contents.subspan(name);
    return {};
}

namespace {

/// Reads the part that sections of both kinds of attributes share.
std::string view_layout(const FileHeader& header, const Section& section, std::span<const std::byte>& contents,
                        AttributeView& out) {
    out.v_up = (section.layout & kVUp) != 0;
    out.per_copy = (section.layout & kPerCopy) != 0;
    if (section.layout >> 19 != 0) return "unknown attribute layout";
    if (std::string why = view_name(section, contents, out); !why.empty()) return why;
    if (out.per_copy && header.copies == 0) return "an attribute of copies where there are none";
    return {};
}

}  // namespace

std::string view_attribute(const FileHeader& header, const Section& section, std::span<const std::byte> contents,
                           AttributeView& out) {
    const std::uint32_t type = section.layout & 0xff;
    out.components = static_cast<std::uint8_t>(section.layout >> 8 & 0xff);
    out.normalized = (section.layout & kNormalized) != 0;
    if (type > static_cast<std::uint32_t>(ComponentType::f64) || out.components == 0) {
        return "unknown attribute layout";
    }
    out.type = static_cast<ComponentType>(type);
    if (std::string why = view_layout(header, section, contents, out); !why.empty()) return why;
    if (contents.size() != std::uint64_t{header.values(out.per_copy)} * size_of(out.type) * out.components) {
        return "attribute of the wrong size";
    }
    out.data = contents;
    return {};
}

std::string view_stored_of(const FileHeader& header, const Section& section, std::span<const std::byte> contents,
                           AttributeView& out) {
    if ((section.layout & 0x1ffff) != 0) return "unknown attribute layout";
    if (std::string why = view_layout(header, section, contents, out); !why.empty()) return why;
    if (contents.size() % 4 != 0) return "no whole number of words";
    out.words = {reinterpret_cast<const std::uint32_t*>(contents.data()), contents.size() / 4};
    return {};
}

std::string view_stream_of(const FileHeader& header, const Section& section, std::span<const std::byte> contents,
                           AttributeView& out) {
    if (std::string why = view_stored_of(header, section, contents, out); !why.empty()) return why;
    const Result<VertexView> view = view_vertices(out.words);
    if (!view) return view.error().message;
    if (view->vertices != header.values(out.per_copy)) return "a vertex stream of another number of vertices";
    out.type = view->type;
    out.components = view->components;
    out.normalized = view->normalized;
    return {};
}

}  // namespace lacedring::detail
