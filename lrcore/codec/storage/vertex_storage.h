#pragma once
// The storage form of vertex streams. Internal to lrcore; docs/storage-format.md has it.

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "lacedring/vertices.hpp"
#include "lrcore/codec/storage/vertex_places.h"

namespace lacedring::storage {

/// The storage form of a vertex stream, which is valid; none: it has none that gives it back bit for bit. `triangles`:
/// three numbers below view.vertices each, in any order. With `places`, normals and texture coordinates may be
/// predicted by them. Cost: O(V + T), a few microseconds a vertex.
std::optional<std::vector<std::uint32_t>> store_vertices(const VertexView& view,
                                                         std::span<const std::uint32_t> triangles,
                                                         const VertexPlaces& places = {});

/// Describes the attribute: mapping, type, normalized, components, integers, largest error. The view has no words, and
/// 0 vertices, since their number is not stored. Cost: O(1). Errors: malformed. Untrusted input: safe.
Result<VertexView> view_stored_vertices(std::span<const std::uint32_t> stored);

/// The vertex stream, bit for bit. It is not validated: what is stored may say anything. `places` are those of
/// store_vertices; malformed, if the stream needs them and they are none. Cost: O(T + V + what is
/// stored) time; some 50 bytes a triangle, for a few components; at most `most_words` words. Errors: malformed,
/// memory_limit. Untrusted input: safe.
Result<std::vector<std::uint32_t>> restore_vertices(std::span<const std::uint32_t> stored,
                                                    std::span<const std::uint32_t> triangles, std::uint32_t vertices,
                                                    std::uint64_t most_words, const VertexPlaces& places = {});

}  // namespace lacedring::storage
