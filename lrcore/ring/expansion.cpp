#include <algorithm>

#include "lacedring/ring.hpp"

namespace lacedring {

std::vector<std::uint32_t> settling_steps(const CornerTable& table, const Expansion& expansion) {
    const auto last = static_cast<std::uint32_t>(std::max<std::size_t>(expansion.corners.size(), 1) - 1);
    std::vector<std::uint32_t> reached(table.vertex_count, last), steps(table.triangle_count(), kNeverInvaded);
    for (std::size_t r = 0; r + 1 < expansion.first.size(); ++r) {
        const std::uint32_t begin = expansion.first[r];
        const CornerId seed = expansion.corners[begin];
        for (const CornerId c : {next(seed), previous(seed)}) reached[table.vertex(c).value] = begin;
        for (std::uint32_t i = begin; i < expansion.first[r + 1]; ++i) {
            const CornerId c = expansion.corners[i];
            steps[triangle(c).value] = i;
            reached[table.vertex(c).value] = i;
        }
    }
    for (std::uint32_t t = 0; t < steps.size(); ++t) {
        if (steps[t] != kNeverInvaded) continue;
        std::uint32_t settled = 0;
        for (std::uint32_t k = 0; k < 3; ++k)
            settled = std::max(settled, reached[table.vertex(corner(TriangleId{t}, k)).value]);
        steps[t] |= table.degenerate(TriangleId{t}) ? last : settled;
    }
    return steps;
}

}  // namespace lacedring
