// Reads .lr files and checks all that is in them.

#include <algorithm>
#include <optional>

#include "lacedring/file.hpp"
#include "lrcore/base/bits.h"
#include "lrcore/codec/storage/packed_storage.h"
#include "lrcore/codec/storage/vertex_storage.h"
#include "lrio/file/lr_layout.h"

namespace lacedring {
namespace {

using namespace detail;  // lr_layout.h's

class Reader {
  public:
    explicit Reader(std::span<const std::byte> bytes, std::uint64_t max_bytes)
        : max_bytes_(max_bytes != 0 ? max_bytes
                                    : std::max<std::uint64_t>(512 << 20, std::uint64_t{128} * bytes.size())) {}

    Result<LrFile> read(std::span<const std::byte> bytes) {
        const Result<FileHeader> header = visit_sections(
            bytes,
            [this](const FileHeader& h, const Section& section, std::span<const std::byte> contents) -> std::string {
                file_.vertex_count = h.vertices;
                file_.input_triangles = h.input_triangles;
                file_.copy_count = h.copies;
                if (section.crc != crc32(contents)) return "is damaged";
                return read_section(h, section, contents);
            });
        if (limit_) return *limit_;
        if (!header) return header.error();
        if (auto good = check(); !good) return good.error();
        return std::move(file_);
    }

    DecodedLr take_decoded() { return std::move(decoded_); }

  private:
    std::string read_section(const FileHeader& header, const Section& section, std::span<const std::byte> contents) {
        switch (section.kind) {
            case kLean:
            case kLr:
            case kLrCompact:
            case kPacked:
                if (has_connectivity_) return "occurs twice";
                has_connectivity_ = true;
                file_.format = format_of(section.kind);
                return section.coding == kStored ? restore(header, contents) : read_words(contents, file_.words);
            case kVertexOrder:
                return read_words(contents, file_.vertex_order);
            case kCornerOrder:
                return read_words(contents, file_.corner_order);
            case kSeams:
                return read_words(contents, file_.seams);
            case kAttribute:
                return read_attribute(header, section, contents);
            case kVertices:
                return read_stream(header, section, contents);
            default:
                return fmt::format("unknown kind {}", section.kind);
        }
    }

    std::string restore(const FileHeader& header, std::span<const std::byte> contents) {
        constexpr double kTriangle = 60, kVertex = 8;  // bytes, while it is restored
        if (kTriangle * header.input_triangles + kVertex * header.vertices > static_cast<double>(max_bytes_)) {
            limit_ = Error{ErrorCode::memory_limit,
                           fmt::format("lr file: {} triangles in storage form would take more than {} MiB",
                                       header.input_triangles, max_bytes_ >> 20)};
            return "too large";
        }
        std::vector<std::uint32_t> words;
        if (std::string why = read_words(contents, words); !why.empty()) return why;
        auto restored = storage::restore_packed(words, {header.vertices, header.input_triangles});
        if (!restored) return restored.error().message;
        file_.words = std::move(*restored);
        return {};
    }

    static std::string read_words(std::span<const std::byte> contents, std::vector<std::uint32_t>& words) {
        if (!words.empty()) return contents.empty() ? "" : "occurs twice";
        if (contents.size() % 4 != 0) return "no whole number of words";
        words.resize(contents.size() / 4);
        if (!words.empty()) std::memcpy(words.data(), contents.data(), contents.size());
        return {};
    }

    std::string read_attribute(const FileHeader& header, const Section& section, std::span<const std::byte> contents) {
        AttributeView view;
        if (std::string why = view_attribute(header, section, contents, view); !why.empty()) return why;
        file_.attributes.push_back({{std::string(view.name),
                                     view.type,
                                     view.components,
                                     view.normalized,
                                     {view.data.begin(), view.data.end()},
                                     view.v_up},
                                    {},
                                    view.per_copy});
        return {};
    }

    std::string read_stream(const FileHeader& header, const Section& section, std::span<const std::byte> contents) {
        // A copy, since the bytes may begin anywhere.
        std::vector<std::uint32_t> words((contents.size() + 3) / 4);
        if (!words.empty()) std::memcpy(words.data(), contents.data(), contents.size());
        AttributeView view;
        const auto copy = std::as_bytes(std::span(words)).first(contents.size());
        if (section.coding == kStored) {
            if (std::string why = view_stored_of(header, section, copy, view); !why.empty()) return why;
            stored_.push_back(file_.attributes.size());
            file_.attributes.push_back({{std::string(view.name), ComponentType::f32, 1, false, {}, view.v_up},
                                        {view.words.begin(), view.words.end()},
                                        view.per_copy});
            return {};
        }
        if (std::string why = view_stream_of(header, section, copy, view); !why.empty()) return why;
        if (const Result<VertexView> valid = validate_vertices(view.words); !valid) return valid.error().message;
        file_.attributes.push_back(
            {{std::string(view.name), view.type, view.components, view.normalized, {}, view.v_up},
             {view.words.begin(), view.words.end()},
             view.per_copy});
        return {};
    }

