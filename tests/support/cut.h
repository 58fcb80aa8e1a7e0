#pragma once
// Surfaces cut along seams: copies for the corners of triangles.

#include <cstdint>
#include <functional>
#include <map>
#include <utility>
#include <vector>

#include "tests/support/shapes.h"

namespace lacedring::test {

/// A surface and the copies of its corners.
struct Cut {
    std::vector<std::uint32_t> triangles, copies;
    std::uint32_t vertices = 0;
};

/// Numbers the copies: corners of a vertex in charts of one number share one.
inline Cut cut_by_chart(std::vector<std::uint32_t> triangles, std::uint32_t vertices,
                        const std::function<std::uint32_t(std::uint32_t corner)>& chart_of) {
    Cut out{std::move(triangles), {}, vertices};
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> numbers;
    for (std::uint32_t c = 0; c < out.triangles.size(); ++c) {
        const std::pair key(out.triangles[c], chart_of(c));
        out.copies.push_back(numbers.emplace(key, static_cast<std::uint32_t>(7 * numbers.size() + 3)).first->second);
    }
    return out;
}

/// Ways to cut: no seams, stripes of triangles, random triangles, each triangle alone, random copies.
constexpr std::uint32_t kCuts = 5;
inline Cut cut(const std::vector<std::uint32_t>& triangles, std::uint32_t vertices, std::uint32_t how,
               std::uint64_t seed) {
    std::vector<std::uint32_t> charts(triangles.size());
    std::uint64_t state = seed;
    for (std::uint32_t c = 0; c < charts.size(); ++c) {
        const std::uint32_t i = c / 3;
        if (how == 1) charts[c] = i / 37 % 5;
        if (how == 2) charts[c] = c % 3 == 0 ? random_below(state, 4) / 3 : charts[c - 1];
        if (how == 3) charts[c] = i;
        if (how == 4) charts[c] = random_below(state, 1 + random_below(state, 5));
    }
    return cut_by_chart(triangles, vertices, [&](std::uint32_t c) { return charts[c]; });
}

}  // namespace lacedring::test
