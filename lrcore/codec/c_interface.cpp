// Implements lacedring.h, the C interface, by the C++ interface.

#include <algorithm>
#include <cstring>
#include <new>

#include "lacedring/lacedring.h"
#include "lacedring/lacedring.hpp"
#include "lrcore/codec/c_message.h"
#include "lrcore/codec/decode_slot.h"
#include "lrcore/codec/packed/packed_format.h"

namespace lacedring {
namespace {

static_assert(static_cast<int>(Format::lean) == LACEDRING_FORMAT_LEAN &&
              static_cast<int>(Format::packed) == LACEDRING_FORMAT_PACKED);
static_assert(static_cast<int>(Format::lr) == LACEDRING_FORMAT_LR &&
              static_cast<int>(Format::lr_compact) == LACEDRING_FORMAT_LR_COMPACT);
static_assert(StreamView::kBlock == LACEDRING_BLOCK);

lacedring_code code_of(ErrorCode code) {
    switch (code) {
        case ErrorCode::malformed:
            return LACEDRING_CODE_MALFORMED;
        case ErrorCode::too_large:
            return LACEDRING_CODE_TOO_LARGE;
        default:
            return LACEDRING_CODE_INVALID_ARGUMENT;
    }
}

/// Sets `count` and copies the elements to `to` unless it is null. Returns false if they exceed `capacity`.
bool put(const std::vector<std::uint32_t>& from, std::uint32_t* to, std::size_t capacity, std::size_t& count) {
    count = from.size();
    if (to == nullptr) return true;
    if (capacity < from.size()) return false;
    std::copy(from.begin(), from.end(), to);
    return true;
}

lacedring_code open(const Result<StreamView>& view, std::span<const std::uint32_t> words, lacedring_stream* stream,
                    lacedring_message* message) {
    if (!view) return fail_with(code_of(view.error().code), view.error().message, message);
    stream->words = words.data();
    stream->word_count = words.size();
    stream->format = static_cast<lacedring_format>(view->format());
    stream->vertices = view->vertices();
    stream->triangles = view->triangles();
    stream->slots = view->slots();
    stream->blocks = view->blocks();
    return LACEDRING_CODE_OK;
}

std::span<const std::uint32_t> words_of(const lacedring_stream& stream) {
    return {stream.words, stream.word_count};
}

template <class View>
LrStreamView<View> view_of(const lacedring_tables& t) {
    LrStreamView<View> out;
    out.view.vertices = t.vertices;
    out.view.ring_vertices = t.ring_vertices;
    if constexpr (requires { out.view.unit; }) out.view.unit = t.unit;
    out.view.lr = {t.lr, t.lr_count};
    out.view.vo = {t.vo, t.vo_count};
    out.view.star = {t.star, t.star_count};
    out.view.c = {t.c, t.c_count};
    out.copies = {t.copies, t.copy_count};
    return out;
}

/// Calls work with the Operators for the tables' format.
template <class Work>
auto with_operators(const lacedring_tables* t, Work work) {
    return t->format == LACEDRING_FORMAT_LR ? work(Operators<LrView>(view_of<LrView>(*t).view))
                                            : work(Operators<CompactLrView>(view_of<CompactLrView>(*t).view));
}

template <class View>
void close(const LrStreamView<View>& stream, lacedring_tables* t) {
    t->vertices = stream.view.vertices;
    t->ring_vertices = stream.view.ring_vertices;
    t->unit = 0;
    if constexpr (requires { stream.view.unit; }) t->unit = stream.view.unit;
    const auto put_span = [](std::span<const std::uint32_t> from, const std::uint32_t*& to, std::size_t& count) {
        to = from.data();
        count = from.size();
    };
    put_span(stream.view.lr, t->lr, t->lr_count);
    put_span(stream.view.vo, t->vo, t->vo_count);
    put_span(stream.view.star, t->star, t->star_count);
    put_span(stream.view.c, t->c, t->c_count);
    put_span(stream.copies, t->copies, t->copy_count);
}

template <class Index>
lacedring_code decode_all(const lacedring_stream* stream, Index* indices, std::size_t capacity) {
    if (capacity / 3 < stream->triangles) return LACEDRING_CODE_TOO_SMALL;
    return guarded(nullptr, [&] {
        const Result<StreamView> view = view_stream(words_of(*stream));
        if (!view) return code_of(view.error().code);
        const Result<void> done = decode(*view, std::span(indices, std::size_t{3} * stream->triangles));
        return done ? LACEDRING_CODE_OK : code_of(done.error().code);
    });
}

/// The triangle of a slot; none if the words are not a stream. Skips StreamView, which counts the triangles of LR
/// tables in linear time.
std::optional<Triangle> triangle_of(const lacedring_stream& stream, std::uint32_t slot) {
    const auto decoded = [slot](const auto& view) {
        return view ? detail::decode_slot(*view, slot) : std::optional<Triangle>();
    };
    switch (stream.format) {
        case LACEDRING_FORMAT_LEAN:
            return decoded(view_lean(words_of(stream)));
        case LACEDRING_FORMAT_PACKED:
            return decoded(view_packed(words_of(stream)));
        case LACEDRING_FORMAT_LR:
            return decoded(view_lr(words_of(stream)));
        default:
            return decoded(view_compact_lr(words_of(stream)));
    }
}

}  // namespace
}  // namespace lacedring