    /// Values are predicted from neighbors', normals and texture coordinates from positions, too: the triangles are
    /// needed first, and then POSITION, the first attribute.
    Result<void> restore_attribute(LrAttribute& attribute, const DecodedLr& decoded) {
        const std::uint32_t values = attribute.per_copy ? file_.copy_count : file_.vertex_count;
        constexpr std::uint64_t kValue = 128;  // bytes, while it is restored
        if (kValue * values > max_bytes_) {
            return Error{ErrorCode::memory_limit,
                         fmt::format("lr file: {} values in storage form would take more than {} MiB", values,
                                     max_bytes_ >> 20)};
        }
        const Result<VertexView> stored = storage::view_stored_vertices(attribute.words);
        const bool is_first = &attribute == file_.attributes.data();
        if (!is_first && stored && stored->integers == 2 && positions_.empty()) positions_ = position_integers(file_);
        auto words = storage::restore_vertices(attribute.words, triangles_of(decoded, attribute.per_copy), values,
                                               max_bytes_ / sizeof(std::uint32_t),
                                               places_of(positions_, decoded, attribute.per_copy));
        if (!words) return words.error();
        attribute.words = std::move(*words);
        const Result<VertexView> view = validate_vertices(attribute.words);
        if (!view) return view.error();
        if (view->vertices != values) return malformed_lr("a vertex stream of another number of vertices");
        attribute.type = view->type;
        attribute.components = view->components;
        attribute.normalized = view->normalized;
        return {};
    }

    Result<void> check() {
        if (file_.seams.empty() != (file_.copy_count == 0)) {
            return malformed_lr("seams without copies, or copies without seams");
        }
        Result<DecodedLr> decoded = decode_connectivity(view_of(file_), true);
        if (!decoded) return decoded.error();
        for (const std::size_t i : stored_) {
            if (auto good = restore_attribute(file_.attributes[i], *decoded); !good) return good;
        }
        if (auto good = check_position(view_of(file_)); !good) return good;
        const std::size_t triangles = decoded->indices.size() / 3;
        if (triangles > file_.input_triangles) return malformed_lr("more triangles than the input had");
        const Attribute position = decode_attribute(file_.attributes[0]);
        if (auto good = check_finite(position.type, position.data); !good) return good;
        if (!file_.vertex_order.empty()) {
            if (file_.vertex_order.size() != std::max(file_.vertex_count, file_.copy_count)) {
                return malformed_lr("the vertex order has another size");
            }
            std::vector<std::uint32_t> order = file_.vertex_order;
            decoded->remove_extra(order);
            const auto kept = static_cast<std::uint32_t>(order.size());
            if (!permutation_into(order, kept, kept)) return malformed_lr("the vertex order is no permutation");
        }
        if (!file_.corner_order.empty()) {
            std::vector<std::uint32_t> order = file_.corner_order;
            for (std::uint32_t& corner : order) corner /= 3;
            if (!permutation_into(order, triangles, file_.input_triangles)) {
                return malformed_lr("the corner order is no permutation");
            }
        }
        decoded_ = std::move(*decoded);
        return {};
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

    std::uint64_t max_bytes_;
    std::optional<Error> limit_;            ///< what was more than may be
    std::vector<std::size_t> stored_;       ///< attributes in storage form, the first one of the file first
    std::vector<std::uint32_t> positions_;  ///< of POSITION, once others may need them
    LrFile file_;
    DecodedLr decoded_;
    bool has_connectivity_ = false;
};

}  // namespace

Result<LrFile> detail::parse_lr(std::span<const std::byte> bytes, std::uint64_t max_bytes, DecodedLr& decoded) {
    Reader reader(bytes, max_bytes);
    Result<LrFile> file = reader.read(bytes);
    if (file) decoded = reader.take_decoded();
    return file;
}

Result<LrFile> parse_lr(std::span<const std::byte> bytes, std::uint64_t max_bytes) {
    return Reader(bytes, max_bytes).read(bytes);
}

Result<LrFile> read_lr(const std::filesystem::path& path) {
    Result<std::vector<std::byte>> bytes = read_file(path);
    if (!bytes) return bytes.error();
    return parse_lr(*bytes);
}

}  // namespace lacedring
