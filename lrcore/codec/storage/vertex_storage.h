#pragma once
// The storage form of vertex streams. Internal to lrcore; docs/storage-format.md has it.

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "lacedring/vertices.hpp"
#include "lrcore/codec/storage/vertex_places.h"

namespace lacedring::storage {

/// The storage form of a vertex stream, which is valid; none: it has none that gives it back bit for bit. `triangles`:
/// three numbers below view.vertices each, in any order. With `places`, normals may be stored as differences from the
/// surface's. Cost: O(V + T), a few microseconds a vertex.
std::optional<std::vector<std::uint32_t>> store_vertices(const VertexView& view,
                                                         std::span<const std::uint32_t> triangles,
                                                         const VertexPlaces& places = {});

/// Describes the attribute: mapping, type, normalized, components, integers, largest error. The view has no words, and
/// 0 vertices, since their number is not stored. Cost: O(1). Errors: malformed. Untrusted input: safe.
Result<VertexView> view_stored_vertices(std::span<const std::uint32_t> stored);

/// A stored vertex stream on the way to the vertex stream, in two steps: its residuals can be read before the triangles
/// are known.
class StoredVertices {
  public:
    /// `stored` has to outlive this. Cost: O(vertices); the integers' size in memory. Errors: malformed. Untrusted
    /// input: safe.
    static Result<StoredVertices> read(std::span<const std::uint32_t> stored, std::uint32_t vertices);

    /// Are these normals that restore needs places for?
    bool needs_places() const;

    /// The vertex stream, bit for bit. It is not validated: what is stored may say anything. At most `most_words`
    /// words. `triangles`: three numbers of vertices each. `places`: those of store_vertices; where they are needed and
    /// there are none, it is an error. Cost: O(T + V) time; some 35 bytes a triangle, for three integers a vertex.
    /// Errors: malformed, memory_limit. Untrusted input: safe.
    Result<std::vector<std::uint32_t>> restore(std::span<const std::uint32_t> triangles, std::uint64_t most_words,
                                               const VertexPlaces& places, unsigned threads) &&;

    StoredVertices(StoredVertices&&) noexcept;
    StoredVertices& operator=(StoredVertices&&) noexcept;
    ~StoredVertices();

  private:
    struct State;
    explicit StoredVertices(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

/// Both steps on one thread.
Result<std::vector<std::uint32_t>> restore_vertices(std::span<const std::uint32_t> stored,
                                                    std::span<const std::uint32_t> triangles, std::uint32_t vertices,
                                                    std::uint64_t most_words, const VertexPlaces& places = {});

}  // namespace lacedring::storage