using namespace lacedring;

const char* lacedring_code_string(int code) {
    switch (code) {
        case LACEDRING_CODE_OK:
            return "no error";
        case LACEDRING_CODE_MALFORMED:
            return "malformed data";
        case LACEDRING_CODE_INVALID_ARGUMENT:
            return "an argument is out of its range";
        case LACEDRING_CODE_TOO_SMALL:
            return "a buffer is too small";
        case LACEDRING_CODE_TOO_LARGE:
            return "more elements than the format can number";
        case LACEDRING_CODE_OUT_OF_MEMORY:
            return "not enough memory";
    }
    return "unknown code";
}

void lacedring_default_options(lacedring_encode_options* options) {
    *options = {LACEDRING_FORMAT_PACKED, 0, static_cast<int>(EncodeOptions{}.effort), 0, 1};
}

lacedring_code lacedring_encode_bounds(int format, std::size_t index_count, std::uint32_t vertex_count,
                                       lacedring_encoded* encoded) {
    if (index_count % 3 != 0 || format < LACEDRING_FORMAT_LEAN || format > LACEDRING_FORMAT_LR_COMPACT) {
        return LACEDRING_CODE_INVALID_ARGUMENT;
    }
    if (index_count > UINT32_MAX) return LACEDRING_CODE_TOO_LARGE;
    const std::uint64_t triangles = index_count / 3, blocks = (triangles + LR_PACKED_BLOCK - 1) / LR_PACKED_BLOCK;
    std::uint64_t words = 0;
    switch (format) {
        case LACEDRING_FORMAT_LEAN:
            words = LACEDRING_LEAN_HEADER_WORDS + 3 * triangles;
            break;
        // Turn bits, plain blocks of 29 bits per vertex; an entry and a head per group.
        case LACEDRING_FORMAT_PACKED:
            words = LR_PACKED_HEADER_WORDS + blocks * (LR_PACKED_BLOCK_WORDS + 3 * LR_PACKED_BLOCK * 29 / 32) +
                    (blocks / LR_PACKED_GROUP + 1) *
                        (2 + (LR_PACKED_HEAD_BITS +
                              LR_PACKED_GROUP * (1 + 2 * 29 + 1 + LR_PACKED_KIND_BITS + LR_PACKED_MAX_OFFSET_BITS +
                                                 LR_PACKED_MAX_ENTRY_BITS)) /
                                 32) +
                    LR_PACKED_DOUBLES_WORDS + 1;
            break;
        // At most 3T vertices, each 2 words or 1, plus copies; 6 per T0, 3 per other triangle.
        case LACEDRING_FORMAT_LR:
            words = kLrHeaderWords + 21 * triangles;
            break;
        // A word and a record of 8 words per ring vertex.
        case LACEDRING_FORMAT_LR_COMPACT:
            words = kLrHeaderWords + 42 * triangles;
            break;
    }
    const bool tables =
        format == LACEDRING_FORMAT_LR || format == LACEDRING_FORMAT_LR_COMPACT;  // vertices may be copied
    const std::uint64_t vertices = std::uint64_t{vertex_count} + (tables ? index_count : 0);
    if (std::max(words, vertices) > SIZE_MAX / sizeof(std::uint32_t)) return LACEDRING_CODE_TOO_LARGE;
    encoded->word_capacity = static_cast<std::size_t>(words);
    encoded->vertex_capacity = static_cast<std::size_t>(vertices);
    encoded->triangle_capacity = index_count / 3;
    return LACEDRING_CODE_OK;
}

