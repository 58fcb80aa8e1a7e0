#pragma once
// From the copies of a surface's corners to the words of a section, for encode_seams and for what restores sections.
// Internal to lrcore.

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "lrcore/codec/seams/seam_codes.h"
#include "lrcore/codec/seams/seam_homes.h"

namespace lacedring {

/// Copies that are known to be sound: of a triangle's three vertices, which differ, or UINT32_MAX three times; each
/// below `count`, and of one vertex.
struct SeamCopies {
    std::span<const std::uint32_t> triangles;
    std::uint32_t vertices = 0;
    std::span<const std::uint32_t> copies;  ///< of each corner
    std::uint32_t count = 0;
};

struct SeamWords {
    std::vector<std::uint32_t> words;  ///< empty: more than 4 GiB
    std::vector<std::uint32_t> order;  ///< the copy of each number of the section; UINT32_MAX: of no corner
};

/// Chooses a section's table, of what decoders ask about vertices and about corners.
using SeamTableChoice = std::function<SeamTable(const SeamAnswers& vertices, const SeamAnswers& corners)>;

/// The section of the copies. `skip_plain`: the table is not chosen by blocks that have no copies; these take no bits,
/// mostly. `corners` are those of the triangles. Cost: O(T log T), 60 bytes a triangle; where there is no seam, some 10
/// ns a triangle.
SeamWords write_seams(const SeamCopies& copies, const VertexCorners& corners, const SeamTableChoice& choose,
                      bool skip_plain);

}  // namespace lacedring
