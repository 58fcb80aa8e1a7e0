#pragma once
// The storage form of seam sections. Internal to lrcore; docs/storage-format.md has it.

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "lacedring/seams.hpp"

namespace lacedring::storage {

/// The storage form of a seam section, which is valid for these triangles; none: it has none that gives it back bit for
/// bit. Cost: O(T log T), under a microsecond a triangle.
std::optional<std::vector<std::uint32_t>> store_seams(const SeamView& view, std::span<const std::uint32_t> triangles);

/// The section, bit for bit. It is not validated: what is stored may say anything. `triangles`: slots of a connectivity
/// (slot_triangles). Cost: O(T log T) time, O(T) where vertices have few triangles; some 150 bytes a triangle. Errors:
/// malformed, too_large. Untrusted input, triangles included: safe.
Result<std::vector<std::uint32_t>> restore_seams(std::span<const std::uint32_t> stored,
                                                 std::span<const std::uint32_t> triangles, std::uint32_t vertices);

}  // namespace lacedring::storage
