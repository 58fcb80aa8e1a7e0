// The C++ interface of lean streams, on the decoder and checks in lacedring_decode.h (C).

#include <cassert>

#include "lacedring/streams.hpp"

#define LACEDRING_DECODE_IMPLEMENTATION
#include "lacedring/lacedring_decode.h"
#include "lacedring/lacedring_seams.h"
#include "lacedring/lacedring_storage.h"
#include "lacedring/lacedring_stored_seams.h"
#include "lacedring/lacedring_vertices.h"
#include "lrcore/base/crc32.h"
#include "lrcore/base/message.h"
#include "lrcore/base/signature.h"
#include "lrcore/codec/lean/lean_format.h"
#include "lrcore/codec/packed/packed_format.h"

namespace lacedring {
namespace {

static_assert(LR_LEAN_MAGIC == magic::kLean);
static_assert(LR_LEAN_HEADER_WORDS == LACEDRING_LEAN_HEADER_WORDS);
// Constants of the packed stream's decoder that only the C implementation defines.
static_assert(LACEDRING_SPLIT_ == LR_PACKED_SPLIT && LACEDRING_BESIDE_ == LR_PACKED_BESIDE &&
              LACEDRING_START_ == LR_PACKED_START && LACEDRING_FAR_ == LR_PACKED_FAR &&
              LACEDRING_JUMP_ == LR_PACKED_JUMP && LACEDRING_TURN_ == LR_PACKED_TURN &&
              LACEDRING_FLIPS_ == LR_PACKED_FLIPS && LACEDRING_NO_EVENT_ == LR_PACKED_EVENT_CODES);

lacedring_lean as_c(const LeanView& view) {
    return {view.payload.data(), view.vertices, view.rings2, view.rings1, view.verbatim, view.triangles};
}

LeanView from_c(const lacedring_lean& lean, std::size_t payload) {
    return {{lean.payload, payload}, lean.vertices, lean.rings2, lean.rings1, lean.verbatim, lean.triangles};
}

/// Describes the fault in English. `words` has a header unless it is too short for one.
std::string why(lacedring_status status, std::uint64_t where, std::span<const std::uint32_t> words) {
    using detail::message;
    const auto ring_vertex = [&] {
        const std::uint32_t rings2 = words[LR_LEAN_WORD_RINGS2];
        return message("ring vertex ", where < 2 * std::uint64_t{rings2} ? where / 2 : where - rings2, ": ");
    };
    const auto word = [&] { return words[LR_LEAN_HEADER_WORDS + where]; };
    switch (status) {
        case LACEDRING_STATUS_OK:
            return {};
        case LACEDRING_STATUS_SHORT:
            return "shorter than its header";
        case LACEDRING_STATUS_MAGIC:
            return wrong_magic(words, "a lean stream");
        case LACEDRING_STATUS_VERSION:
            return message("version ", where, " is not ", LR_LEAN_VERSION);
        case LACEDRING_STATUS_VERTICES:
            return message(words[LR_LEAN_WORD_VERTICES], " vertices");
        case LACEDRING_STATUS_RING_VERTICES:
            return "more ring vertices than vertices";
        case LACEDRING_STATUS_SIZE:
            return message(words.size() - LR_LEAN_HEADER_WORDS, " references; the header says ", where);
        case LACEDRING_STATUS_SLOTS:
            return "too many slots";
        case LACEDRING_STATUS_CHECKSUM:
            return "checksum does not match";
        case LACEDRING_STATUS_TIP:
            return message(ring_vertex(), "tip ", word() & LR_LEAN_TIP_MASK, " of ", words[LR_LEAN_WORD_VERTICES],
                           " vertices");
        case LACEDRING_STATUS_OPEN_RING:
            return message("the ring from vertex ", where, " does not close");
        case LACEDRING_STATUS_SHORT_RING:
            return message("the ring from vertex ", where, " has fewer than three vertices");
        case LACEDRING_STATUS_CLOSING_WORD:
            return message(ring_vertex(), "closing word ", detail::hexadecimal(word()));
        case LACEDRING_STATUS_WORD:
            return message(ring_vertex(), "word ", detail::hexadecimal(word()));
        case LACEDRING_STATUS_VERBATIM: {
            const auto triangle = words.subspan(words.size() - 3 * (words[LR_LEAN_WORD_VERBATIM] - where), 3);
            return message("verbatim triangle ", where, ": ", triangle[0], " ", triangle[1], " ", triangle[2]);
        }
        case LACEDRING_STATUS_TRIANGLES:
            return message(where, " triangles; the header says ", words[LR_LEAN_WORD_TRIANGLES]);
        case LACEDRING_STATUS_GROUP:
        case LACEDRING_STATUS_BLOCK:
        case LACEDRING_STATUS_HEADER:
        case LACEDRING_STATUS_TURNS:
        case LACEDRING_STATUS_DOUBLES:
            break;  // packed streams only
        case LACEDRING_STATUS_VERTEX_BLOCK:
        case LACEDRING_STATUS_TRIANGLE:
            break;  // seam sections only
        case LACEDRING_STATUS_LIMIT:
        case LACEDRING_STATUS_CODED:
        case LACEDRING_STATUS_INTEGER:
        case LACEDRING_STATUS_POSITIONS:
        case LACEDRING_STATUS_COPY:
            break;  // storage form only
    }
    return "unknown";
}

Error malformed(lacedring_status status, std::uint64_t where, std::span<const std::uint32_t> words) {
    return {ErrorCode::malformed, "lean stream: " + why(status, where, words)};
}

}  // namespace

std::size_t LeanView::bytes() const {
    return (LR_LEAN_HEADER_WORDS + references()) * sizeof(std::uint32_t);
}

std::uint32_t lean_checksum(std::span<const std::uint32_t> words) {
    const std::uint32_t header = crc32(std::as_bytes(words.first(LR_LEAN_WORD_CHECKSUM)));
    return crc32(std::as_bytes(words.subspan(LR_LEAN_HEADER_WORDS)), header);
}

Result<LeanView> view_lean(std::span<const std::uint32_t> words) {
    lacedring_lean lean;
    std::uint64_t where = 0;
    const lacedring_status status = lacedring_lean_open(words.data(), words.size(), &lean, &where);
    if (status != LACEDRING_STATUS_OK) return malformed(status, where, words);
    return from_c(lean, words.size() - LR_LEAN_HEADER_WORDS);
}

Result<LeanView> validate_lean(std::span<const std::uint32_t> words) {
    Result<LeanView> view = view_lean(words);
    if (!view) return view;
    // Computed here because crc32 is several times faster than the C file's version with a small table.
    if (words[LR_LEAN_WORD_CHECKSUM] != lean_checksum(words)) return malformed(LACEDRING_STATUS_CHECKSUM, 0, words);
    const lacedring_lean lean = as_c(*view);
    std::uint64_t where = 0;
    const lacedring_status status = lacedring_lean_check(&lean, &where);
    if (status != LACEDRING_STATUS_OK) return malformed(status, where, words);
    return view;
}

Triangle decode_lean_slot(const LeanView& view, std::uint32_t slot) {
    const lacedring_lean lean = as_c(view);
    Triangle out;
    lacedring_lean_slot(&lean, slot, out.v);
    return out;
}

void decode_lean(const LeanView& view, std::span<std::uint32_t> indices) {
    assert(indices.size() == std::size_t{3} * view.slots());
    const lacedring_lean lean = as_c(view);
    lacedring_lean_decode(&lean, indices.data());
}

void decode_lean_triangles(const LeanView& view, std::span<std::uint32_t> indices) {
    assert(indices.size() == std::size_t{3} * view.triangles);
    const lacedring_lean lean = as_c(view);
    lacedring_lean_triangles_u32(&lean, indices.data());
}

}  // namespace lacedring
