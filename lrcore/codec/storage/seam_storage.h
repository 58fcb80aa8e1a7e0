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

/// A section, and what decode_seams and copy_vertices make of it.
struct RestoredSeams {
    std::vector<std::uint32_t> words;
    std::vector<std::uint32_t> copies;    ///< of each corner
    std::vector<std::uint32_t> vertices;  ///< of each copy
};

/// The section, bit for bit. Whatever is stored: it is valid for the triangles, which are the slots of a connectivity
/// (slot_triangles). Cost: O(T log T) time, O(T) where vertices have few triangles; some 150 bytes a triangle. Errors:
/// malformed, too_large. Untrusted input, triangles included: safe.
Result<RestoredSeams> restore_seams(std::span<const std::uint32_t> stored, std::span<const std::uint32_t> triangles,
                                    std::uint32_t vertices);

}  // namespace lacedring::storage
