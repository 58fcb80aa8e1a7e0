#include "lacedring/lr_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <numeric>

#include "lacedring/file.hpp"
#include "lrcore/base/bits.h"
#include "lrcore/base/crc32.h"
#include "lrcore/base/signature.h"

namespace lacedring {
namespace {

static_assert(std::endian::native == std::endian::little, ".lr files are little-endian");

constexpr std::uint32_t kMagic = 0x4c46524c;  // "LRFL"
constexpr std::uint32_t kVersion = 3;

enum Kind : std::uint16_t {
    kLean = 1,
    kAttribute = 2,
    kVertexOrder = 3,
    kCornerOrder = 4,
    kLr = 5,
    kLrCompact = 6,
    kPacked = 7,
    kVertices = 8
};
constexpr const char* kKindNames[] = {"",   "lean",       "attribute", "vertex_order", "corner_order",
                                      "lr", "lr_compact", "packed",    "vertices"};
constexpr const char* kMappingNames[] = {"integers", "lattice", "octahedral", "floats", "decimals", "doubles"};

struct FileHeader {
    std::uint32_t magic, version, sections, vertices, input_triangles, reserved;
    std::uint32_t table_crc;   // of the section table
    std::uint32_t header_crc;  // of the seven words before
};
static_assert(sizeof(FileHeader) == 32);
static_assert(kMagic == magic::kLrFile);

struct Section {
    std::uint16_t kind;
    std::uint16_t coding;  // of the contents; 0: as they lie in memory
    std::uint32_t crc;     // of the contents
    std::uint64_t offset, size;
    std::uint32_t layout;  // attributes, but for what a stream says itself: type | components << 8 | normalized << 16 |
                           // v_up << 17
    std::uint32_t name_length;  // attributes: the contents begin with the name, padded with zeros to 8 bytes
};
static_assert(sizeof(Section) == 32);

constexpr std::size_t align8(std::size_t size) {
    return (size + 7) / 8 * 8;
}

template <class T>
std::span<const std::byte> bytes_of(const T& value) {
    return std::as_bytes(std::span(&value, 1));
}

/// The section kind of a format's words.
constexpr Kind kKinds[] = {kLean, kPacked, kLr, kLrCompact};

Kind kind_of(Format format) {
    return kKinds[static_cast<std::size_t>(format)];
}
Format format_of(std::uint32_t kind) {
    return static_cast<Format>(std::find(std::begin(kKinds), std::end(kKinds), kind) - std::begin(kKinds));
}

Error malformed(std::string message) {
    return {ErrorCode::malformed, "lr file: " + std::move(message)};
}

/// The triangles that a file's connectivity holds, degenerate slots left out, and which of its vertices are copies.
struct Decoded {
    std::uint32_t vertices = 0;
    std::vector<std::uint32_t> indices;
    std::vector<bool> copy;  // empty if there is none; vertices beyond its end are no copies
};

Result<Decoded> decode(const LrFile& file, bool untrusted) {
    const Result<StreamView> view = untrusted ? validate(file.words) : view_stream(file.words);
    if (!view) return view.error();
    if (view->format() != file.format) return malformed("the stream is of another format than its section");
    Decoded out;
    out.vertices = view->vertices();
    out.indices = lacedring::decode(*view);
    const auto mark_copies = [&](const auto* stream) {
        if (stream == nullptr || stream->copies.empty()) return;
        out.copy.assign(stream->view.used_vertices(), false);
        for (std::size_t i = 0; i < stream->copies.size(); i += 2) out.copy[stream->copies[i]] = true;
    };
    mark_copies(view->get<LrStreamView<LrView>>());
    mark_copies(view->get<LrStreamView<CompactLrView>>());
    return out;
}

/// Leaves out of `values`, one for each vertex, those of copies.
void remove_copies(const Decoded& decoded, std::vector<std::uint32_t>& values) {
    if (decoded.copy.empty()) return;
    std::size_t kept = 0;
    for (std::size_t v = 0; v < values.size(); ++v) {
        if (v >= decoded.copy.size() || !decoded.copy[v]) values[kept++] = values[v];
    }
    values.resize(kept);
}

/// Empty if the bytes begin as an .lr file, else an error message that names their kind if it is known.
std::string not_an_lr_file(std::span<const std::byte> bytes) {
    std::uint32_t magic_number = 0;
    if (bytes.size() >= sizeof magic_number) std::memcpy(&magic_number, bytes.data(), sizeof magic_number);
    if (magic_number == kMagic) return {};
    const std::string_view kind = kind_by_signature(bytes);
    return kind.empty() ? "not an .lr file" : fmt::format("not an .lr file: it looks like {}", kind);
}

/// Checks header and section table and calls visit(section, contents) for each section; what visit returns, if not
/// empty, is an error. The contents' checksums are visit's to look at.
template <class Visit>
Result<FileHeader> visit_sections(std::span<const std::byte> bytes, Visit visit) {
    FileHeader header;
    if (std::string why = not_an_lr_file(bytes); !why.empty()) return Error{ErrorCode::malformed, std::move(why)};
    if (bytes.size() < sizeof header) return malformed("shorter than its header");
    std::memcpy(&header, bytes.data(), sizeof header);
    if (header.version != kVersion) return malformed(fmt::format("version {} is not {}", header.version, kVersion));
    if (header.header_crc != crc32(bytes.first(28)) || header.reserved != 0) return malformed("damaged header");
    const std::uint64_t table = std::uint64_t{header.sections} * sizeof(Section);
    if (table > bytes.size() - sizeof header) return malformed("shorter than its section table");
    const auto table_bytes = bytes.subspan(sizeof header, table);
    if (header.table_crc != crc32(table_bytes)) return malformed("damaged section table");
    std::size_t end = sizeof header + table;
    for (std::uint32_t i = 0; i < header.sections; ++i) {
        Section section;
        std::memcpy(&section, table_bytes.data() + std::size_t{i} * sizeof section, sizeof section);
        if (section.offset != align8(end) || section.offset > bytes.size() ||
            section.size > bytes.size() - section.offset) {
            return malformed(fmt::format("section {} lies outside the file", i));
        }
        for (; end < section.offset; ++end) {
            if (bytes[end] != std::byte{0}) return malformed(fmt::format("padding before section {}", i));
        }
        end = section.offset + section.size;
        const bool named = section.kind == kAttribute || section.kind == kVertices;
        if (!named && (section.layout != 0 || section.name_length != 0)) {
            return malformed(fmt::format("section {}: it has no layout and no name", i));
        }
        if (section.coding != 0) return malformed(fmt::format("section {}: unknown coding {}", i, section.coding));
        if (std::string why = visit(header, section, bytes.subspan(section.offset, section.size)); !why.empty()) {
            return malformed(fmt::format("section {}: {}", i, why));
        }
    }
    if (end != bytes.size()) return malformed("bytes behind the last section");
    return header;
}

/// Takes the name off the contents' begin; empty if that is sound.
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

/// Fills `out`; empty if the section is an attribute of so many vertices, else what is wrong.
std::string view_attribute(const Section& section, std::span<const std::byte> contents, std::uint32_t vertices,
                           AttributeView& out) {
    const std::uint32_t type = section.layout & 0xff;
    out.components = static_cast<std::uint8_t>(section.layout >> 8 & 0xff);
    out.normalized = (section.layout >> 16 & 1) != 0;
    out.v_up = (section.layout >> 17 & 1) != 0;
    if (type > static_cast<std::uint32_t>(ComponentType::f64) || out.components == 0 || section.layout >> 18 != 0) {
        return "unknown attribute layout";
    }
    out.type = static_cast<ComponentType>(type);
    if (std::string why = view_name(section, contents, out); !why.empty()) return why;
    if (contents.size() != std::uint64_t{vertices} * size_of(out.type) * out.components) {
        return "attribute of the wrong size";
    }
    out.data = contents;
    return {};
}

/// The same of an attribute that is a vertex stream. Reads no more of it than its header; `contents` may lie anywhere.
std::string view_stream_of(const Section& section, std::span<const std::byte> contents, std::uint32_t vertices,
                           AttributeView& out) {
    if ((section.layout & ~(1U << 17)) != 0) return "unknown attribute layout";
    if (std::string why = view_name(section, contents, out); !why.empty()) return why;
    if (contents.size() % 4 != 0) return "no whole number of words";
    out.v_up = section.layout != 0;
    out.words = {reinterpret_cast<const std::uint32_t*>(contents.data()), contents.size() / 4};
    const Result<VertexView> view = view_vertices(out.words);
    if (!view) return view.error().message;
    if (view->vertices != vertices) return "a vertex stream of another number of vertices";
    out.type = view->type;
    out.components = view->components;
    out.normalized = view->normalized;
    return {};
}

/// The attribute with its values. Of a stream, which is valid, they are decoded.
Attribute decode_attribute(const LrAttribute& attribute) {
    Attribute out = attribute;
    if (attribute.words.empty()) return out;
    if (const Result<VertexView> view = view_vertices(attribute.words)) {
        out.data.resize(view->decoded_bytes());
        decode_vertices(*view, out.data);
    }
    return out;
}

class Reader {
  public:
    Result<LrFile> read(std::span<const std::byte> bytes) {
        const Result<FileHeader> header = visit_sections(
            bytes,
            [this](const FileHeader& h, const Section& section, std::span<const std::byte> contents) -> std::string {
                file_.vertex_count = h.vertices;
                file_.input_triangles = h.input_triangles;
                if (section.crc != crc32(contents)) return "is damaged";
                return read_section(section, contents);
            });
        if (!header) return header.error();
        if (std::string why = check(); !why.empty()) return malformed(std::move(why));
        return std::move(file_);
    }

