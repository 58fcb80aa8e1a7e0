#include "lrcore/codec/seams/seam_homes.h"

#include <algorithm>

#include "lacedring/lacedring_seams.h"
#include "lacedring/seams.hpp"
#include "lrcore/base/bits.h"

namespace lacedring {
namespace {

constexpr std::uint32_t kNoState = UINT32_MAX;
constexpr std::uint32_t kMostHomes = LACEDRING_SEAMS_MAX_STEPS;  // a vertex has one step fewer, or as many if it wraps

using Triangles = std::span<const std::uint32_t>;

/// The side of each triangle: the side of its ring edge, or its parent's side.
std::vector<std::uint8_t> find_sides(Triangles triangles) {
    std::vector<std::uint8_t> out(triangles.size() / 3);
    for (std::uint32_t i = 0; i < out.size(); ++i) {
        const std::uint32_t in_block = i % kSeamBlock, side = lacedring_seam_side(&triangles[std::size_t{3} * i]);
        std::uint32_t pair[2];
        out[i] = static_cast<std::uint8_t>(side);
        if (side < 2 || lacedring_seam_is_empty(&triangles[std::size_t{3} * i])) continue;
        const std::uint32_t back = lacedring_seam_parent(&triangles[std::size_t{3} * (i - in_block)], in_block, pair);
        out[i] = back > 0 ? out[i - back] : 0;
    }
    return out;
}

/// Chooses the home copies of each vertex: those of its corners in triangles left of the ring, in the order of its fan.
/// The copy at the ring edge (v - 1, v) is first, the copy at (v, v + 1) last.
class HomeFinder {
  public:
    HomeFinder(Triangles triangles, std::span<const std::uint32_t> copies, std::span<const std::uint8_t> sides)
        : triangles_(triangles), copies_(copies), sides_(sides), visited_(triangles.size()) {}

    /// Finds the home copies of vertex v. `corners` are its corners in ascending order. Returns whether the fan wraps.
    bool find(std::uint32_t v, std::span<const std::uint32_t> corners, std::vector<std::uint32_t>& homes) {
        find_fan(v, corners);
        homes.clear();
        const auto add = [&](std::uint32_t copy) {
            if (homes.size() < kMostHomes - 2 && std::ranges::find(homes, copy) == homes.end()) homes.push_back(copy);
        };
        // Copies at the ring edges (v - 1, v) and (v, v + 1).
        std::uint32_t ends[2] = {kNoState, kNoState};
        for (const std::uint32_t c : fan_) add(copies_[c]);
        for (const std::uint32_t c : corners) {
            if (sides_[c / 3] != 0) continue;
            add(copies_[c]);
            const std::uint32_t a = triangles_[corner_next(c)], b = triangles_[corner_previous(c)];
            if (ends[0] == kNoState && (a == v - 1 || b == v - 1)) ends[0] = copies_[c];
            if (ends[1] == kNoState && (a == v + 1 || b == v + 1)) ends[1] = copies_[c];
        }
        if (homes.empty()) homes.push_back(corners.empty() ? kNoState : copies_[corners.front()]);
        if (homes.size() > 1) {
            if (ends[1] != kNoState && ends[1] != ends[0]) {
                std::erase(homes, ends[1]);
                homes.push_back(ends[1]);
            }
            if (ends[0] != kNoState) {
                std::erase(homes, ends[0]);
                homes.insert(homes.begin(), ends[0]);
            }
        }
        std::size_t changes = 0;
        for (std::size_t i = 1; i < fan_.size(); ++i) changes += copies_[fan_[i - 1]] != copies_[fan_[i]] ? 1U : 0U;
        return homes.size() > 1 && changes == homes.size() && copies_[fan_.front()] == copies_[fan_.back()];
    }

  private:
    /// Collects the left corners of v from ring edge (v - 1, v) to (v, v + 1), or up to a border.
    void find_fan(std::uint32_t v, std::span<const std::uint32_t> corners) {
        walk(corners, v + 1, v - 1, corner_next, corner_previous);
        std::ranges::reverse(fan_);
        if (fan_.empty()) walk(corners, v - 1, v + 1, corner_previous, corner_next);
        std::erase_if(fan_, [&](std::uint32_t c) { return sides_[c / 3] != 0; });
    }

    template <class Corner>
    void walk(std::span<const std::uint32_t> corners, std::uint32_t start, std::uint32_t stop, Corner from, Corner to) {
        fan_.clear();
        by_.clear();
        for (const std::uint32_t c : corners) by_.emplace_back(triangles_[from(c)], c);
        std::ranges::sort(by_);
        for (std::uint32_t at = start; fan_.empty() || at != stop; at = triangles_[to(fan_.back())]) {
            const auto found = std::ranges::lower_bound(by_, std::pair(at, 0U));
            if (found == by_.end() || found->first != at || visited_.test(found->second)) break;
            visited_.set(found->second);
            fan_.push_back(found->second);
        }
        for (const std::uint32_t c : fan_) visited_.clear(c);
    }

    Triangles triangles_;
    std::span<const std::uint32_t> copies_;
    std::span<const std::uint8_t> sides_;
    BitVector visited_;
    std::vector<std::uint32_t> fan_;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> by_;  // pairs of a vertex and a corner
};

}  // namespace

VertexCorners::VertexCorners(std::span<const std::uint32_t> triangles, std::uint32_t vertices)
    : begin_(std::size_t{vertices} + 2), corners_(triangles.size()) {
    for (const std::uint32_t v : triangles) {
        if (v != kNoState) ++begin_[v + 2];
    }
    for (std::size_t v = 2; v < begin_.size(); ++v) begin_[v] += begin_[v - 1];
    for (std::uint32_t c = 0; c < triangles.size(); ++c) {
        if (triangles[c] != kNoState) corners_[begin_[triangles[c] + 1]++] = c;
    }
}

SeamHomes find_homes(std::span<const std::uint32_t> triangles, std::uint32_t vertices,
                     std::span<const std::uint32_t> copies, std::uint32_t copy_count, const VertexCorners& corners) {
    const std::vector<std::uint8_t> sides = find_sides(triangles);
    HomeFinder finder(triangles, copies, sides);
    SeamHomes out;
    out.index.assign(copy_count, kNoState);
    out.first.reserve(std::size_t{vertices} + 1);
    out.copy.reserve(vertices);
    out.wrap.assign(vertices, 0);
    out.single.assign(vertices, 1);
    std::vector<std::uint32_t> homes;
    for (std::uint32_t v = 0; v < vertices; ++v) {
        const std::span<const std::uint32_t> own = corners.of(v);
        out.first.push_back(static_cast<std::uint32_t>(out.copy.size()));
        const std::uint32_t copy = own.empty() ? kNoState : copies[own.front()];
        if (std::ranges::all_of(own, [&](std::uint32_t c) { return copies[c] == copy; })) {
            if (copy != kNoState) out.index[copy] = 0;
            out.copy.push_back(copy);
            continue;
        }
        out.single[v] = 0;
        out.wrap[v] = finder.find(v, own, homes) ? 1 : 0;
        for (std::uint32_t i = 0; i < homes.size(); ++i) {
            out.index[homes[i]] = i;
        }
        out.copy.insert(out.copy.end(), homes.begin(), homes.end());
    }
    out.first.push_back(static_cast<std::uint32_t>(out.copy.size()));
    return out;
}

}  // namespace lacedring
