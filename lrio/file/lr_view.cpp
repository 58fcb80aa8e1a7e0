// Views .lr files in place, typically in a mapped file, and lists their sections.

#include <algorithm>
#include <cmath>

#include "lrcore/base/try.h"
#include "lrcore/codec/storage/vertex_storage.h"
#include "lrio/file/lr_layout.h"

namespace lacedring {
namespace {

using namespace detail;  // lr_layout.h's

constexpr const char* kMappingNames[] = {"integers", "lattice", "octahedral", "floats", "decimals", "doubles"};

/// Fills `listed` from a vertex stream's header; `contents` may have any alignment. Returns an error message, or empty.
std::string list_stream(const Section& section, std::span<const std::byte> contents, LrSection& listed) {
    std::vector<std::uint32_t> words((contents.size() + 3) / 4);
    if (!words.empty()) std::memcpy(words.data(), contents.data(), contents.size());
    AttributeView view;
    if (std::string why = view_name(section, contents, view); !why.empty()) return why;
    listed.name = view.name;
    const std::span<const std::uint32_t> behind = std::span(words).subspan(align8(section.name_length) / 4);
    const Result<VertexView> stream =
        section.coding == kStored ? storage::view_stored_vertices(behind) : view_vertices(behind);
    if (!stream) return stream.error().message;
    listed.type = stream->type;
    listed.components = stream->components;
    listed.mapping = kMappingNames[static_cast<std::size_t>(stream->mapping)];
    listed.largest_error = stream->largest_error;
    return {};
}

}  // namespace

bool is_lr(std::span<const std::byte> bytes) {
    std::uint32_t number = 0;
    if (bytes.size() < sizeof number) return false;
    std::memcpy(&number, bytes.data(), sizeof number);
    return number == magic::kLrFile;
}

Result<LrContents> list_lr(std::span<const std::byte> bytes) {
    LrContents out;
    const Result<FileHeader> header = visit_sections(
        bytes, [&](const FileHeader&, const Section& section, std::span<const std::byte> contents) -> std::string {
            if (section.kind == 0 || section.kind >= std::size(kKindNames))
                return fmt::format("unknown kind {}", section.kind);
            LrSection& listed = out.sections.emplace_back();
            listed.kind = kKindNames[section.kind];
            listed.bytes = section.size;
            listed.per_copy = (section.layout & kPerCopy) != 0;
            listed.stored = section.coding == kStored;
            if (section.kind == kVertices) return list_stream(section, contents, listed);
            if (section.kind != kAttribute) return {};
            if (section.name_length > contents.size()) return "attribute of the wrong size";
            listed.name.assign(reinterpret_cast<const char*>(contents.data()), section.name_length);
            listed.type = static_cast<ComponentType>(std::min(section.layout & 0xffU, 7U));
            listed.components = static_cast<std::uint8_t>(section.layout >> 8 & 0xff);
            return {};
        });
    if (!header) return header.error();
    out.version = header->version;
    out.vertices = header->vertices;
    out.copies = header->copies;
    out.input_triangles = header->input_triangles;
    out.bytes = bytes.size();
    return out;
}

Result<StreamView> LrFileView::validate() const {
    Result<StreamView> view = lacedring::validate(words);
    if (!view) return view;
    if (view->format() != format) return malformed_lr("the stream is of another format than its section");
    if (view->vertices() != vertex_count) return malformed_lr("connectivity and file have different vertex counts");
    if (seams.empty()) return view;
    LR_ASSIGN(const SeamView valid, validate_seams(seams, slot_triangles(*view), vertex_count));
    if (valid.copies != copy_count) return malformed_lr("seams and file have different numbers of copies");
    return view;
}

Positions LrFileView::positions() const {
    const auto position = std::ranges::find(attributes, "POSITION", &AttributeView::name);
    if (position == attributes.end() || position->components != 3 || position->per_copy) return {};
    if (position->type != ComponentType::f32 && position->type != ComponentType::f64) return {};
    return {position->data, position->type == ComponentType::f64};
}

namespace {

Result<LrFileView> view_sections(std::span<const std::byte> bytes, bool checksums) {
    LrFileView out;
    bool stored = false;
    if (reinterpret_cast<std::uintptr_t>(bytes.data()) % 8 != 0) {  // words are read in place
        if (std::string why = not_an_lr_file(bytes); !why.empty()) return Error{ErrorCode::malformed, std::move(why)};
        return Error{ErrorCode::invalid_argument, "the file does not begin at a multiple of eight bytes"};
    }
    const auto view_words = [](std::span<const std::byte> contents, std::span<const std::uint32_t>& words) {
        if (!words.empty()) return contents.empty() ? "" : "occurs twice";
        if (contents.size() % 4 != 0) return "no whole number of words";
        words = {reinterpret_cast<const std::uint32_t*>(contents.data()), contents.size() / 4};
        return "";
    };
    const Result<FileHeader> header = visit_sections(
        bytes, [&](const FileHeader& h, const Section& section, std::span<const std::byte> contents) -> std::string {
            if (checksums && section.crc != crc32(contents)) return "is damaged";
            if (section.coding == kStored) {
                stored = true;
                return {};
            }
            switch (section.kind) {
                case kLean:
                case kLr:
                case kLrCompact:
                case kPacked:
                    if (out.words.data() != nullptr) return "occurs twice";
                    out.format = format_of(section.kind);
                    return view_words(contents, out.words);
                case kVertexOrder:
                    return view_words(contents, out.vertex_order);
                case kCornerOrder:
                    return view_words(contents, out.corner_order);
                case kSeams:
                    return view_words(contents, out.seams);
                case kAttribute:
                    return view_attribute(h, section, contents, out.attributes.emplace_back());
                case kVertices:
                    return view_stream_of(h, section, contents, out.attributes.emplace_back());
                default:
                    return fmt::format("unknown kind {}", section.kind);
            }
        });
    if (!header) return header.error();
    if (stored) return Error{ErrorCode::unsupported, "lr file: in storage form, which is not read in place"};
    if (out.words.data() == nullptr) return malformed_lr("no connectivity");
    if (out.seams.empty() != (header->copies == 0))
        return malformed_lr("seams without copies, or copies without seams");
    out.vertex_count = header->vertices;
    out.copy_count = header->copies;
    out.input_triangles = header->input_triangles;
    if (!out.vertex_order.empty() && out.vertex_order.size() != std::max(out.vertex_count, out.copy_count)) {
        return malformed_lr("the vertex order has another size");
    }
    return out;
}

}  // namespace

Result<LrFileView> view_lr_file(std::span<const std::byte> bytes) {
    return view_sections(bytes, false);
}

namespace detail {

Result<LrFileView> view_checked_lr(std::span<const std::byte> bytes) {
    return view_sections(bytes, true);
}

LrFileView view_of(const LrFile& file) {
    LrFileView out{file.vertex_count, file.copy_count,  file.input_triangles, file.format, file.words, file.seams, {},
                   file.vertex_order, file.corner_order};
    for (const LrAttribute& a : file.attributes) {
        out.attributes.push_back({a.name, a.type, a.components, a.normalized, a.v_up, a.per_copy,
                                  std::as_bytes(std::span(a.data)), a.words});
    }
    return out;
}

Result<void> check_position(const LrFileView& file) {
    const bool is_position =
        !file.attributes.empty() && file.attributes[0].name == "POSITION" && file.attributes[0].components == 3 &&
        !file.attributes[0].per_copy &&
        (file.attributes[0].type == ComponentType::f32 || file.attributes[0].type == ComponentType::f64);
    return is_position ? Result<void>() : malformed_lr("the first attribute is not POSITION");
}

Result<void> check_finite(ComponentType type, std::span<const std::byte> coordinates) {
    const std::size_t size = size_of(type);
    bool finite = true;
    for (std::size_t i = 0; i < coordinates.size(); i += size) {
        float single = 0;
        if (type == ComponentType::f64) {
            double value = 0;
            std::memcpy(&value, coordinates.data() + i, sizeof value);
            single = static_cast<float>(value);
        } else {
            std::memcpy(&single, coordinates.data() + i, sizeof single);
        }
        finite &= std::isfinite(single);
    }
    return finite ? Result<void>() : malformed_lr("a position is not finite as a float");
}

}  // namespace detail
}  // namespace lacedring
