#include "lrio/scene/stream_decoder.h"

#include <algorithm>
#include <cstring>
#include <numeric>
#include <thread>

#include "lrcore/base/try.h"
#include "lrio/mesh/read_formats.h"
#include "lrio/scene/part_codes.h"

namespace lacedring::detail {

Result<StreamDecoder> StreamDecoder::open(std::span<const std::byte> file, std::span<const std::byte> parts, Said said,
                                          const Check& check) {
    std::unique_ptr<LrFile> restored;
    DecodedLr decoded;
    Result<LrFileView> view = view_checked_lr(file);
    if (!view && view.error().code == ErrorCode::unsupported) {  // in storage form
        LR_ASSIGN(LrFile whole, parse_lr(file, 0, decoded, std::thread::hardware_concurrency()));
        restored = std::make_unique<LrFile>(std::move(whole));
        view = view_of(*restored);
    }
    if (!view) return view.error();
    LR_TRY(check_position(*view));
    if (check) {
        LR_TRY(check(*view));
    }
    StreamDecoder out;
    out.said_ = std::move(said);
    out.view_ = std::move(*view);
    out.restored_ = std::move(restored);
    out.decoded_ = std::move(decoded);
    out.corners_.assign(out.said_.set_of_part.size(), 0);
    LR_TRY(out.read(file));
    LR_TRY(out.read_parts(parts));
    LR_TRY(out.number_vertices());
    return out;
}

Result<void> StreamDecoder::read(std::span<const std::byte> file) {
    const bool plain = view_.format == Format::packed || view_.format == Format::lean;
    if (!plain || !view_.vertex_order.empty() || !view_.corner_order.empty()) return read_mesh(file);
    if (view_.format == Format::packed && view_.seams.empty() && corners_.size() == 1 && said_.vertices.size() == 1 &&
        !restored_) {
        LR_ASSIGN(StreamView stream, view_.validate());
        vertex_count_ = stream.vertices();
        triangle_count_ = stream.triangles();
        stream_ = stream;
    } else {
        if (!restored_) {
            LR_ASSIGN(DecodedLr decoded, decode_connectivity(view_, true));
            decoded_ = std::move(decoded);
        }
        vertex_count_ = view_.seams.empty() ? decoded_.vertices : view_.copy_count;
        indices_ = std::move(decoded_.indices);
        row_of_ = std::move(decoded_.vertex_of);
        triangle_count_ = indices_.size() / 3;
    }
    if (triangle_count_ > view_.input_triangles) return malformed_lr("more triangles than the input had");
    return {};
}

/// Decodes files whose vertices or triangles need another order than the stored one.
Result<void> StreamDecoder::read_mesh(std::span<const std::byte> file) {
    if (!restored_) {
        LR_ASSIGN(LrFile whole, parse_lr(file, 0, decoded_, 1));
        restored_ = std::make_unique<LrFile>(std::move(whole));
    }
    const LrFile* whole = restored_.get();
    in_order_ = !whole->vertex_order.empty() && !whole->corner_order.empty();
    LR_ASSIGN(Mesh mesh, in_order_ ? decode_lr_original_order(*whole) : decode_mesh(*whole, decoded_, nullptr));
    vertex_count_ = mesh.vertex_count;
    indices_ = std::move(mesh.indices);
    triangle_count_ = indices_.size() / 3;
    mesh_ = std::move(mesh);
    return {};
}

Result<void> StreamDecoder::read_parts(std::span<const std::byte> codes) {
    if (corners_.size() == 1) {
        corners_[0] = 3 * triangle_count_;
        return codes.empty() ? Result<void>() : malformed("parts of a stream that has one");
    }
    LR_ASSIGN(auto decoded, decode_part_codes(codes, triangle_count_, corners_.size()));
    part_of_ = std::move(decoded);
    if (in_order_) {  // codes are in the stream's order
        std::vector<std::uint32_t> order(part_of_.size()), sorted;
        std::iota(order.begin(), order.end(), 0U);
        const std::span<const std::uint32_t> corner = view_.corner_order;
        std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return corner[a] < corner[b]; });
        sorted.reserve(order.size());
        for (const std::uint32_t i : order) sorted.push_back(part_of_[i]);
        part_of_ = std::move(sorted);
    }
    for (const std::uint32_t part : part_of_) corners_[part] += 3;
    return {};
}

Result<void> StreamDecoder::number_vertices() {
    if (said_.vertices.size() > 1) return in_order_ ? number_by_ranges() : number_by_triangles();
    std::uint32_t& count = said_.vertices[0];
    if (count == UINT32_MAX && !in_order_) count = vertex_count_;
    if (count == vertex_count_) return {};
    return malformed("{} vertices of a set, where its accessors have {}", vertex_count_, count);
}

