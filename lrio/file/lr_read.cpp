// Reads .lr files and checks their contents.

#include <algorithm>
#include <optional>

#include "lacedring/file.hpp"
#include "lrcore/base/bits.h"
#include "lrcore/base/parallel.h"
#include "lrcore/base/try.h"
#include "lrcore/codec/storage/packed_storage.h"
#include "lrcore/codec/storage/vertex_storage.h"
#include "lrio/file/lr_layout.h"

namespace lacedring {
namespace {

using namespace detail;  // lr_layout.h's

class Reader {
  public:
    Reader(std::span<const std::byte> bytes, std::uint64_t max_bytes, unsigned threads)
        : max_bytes_(max_bytes != 0 ? max_bytes : default_memory(bytes.size())), threads_(threads) {}

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
        LR_TRY(check());
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
                return section.coding == kStored ? read_stored(header, contents) : read_words(contents, file_.words);
            case kVertexOrder:
                return read_words(contents, file_.vertex_order);
            case kCornerOrder:
                return read_words(contents, file_.corner_order);
            case kSeams:
                has_stored_seams_ |= section.coding == kStored && !contents.empty();
                return read_words(contents, file_.seams);
            case kAttribute:
                return read_attribute(header, section, contents);
            case kVertices:
                return read_stream(header, section, contents);
            default:
                return fmt::format("unknown kind {}", section.kind);
        }
    }