lacedring_code lacedring_encode(const std::uint32_t* indices, std::size_t index_count, std::uint32_t vertex_count,
                                const lacedring_encode_options* options, lacedring_encoded* encoded,
                                lacedring_message* message) {
    return guarded(message, [&] {
        lacedring_encode_options chosen;
        lacedring_default_options(&chosen);
        if (options != nullptr) chosen = *options;
        if (chosen.format < LACEDRING_FORMAT_LEAN || chosen.format > LACEDRING_FORMAT_LR_COMPACT) {
            return fail_with(LACEDRING_CODE_INVALID_ARGUMENT, "no such format", message);
        }
        EncodeOptions how;
        how.format = static_cast<Format>(chosen.format);
        how.profile = chosen.cache != 0 ? PackedProfile::cache : PackedProfile::small;
        how.effort = static_cast<std::uint32_t>(chosen.effort);
        how.wart_skipping = chosen.no_wart_skipping == 0;
        how.threads = static_cast<unsigned>(std::max(chosen.threads, 1));
        const Result<Encoded> made = encode({indices, index_count}, vertex_count, how);
        if (!made) return fail_with(code_of(made.error().code), made.error().message, message);
        encoded->degenerate = made->report.topology.degenerate;
        const bool words = put(made->words, encoded->words, encoded->word_capacity, encoded->word_count);
        const bool vertices =
            put(made->vertex_order, encoded->vertex_order, encoded->vertex_capacity, encoded->vertex_count);
        const bool triangles =
            put(made->triangle_order, encoded->triangle_order, encoded->triangle_capacity, encoded->triangle_count);
        if (words && vertices && triangles) return LACEDRING_CODE_OK;
        return fail_with(LACEDRING_CODE_TOO_SMALL, lacedring_code_string(LACEDRING_CODE_TOO_SMALL), message);
    });
}

lacedring_code lacedring_validate(const std::uint32_t* words, std::size_t word_count, lacedring_stream* stream,
                                  lacedring_message* message) {
    return guarded(message, [&] {
        const std::span all(words, word_count);
        return open(validate(all), all, stream, message);
    });
}

lacedring_code lacedring_view(const std::uint32_t* words, std::size_t word_count, lacedring_stream* stream,
                              lacedring_message* message) {
    return guarded(message, [&] {
        const std::span all(words, word_count);
        return open(view_stream(all), all, stream, message);
    });
}

lacedring_code lacedring_decode_u32(const lacedring_stream* stream, std::uint32_t* indices, std::size_t capacity) {
    return decode_all(stream, indices, capacity);
}
lacedring_code lacedring_decode_u16(const lacedring_stream* stream, std::uint16_t* indices, std::size_t capacity) {
    return decode_all(stream, indices, capacity);
}

lacedring_code lacedring_decode_block(const lacedring_stream* stream, std::uint32_t block, std::uint32_t* indices,
                                      std::size_t capacity, std::uint32_t* triangles) {
    if (block >= stream->blocks) return LACEDRING_CODE_INVALID_ARGUMENT;
    const std::uint32_t first = block * LACEDRING_BLOCK;
    const std::uint32_t count = std::min<std::uint32_t>(stream->slots - first, LACEDRING_BLOCK);
    if (capacity / 3 < count) return LACEDRING_CODE_TOO_SMALL;
    *triangles = 0;
    if (stream->format == LACEDRING_FORMAT_PACKED) {
        return guarded(nullptr, [&] {
            const Result<PackedView> view = view_packed(words_of(*stream));
            if (!view) return code_of(view.error().code);
            decode_packed_block(*view, block, {indices, std::size_t{3} * count});
            *triangles = count;
            return LACEDRING_CODE_OK;
        });
    }
    for (std::uint32_t slot = first; slot < first + count; ++slot) {
        if (lacedring_decode_triangle(stream, slot, indices + std::size_t{3} * *triangles) != 0) ++*triangles;
    }
    return LACEDRING_CODE_OK;
}

int lacedring_decode_triangle(const lacedring_stream* stream, std::uint32_t slot, std::uint32_t triangle[3]) {
    if (slot >= stream->slots) return 0;
    std::optional<Triangle> found;
    (void)guarded(nullptr, [&] {
        found = triangle_of(*stream, slot);
        return LACEDRING_CODE_OK;
    });
    if (!found) return 0;
    std::copy(found->v, found->v + 3, triangle);
    return 1;
}