  private:
    std::string read_section(const Section& section, std::span<const std::byte> contents) {
        switch (section.kind) {
            case kLean:
            case kLr:
            case kLrCompact:
            case kPacked:
                file_.format = format_of(section.kind);
                return read_words(contents, file_.words);
            case kVertexOrder:
                return read_words(contents, file_.vertex_order);
            case kCornerOrder:
                return read_words(contents, file_.corner_order);
            case kAttribute:
                return read_attribute(section, contents);
            case kVertices:
                return read_stream(section, contents);
            default:
                return fmt::format("unknown kind {}", section.kind);
        }
    }

    static std::string read_words(std::span<const std::byte> contents, std::vector<std::uint32_t>& words) {
        if (!words.empty()) return "occurs twice";
        if (contents.size() % 4 != 0) return "no whole number of words";
        words.resize(contents.size() / 4);
        if (!words.empty()) std::memcpy(words.data(), contents.data(), contents.size());
        return {};
    }

    std::string read_attribute(const Section& section, std::span<const std::byte> contents) {
        AttributeView view;
        if (std::string why = view_attribute(section, contents, file_.vertex_count, view); !why.empty()) return why;
        file_.attributes.push_back({{std::string(view.name),
                                     view.type,
                                     view.components,
                                     view.normalized,
                                     {view.data.begin(), view.data.end()},
                                     view.v_up},
                                    {}});
        return {};
    }

