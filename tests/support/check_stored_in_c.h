#pragma once
// Checks that stored vertex streams are restored, and that C decodes the same values.

#include <doctest/doctest.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "lrcore/codec/storage/vertex_storage.h"
#include "tests/support/damage.h"
#include "tests/support/stored_in_c.h"

namespace lacedring::test {

/// Decodes a stored stream in C and compares integers, values and header with `view`, the restored stream.
inline void check_in_c(std::span<const std::uint32_t> stored, std::span<const std::uint32_t> triangles,
                       const VertexView& view, const storage::VertexPlaces& places = {}) {
    const auto in_c = attribute_in_c(stored, triangles, view.vertices, places);
    REQUIRE(in_c);
    std::vector<std::uint32_t> integers(std::size_t{view.vertices} * view.integers);
    for (std::uint32_t block = 0; block < view.blocks(); ++block)
        decode_vertex_block(view, block,
                            std::span(integers).subspan(std::size_t{block} * kVertexBlock * view.integers));
    CHECK_MESSAGE(in_c->integers == integers, "C decodes the same integers");
    std::vector<std::byte> values(view.decoded_bytes());
    decode_vertices(view, values);
    CHECK_MESSAGE(in_c->values == values, "C decodes the same values");
    INFO("C reads the same header");
    CHECK(in_c->header.mapping == static_cast<std::uint32_t>(view.mapping));
    CHECK(in_c->header.type == static_cast<std::uint32_t>(view.type));
    CHECK((in_c->header.normalized != 0) == view.normalized);
    CHECK(in_c->header.largest_error == view.largest_error);
    CHECK(in_c->header.step == view.step);
    CHECK(in_c->header.exception_count == view.exceptions);
}

/// Restores a stored vertex stream that may be damaged, to at most `most` words. If the result is valid, C must decode
/// the same values.
inline void check_damaged_in_c(std::span<const std::uint32_t> stored, std::span<const std::uint32_t> triangles,
                               std::uint32_t vertices, std::uint64_t most, const storage::VertexPlaces& places = {}) {
    const auto exact = exact_copy(stored);
    const auto back = storage::restore_vertices({exact.get(), stored.size()}, triangles, vertices, most, places);
    (void)attribute_in_c(stored, triangles, vertices, places);
    if (!back) return;
    CHECK(back->size() <= most);
    CHECK((*back)[1] == vertices);
    if (const Result<VertexView> valid = validate_vertices(*back)) check_in_c(stored, triangles, *valid, places);
}

/// Stores a vertex stream with predictions from positions and returns the stored words. Checks that they are restored,
/// in C too, with the same positions, and refused with none or fewer.
inline std::vector<std::uint32_t> check_stored_by_places(const std::vector<std::uint32_t>& stream,
                                                         std::span<const std::uint32_t> triangles,
                                                         const storage::VertexPlaces& places) {
    const VertexView view = validate_vertices(stream).value();
    const std::vector<std::uint32_t> stored = storage::store_vertices(view, triangles, places).value();
    const auto back = storage::restore_vertices(stored, triangles, view.vertices, stream.size(), places);
    REQUIRE_MESSAGE(back, back.error().message);
    CHECK_MESSAGE(*back == stream, "the stored form restores the stream");
    check_in_c(stored, triangles, view, places);
    const storage::VertexPlaces fewer{places.positions.first(places.positions.size() - 3), places.vertex_of};
    for (const storage::VertexPlaces& bad : {storage::VertexPlaces{}, fewer}) {
        INFO("no positions, or fewer, are refused");
        const auto failed = storage::restore_vertices(stored, triangles, view.vertices, stream.size(), bad);
        CHECK_FALSE(attribute_in_c(stored, triangles, view.vertices, bad).has_value());
        REQUIRE_FALSE(failed);
        CHECK(failed.error().code == ErrorCode::malformed);
        CHECK(failed.error().message.find("positions") != std::string::npos);
    }
    return stored;
}

}  // namespace lacedring::test
