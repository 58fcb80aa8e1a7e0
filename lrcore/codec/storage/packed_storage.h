#pragma once
// The storage form of packed streams. Internal to lrcore. Specified in docs/storage-format.md.

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "lacedring/streams.hpp"
#include "lrcore/codec/storage/packed_steps.h"

namespace lacedring::storage {

/// Limits of a restored stream. The caller derives them from the file or from the memory it allows.
struct PackedLimits {
    std::uint32_t vertices = 0, triangles = 0;
};

/// The storage form of a valid packed stream; none if no storage form restores it bit for bit. Cost: O(T log T).
std::optional<std::vector<std::uint32_t>> store_packed(const PackedView& view);

/// Restores a packed stream in two steps: read() yields the triangles, write() the stream.
class StoredPacked {
  public:
    /// `stored` must outlive the object. Cost: O(T); 25 bytes per triangle and 1 per vertex. Errors: malformed.
    /// Untrusted input: safe.
    static Result<StoredPacked> read(std::span<const std::uint32_t> stored, const PackedLimits& limits);

    /// The triangles; empty if the stream has doubles.
    std::vector<std::uint32_t> triangles() const;

    /// The packed stream, bit for bit. It is not validated and may be invalid if `stored` is. Errors: too_large.
    Result<std::vector<std::uint32_t>> write() const;

  private:
    PackedSteps steps_;
    std::uint32_t vertices_ = 0, runs_ = 0;
    std::span<const std::uint32_t> doubles_;
};

/// read() and write() in one call.
Result<std::vector<std::uint32_t>> restore_packed(std::span<const std::uint32_t> stored, const PackedLimits& limits);

}  // namespace lacedring::storage