    std::string read_stream(const Section& section, std::span<const std::byte> contents) {
        // A copy, since the bytes may begin anywhere.
        std::vector<std::uint32_t> words((contents.size() + 3) / 4);
        if (!words.empty()) std::memcpy(words.data(), contents.data(), contents.size());
        AttributeView view;
        const auto copy = std::as_bytes(std::span(words)).first(contents.size());
        if (std::string why = view_stream_of(section, copy, file_.vertex_count, view); !why.empty()) return why;
        if (const Result<VertexView> valid = validate_vertices(view.words); !valid) return valid.error().message;
        file_.attributes.push_back(
            {{std::string(view.name), view.type, view.components, view.normalized, {}, view.v_up},
             {view.words.begin(), view.words.end()}});
        return {};
    }

    std::string check() const {
        const Result<Decoded> decoded = decode(file_, true);
        if (!decoded) return decoded.error().message;
        if (decoded->vertices != file_.vertex_count) return "connectivity and file have different vertex counts";
        const std::size_t triangles = decoded->indices.size() / 3;
        if (triangles > file_.input_triangles) return "more triangles than the input had";
        if (file_.attributes.empty() || file_.attributes[0].name != "POSITION" || file_.attributes[0].components != 3 ||
            (file_.attributes[0].type != ComponentType::f32 && file_.attributes[0].type != ComponentType::f64)) {
            return "the first attribute is not POSITION";
        }
        if (!finite(decode_attribute(file_.attributes[0]))) return "a position is not finite as a float";
        if (!file_.vertex_order.empty()) {
            if (file_.vertex_order.size() != file_.vertex_count) return "the vertex order has another size";
            std::vector<std::uint32_t> order = file_.vertex_order;
            remove_copies(*decoded, order);
            const auto kept = static_cast<std::uint32_t>(order.size());
            if (!permutation_into(order, kept, kept)) return "the vertex order is no permutation";
        }
        if (!file_.corner_order.empty()) {
            std::vector<std::uint32_t> order = file_.corner_order;
            for (std::uint32_t& corner : order) corner /= 3;
            if (!permutation_into(order, triangles, file_.input_triangles)) return "the corner order is no permutation";
        }
        return {};
    }

