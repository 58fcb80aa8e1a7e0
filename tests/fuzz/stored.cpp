// The target for streams in storage form: compares what C++ restores with the arrays that C decodes.

#include <algorithm>
#include <array>
#include <optional>

#include "lacedring/lacedring.hpp"
#include "lrcore/codec/storage/packed_storage.h"
#include "lrcore/codec/storage/seam_storage.h"
#include "lrcore/codec/storage/vertex_storage.h"
#include "tests/fuzz/streams.h"
#include "tests/fuzz/use.h"
#include "tests/support/stored_in_c.h"

namespace lacedring::fuzz {
namespace {

// Words of the head: vertices, triangles, and the lengths of the first three parts.
constexpr std::size_t kHead = 5;
constexpr std::uint32_t kMostElements = 4096;

/// The parts of an input: a packed stream, positions, another attribute, seams.
struct Parts {
    std::uint32_t vertices = 0, triangles = 0;
    std::array<Words, 4> words;

    explicit Parts(const Words& from) {
        if (from.size() < kHead) return;
        vertices = from[0] % kMostElements;
        triangles = from[1] % kMostElements;
        auto rest = std::span(from).subspan(kHead);
        for (std::size_t i = 0; i < words.size(); ++i) {
            const auto part = i < 3 ? rest.first(std::min<std::size_t>(from[2 + i], rest.size())) : rest;
            words[i].assign(part.begin(), part.end());
            rest = rest.subspan(part.size());
        }
    }

    Words all() const {
        Words out{vertices, triangles};
        for (std::size_t i = 0; i < 3; ++i) out.push_back(static_cast<std::uint32_t>(words[i].size()));
        for (const Words& part : words) out.insert(out.end(), part.begin(), part.end());
        return out;
    }
};

/// The triangles of the packed stream, or others if it is refused. Sets `accepted`.
Words triangles_of_parts(const Parts& parts, bool& accepted) {
    const storage::PackedLimits limits{parts.vertices, parts.triangles};
    const auto in_c = test::triangles_in_c(parts.words[0], parts.vertices, parts.triangles);
    const auto steps = storage::StoredPacked::read(parts.words[0], limits);
    if (!steps) check_message(steps.error());
    // C refuses degenerate triangles while decoding, C++ when it validates the stream.
    if (const Words own = steps ? steps->triangles() : Words(); !own.empty() && in_c) REQUIRE(in_c == own);
    if (const auto restored = storage::restore_packed(parts.words[0], limits)) {
        if (use_stream(Format::packed, *restored)) REQUIRE(in_c.has_value());
    } else {
        check_message(restored.error());
    }
    accepted = in_c.has_value() && std::ranges::all_of(*in_c, [&](std::uint32_t v) { return v < parts.vertices; });
    if (accepted) return *in_c;
    Words strip;
    for (std::uint32_t i = 0; parts.vertices > 2 && i < parts.triangles; ++i) {
        for (std::uint32_t k = 0; k < 3; ++k) strip.push_back((i / 2 + k * (i % 7 + 1)) % parts.vertices);
    }
    return strip;
}

/// Decodes a vertex stream in C. Checks that C++ restores the same integers, and nothing that C refuses.
std::optional<test::AttributeInC> use_attribute(const Words& stored, std::span<const std::uint32_t> triangles,
                                                std::uint32_t vertices, const storage::VertexPlaces& places) {
    constexpr std::uint64_t kMostWords = 1 << 18;
    (void)storage::view_stored_vertices(stored);
    auto in_c = test::attribute_in_c(stored, triangles, vertices, places);
    const auto restored = storage::restore_vertices(stored, triangles, vertices, kMostWords, places);
    if (!restored) {
        check_message(restored.error());
        return in_c;
    }
    const auto view = validate_vertices(*restored);
    if (!view) return in_c;
    REQUIRE(in_c.has_value());
    Words integers(std::size_t{view->vertices} * view->integers);
    for (std::uint32_t b = 0; b < view->blocks(); ++b)
        decode_vertex_block(*view, b, std::span(integers).subspan(std::size_t{b} * kVertexBlock * view->integers));
    REQUIRE(in_c->integers == integers);
    return in_c;
}

bool run_stored(std::span<const std::byte> bytes) {
    const Parts parts(words_of(bytes));
    bool accepted = false;
    const Words triangles = triangles_of_parts(parts, accepted);
    const auto positions = use_attribute(parts.words[1], triangles, parts.vertices, {});
    const bool places = positions && positions->header.components == 3;
    storage::VertexPlaces at{places ? std::span<const std::uint32_t>(positions->integers) : std::span<std::uint32_t>(),
                             {}};
    const auto seams = test::seams_in_c(parts.words[3], triangles, parts.vertices, 4 * kMostElements);
    const auto restored = storage::restore_seams(parts.words[3], triangles, parts.vertices);
    if (restored && seams) {
        REQUIRE(restored->copies == seams->copies);
        REQUIRE(restored->vertices == seams->vertices);
    }
    if (!restored) check_message(restored.error());
    bool attribute = false;
    if (seams && !seams->copies.empty()) {
        at.vertex_of = seams->vertices;
        const auto copies = static_cast<std::uint32_t>(seams->vertices.size());
        attribute = use_attribute(parts.words[2], seams->copies, copies, at).has_value();
    } else {
        attribute = use_attribute(parts.words[2], triangles, parts.vertices, at).has_value();
    }
    return accepted || positions || attribute;
}

/// Mutates one part; the others mostly keep their contents and positions.
void mutate_stored(Bytes& bytes, std::size_t max_size, Random& random) {
    const Words words = words_of(bytes);
    if (words.size() < kHead || random_below(random, 32) == 0) return mutate_bytes(bytes, max_size);
    Parts parts(words);
    Words& part = parts.words[random_below(random, 4)];
    const auto from = std::as_bytes(std::span(part));
    Bytes changed(from.begin(), from.end());
    mutate_bytes(changed, std::max<std::size_t>(changed.size() + 64, 64));
    part = words_of(changed);
    Words all = parts.all();
    all.resize(std::min(all.size(), max_size / 4));
    const auto out = std::as_bytes(std::span(all));
    bytes.assign(out.begin(), out.end());
}

}  // namespace

extern const Target stored_target{"stored", run_stored, mutate_stored};

}  // namespace lacedring::fuzz
