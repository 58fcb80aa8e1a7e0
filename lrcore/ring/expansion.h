#pragma once
// How expand_rings came to its rings, to be watched. Paper: LR 2011, section 4.2, Figure 3.

#include <cstdint>
#include <vector>

#include "lrcore/base/ids.h"
#include "lrcore/topology/corner_table.h"

namespace lr {

/// The triangles that expand_rings invaded, in that order; of each ring those from the seed that it kept.
struct Expansion {
    /// Ring after ring: the seed, then for each triangle its corner c that faces the edge it was entered across (the
    /// paper's c). vertex(c) is on no ring until then; opposite(c) is in a triangle that was invaded before. A ring of
    /// n vertices has n - 2 of them.
    std::vector<CornerId> corners;
    std::vector<std::uint32_t> first;  ///< where each ring begins in `corners`; one more entry at the end

    bool operator==(const Expansion&) const = default;
};

/// A triangle that is never invaded has this bit in its step.
constexpr std::uint32_t kNeverInvaded = 0x80000000U;

/// When it is settled on which side each triangle lies. A triangle of step s is settled once more than s triangles are
/// invaded: by being the last of those, or, with kNeverInvaded, because its last vertex was reached through another
/// one. What has a vertex on no ring, or is degenerate, is settled with the last triangle invaded. So the rings so far,
/// after n triangles, are the edges between a triangle that is invaded (step < n) and one that is not (yet); such an
/// edge stays on its ring if that one is settled (step & ~kNeverInvaded < n), and may still be crossed if it is not.
/// Cost: O(T) time, 4 bytes a triangle for the result, 4 a vertex while it runs.
std::vector<std::uint32_t> settling_steps(const CornerTable& table, const Expansion& expansion);

}  // namespace lr
