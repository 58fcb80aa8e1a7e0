// Calls the decoder of a stream's format.

#include <algorithm>
#include <array>

#include "lacedring/operators.hpp"
#include "lacedring/streams.hpp"
#include "lrcore/base/message.h"
#include "lrcore/base/signature.h"
#include "lrcore/base/try.h"
#include "lrcore/codec/decode_slot.h"

namespace lacedring {
namespace {

template <class... Cases>
struct Overload : Cases... {
    using Cases::operator()...;
};
template <class... Cases>
Overload(Cases...) -> Overload<Cases...>;  // clang 14 needs this deduction guide

static_assert(std::is_same_v<std::variant_alternative_t<std::size_t(Format::packed), StreamView::Any>, PackedView>);
static_assert(std::is_same_v<std::variant_alternative_t<std::size_t(Format::lr_compact), StreamView::Any>,
                             LrStreamView<CompactLrView>>);

template <class View>
Result<StreamView::Any> any(const Result<View>& view) {
    if (!view) return view.error();
    return StreamView::Any(*view);
}

Result<StreamView::Any> open(std::span<const std::uint32_t> words, bool check) {
    switch (words.empty() ? 0 : words[0]) {
        case magic::kLean:
            return any(check ? validate_lean(words) : view_lean(words));
        case magic::kPacked:
        case magic::kPacked1:
            return any(check ? validate_packed(words) : view_packed(words));
        case magic::kLr:
            return any(check ? validate_lr(words) : view_lr(words));
        case magic::kCompactLr:
            return any(check ? validate_compact_lr(words) : view_compact_lr(words));
        default:
            return Error{ErrorCode::malformed, wrong_magic(words, "a stream")};
    }
}

template <class Indices>
Error wrong_size(const StreamView& view, const Indices& indices) {
    return {ErrorCode::invalid_argument,
            detail::message("room for ", indices.size(), " indices, not for three of each of ", view.triangles(),
                            " triangles")};
}

/// Decodes all triangles block by block, for index types that the decoders do not write.
template <class Index>
void decode_blocks(const StreamView& view, Index* out) {
    std::array<std::uint32_t, std::size_t{3} * StreamView::kBlock> block{};
    for (std::uint32_t b = 0; b < view.blocks(); ++b) {
        const Result<std::uint32_t> triangles = decode_block(view, b, block);
        const std::size_t count = std::size_t{3} * *triangles;
        out = std::transform(block.begin(), block.begin() + static_cast<std::ptrdiff_t>(count), out,
                             [](std::uint32_t v) { return static_cast<Index>(v); });
    }
}

}  // namespace

const char* name_of(Format format) {
    constexpr const char* kNames[] = {"lean", "packed", "lr", "lr-compact"};
    return kNames[static_cast<std::size_t>(format)];
}

StreamView::StreamView(const Any& any_view) : view_(any_view) {
    const auto tables = [this](const auto& stream) {
        vertices_ = stream.view.vertices;
        slots_ = stream.view.triangle_numbers();
        triangles_ = detail::count_triangles(stream);
    };
    std::visit(Overload{[this](const LeanView& view) {
                            vertices_ = view.vertices;
                            slots_ = view.slots();
                            triangles_ = view.triangles;
                        },
                        [this](const PackedView& view) {
                            vertices_ = view.vertices;
                            slots_ = triangles_ = view.triangles;
                        },
                        [&](const LrStreamView<LrView>& stream) { tables(stream); },
                        [&](const LrStreamView<CompactLrView>& stream) { tables(stream); }},
               view_);
}

Result<StreamView> view_stream(std::span<const std::uint32_t> words) {
    LR_ASSIGN(const StreamView::Any view, open(words, false));
    if (const auto* compact = std::get_if<LrStreamView<CompactLrView>>(&view)) {
        for (const std::uint32_t w : compact->view.lr) {  // StreamView counts triangles, which reads the records
            if (CompactLrView::is_long(w) && compact->view.record(w) + 1 >= compact->view.star.size()) {
                return Error{ErrorCode::malformed, "LR tables: a record outside VO*"};
            }
        }
    }
    return StreamView(view);
}

Result<StreamView> validate(std::span<const std::uint32_t> words) {
    LR_ASSIGN(const StreamView::Any view, open(words, true));
    return StreamView(view);
}

Result<StreamView> validate(std::span<const std::byte> bytes) {
    if (reinterpret_cast<std::uintptr_t>(bytes.data()) % alignof(std::uint32_t) != 0) {
        return Error{ErrorCode::invalid_argument, "the stream does not begin at a multiple of four bytes"};
    }
    if (bytes.size() % sizeof(std::uint32_t) != 0) {
        return Error{ErrorCode::malformed, detail::message(bytes.size(), " bytes are not a whole number of words")};
    }
    return validate(
        std::span(reinterpret_cast<const std::uint32_t*>(bytes.data()), bytes.size() / sizeof(std::uint32_t)));
}

Result<void> decode(const StreamView& view, std::span<std::uint32_t> indices, unsigned threads) {
    if (indices.size() != std::size_t{3} * view.triangles()) return wrong_size(view, indices);
    if (const PackedView* packed = view.get<PackedView>()) {
        decode_packed(*packed, indices, threads);
    } else if (const auto* lr = view.get<LrStreamView<LrView>>()) {
        detail::decode_tables(*lr, indices.data());
    } else if (const auto* compact = view.get<LrStreamView<CompactLrView>>()) {
        detail::decode_tables(*compact, indices.data());
    } else {
        decode_lean_triangles(*view.get<LeanView>(), indices);
    }
    return {};
}

Result<void> decode(const StreamView& view, std::span<std::uint16_t> indices) {
    if (indices.size() != std::size_t{3} * view.triangles()) return wrong_size(view, indices);
    if (view.vertices() > 65536) {
        return Error{ErrorCode::invalid_argument,
                     detail::message(view.vertices(), " vertices; 16-bit indices number at most 65536")};
    }
    decode_blocks(view, indices.data());
    return {};
}

std::vector<std::uint32_t> decode(const StreamView& view) {
    std::vector<std::uint32_t> indices(std::size_t{3} * view.triangles());
    (void)decode(view, indices);
    return indices;
}

Result<std::uint32_t> decode_block(const StreamView& view, std::uint32_t block, std::span<std::uint32_t> indices) {
    if (block >= view.blocks()) {
        return Error{ErrorCode::invalid_argument, detail::message("block ", block, " of ", view.blocks())};
    }
    const std::uint32_t first = block * StreamView::kBlock, count = std::min(view.slots() - first, StreamView::kBlock);
    if (indices.size() < std::size_t{3} * count) {
        return Error{
            ErrorCode::invalid_argument,
            detail::message("room for ", indices.size(), " indices, not for three of each of ", count, " slots")};
    }
    if (const PackedView* packed = view.get<PackedView>()) {
        decode_packed_block(*packed, block, indices);
        return count;
    }
    std::uint32_t triangles = 0;
    for (std::uint32_t slot = first; slot < first + count; ++slot) {
        if (const std::optional<Triangle> t = decode_triangle(view, slot)) {
            std::copy(t->v, t->v + 3, indices.begin() + std::ptrdiff_t{3} * triangles++);
        }
    }
    return triangles;
}

std::optional<Triangle> decode_triangle(const StreamView& view, std::uint32_t slot) {
    if (slot >= view.slots()) return std::nullopt;
    return std::visit([slot](const auto& own) { return detail::decode_slot(own, slot); }, view.view_);
}

}  // namespace lacedring