Result<void> StreamDecoder::number_by_ranges() {
    const std::vector<std::uint32_t>& counts = said_.vertices;
    if (std::ranges::count(counts, UINT32_MAX) != 0) return malformed("vertices in order, and a set without a count");
    const std::uint64_t sum = std::accumulate(counts.begin(), counts.end(), std::uint64_t{0});
    if (sum != vertex_count_) return malformed("{} vertices, where the accessors have {}", vertex_count_, sum);
    set_of_.reserve(vertex_count_);
    place_.reserve(vertex_count_);
    for (std::uint32_t set = 0; set < counts.size(); ++set) {
        set_of_.insert(set_of_.end(), counts[set], set);
        for (std::uint32_t v = 0; v < counts[set]; ++v) place_.push_back(v);
    }
    for (std::size_t i = 0; i < indices_.size(); ++i) {
        const std::uint32_t part = part_of_.empty() ? 0 : part_of_[i / 3];
        if (set_of_[indices_[i]] != said_.set_of_part[part]) return malformed("a triangle with another set's vertex");
    }
    return {};
}

/// Assigns each vertex to the set of its triangles.
Result<void> StreamDecoder::number_by_triangles() {
    set_of_.assign(vertex_count_, UINT32_MAX);
    for (std::size_t i = 0; i < indices_.size(); ++i) {
        const std::uint32_t set = said_.set_of_part[part_of_.empty() ? 0 : part_of_[i / 3]];
        std::uint32_t& owner = set_of_[indices_[i]];
        if (owner != UINT32_MAX && owner != set) return malformed("a vertex of two sets");
        owner = set;
    }
    std::vector<std::uint32_t> counts(said_.vertices.size(), 0);
    place_.reserve(vertex_count_);
    for (std::uint32_t v = 0; v < vertex_count_; ++v) {
        if (set_of_[v] == UINT32_MAX) return malformed("vertex {} is in no triangle", v);
        place_.push_back(counts[set_of_[v]]++);
    }
    for (std::size_t s = 0; s < counts.size(); ++s) {
        if (said_.vertices[s] == UINT32_MAX || said_.vertices[s] == counts[s]) continue;
        return malformed("{} vertices of a set, where its accessors have {}", counts[s], said_.vertices[s]);
    }
    said_.vertices = std::move(counts);
    return {};
}

/// Decodes an attribute in the file's order: a row for each vertex or copy.
Result<void> StreamDecoder::decode_values(std::size_t attribute, std::span<std::byte> out) const {
    const AttributeView& from = view_.attributes[attribute];
    if (from.words.empty()) {
        if (!out.empty()) std::memcpy(out.data(), from.data.data(), out.size());
    } else {
        LR_ASSIGN(const VertexView stream, view_vertices(from.words));
        if (auto good = decode_vertices_checked(stream, out); !good) return good;
        if (stream.mapping == VertexMapping::lattice) return {};  // decodes to finite floats
    }
    return attribute == 0 ? check_finite(from.type, out) : Result<void>();
}

Result<void> StreamDecoder::decode_attribute(std::size_t attribute, std::span<const std::span<std::byte>> sets) {
    const AttributeView& from = view_.attributes[attribute];
    const std::size_t stride = size_of(from.type) * from.components;
    const bool has_rows = !mesh_ && !from.per_copy && !row_of_.empty();
    std::span<const std::byte> values;
    if (mesh_) {
        values = mesh_->attributes[attribute].data;
    } else if (set_of_.empty() && !has_rows) {
        return decode_values(attribute, sets[0]);
    } else {
        scratch_.resize((has_rows ? view_.vertex_count : vertex_count_) * stride);
        if (auto good = decode_values(attribute, scratch_); !good) return good;
        values = scratch_;
    }
    if (set_of_.empty() && !has_rows) {
        if (!values.empty()) std::memcpy(sets[0].data(), values.data(), values.size());
        return {};
    }
    for (std::size_t v = 0; v < vertex_count_; ++v) {
        const std::size_t set = set_of_.empty() ? 0 : set_of_[v], place = set_of_.empty() ? v : place_[v];
        std::memcpy(sets[set].data() + place * stride, values.data() + (has_rows ? row_of_[v] : v) * stride, stride);
    }
    return {};
}

void StreamDecoder::decode_parts(std::span<const std::span<std::uint32_t>> parts) const {
    if (stream_) {
        (void)decode(*stream_, parts[0]);  // cannot fail: the size is right
        return;
    }
    if (corners_.size() == 1 && set_of_.empty()) {
        std::ranges::copy(indices_, parts[0].begin());
        return;
    }
    std::vector<std::uint32_t*> to;
    for (const std::span<std::uint32_t> part : parts) to.push_back(part.data());
    for (std::size_t i = 0; i < indices_.size(); ++i) {
        const std::uint32_t v = indices_[i];
        *to[part_of_.empty() ? 0 : part_of_[i / 3]]++ = set_of_.empty() ? v : place_[v];
    }
}

}  // namespace lacedring::detail
