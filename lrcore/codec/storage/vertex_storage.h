#pragma once
// The storage form of vertex streams. Internal to lrcore. Specified in docs/storage-format.md.

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "lacedring/vertices.hpp"
#include "lrcore/codec/storage/vertex_places.h"

namespace lacedring::storage {

/// The storage form of a valid vertex stream; none if no storage form restores it bit for bit. `triangles`: three
/// numbers below view.vertices each, in any order. With `places`, normals may be stored as differences from the
/// surface's normals. Cost: O(V + T), a few microseconds per vertex.
std::optional<std::vector<std::uint32_t>> store_vertices(const VertexView& view,
                                                         std::span<const std::uint32_t> triangles,
                                                         const VertexPlaces& places = {});

/// Describes the attribute: mapping, type, normalized, components, integers, largest error. The view has no words, and
/// 0 vertices because their number is not stored. Cost: O(1). Errors: malformed. Untrusted input: safe.
Result<VertexView> view_stored_vertices(std::span<const std::uint32_t> stored);

/// Restores a vertex stream in two steps: read() decodes the residuals, before the triangles are known; restore() makes
/// the stream.
class StoredVertices {
  public:
    /// `stored` must outlive the object. Cost: O(vertices); memory for the integers. Errors: malformed. Untrusted
    /// input: safe.
    static Result<StoredVertices> read(std::span<const std::uint32_t> stored, std::uint32_t vertices);

    /// Does restore() need positions?
    bool needs_places() const;

    /// The vertex stream, bit for bit, of at most `most_words` words. It is not validated and may be invalid if
    /// `stored` is. `triangles` and `places`: as for store_vertices. Cost: O(T + V) time; about 35 bytes per triangle
    /// for three integers per vertex. Errors: malformed (also if places are needed and missing), memory_limit.
    /// Untrusted input: safe.
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

/// read() and restore() on one thread.
Result<std::vector<std::uint32_t>> restore_vertices(std::span<const std::uint32_t> stored,
                                                    std::span<const std::uint32_t> triangles, std::uint32_t vertices,
                                                    std::uint64_t most_words, const VertexPlaces& places = {});

}  // namespace lacedring::storage
