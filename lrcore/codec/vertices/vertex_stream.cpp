// The C++ interface of vertex streams, on the decoder and checks in lacedring_vertices.h (C).

#include <bit>
#include <cassert>

#include "lacedring/lacedring_vertices.h"
#include "lacedring/vertices.hpp"
#include "lrcore/base/crc32.h"
#include "lrcore/base/message.h"
#include "lrcore/base/signature.h"
#include "lrcore/base/try.h"

namespace lacedring {
namespace {

static_assert(std::endian::native == std::endian::little, "streams are little-endian words");
static_assert(kVertexBlock == LACEDRING_VERTICES_BLOCK);

constexpr std::size_t kChecksumWord = 3;

/// Describes the fault in English.
std::string vertex_fault(lacedring_status status, std::uint64_t where, std::span<const std::uint32_t> words) {
    using detail::message;
    switch (status) {
        case LACEDRING_STATUS_SHORT:
            return "shorter than its header";
        case LACEDRING_STATUS_MAGIC:
            return wrong_magic(words, "a vertex stream");
        case LACEDRING_STATUS_HEADER:
            return message("word ", where, " of the header is invalid");
        case LACEDRING_STATUS_SIZE:
            return message(words.size(), " words do not match the size of its blocks");
        case LACEDRING_STATUS_CHECKSUM:
            return "checksum does not match";
        case LACEDRING_STATUS_GROUP:
            return message("block ", where, ": its group has a wrong beginning");
        case LACEDRING_STATUS_BLOCK:
            return message("block ", where, " is invalid");
        default:
            return "unknown";
    }
}

Error bad_vertices(lacedring_status status, std::uint64_t where, std::span<const std::uint32_t> words) {
    return {ErrorCode::malformed, "vertex stream: " + vertex_fault(status, where, words)};
}

lacedring_vertices as_c(std::span<const std::uint32_t> words) {
    lacedring_vertices out{};
    [[maybe_unused]] const lacedring_status status = lacedring_vertices_open(words.data(), words.size(), &out, nullptr);
    assert(status == LACEDRING_STATUS_OK);
    return out;
}

/// Checks the checksum and everything that decoders rely on. Also writes the values if `values` is not null.
Result<void> check_vertices(std::span<const std::uint32_t> words, std::byte* values) {
    const std::uint32_t header = crc32(std::as_bytes(words.first(kChecksumWord)));
    if (words[kChecksumWord] != crc32(std::as_bytes(words.subspan(kChecksumWord + 1)), header)) {
        return bad_vertices(LACEDRING_STATUS_CHECKSUM, 0, words);
    }
    const lacedring_vertices stream = as_c(words);
    std::uint64_t where = 0;
    const lacedring_status status = values == nullptr ? lacedring_vertices_check(&stream, &where)
                                                      : lacedring_vertices_decode_checked(&stream, values, &where);
    if (status != LACEDRING_STATUS_OK) return bad_vertices(status, where, words);
    return {};
}

}  // namespace

Result<VertexView> view_vertices(std::span<const std::uint32_t> words) {
    lacedring_vertices stream;
    std::uint64_t where = 0;
    const lacedring_status status = lacedring_vertices_open(words.data(), words.size(), &stream, &where);
    if (status != LACEDRING_STATUS_OK) return bad_vertices(status, where, words);
    VertexView view;
    view.words = words;
    view.vertices = stream.vertices;
    view.mapping = static_cast<VertexMapping>(stream.mapping);
    view.type = static_cast<ComponentType>(stream.type);
    view.normalized = stream.normalized != 0;
    view.components = static_cast<std::uint8_t>(lacedring_vertices_values(&stream));
    view.integers = static_cast<std::uint8_t>(stream.components);
    view.bits = static_cast<std::uint8_t>(stream.bits);
    view.digits = static_cast<std::uint8_t>(stream.digits);
    view.exceptions = stream.exception_count;
    view.step = stream.step;
    view.largest_error = stream.largest_error;
    return view;
}

Result<VertexView> validate_vertices(std::span<const std::uint32_t> words) {
    Result<VertexView> view = view_vertices(words);
    if (!view) return view;
    LR_TRY(check_vertices(words, nullptr));
    return view;
}

Result<void> decode_vertices_checked(const VertexView& view, std::span<std::byte> values) {
    assert(values.size() == view.decoded_bytes());
    return check_vertices(view.words, values.data());
}

void decode_vertices(const VertexView& view, std::span<std::byte> values) {
    assert(values.size() == view.decoded_bytes());
    const lacedring_vertices stream = as_c(view.words);
    lacedring_vertices_decode(&stream, values.data());
}

void decode_vertex_block(const VertexView& view, std::uint32_t block, std::span<std::uint32_t> integers) {
    assert(block < view.blocks());
    assert(integers.size() >=
           std::size_t{view.integers} * std::min(view.vertices - block * kVertexBlock, kVertexBlock));
    const lacedring_vertices stream = as_c(view.words);
    lacedring_vertices_blocks(&stream, block, block + 1, integers.data());
}

}  // namespace lacedring
