#include "tests/support/cuts.h"

#include <map>
#include <utility>

#include "tests/support/shapes.h"

namespace lacedring::test {

CutSurface cut_by_chart(std::vector<std::uint32_t> triangles, std::uint32_t vertices,
                        const std::function<std::uint32_t(std::uint32_t corner)>& chart_of) {
    CutSurface out{std::move(triangles), {}, vertices};
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> numbers;  // by vertex and chart: the copy
    for (std::uint32_t c = 0; c < out.triangles.size(); ++c) {
        const auto number = static_cast<std::uint32_t>(7 * numbers.size() + 3);
        out.copies.push_back(numbers.emplace(std::pair(out.triangles[c], chart_of(c)), number).first->second);
    }
    return out;
}

CutSurface cut(const std::vector<std::uint32_t>& triangles, std::uint32_t vertices, std::uint32_t how,
               std::uint64_t seed) {
    SplitMix64 random(seed);
    std::uint32_t chart = 0;
    return cut_by_chart(triangles, vertices, [&](std::uint32_t c) {
        if (how == 1) chart = c / 3 / 37 % 5;
        if (how == 2 && c % 3 == 0) chart = random.below(4) / 3;
        if (how == 3) chart = c / 3;
        if (how == 4) chart = random.below(1 + random.below(5));
        return chart;
    });
}

}  // namespace lacedring::test
