// Headers, checksums, and what decoders rely on. Everything here may meet hostile words.

#include "lrcore/base/crc32.h"
#include "lrcore/base/message.h"
#include "lrcore/base/signature.h"
#include "lrcore/codec/lean/lean_format.h"
#include "lrcore/codec/lean/lean_stream.h"

namespace lr {
namespace {

static_assert(LR_LEAN_MAGIC == magic::kLean);

Error malformed(std::string message) {
    return {ErrorCode::malformed, "lean stream: " + std::move(message)};
}

/// Checks the rings of one section. Ring vertices are begin..end-1, with `sides` words each.
class SectionChecker {
  public:
    SectionChecker(const LeanView& view, std::uint32_t begin, std::uint32_t end, std::uint32_t sides,
                   std::size_t first_word)
        : view_(view), begin_(begin), end_(end), sides_(sides), words_(view.payload.subspan(first_word)) {}

    /// Empty, or what is wrong. Adds the triangles that are not degenerate.
    std::string check(std::uint64_t& triangles) const {
        std::uint32_t first = begin_;
        for (std::uint32_t v = begin_; v < end_; ++v) {
            for (std::uint32_t side = 0; side < sides_; ++side) {
                if ((word(v, side) & LR_LEAN_TIP_MASK) >= view_.vertices) {
                    return detail::message("ring vertex ", v, ": tip ", word(v, side) & LR_LEAN_TIP_MASK, " of ",
                                           view_.vertices, " vertices");
                }
            }
            if (!closes(v)) continue;
            if (std::string why = check_ring(first, v, triangles); !why.empty()) return why;
            first = v + 1;
        }
        if (first != end_) return detail::message("the ring from vertex ", first, " does not close");
        return {};
    }

  private:
    std::uint32_t word(std::uint32_t v, std::uint32_t side) const {
        return words_[std::size_t{v - begin_} * sides_ + side];
    }
    bool closes(std::uint32_t v) const {
        for (std::uint32_t side = 0; side < sides_; ++side) {
            if ((word(v, side) & LR_LEAN_CLOSE_FLAG) != 0) return true;
        }
        return false;
    }

    std::string check_ring(std::uint32_t first, std::uint32_t last, std::uint64_t& triangles) const {
        if (last - first < 2) return detail::message("the ring from vertex ", first, " has fewer than three");
        const auto next = [&](std::uint32_t v) { return v == last ? first : v + 1; };
        bool closed = false;
        for (std::uint32_t v = first; v <= last; ++v) {
            for (std::uint32_t side = 0; side < sides_; ++side) {
                const std::uint32_t w = word(v, side), tip = w & LR_LEAN_TIP_MASK, flags = w & ~LR_LEAN_TIP_MASK;
                if ((flags & LR_LEAN_CLOSE_FLAG) != 0) {
                    if (closed || flags != LR_LEAN_CLOSE_FLAG || tip != first) {
                        return detail::message("ring vertex ", v, ": closing word ", detail::hexadecimal(w));
                    }
                    closed = true;
                    continue;
                }
                const std::uint32_t end = (flags & LR_LEAN_WART_FLAG) != 0 ? next(next(v)) : next(v);
                const bool degenerate = tip == v || tip == end;
                const bool free = flags == 0 && tip == (side == 0 ? v : end);
                if (degenerate && !free) return detail::message("ring vertex ", v, ": word ", detail::hexadecimal(w));
                if (!degenerate) ++triangles;
            }
        }
        return {};
    }

    const LeanView& view_;
    std::uint32_t begin_, end_, sides_;
    std::span<const std::uint32_t> words_;
};

}  // namespace

std::size_t LeanView::bytes() const {
    return (LR_LEAN_HEADER_WORDS + references()) * sizeof(std::uint32_t);
}

std::uint32_t lean_checksum(std::span<const std::uint32_t> words) {
    const std::uint32_t header = crc32(std::as_bytes(words.first(LR_LEAN_WORD_CHECKSUM)));
    return crc32(std::as_bytes(words.subspan(LR_LEAN_HEADER_WORDS)), header);
}

Result<LeanView> view_lean(std::span<const std::uint32_t> words) {
    if (words.size() < LR_LEAN_HEADER_WORDS) return malformed("shorter than its header");
    if (words[LR_LEAN_WORD_MAGIC] != LR_LEAN_MAGIC) return malformed(wrong_magic(words, "a lean stream"));
    if (words[LR_LEAN_WORD_VERSION] != LR_LEAN_VERSION) {
        return malformed(detail::message("version ", words[LR_LEAN_WORD_VERSION], " is not ", LR_LEAN_VERSION));
    }
    LeanView view;
    view.payload = words.subspan(LR_LEAN_HEADER_WORDS);
    view.vertices = words[LR_LEAN_WORD_VERTICES];
    view.rings2 = words[LR_LEAN_WORD_RINGS2];
    view.rings1 = words[LR_LEAN_WORD_RINGS1];
    view.verbatim = words[LR_LEAN_WORD_VERBATIM];
    view.triangles = words[LR_LEAN_WORD_TRIANGLES];
    if (view.vertices > LR_LEAN_TIP_MASK + 1) return malformed(detail::message(view.vertices, " vertices"));
    if (std::uint64_t{view.rings2} + view.rings1 > view.vertices) return malformed("more ring vertices than vertices");
    const std::uint64_t references = std::uint64_t{2} * view.rings2 + view.rings1 + std::uint64_t{3} * view.verbatim;
    if (references != view.payload.size()) {
        return malformed(detail::message(view.payload.size(), " references, where the header says ", references));
    }
    if (std::uint64_t{2} * view.rings2 + view.rings1 + view.verbatim > UINT32_MAX / 3)
        return malformed("too many slots");
    return view;
}

Result<LeanView> validate_lean(std::span<const std::uint32_t> words) {
    Result<LeanView> view = view_lean(words);
    if (!view) return view;
    if (words[LR_LEAN_WORD_CHECKSUM] != lean_checksum(words)) return malformed("checksum does not match");
    std::uint64_t triangles = 0;
    const std::uint32_t rings = view->rings2 + view->rings1;
    std::string why = SectionChecker(*view, 0, view->rings2, 2, 0).check(triangles);
    if (why.empty()) {
        why = SectionChecker(*view, view->rings2, rings, 1, std::size_t{2} * view->rings2).check(triangles);
    }
    if (!why.empty()) return malformed(std::move(why));
    const std::span<const std::uint32_t> verbatim = view->payload.subspan(view->ring_slots());
    for (std::size_t i = 0; i < verbatim.size(); i += 3, ++triangles) {
        const std::uint32_t a = verbatim[i], b = verbatim[i + 1], c = verbatim[i + 2];
        if (a >= view->vertices || b >= view->vertices || c >= view->vertices || a == b || b == c || c == a) {
            return malformed(detail::message("verbatim triangle ", i / 3, ": ", a, " ", b, " ", c));
        }
    }
    if (triangles != view->triangles) {
        return malformed(detail::message(triangles, " triangles, where the header says ", view->triangles));
    }
    return view;
}

}  // namespace lr
