#include "tests/support/cuts.h"

#include <map>
#include <utility>

#include "tests/support/shapes.h"

namespace lacedring::test {

CutSurface cut(const std::vector<std::uint32_t>& triangles, std::uint32_t vertices, std::uint32_t how,
               std::uint64_t seed) {
    CutSurface out{triangles, {}, vertices};
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> numbers;  // of the copies: of a vertex in a chart
    std::uint64_t state = seed;
    std::uint32_t chart = 0;
    for (std::uint32_t c = 0; c < triangles.size(); ++c) {
        const std::uint32_t i = c / 3;
        if (how == 1) chart = i / 37 % 5;
        if (how == 2 && c % 3 == 0) chart = random_below(state, 4) / 3;
        if (how == 3) chart = i;
        if (how == 4) chart = random_below(state, 1 + random_below(state, 5));
        const auto number = static_cast<std::uint32_t>(7 * numbers.size() + 3);
        out.copies.push_back(numbers.emplace(std::pair(triangles[c], chart), number).first->second);
    }
    return out;
}

}  // namespace lacedring::test
