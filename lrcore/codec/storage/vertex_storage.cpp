#include "lrcore/codec/storage/vertex_storage.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cassert>
#include <cstring>
#include <type_traits>

#include "lrcore/base/message.h"
#include "lrcore/base/parallel.h"
#include "lrcore/base/try.h"
#include "lrcore/codec/storage/block_coder.h"
#include "lrcore/codec/storage/normal_base.h"
#include "lrcore/codec/storage/parameter_search.h"
#include "lrcore/codec/storage/place_prediction.h"

namespace lacedring::storage {
namespace {

using Words = std::vector<std::uint32_t>;

constexpr std::uint32_t kLayoutBits = 23;
constexpr std::uint32_t kChunk = 1U << 16;  ///< vertices whose blocks form one part
static_assert(kChunk % (kVertexGroup * kVertexBlock) == 0);

/// The contents of a stream.
struct StoredStream {
    std::uint32_t vertices = 0;
    StreamChoices choices;
    VertexParameters parameters;
    bool by_places = false;  // the integers are differences from a prediction by positions
    NormalBase base;         // normals only
    Words exceptions;        // two words each
    Words values;
    std::vector<BlockChoices> blocks;  // encoder only

    std::uint32_t components() const { return choices.layout & 31; }
    std::uint32_t mapping() const { return choices.layout >> 5 & 7; }
    std::uint32_t bits() const { return choices.layout >> 13 & 31; }
    bool is_octahedral() const { return static_cast<VertexMapping>(mapping()) == VertexMapping::octahedral; }
};

Error malformed_vertices(const char* what) {
    return {ErrorCode::malformed, detail::message("stored vertex stream: ", what)};
}

/// Appends a part: the number of its words, then the words.
void add_part(Encoder& coder, Words& out) {
    const Words words = coder.finish();
    out.push_back(static_cast<std::uint32_t>(words.size()));
    out.insert(out.end(), words.begin(), words.end());
}

/// Removes a part from the front of `rest`. Returns an empty span, which a Decoder rejects, if the part is truncated.
std::span<const std::uint32_t> take_part(std::span<const std::uint32_t>& rest) {
    if (rest.empty() || rest[0] > rest.size() - 1) return {};
    const auto part = rest.subspan(1, rest[0]);
    rest = rest.subspan(1 + part.size());
    return part;
}

/// Codes whether and how positions predict attributes of two integers per vertex.
template <class Coder>
bool code_places(Coder& coder, StoredStream& stream) {
    if (stream.components() != 2) return true;
    stream.by_places = coder.raw(stream.by_places ? 1 : 0, 1) != 0;
    if (!stream.by_places || !stream.is_octahedral()) return true;
    for (bool NormalBase::*flag : {&NormalBase::by_angle, &NormalBase::by_area, &NormalBase::of_vertex})
        stream.base.*flag = coder.raw(stream.base.*flag ? 1 : 0, 1) != 0;
    return stream.bits() >= 2 && stream.bits() <= 16;
}

/// Codes the header of a stream. `has_usual_ranges`: the ranges are those of find_vertex_ranges; a Decoder computes
/// them later, when it has the integers.
template <class Coder>
bool code_header(Coder& coder, StoredStream& stream, bool& has_usual_ranges) {
    StreamChoices& choices = stream.choices;
    choices.layout = coder.raw(choices.layout, kLayoutBits);
    const std::uint32_t n = stream.components();
    if (n == 0 || n > kMostComponents) return false;
    const auto mapping = static_cast<VertexMapping>(stream.mapping());
    if (mapping == VertexMapping::lattice) choices.lattice = coder.raw(choices.lattice, 32);
    if (mapping == VertexMapping::decimals) choices.lattice = coder.raw(choices.lattice, 4);
    if (mapping == VertexMapping::lattice || mapping == VertexMapping::octahedral)
        choices.error = coder.raw(choices.error, 32);
    has_usual_ranges = coder.raw(has_usual_ranges ? 1 : 0, 1) != 0;
    choices.components.resize(n);
    for (VertexComponent& c : choices.components) {
        c.width = coder.raw(c.width, 5);
        c.predictor = coder.raw(c.predictor, 5);
        if (has_usual_ranges) continue;
        c.low = coder.raw(c.low, 32);
        c.first_bits = coder.raw(c.first_bits, 6);
        if (c.first_bits > 32) return false;
    }
    VertexParameters& p = stream.parameters;
    for (std::uint32_t c = 0; c < n; ++c)
        p.rules[c] = static_cast<VertexRule>(coder.raw(static_cast<std::uint32_t>(p.rules[c]), 2));
    p.has_normal = coder.raw(p.has_normal ? 1 : 0, 1) != 0;
    p.error = coder.raw(p.error, 4);
    p.smooth = coder.raw(p.smooth, 5);
    p.fine = coder.raw(p.fine, 4);
    return code_places(coder, stream) && p.smooth <= 16 && !(p.has_normal && n != 3);
}

template <class Coder>
bool code_exceptions(Coder& coder, StoredStream& stream) {
    if (static_cast<VertexMapping>(stream.mapping()) != VertexMapping::decimals) return true;
    const std::uint32_t count = coder.raw(static_cast<std::uint32_t>(stream.exceptions.size() / 2), 32);
    NumberModel distance;
    BitModel same;
    std::uint64_t next = 0;            // lower bound of the exception's number
    std::uint32_t last = 0x80000000U;  // -0, the most frequent exception
    for (std::uint32_t i = 0; i < count; ++i) {
        if constexpr (Coder::kDecodes) stream.exceptions.resize(2 * std::size_t{i} + 2);
        std::uint32_t* at = stream.exceptions.data() + 2 * std::size_t{i};
        const std::uint64_t number = next + distance.code(coder, at[0] - static_cast<std::uint32_t>(next));
        if (number >= std::uint64_t{stream.vertices} * stream.components() || number > UINT32_MAX || coder.bad())
            return false;
        at[0] = static_cast<std::uint32_t>(number);
        if (coder.bit(same, at[1] != last ? 1 : 0) != 0) last = coder.raw(at[1], 32);
        at[1] = last;
        next = number + 1;
    }
    return true;
}

/// The blocks of a chunk as bits, and the first bit of each.
struct BlocksOut {
    BlockBits bits;
    std::vector<std::uint64_t> begins;
};

/// Codes and writes the blocks of vertices [first, end).
template <class Coder>
bool code_blocks(Coder& coder, StoredStream& stream, std::uint32_t first, std::uint32_t end, std::uint64_t most_words,
                 BlocksOut& out) {
    BlockCoder<Coder> blocks(coder, stream.choices.components, out.bits);
    const std::uint32_t n = stream.components();
    for (; first < end; first += std::min(end - first, kVertexBlock)) {
        if (out.begins.size() % kVertexGroup == 0) out.bits.align();
        if (out.bits.words() > most_words || coder.bad()) return false;
        BlockChoices own;
        BlockChoices& choices = Coder::kDecodes ? own : stream.blocks[first / kVertexBlock];
        out.begins.push_back(out.bits.bits());
        const std::uint32_t count = std::min(end - first, kVertexBlock);
        if (!blocks.code(stream.values.data() + std::size_t{first} * n, count, choices)) return false;
    }
    out.bits.align();
    return true;
}

/// Assembles the vertex stream from its parts.
Result<Words> assemble(const StoredStream& stream, std::span<const BlocksOut> chunks, std::uint64_t most_words) {
    Words data;
    std::vector<std::uint64_t> begins;
    for (const BlocksOut& chunk : chunks) {
        const std::uint64_t begin = std::uint64_t{32} * data.size();
        for (const std::uint64_t b : chunk.begins) begins.push_back(begin + b);
        const auto words = chunk.bits.finished();
        data.insert(data.end(), words.begin(), words.end());
    }
    VertexStreamParts parts;
    parts.vertices = stream.vertices;
    parts.layout = stream.choices.layout;
    parts.parameter = stream.choices.lattice;
    parts.largest_error = stream.choices.error;
    parts.components = stream.choices.components;
    parts.exceptions = stream.exceptions;
    parts.begins = begins;
    parts.data = data;
    if (parts.size() > most_words) return Error{ErrorCode::memory_limit, "stored vertex stream: too large"};
    if (data.size() > UINT32_MAX) return malformed_vertices("more words than its table can number");
    for (std::size_t b = 0; b < begins.size(); ++b) {
        if ((begins[b] - begins[b / kVertexGroup * kVertexGroup]) >> parts.field_bits() == 0) continue;
        return malformed_vertices("a block is farther than its table can express");
    }
    return make_vertex_stream(parts);
}

StoredStream parts_of(const VertexView& view) {
    lacedring_vertices stream;
    [[maybe_unused]] const lacedring_status status =
        lacedring_vertices_open(view.words.data(), view.words.size(), &stream, nullptr);
    assert(status == LACEDRING_STATUS_OK);
    StoredStream out;
    out.vertices = view.vertices;
    out.choices.layout = view.words[2];
    out.choices.lattice = view.words[4];
    out.choices.error = view.words[5];
    for (std::uint32_t c = 0; c < view.integers; ++c) {
        const std::uint32_t said = stream.parameters[2 * c + 1];
        out.choices.components.push_back({stream.parameters[2 * c], said & 63, said >> 6 & 31, said >> 11 & 31});
    }
    out.exceptions.assign(stream.exceptions, stream.exceptions + std::size_t{2} * view.exceptions);
    out.values.resize(std::size_t{view.vertices} * view.integers);
    if (view.vertices > 0) lacedring_vertices_blocks(&stream, 0, view.blocks(), out.values.data());
    out.blocks = read_choices(stream);
    return out;
}

/// The differences of the integers from a prediction by positions, two per vertex.
Words differences_of(StoredStream& stream, const WalkRecord& walk, std::span<const std::uint32_t> triangles,
                     const VertexPlaces& places) {
    Words out = stream.values;
    if (stream.is_octahedral()) {
        stream.base = nearest_base(places, triangles, stream.values, stream.bits());
        subtract_normals(out, surface_normals(places, triangles, stream.vertices, stream.base, stream.bits()),
                         stream.bits());
        return out;
    }
    struct Nothing {
        void start(std::uint32_t, std::uint32_t) {}
        void predicted(std::uint32_t, const Parallelograms&) {}
    } nothing;
    const PlacePrediction prediction(places);
    PlaceVisitor<false, Nothing> visitor(prediction, stream.values, out, nothing);
    walk.run(visitor);
    return out;
}

/// Chooses the parameters. Returns the integers to code.
Words choose_prediction(StoredStream& stream, const WalkRecord& walk, std::span<const std::uint32_t> triangles,
                        const VertexPlaces& places) {
    const std::uint32_t n = stream.components();
    ParameterSearch plain(walk, n, stream.values, false);
    stream.parameters = plain.best();
    if (n != 2 || places.positions.empty() || !has_places(places, stream.vertices)) return stream.values;
    Words differences = differences_of(stream, walk, triangles, places);
    ParameterSearch with(walk, n, differences, true);
    const VertexParameters parameters = with.best();
    if (with.least() >= plain.least()) return stream.values;
    stream.parameters = parameters;
    stream.by_places = true;
    return differences;
}

/// Computes the values from the residuals.
void restore_values(StoredStream& stream, std::span<std::uint32_t> residuals, std::span<const std::uint32_t> triangles,
                    const VertexPlaces& places) {
    // Made first, since its construction needs more memory than the walk itself.
    VertexWalk walk(triangles, stream.vertices);
    stream.values.resize(residuals.size());
    if (stream.by_places && !stream.is_octahedral()) {
        Words differences(residuals.size());
        VertexPredictor<2, true> predictor(stream.parameters, 2, differences, residuals);
        const PlacePrediction prediction(places);
        PlaceVisitor<true, VertexPredictor<2, true>> visitor(prediction, stream.values, differences, predictor);
        walk.run(visitor);
        return;
    }
    predict<true>(walk, stream.parameters, stream.components(), stream.values, residuals);
    if (!stream.by_places) return;
    walk = VertexWalk({}, 0);  // frees its memory
    add_normals(stream.values, surface_normals(places, triangles, stream.vertices, stream.base, stream.bits()),
                stream.bits());
}

}  // namespace

std::optional<std::vector<std::uint32_t>> store_vertices(const VertexView& view,
                                                         std::span<const std::uint32_t> triangles,
                                                         const VertexPlaces& places) {
    StoredStream stream = parts_of(view);
    const std::uint32_t n = stream.components();
    WalkRecord walk;
    VertexWalk(triangles, view.vertices).run(walk);
    Words integers = choose_prediction(stream, walk, triangles, places);
    std::vector<VertexComponent> usual(n);
    find_vertex_ranges(stream.values, static_cast<VertexMapping>(stream.mapping()), usual);
    bool has_usual_ranges = true;
    for (std::uint32_t c = 0; c < n; ++c) {
        const VertexComponent& own = stream.choices.components[c];
        has_usual_ranges &= own.low == usual[c].low && own.first_bits == usual[c].first_bits;
    }
    Encoder coder;
    if (!code_header(coder, stream, has_usual_ranges)) return {};
    Words residuals(stream.values.size());
    predict<false>(walk, stream.parameters, n, integers, residuals);
    code_residuals(coder, n, stream.parameters.fine, residuals);
    if (!code_exceptions(coder, stream)) return {};
    Words out;
    add_part(coder, out);
    for (std::uint32_t first = 0; first < view.vertices; first += std::min(view.vertices - first, kChunk)) {
        Encoder blocks;
        BlocksOut written;
        const std::uint32_t end = first + std::min(view.vertices - first, kChunk);
        if (!code_blocks(blocks, stream, first, end, UINT64_MAX, written)) return {};
        add_part(blocks, out);
    }
    const auto restored = restore_vertices(out, triangles, view.vertices, view.words.size(), places);
    if (!restored || !std::ranges::equal(*restored, view.words)) return {};
    return out;
}

/// Reads the header from the first part.
Result<StoredStream> read_header(Decoder& coder, bool& has_usual_ranges) {
    StoredStream out;
    const Error error = malformed_vertices("its header is invalid");
    if (coder.bad() || !code_header(coder, out, has_usual_ranges) || coder.bad()) return error;
    const std::uint32_t type = out.choices.layout >> 8 & 15;
    if (type > static_cast<std::uint32_t>(ComponentType::f64) || out.mapping() > 5) return error;
    return out;
}

Result<VertexView> view_stored_vertices(std::span<const std::uint32_t> stored) {
    std::span<const std::uint32_t> rest = stored;
    Decoder coder(take_part(rest));
    bool has_usual_ranges = false;
    LR_ASSIGN(const StoredStream stream, read_header(coder, has_usual_ranges));
    const std::uint32_t n = stream.components();
    VertexView out;
    out.mapping = static_cast<VertexMapping>(stream.mapping());
    out.type = static_cast<ComponentType>(stream.choices.layout >> 8 & 15);
    out.normalized = (stream.choices.layout >> 12 & 1) != 0;
    out.integers = static_cast<std::uint8_t>(n);
    const std::uint32_t values = out.mapping == VertexMapping::octahedral ? n + 1
                                 : out.mapping == VertexMapping::doubles  ? n / 2
                                                                          : n;
    out.components = static_cast<std::uint8_t>(values);
    out.largest_error = std::bit_cast<float>(stream.choices.error);
    return out;
}

struct StoredVertices::State {
    StoredStream stream;
    bool has_usual_ranges = false;
    Words residuals;                                     // in the walk's order
    std::vector<std::span<const std::uint32_t>> chunks;  // coded parts of blocks
};

StoredVertices::StoredVertices(std::unique_ptr<State> state) : state_(std::move(state)) {}
StoredVertices::StoredVertices(StoredVertices&&) noexcept = default;
StoredVertices& StoredVertices::operator=(StoredVertices&&) noexcept = default;
StoredVertices::~StoredVertices() = default;

bool StoredVertices::needs_places() const {
    return state_->stream.by_places;
}

Result<StoredVertices> StoredVertices::read(std::span<const std::uint32_t> stored, std::uint32_t vertices) {
    std::span<const std::uint32_t> rest = stored;
    Decoder coder(take_part(rest));
    auto state = std::make_unique<State>();
    LR_ASSIGN(StoredStream header, read_header(coder, state->has_usual_ranges));
    StoredStream& stream = state->stream = std::move(header);
    stream.vertices = vertices;
    const std::uint32_t n = stream.components();
    state->residuals.resize(std::size_t{vertices} * n);
    code_residuals(coder, n, stream.parameters.fine, state->residuals);
    if (coder.bad()) return malformed_vertices("its integers end early");
    if (!code_exceptions(coder, stream)) return malformed_vertices("an exception is invalid");
    const Error error = malformed_vertices("its parts do not end at its end");
    if (!coder.is_at_end()) return error;
    for (std::uint32_t first = 0; first < vertices; first += std::min(vertices - first, kChunk)) {
        state->chunks.push_back(take_part(rest));
    }
    if (!rest.empty()) return error;
    return StoredVertices(std::move(state));
}

Result<std::vector<std::uint32_t>> StoredVertices::restore(std::span<const std::uint32_t> triangles,
                                                           std::uint64_t most_words, const VertexPlaces& places,
                                                           unsigned threads) && {
    StoredStream& stream = state_->stream;
    if (triangles.size() > UINT32_MAX || triangles.size() % 3 != 0)
        return malformed_vertices("invalid number of corners");
    for (const std::uint32_t v : triangles) {
        if (v >= stream.vertices) return malformed_vertices("a triangle has a vertex out of range");
    }
    if (stream.by_places && (places.positions.empty() || !has_places(places, stream.vertices)))
        return malformed_vertices("it needs the mesh's positions as integers");
    const std::uint32_t n = stream.components();
    restore_values(stream, state_->residuals, triangles, places);
    state_->residuals = {};
    if (state_->has_usual_ranges) {
        find_vertex_ranges(stream.values, static_cast<VertexMapping>(stream.mapping()), stream.choices.components);
    } else {
        for (std::size_t i = 0; i < stream.values.size(); ++i) {
            const VertexComponent& c = stream.choices.components[i % n];
            if (static_cast<std::uint64_t>(stream.values[i] - c.low) >> c.first_bits != 0)
                return malformed_vertices("an integer is out of range");
        }
    }
    std::vector<BlocksOut> blocks(state_->chunks.size());
    std::atomic<bool> is_good = true, is_large = false;
    detail::in_parallel(threads, static_cast<std::uint32_t>(blocks.size()), [&](std::uint32_t i) {
        Decoder coder(state_->chunks[i]);
        const std::uint32_t first = i * kChunk, end = first + std::min(stream.vertices - first, kChunk);
        if (code_blocks(coder, stream, first, end, most_words, blocks[i]) && coder.is_at_end()) return;
        is_good = false;
        if (blocks[i].bits.words() > most_words) is_large = true;
    });
    if (is_large) return Error{ErrorCode::memory_limit, "stored vertex stream: too large"};
    if (!is_good) return malformed_vertices("a block is invalid");
    return assemble(stream, blocks, most_words);
}

Result<std::vector<std::uint32_t>> restore_vertices(std::span<const std::uint32_t> stored,
                                                    std::span<const std::uint32_t> triangles, std::uint32_t vertices,
                                                    std::uint64_t most_words, const VertexPlaces& places) {
    LR_ASSIGN(StoredVertices read, StoredVertices::read(stored, vertices));
    return std::move(read).restore(triangles, most_words, places, 1);
}

}  // namespace lacedring::storage
