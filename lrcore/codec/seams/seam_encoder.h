#pragma once
// Encodes the copies of a surface's corners as a section. Used by encode_seams and by the storage form's decoder.
// Internal to lrcore.

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "lrcore/codec/seams/seam_codes.h"
#include "lrcore/codec/seams/seam_homes.h"

namespace lacedring {

/// Copies that have been checked. A triangle has three different vertices, or UINT32_MAX three times. Each copy is
/// below `count` and belongs to one vertex.
struct SeamCopies {
    std::span<const std::uint32_t> triangles;
    std::uint32_t vertices = 0;
    std::span<const std::uint32_t> copies;  ///< per corner
    std::uint32_t count = 0;
};

struct SeamWords {
    std::vector<std::uint32_t> words;  ///< empty if it would exceed 4 GiB
    std::vector<std::uint32_t> order;  ///< copy by the section's number; UINT32_MAX: no corner has it
};

/// Chooses a section's table from its answers about vertices and about corners.
using SeamTableChoice = std::function<SeamTable(const SeamAnswers& vertices, const SeamAnswers& corners)>;

/// Encodes the section of the copies. `corners` is made from the triangles. With `skip_plain`, blocks without copies do
/// not influence the table; they usually take no bits. Cost: O(T log T), 60 bytes per triangle; without seams about 10
/// ns per triangle.
SeamWords write_seams(const SeamCopies& copies, const VertexCorners& corners, const SeamTableChoice& choose,
                      bool skip_plain);

}  // namespace lacedring
