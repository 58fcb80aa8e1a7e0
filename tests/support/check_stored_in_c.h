#pragma once
// Checks that C decodes a stored vertex stream to what it restores to.

#include <doctest/doctest.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "tests/support/stored_in_c.h"

namespace lacedring::test {

/// Compares what C decodes with the stream that it restores to.
inline void check_in_c(std::span<const std::uint32_t> stored, std::span<const std::uint32_t> triangles,
                       const VertexView& view, const storage::VertexPlaces& places = {}) {
    const auto in_c = attribute_in_c(stored, triangles, view.vertices, places);
    REQUIRE(in_c);
    std::vector<std::uint32_t> integers(std::size_t{view.vertices} * view.integers);
    for (std::uint32_t block = 0; block < view.blocks(); ++block)
        decode_vertex_block(view, block,
                            std::span(integers).subspan(std::size_t{block} * kVertexBlock * view.integers));
    CHECK(in_c->integers == integers);
    std::vector<std::byte> values(view.decoded_bytes());
    decode_vertices(view, values);
    CHECK(in_c->values == values);
    CHECK(in_c->header.mapping == static_cast<std::uint32_t>(view.mapping));
    CHECK(in_c->header.type == static_cast<std::uint32_t>(view.type));
    CHECK((in_c->header.normalized != 0) == view.normalized);
    CHECK(in_c->header.largest_error == view.largest_error);
    CHECK(in_c->header.step == view.step);
    CHECK(in_c->header.exception_count == view.exceptions);
}

}  // namespace lacedring::test
