#include "lrlab/rivals/limit.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <numeric>
#include <vector>

namespace lacedring {

namespace {

/// Number of sets of triangles connected by vertices.
std::uint64_t components(std::span<const std::uint32_t> indices, std::size_t vertex_count) {
    std::vector<std::uint32_t> parent(vertex_count);
    std::iota(parent.begin(), parent.end(), 0U);
    const auto find = [&](std::uint32_t v) {
        while (parent[v] != v) v = parent[v] = parent[parent[v]];
        return v;
    };
    for (std::size_t i = 0; i < indices.size(); ++i) parent[find(indices[i])] = find(indices[i - i % 3]);
    std::vector<bool> used(vertex_count, false);
    for (const std::uint32_t v : indices) used[find(v)] = true;
    return static_cast<std::uint64_t>(std::ranges::count(used, true));
}

/// Hash of the triangle's centroid: equal for triangles at the same place.
std::uint64_t place(std::span<const float> positions, std::span<const std::uint32_t> triangle) {
    std::uint64_t hash = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        float sum = 0;
        for (const std::uint32_t v : triangle) sum += positions[std::size_t{v} * 3 + k];
        hash = (hash ^ std::bit_cast<std::uint32_t>(sum)) * 0x9e3779b97f4a7c15U;
        hash ^= hash >> 32U;
    }
    return hash;
}

}  // namespace

Valences count_valences(std::span<const std::uint32_t> indices, std::uint32_t vertex_count) {
    Valences out;
    out.triangles = indices.size() / 3;
    std::vector<std::uint32_t> triangles(vertex_count, 0);
    for (const std::uint32_t v : indices) {
        out.squares += 2 * std::uint64_t{triangles[v]++} + 1;  // from n^2 to (n + 1)^2
        out.most = std::max(out.most, triangles[v]);
    }
    return out;
}

Result<void> check_valences(std::span<const std::uint32_t> indices, std::uint32_t vertex_count,
                            std::string_view rival) {
    const Valences valences = count_valences(indices, vertex_count);
    if (valences.moderate()) return {};
    return Error{ErrorCode::too_large,
                 fmt::format("{} takes time quadratic in a vertex's triangles, and one has {}", rival, valences.most)};
}

Result<void> check_places(std::span<const std::uint32_t> indices, std::span<const float> positions) {
    std::vector<std::uint64_t> places;
    places.reserve(indices.size() / 3);
    for (std::size_t i = 0; i + 2 < indices.size(); i += 3) places.push_back(place(positions, indices.subspan(i, 3)));
    std::ranges::sort(places);
    std::size_t most = 0;
    for (std::size_t begin = 0, end = 0; begin < places.size(); begin = end) {
        while (end < places.size() && places[end] == places[begin]) ++end;
        most = std::max(most, end - begin);
    }
    // Uses the number of visited triangles as the sum of squared valences.
    const auto moderate = [&](std::uint64_t looked_for) {
        return Valences{looked_for * most, places.size(), 0}.moderate();
    };
    if (moderate(places.size()) || moderate(components(indices, positions.size() / 3))) return {};
    return Error{ErrorCode::too_large,
                 fmt::format("meshoptimizer takes time quadratic in the triangles at one place, and {} are", most)};
}

}  // namespace lacedring