    /// As floats: what draws or exports a mesh has no other.
    static bool finite(const Attribute& attribute) {
        const std::size_t size = size_of(attribute.type);
        for (std::size_t i = 0; i < attribute.data.size(); i += size) {
            double value = 0;
            if (attribute.type == ComponentType::f64) {
                std::memcpy(&value, attribute.data.data() + i, sizeof value);
            } else {
                float single = 0;
                std::memcpy(&single, attribute.data.data() + i, sizeof single);
                value = static_cast<double>(single);
            }
            if (!std::isfinite(static_cast<float>(value))) return false;
        }
        return true;
    }

    /// `size` distinct numbers below `range`?
    static bool permutation_into(std::span<const std::uint32_t> order, std::size_t size, std::uint32_t range) {
        if (order.size() != size || size > range) return false;
        if (range / 64 > size) {  // mostly degenerate input, or a hostile count: no flag for each
            std::vector<std::uint32_t> sorted(order.begin(), order.end());
            std::sort(sorted.begin(), sorted.end());
            return sorted.empty() ||
                   (sorted.back() < range && std::adjacent_find(sorted.begin(), sorted.end()) == sorted.end());
        }
        BitVector seen(range);
        for (const std::uint32_t i : order) {
            if (i >= range || seen.test(i)) return false;
            seen.set(i);
        }
        return true;
    }

