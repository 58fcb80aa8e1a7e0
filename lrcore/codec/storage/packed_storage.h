#pragma once
// The storage form of packed streams. Internal to lrcore; docs/storage-format.md has it.

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "lacedring/streams.hpp"
#include "lrcore/codec/storage/packed_steps.h"

namespace lacedring::storage {

/// The most that a restored stream may have. The caller takes them from the file, or from the memory that it allows.
struct PackedLimits {
    std::uint32_t vertices = 0, triangles = 0;
};

/// The storage form of a packed stream, which is valid; none: it has none that gives it back bit for bit. Cost: O(T log
/// T).
std::optional<std::vector<std::uint32_t>> store_packed(const PackedView& view);

/// A stored packed stream on the way to the packed stream, in two steps: triangles are known before it is written.
class StoredPacked {
  public:
    /// `stored` has to outlive this. Cost: O(T); 25 bytes a triangle and 1 a vertex. Errors: malformed. Untrusted
    /// input: safe.
    static Result<StoredPacked> read(std::span<const std::uint32_t> stored, const PackedLimits& limits);

    /// The triangles, where these are the steps' alone, without doubles; else none.
    std::vector<std::uint32_t> triangles() const;

    /// The packed stream, bit for bit. It is not validated: what is stored may say anything. Errors: too_large.
    Result<std::vector<std::uint32_t>> write() const;

  private:
    PackedSteps steps_;
    std::uint32_t vertices_ = 0, runs_ = 0;
    std::span<const std::uint32_t> doubles_;
};

/// Both steps.
Result<std::vector<std::uint32_t>> restore_packed(std::span<const std::uint32_t> stored, const PackedLimits& limits);

}  // namespace lacedring::storage
