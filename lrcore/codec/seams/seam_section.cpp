// The C++ interface of seam sections, on the decoder and checks in lacedring_seams.h (C).

#include <algorithm>
#include <bit>
#include <cassert>

#include "lacedring/lacedring_seams.h"
#include "lacedring/seams.hpp"
#include "lrcore/base/crc32.h"
#include "lrcore/base/message.h"
#include "lrcore/base/signature.h"
#include "lrcore/codec/tables/tables_decode.h"

namespace lacedring {
namespace {

static_assert(std::endian::native == std::endian::little, "sections are little-endian words");
static_assert(kSeamBlock == LACEDRING_SEAMS_BLOCK);

constexpr std::size_t kSeamChecksum = 1;

/// Describes the fault in English.
std::string seam_fault(lacedring_status status, std::uint64_t where, std::span<const std::uint32_t> words) {
    using detail::message;
    switch (status) {
        case LACEDRING_STATUS_SHORT:
            return "shorter than its header";
        case LACEDRING_STATUS_MAGIC:
            return wrong_magic(words, "a seam section");
        case LACEDRING_STATUS_HEADER:
            return message("word ", where, " of the header is invalid for this mesh");
        case LACEDRING_STATUS_SIZE:
            return message(words.size(), " words do not match the size of its blocks");
        case LACEDRING_STATUS_CHECKSUM:
            return "checksum does not match";
        case LACEDRING_STATUS_VERTEX_BLOCK:
            return message("vertex block ", where, " is invalid");
        case LACEDRING_STATUS_BLOCK:
            return message("block ", where, " is invalid");
        case LACEDRING_STATUS_TRIANGLE:
            return message("triangle ", where, " has a vertex out of range or a repeated vertex");
        default:
            return "unknown";
    }
}

Error bad_seams(lacedring_status status, std::uint64_t where, std::span<const std::uint32_t> words) {
    return {ErrorCode::malformed, "seam section: " + seam_fault(status, where, words)};
}

lacedring_seams as_c(const SeamView& view) {
    lacedring_seams out{};
    [[maybe_unused]] const lacedring_status status =
        lacedring_seams_open(view.words.data(), view.words.size(), view.vertices, view.triangles, &out, nullptr);
    assert(status == LACEDRING_STATUS_OK);
    return out;
}

/// Number of corners of block `block`, if there are `slots` slots.
std::size_t block_corners(std::uint32_t slots, std::uint32_t block) {
    return std::size_t{3} * std::min(slots - block * kSeamBlock, kSeamBlock);
}

/// Decodes the slots from `first` on, as many as fit in `triangles`.
void write_slots(const StreamView& stream, std::uint32_t first, std::span<std::uint32_t> triangles) {
    for (std::size_t i = 0; i < triangles.size(); i += 3, ++first) {
        const Triangle t = decode_triangle(stream, first).value_or(Triangle{{UINT32_MAX, UINT32_MAX, UINT32_MAX}});
        std::ranges::copy(t.v, triangles.begin() + static_cast<std::ptrdiff_t>(i));
    }
}

}  // namespace

Result<SeamView> view_seams(std::span<const std::uint32_t> words, std::uint32_t triangles, std::uint32_t vertices) {
    lacedring_seams seams;
    std::uint64_t where = 0;
    const lacedring_status status =
        lacedring_seams_open(words.data(), words.size(), vertices, triangles, &seams, &where);
    if (status != LACEDRING_STATUS_OK) return bad_seams(status, where, words);
    return SeamView{words, vertices, triangles, seams.homes, seams.copies};
}

namespace {

/// Checks the section, and also decodes it if `vertices` is not null.
Result<SeamView> check_seams(std::span<const std::uint32_t> words, std::span<const std::uint32_t> triangles,
                             std::uint32_t vertex_count, std::span<std::uint32_t> copies,
                             std::vector<std::uint32_t>* vertices) {
    if (triangles.size() % 3 != 0 || triangles.size() / 3 > UINT32_MAX / 3) {
        return Error{ErrorCode::malformed, "seam section: invalid number of corners"};
    }
    Result<SeamView> view = view_seams(words, static_cast<std::uint32_t>(triangles.size() / 3), vertex_count);
    if (!view) return view;
    if (words[kSeamChecksum] != crc32(std::as_bytes(words.subspan(kSeamChecksum + 1)))) {
        return bad_seams(LACEDRING_STATUS_CHECKSUM, 0, words);
    }
    const lacedring_seams seams = as_c(*view);
    std::vector<std::uint32_t> scratch(lacedring_seams_scratch(&seams));
    std::uint64_t where = 0;
    lacedring_status status = LACEDRING_STATUS_OK;
    if (vertices == nullptr) {
        status = lacedring_seams_check(&seams, triangles.data(), scratch.data(), &where);
    } else {
        vertices->resize(view->copies);
        status = lacedring_seams_decode_checked(&seams, triangles.data(), scratch.data(), copies.data(),
                                                vertices->data(), &where);
    }
    if (status != LACEDRING_STATUS_OK) return bad_seams(status, where, words);
    return view;
}

}  // namespace

Result<SeamView> validate_seams(std::span<const std::uint32_t> words, std::span<const std::uint32_t> triangles,
                                std::uint32_t vertices) {
    return check_seams(words, triangles, vertices, {}, nullptr);
}

Result<SeamView> decode_seams_checked(std::span<const std::uint32_t> words, std::span<const std::uint32_t> triangles,
                                      std::uint32_t vertex_count, std::span<std::uint32_t> copies,
                                      std::vector<std::uint32_t>& vertices) {
    assert(copies.size() == triangles.size());
    return check_seams(words, triangles, vertex_count, copies, &vertices);
}

void decode_seams(const SeamView& view, std::span<const std::uint32_t> triangles, std::span<std::uint32_t> copies) {
    assert(triangles.size() == std::size_t{3} * view.triangles && copies.size() == triangles.size());
    const lacedring_seams seams = as_c(view);
    std::vector<std::uint32_t> home(std::size_t{view.vertices} + 1);
    lacedring_seams_decode(&seams, triangles.data(), home.data(), copies.data());
}

void decode_seam_block(const SeamView& view, std::uint32_t block, std::span<const std::uint32_t> triangles,
                       std::span<std::uint32_t> copies) {
    assert(block < view.blocks());
    assert(triangles.size() == block_corners(view.triangles, block));
    assert(copies.size() == triangles.size());
    const lacedring_seams seams = as_c(view);
    lacedring_seams_block(&seams, block, triangles.data(), copies.data());
}

std::vector<std::uint32_t> slot_triangles(const StreamView& stream) {
    std::vector<std::uint32_t> out(std::size_t{3} * stream.slots());
    if (const PackedView* packed = stream.get<PackedView>()) {
        decode_packed(*packed, out);
        return out;
    }
    write_slots(stream, 0, out);
    return out;
}

void slot_triangles(const StreamView& stream, std::uint32_t block, std::span<std::uint32_t> triangles) {
    assert(triangles.size() == block_corners(stream.slots(), block));
    const PackedView* packed = stream.get<PackedView>();
    if (packed == nullptr) return write_slots(stream, block * kSeamBlock, triangles);
    constexpr std::size_t kCorners = std::size_t{3} * StreamView::kBlock;
    for (std::uint32_t b = block * (kSeamBlock / StreamView::kBlock); !triangles.empty(); ++b) {
        const std::size_t size = std::min(triangles.size(), kCorners);
        decode_packed_block(*packed, b, triangles.first(size));
        triangles = triangles.subspan(size);
    }
}

void first_copies(const SeamView& view, std::span<std::uint32_t> first) {
    assert(first.size() == std::size_t{view.vertices} + 1);
    const lacedring_seams seams = as_c(view);
    lacedring_seams_homes(&seams, first.data());
    for (std::uint32_t& copy : first) copy >>= 1;
}

void copy_vertices(const SeamView& view, std::span<const std::uint32_t> triangles, std::span<std::uint32_t> vertices) {
    assert(triangles.size() == std::size_t{3} * view.triangles && vertices.size() == view.copies);
    const lacedring_seams seams = as_c(view);
    std::vector<std::uint32_t> home(std::size_t{view.vertices} + 1);
    lacedring_seams_copy_vertices(&seams, triangles.data(), home.data(), vertices.data());
}

CornerCopies::CornerCopies(const StreamView& stream, const SeamView& seams) : stream_(stream), seams_(seams) {
    assert(stream.slots() == seams.triangles && stream.vertices() == seams.vertices);
    for (std::uint32_t i = 0; i < recent_.size(); ++i) recent_[i] = {UINT32_MAX, i};
}

std::uint32_t CornerCopies::copy(std::uint32_t slot, std::uint32_t place) {
    assert(slot < seams_.triangles && place < 3);
    const std::uint32_t block = slot / kSeamBlock;
    auto found = std::ranges::find(recent_, block, &Cached::block);
    if (found == recent_.end()) {
        --found;
        std::array<std::uint32_t, std::size_t{3} * kSeamBlock> buffer;
        const std::span triangles = std::span(buffer).first(block_corners(seams_.triangles, block));
        slot_triangles(stream_, block, triangles);
        decode_seam_block(seams_, block, triangles, std::span(copies_[found->entry]).first(triangles.size()));
        found->block = block;
    }
    std::rotate(recent_.begin(), found, found + 1);
    return copies_[recent_.front().entry][std::size_t{3} * (slot % kSeamBlock) + place];
}

std::uint32_t CornerCopies::copy(CornerId c) {
    const auto in = [&](const auto& tables) {
        const CornerId own = Operators(tables).canonical(c);
        return own.is_null() ? UINT32_MAX : copy(own.value / 4, detail::place_of(tables, own));
    };
    if (const auto* lr = stream_.get<LrStreamView<LrView>>()) return in(lr->view);
    const auto* compact = stream_.get<LrStreamView<CompactLrView>>();
    assert(compact != nullptr);
    return in(compact->view);
}

}  // namespace lacedring
