#pragma once
// The storage form of packed streams. Internal to lrcore; docs/storage-format.md has it.

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "lacedring/streams.hpp"

namespace lacedring::storage {

/// The most that a restored stream may have. The caller takes them from the file, or from the memory that it allows.
struct PackedLimits {
    std::uint32_t vertices = 0, triangles = 0;
};

/// The storage form of a packed stream, which is valid; none: it has none that gives it back bit for bit. Cost: O(T log
/// T).
std::optional<std::vector<std::uint32_t>> store_packed(const PackedView& view);

/// The packed stream, bit for bit. It is not validated: what is stored may say anything. Cost: O(T); 33 bytes a
/// triangle and 2 a vertex beside the stream. Errors: malformed, too_large. Untrusted input: safe.
Result<std::vector<std::uint32_t>> restore_packed(std::span<const std::uint32_t> stored, const PackedLimits& limits);

}  // namespace lacedring::storage