lacedring_code lacedring_open_tables(const lacedring_stream* stream, lacedring_tables* tables) {
    tables->format = stream->format;
    if (stream->format != LACEDRING_FORMAT_LR && stream->format != LACEDRING_FORMAT_LR_COMPACT) {
        return LACEDRING_CODE_INVALID_ARGUMENT;
    }
    return guarded(nullptr, [&] {
        const auto put_tables = [&](const auto& view) {
            if (!view) return code_of(view.error().code);
            close(*view, tables);
            return LACEDRING_CODE_OK;
        };
        return stream->format == LACEDRING_FORMAT_LR ? put_tables(view_lr(words_of(*stream)))
                                                     : put_tables(view_compact_lr(words_of(*stream)));
    });
}

int lacedring_is_triangle(const lacedring_tables* tables, std::uint32_t t) {
    return with_operators(tables, [&](const auto& ops) {
        return t < ops.store().triangle_numbers() && ops.is_canonical(TriangleId(t)) ? 1 : 0;
    });
}
std::uint32_t lacedring_triangle(std::uint32_t corner) {
    return corner == LACEDRING_NULL ? corner : Operators<LrView>::triangle(CornerId(corner)).value;
}
std::uint32_t lacedring_corner_of_triangle(std::uint32_t t) {
    return t == LACEDRING_NULL ? t : Operators<LrView>::corner(TriangleId(t)).value;
}
std::uint32_t lacedring_next(std::uint32_t corner) {
    return corner == LACEDRING_NULL ? corner : Operators<LrView>::next(CornerId(corner)).value;
}
std::uint32_t lacedring_previous(std::uint32_t corner) {
    return corner == LACEDRING_NULL ? corner : Operators<LrView>::previous(CornerId(corner)).value;
}
std::uint32_t lacedring_vertex(const lacedring_tables* tables, std::uint32_t corner) {
    if (corner == LACEDRING_NULL) return corner;
    return with_operators(tables, [&](const auto& ops) { return ops.vertex(CornerId(corner)).value; });
}
std::uint32_t lacedring_opposite(const lacedring_tables* tables, std::uint32_t corner) {
    if (corner == LACEDRING_NULL) return corner;
    return with_operators(tables, [&](const auto& ops) { return ops.opposite(CornerId(corner)).value; });
}
std::uint32_t lacedring_left(const lacedring_tables* tables, std::uint32_t corner) {
    if (corner == LACEDRING_NULL) return corner;
    return with_operators(tables, [&](const auto& ops) { return ops.left(CornerId(corner)).value; });
}
std::uint32_t lacedring_right(const lacedring_tables* tables, std::uint32_t corner) {
    if (corner == LACEDRING_NULL) return corner;
    return with_operators(tables, [&](const auto& ops) { return ops.right(CornerId(corner)).value; });
}
std::uint32_t lacedring_swing(const lacedring_tables* tables, std::uint32_t corner) {
    if (corner == LACEDRING_NULL) return corner;
    return with_operators(tables, [&](const auto& ops) { return ops.swing(CornerId(corner)).value; });
}
std::uint32_t lacedring_corner_of_vertex(const lacedring_tables* tables, std::uint32_t v) {
    if (v == LACEDRING_NULL) return v;
    return with_operators(tables, [&](const auto& ops) { return ops.corner(VertexId(v)).value; });
}
std::uint32_t lacedring_original(const lacedring_tables* tables, std::uint32_t v) {
    return view_of<LrView>(*tables).original(v);
}
int lacedring_is_border(const lacedring_tables* tables, std::uint32_t v) {
    if (v == LACEDRING_NULL) return 0;
    return with_operators(tables, [&](const auto& ops) { return ops.is_border(VertexId(v)) ? 1 : 0; });
}
std::uint32_t lacedring_valence(const lacedring_tables* tables, std::uint32_t v) {
    if (v == LACEDRING_NULL) return 0;
    return with_operators(tables, [&](const auto& ops) { return ops.valence(VertexId(v)); });
}
std::uint32_t lacedring_neighbors(const lacedring_tables* tables, std::uint32_t v, std::uint32_t* neighbors,
                                  std::uint32_t capacity) {
    std::uint32_t count = 0;
    if (v == LACEDRING_NULL) return count;
    with_operators(tables, [&](const auto& ops) {
        ops.neighbors(VertexId(v), [&](VertexId u) {
            if (count < capacity) neighbors[count] = u.value;
            ++count;
        });
        return 0;
    });
    return count;
}