    LrFile file_;
};

}  // namespace

namespace {

/// Fills what a vertex stream's header says, which may lie anywhere; empty if it is sound.
std::string list_stream(const Section& section, std::span<const std::byte> contents, LrSection& listed) {
    std::vector<std::uint32_t> words((contents.size() + 3) / 4);
    if (!words.empty()) std::memcpy(words.data(), contents.data(), contents.size());
    AttributeView view;
    if (std::string why = view_name(section, contents, view); !why.empty()) return why;
    listed.name = view.name;
    const Result<VertexView> stream = view_vertices(std::span(words).subspan(align8(section.name_length) / 4));
    if (!stream) return stream.error().message;
    listed.type = stream->type;
    listed.components = stream->components;
    listed.mapping = kMappingNames[static_cast<std::size_t>(stream->mapping)];
    listed.largest_error = stream->largest_error;
    return {};
}

std::vector<Attribute> decode_attributes(const LrFile& file) {
    std::vector<Attribute> out;
    for (const LrAttribute& attribute : file.attributes) out.push_back(decode_attribute(attribute));
    return out;
}

/// The input's corner that each decoded triangle begins with. `triangles` are those of the input, in decoded order.
std::vector<std::uint32_t> find_corners(const Mesh& mesh, const LrFile& file, std::span<const std::uint32_t> triangles,
                                        std::span<const std::uint32_t> vertex_order) {
    const Result<Decoded> decoded = decode(file, false);
    std::vector<std::uint32_t> out;
    if (!decoded) return out;
    out.reserve(decoded->indices.size() / 3);
    for (const std::uint32_t t : triangles) {
        const std::uint32_t* now = decoded->indices.data() + 3 * out.size();
        const std::uint32_t* before = mesh.indices.data() + std::size_t{3} * t;
        std::uint32_t place = 0;  // its three vertices differ, so that one of them is it
        while (place < 2 && before[place] != vertex_order[now[0]]) ++place;
        out.push_back(3 * t + place);
    }
    return out;
}

}  // namespace

LrFile make_lr_file(const Mesh& mesh, Encoded encoded, bool keep_order) {
    LrFile file;
    file.vertex_count = static_cast<std::uint32_t>(encoded.vertex_order.size());
    file.input_triangles = static_cast<std::uint32_t>(mesh.triangle_count());
    file.format = encoded.format;
    file.words = std::move(encoded.words);
    for (Attribute& attribute : permute_attributes(mesh.attributes, encoded.vertex_order)) {
        file.attributes.push_back({std::move(attribute), {}});
    }
    if (keep_order) {
        file.corner_order = find_corners(mesh, file, encoded.triangle_order, encoded.vertex_order);
        file.vertex_order = std::move(encoded.vertex_order);
    }
    return file;
}

std::vector<std::byte> serialize_lr(const LrFile& file) {
    std::vector<Section> sections;
    std::vector<std::vector<std::byte>> names;  // beside sections; empty but for attributes
    std::vector<std::span<const std::byte>> contents;
    const auto add = [&](Kind kind, std::span<const std::byte> data) {
        sections.push_back({kind, 0, 0, 0, 0, 0, 0});
        names.emplace_back();
        contents.push_back(data);
    };
    add(kind_of(file.format), std::as_bytes(std::span(file.words)));
    for (const LrAttribute& attribute : file.attributes) {
        const bool stream = !attribute.words.empty();
        add(stream ? kVertices : kAttribute, stream ? std::as_bytes(std::span(attribute.words)) : attribute.data);
        sections.back().layout = attribute.v_up ? 1U << 17 : 0U;
        if (!stream) {
            sections.back().layout |= static_cast<std::uint32_t>(attribute.type) |
                                      std::uint32_t{attribute.components} << 8 | (attribute.normalized ? 1U << 16 : 0U);
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
    FileHeader header{kMagic,
                      kVersion,
                      static_cast<std::uint32_t>(sections.size()),
                      file.vertex_count,
                      file.input_triangles,
                      0,
                      crc32(std::as_bytes(std::span(sections))),
                      0};
    header.header_crc = crc32(bytes_of(header).first(28));
    std::vector<std::byte> out(end);
    const auto put = [&](std::size_t offset, std::span<const std::byte> data) {
        if (!data.empty()) std::memcpy(out.data() + offset, data.data(), data.size());
    };
    put(0, bytes_of(header));
    put(sizeof header, std::as_bytes(std::span(sections)));
    for (std::size_t i = 0; i < sections.size(); ++i) {
        put(sections[i].offset, names[i]);
        put(sections[i].offset + names[i].size(), contents[i]);
    }
    return out;
}

Result<LrFile> parse_lr(std::span<const std::byte> bytes) {
    return Reader().read(bytes);
}

Result<void> write_lr(const LrFile& file, const std::filesystem::path& path) {
    const std::vector<std::byte> bytes = serialize_lr(file);
    const std::span<const std::byte> parts[] = {bytes};
    return write_file(path, parts);
}

Result<LrFile> read_lr(const std::filesystem::path& path) {
    Result<std::vector<std::byte>> bytes = read_file(path);
    if (!bytes) return bytes.error();
    return parse_lr(*bytes);
}

bool is_lr(std::span<const std::byte> bytes) {
    std::uint32_t magic = 0;
    if (bytes.size() < sizeof magic) return false;
    std::memcpy(&magic, bytes.data(), sizeof magic);
    return magic == kMagic;
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
    out.input_triangles = header->input_triangles;
    out.bytes = bytes.size();
    return out;
}

Result<StreamView> LrFileView::validate() const {
    Result<StreamView> view = lacedring::validate(words);
    if (!view) return view;
    if (view->format() != format) return malformed("the stream is of another format than its section");
    if (view->vertices() != vertex_count) return malformed("connectivity and file have different vertex counts");
    return view;
}

Positions LrFileView::positions() const {
    const auto position = std::ranges::find(attributes, "POSITION", &AttributeView::name);
    if (position == attributes.end() || position->components != 3) return {};
    if (position->type != ComponentType::f32 && position->type != ComponentType::f64) return {};
    return {position->data, position->type == ComponentType::f64};
}

Result<LrFileView> view_lr_file(std::span<const std::byte> bytes) {
    LrFileView out;
    if (reinterpret_cast<std::uintptr_t>(bytes.data()) % 8 != 0) {  // words are read where they lie
        if (std::string why = not_an_lr_file(bytes); !why.empty()) return Error{ErrorCode::malformed, std::move(why)};
        return Error{ErrorCode::invalid_argument, "the file does not begin at a multiple of eight bytes"};
    }
    const auto view_words = [](std::span<const std::byte> contents, std::span<const std::uint32_t>& words) {
        if (words.data() != nullptr) return "occurs twice";
        if (contents.size() % 4 != 0) return "no whole number of words";
        words = {reinterpret_cast<const std::uint32_t*>(contents.data()), contents.size() / 4};
        return "";
    };
    const Result<FileHeader> header = visit_sections(
        bytes, [&](const FileHeader& h, const Section& section, std::span<const std::byte> contents) -> std::string {
            switch (section.kind) {
                case kLean:
                case kLr:
                case kLrCompact:
                case kPacked:
                    out.format = format_of(section.kind);
                    return view_words(contents, out.words);
                case kVertexOrder:
                    return view_words(contents, out.vertex_order);
                case kCornerOrder:
                    return view_words(contents, out.corner_order);
                case kAttribute:
                    return view_attribute(section, contents, h.vertices, out.attributes.emplace_back());
                case kVertices:
                    return view_stream_of(section, contents, h.vertices, out.attributes.emplace_back());
                default:
                    return fmt::format("unknown kind {}", section.kind);
            }
        });
    if (!header) return header.error();
    if (out.words.data() == nullptr) return malformed("no connectivity");
    out.vertex_count = header->vertices;
    out.input_triangles = header->input_triangles;
    if (!out.vertex_order.empty() && out.vertex_order.size() != out.vertex_count) {
        return malformed("the vertex order has another size");
    }
    return out;
}

Result<Mesh> decode_lr(const LrFile& file) {
    Result<Decoded> decoded = decode(file, false);
    if (!decoded) return decoded.error();
    Mesh mesh;
    mesh.indices = std::move(decoded->indices);
    if (decoded->copy.empty()) {
        mesh.vertex_count = file.vertex_count;
        mesh.attributes = decode_attributes(file);
        return mesh;
    }
    // The vertices that are no copies close ranks. No triangle names a copy.
    std::vector<std::uint32_t> kept(file.vertex_count);
    std::iota(kept.begin(), kept.end(), 0U);
    remove_copies(*decoded, kept);
    mesh.vertex_count = static_cast<std::uint32_t>(kept.size());
    mesh.attributes = permute_attributes(decode_attributes(file), kept);
    std::vector<std::uint32_t> number(file.vertex_count, 0);
    for (std::uint32_t i = 0; i < kept.size(); ++i) number[kept[i]] = i;
    for (std::uint32_t& v : mesh.indices) v = number[v];
    return mesh;
}

Result<Mesh> decode_lr_original_order(const LrFile& file) {
    const Result<Mesh> stream = decode_lr(file);
    if (!stream) return stream;
    if (file.vertex_order.size() != file.vertex_count || file.corner_order.size() != stream->triangle_count()) {
        return Error{ErrorCode::invalid_argument,
                     "the file does not keep the input's order (encode --keep-order does)"};
    }
    const Result<Decoded> decoded = decode(file, false);
    if (!decoded) return decoded.error();
    std::vector<std::uint32_t> vertex_order = file.vertex_order;
    remove_copies(*decoded, vertex_order);
    // Where each new vertex was, inverted: permute_attributes wants the new number of each old vertex.
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
