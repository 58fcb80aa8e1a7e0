#pragma once
// The storage form of seam sections. Internal to lrcore. Specified in docs/storage-format.md.

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "lacedring/seams.hpp"

namespace lacedring::storage {

/// The storage form of a seam section that is valid for these triangles; none if no storage form restores it bit for
/// bit. Cost: O(T log T), under a microsecond per triangle.
std::optional<std::vector<std::uint32_t>> store_seams(const SeamView& view, std::span<const std::uint32_t> triangles);

/// A section, and the results of decode_seams and copy_vertices for it.
struct RestoredSeams {
    std::vector<std::uint32_t> words;
    std::vector<std::uint32_t> copies;    ///< copy of each corner
    std::vector<std::uint32_t> vertices;  ///< vertex of each copy
};

/// The section, bit for bit. The result is always valid for the triangles, which are the slots of a connectivity stream
/// (slot_triangles). Cost: O(T log T) time, O(T) if vertices have few triangles; about 150 bytes per triangle. Errors:
/// malformed, too_large. Untrusted input, including triangles: safe.
Result<RestoredSeams> restore_seams(std::span<const std::uint32_t> stored, std::span<const std::uint32_t> triangles,
                                    std::uint32_t vertices);

}  // namespace lacedring::storage