    std::string read_stored(const FileHeader& header, std::span<const std::byte> contents) {
        if (memory_to_restore(header.input_triangles, header.vertices) > max_bytes_) {
            limit_ = Error{ErrorCode::memory_limit,
                           fmt::format("lr file: {} triangles in storage form would take more than {} MiB",
                                       header.input_triangles, max_bytes_ >> 20)};
            return "too large";
        }
        is_stored_ = true;
        return read_words(contents, file_.words);
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

    std::uint32_t values_of(const LrAttribute& attribute) const {
        return attribute.per_copy ? file_.copy_count : file_.vertex_count;
    }

    /// Reads the parts in storage form that do not depend on each other: the connectivity's steps and the vertex
    /// streams' residuals.
    Result<void> read_parts() {
        for (const std::size_t i : stored_) {
            const std::uint32_t values = values_of(file_.attributes[i]);
            if (memory_to_restore(values) <= max_bytes_) continue;
            return Error{ErrorCode::memory_limit,
                         fmt::format("lr file: {} values in storage form would take more than {} MiB", values,
                                     max_bytes_ >> 20)};
        }
        residuals_.resize(file_.attributes.size());
        return in_parts(1 + stored_.size(), [&](std::size_t part) -> Result<void> {
            if (part == 0) {
                if (!is_stored_) return {};
                LR_ASSIGN(auto read,
                          storage::StoredPacked::read(file_.words, {file_.vertex_count, file_.input_triangles}));
                steps_ = std::move(read);
                return {};
            }
            const std::size_t i = stored_[part - 1];
            LR_ASSIGN(auto read,
                      storage::StoredVertices::read(file_.attributes[i].words, values_of(file_.attributes[i])));
            residuals_[i] = std::move(read);
            return {};
        });
    }

    /// Restores a vertex stream from its residuals. It needs the triangles, since values are predicted from neighbors.
    Result<void> restore_attribute(std::size_t i, std::span<const std::uint32_t> triangles,
                                   const storage::VertexPlaces& places, unsigned threads) {
        LrAttribute& attribute = file_.attributes[i];
        auto words = std::move(*residuals_[i]).restore(triangles, max_bytes_ / sizeof(std::uint32_t), places, threads);
        residuals_[i].reset();
        if (!words) return words.error();
        attribute.words = std::move(*words);
        LR_ASSIGN(const VertexView view, validate_vertices(attribute.words));
        if (view.vertices != values_of(attribute)) return malformed_lr("a vertex stream of another number of vertices");
        attribute.type = view.type;
        attribute.components = view.components;
        attribute.normalized = view.normalized;
        return {};
    }

    /// Restores and decodes the connectivity's stream. With several threads, restores per-vertex streams at the same
    /// time, with triangles from the steps; this takes more memory.
    Result<void> restore_connectivity() {
        std::vector<std::uint32_t> triangles;
        if (steps_ && threads_ > 1) triangles = steps_->triangles();
        std::vector<std::size_t> beside;
        for (const std::size_t i : stored_) {
            if (!triangles.empty() && !file_.attributes[i].per_copy && !residuals_[i]->needs_places())
                beside.push_back(i);
        }
        const unsigned inner = beside.size() == 1 ? threads_ : 1;
        auto good = in_parts(1 + beside.size(), [&](std::size_t part) -> Result<void> {
            if (part > 0) return restore_attribute(beside[part - 1], triangles, {}, inner);
            if (steps_) {
                auto words = steps_->write();
                steps_.reset();
                if (!words) return words.error();
                file_.words = std::move(*words);
            }
            LrFileView connectivity;  // not view_of(file_), whose attributes are being restored
            connectivity.format = file_.format;
            connectivity.vertex_count = file_.vertex_count;
            connectivity.copy_count = file_.copy_count;
            connectivity.words = file_.words;
            connectivity.seams = file_.seams;
            const StoredSeams seams{file_.seams, max_bytes_};
            LR_ASSIGN(auto decoded, decode_connectivity(connectivity, true, has_stored_seams_ ? &seams : nullptr));
            decoded_ = std::move(decoded);
            return {};
        });
        if (!good || beside.empty()) return good;
        std::vector<std::uint32_t> of_vertices;
        if (!std::ranges::equal(triangles, triangles_of(decoded_, false, of_vertices)))
            return malformed_lr("steps that no stream is written as");
        return {};
    }

    /// Restores the remaining vertex streams. Streams predicted from positions (normals) come last.
    Result<void> restore_attributes() {
        std::vector<std::uint32_t> of_vertices, positions;
        for (const bool with_places : {false, true}) {
            std::vector<std::size_t> now;
            for (const std::size_t i : stored_) {
                if (residuals_[i] && residuals_[i]->needs_places() == with_places) now.push_back(i);
            }
            if (now.empty()) continue;
            for (const std::size_t i : now) triangles_of(decoded_, file_.attributes[i].per_copy, of_vertices);
            if (with_places) positions = position_integers(file_);
            const unsigned inner = now.size() == 1 ? threads_ : 1;
            auto good = in_parts(now.size(), [&](std::size_t part) {
                const bool per_copy = file_.attributes[now[part]].per_copy;
                return restore_attribute(now[part], triangles_of(decoded_, per_copy, of_vertices),
                                         places_of(positions, decoded_, per_copy), inner);
            });
            if (!good) return good;
        }
        return {};
    }

    /// Calls work(i) for each i < `parts`, on several threads; returns the error of the lowest i, if any.
    template <class Work>
    Result<void> in_parts(std::size_t parts, Work work) {
        std::vector<Result<void>> good(parts);
        in_parallel(threads_, static_cast<std::uint32_t>(parts), [&](std::uint32_t i) { good[i] = work(i); });
        for (const Result<void>& one : good) {
            if (!one) return one;
        }
        return {};
    }

    Result<void> check() {
        if (file_.seams.empty() != (file_.copy_count == 0)) {
            return malformed_lr("seams without copies, or copies without seams");
        }
        if (auto good = read_parts(); !good) return good;
        if (auto good = restore_connectivity(); !good) return good;
        if (auto good = restore_attributes(); !good) return good;
        if (auto good = check_position(view_of(file_)); !good) return good;
        const std::size_t triangles = decoded_.indices.size() / 3;
        if (triangles > file_.input_triangles) return malformed_lr("more triangles than the input had");
        const Attribute position = decode_attribute(file_.attributes[0]);
        if (auto good = check_finite(position.type, position.data); !good) return good;
        if (!file_.vertex_order.empty()) {
            if (file_.vertex_order.size() != std::max(file_.vertex_count, file_.copy_count)) {
                return malformed_lr("the vertex order has another size");
            }
            std::vector<std::uint32_t> order = file_.vertex_order;
            decoded_.remove_extra(order);
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
        return {};
    }

    /// Are these `size` distinct numbers below `range`?
    static bool permutation_into(std::span<const std::uint32_t> order, std::size_t size, std::uint32_t range) {
        if (order.size() != size || size > range) return false;
        // Sorts instead of flagging if `range` is far larger than `size`: a mostly degenerate input, or a hostile
        // count.
        if (range / 64 > size) {
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
    std::optional<Error> limit_;  ///< the memory_limit error of a section
    unsigned threads_;
    bool is_stored_ = false;           ///< connectivity is in storage form
    std::vector<std::size_t> stored_;  ///< attributes in storage form
    std::vector<std::optional<storage::StoredVertices>>
        residuals_;  ///< residuals of each attribute until it is restored
    std::optional<storage::StoredPacked> steps_;
    LrFile file_;
    DecodedLr decoded_;
    bool has_connectivity_ = false, has_stored_seams_ = false;
};

}  // namespace

Result<LrFile> detail::parse_lr(std::span<const std::byte> bytes, std::uint64_t max_bytes, DecodedLr& decoded,
                                unsigned threads) {
    Reader reader(bytes, max_bytes, threads);
    Result<LrFile> file = reader.read(bytes);
    if (file) decoded = reader.take_decoded();
    return file;
}

Result<LrFile> parse_lr(std::span<const std::byte> bytes, std::uint64_t max_bytes, unsigned threads) {
    return Reader(bytes, max_bytes, threads).read(bytes);
}

Result<LrFile> read_lr(const std::filesystem::path& path) {
    LR_ASSIGN(std::vector<std::byte> bytes, read_file(path));
    return parse_lr(bytes);
}

}  // namespace lacedring
