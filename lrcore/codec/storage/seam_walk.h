#pragma once
// Codes which corners of each vertex share a copy: vertex by vertex along the seams, and around each vertex from
// triangle to triangle. A template over the coder (bit_coder.h), so that encoder and decoder take the same steps.
// Internal to lrcore. Specified in docs/storage-format.md.

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "lrcore/codec/seams/seam_homes.h"
#include "lrcore/codec/storage/bit_coder.h"

namespace lacedring::storage {

template <class Coder>
class SeamWalk {
  public:
    /// `given` is the copy of each corner, below `given_count`; decoders need none.
    SeamWalk(Coder& coder, std::span<const std::uint32_t> triangles, std::uint32_t vertices,
             const VertexCorners& corners, std::span<const std::uint32_t> given = {}, std::uint32_t given_count = 0)
        : coder_(coder),
          triangles_(triangles),
          corners_(corners),
          given_(given),
          place_of_given_(given_count, kNone),
          copies_(triangles.begin(), triangles.end()),
          count_(vertices),
          status_(vertices, kUndecided),
          seams_(vertices, 0) {}

    /// Codes all copies. Returns false if a decoder's input is invalid.
    bool run() {
        bool before = false;
        for (std::uint32_t v = 0; v < status_.size(); ++v) {
            decide(v, first_[before ? 1 : 0]);
            before = status_[v] != kSingle;
            if (status_[v] == kSeveral) stack_.push_back(v);
            while (!stack_.empty()) {
                const std::uint32_t u = stack_.back();
                stack_.pop_back();
                if (status_[u] == kSeveral) code_vertex(u);
            }
            if (bad_ || coder_.bad()) return false;
        }
        return true;
    }

    /// The copy of each corner. The copies of vertex v are v itself and numbers >= `vertices`.
    const std::vector<std::uint32_t>& copies() const { return copies_; }
    std::vector<std::uint32_t> take_copies() { return std::move(copies_); }
    /// All copies are below count().
    std::uint32_t count() const { return count_; }

  private:
    static constexpr std::uint32_t kNone = UINT32_MAX;

    /// Status of a vertex: whether it has several copies, and whether these are coded. An edge has the status of its
    /// other end; kDone + 1 if that end is done and the edge is a seam there.
    enum Status : std::uint8_t { kSingle, kUndecided, kSeveral, kDone };
    static constexpr std::uint32_t kEnds = 5;  ///< number of statuses of edges, including kDone + 1

    /// An edge of the vertex as seen from one of its corners: 2 j + s is the edge from the j-th corner to the next (s =
    /// 0) or previous (s = 1) vertex of its triangle.
    using Side = std::uint32_t;

    /// Kinds of edges of a vertex that is done.
    enum Kind : std::uint32_t { kInner, kSeam, kBorder };
    /// The other end of an edge.
    struct Far {
        std::uint32_t vertex, corner;
    };
    /// Another corner of the vertex across an edge.
    struct Link {
        std::uint32_t end;   ///< status of the edge
        std::uint32_t copy;  ///< copy of the corner
    };

    void decide(std::uint32_t v, BitModel& model) {
        if (status_[v] != kUndecided) return;
        const std::span<const std::uint32_t> own = corners_.of(v);
        bool has_several = false;
        if constexpr (!Coder::kDecodes) {
            has_several = std::ranges::any_of(own, [&](std::uint32_t c) { return given_[c] != given_[own[0]]; });
        }
        status_[v] = own.size() > 1 && coder_.bit(model, has_several) ? kSeveral : kSingle;
    }

    void code_vertex(std::uint32_t v) {
        own_ = corners_.of(v);
        link_corners();
        known_ = 0;
        left_ = static_cast<std::uint32_t>(own_.size());
        copy_.assign(own_.size(), kNone);
        const auto sides = static_cast<Side>(mate_.size());
        for (Side s = 0; s < sides; ++s) {
            if (copy_[s / 2] == kNone && end_of(s) > kDone) code_fan(s, true);
        }
        for (Side s = 0; s < sides; ++s) {
            if (copy_[s / 2] == kNone && mate_[s] == kNone) code_fan(s, false);
        }
        for (Side s = 0; s < sides; s += 2) {
            if (copy_[s / 2] == kNone) code_fan(s, false);
        }
        for (std::size_t j = 0; j < own_.size(); ++j) copies_[own_[j]] = copy_[j] == 0 ? v : count_ + copy_[j] - 1;
        count_ += known_ - 1;
        status_[v] = kDone;
        visit_neighbors();
    }

    /// Sets far_ and mate_: for each side, the side of another corner at the same edge, or kNone.
    void link_corners() {
        edges_.clear();
        far_.clear();
        for (const std::uint32_t c : own_) {
            const std::uint32_t place = c % 3;
            for (const std::uint32_t corner : {place == 2 ? c - 2 : c + 1, place == 0 ? c + 2 : c - 1}) {
                edges_.emplace_back(triangles_[corner], static_cast<Side>(far_.size()));
                far_.push_back({triangles_[corner], corner});
            }
        }
        std::ranges::sort(edges_);
        mate_.assign(edges_.size(), kNone);
        for (std::size_t i = 1; i < edges_.size(); ++i) {
            const auto [before, now] = std::pair(edges_[i - 1], edges_[i]);
            if (before.first != now.first || mate_[before.second] != kNone) continue;
            mate_[before.second] = now.second;
            mate_[now.second] = before.second;
        }
    }

    /// The status of a side's edge.
    std::uint32_t end_of(Side side) const {
        const Status status = status_[far_[side].vertex];
        if (status != kDone) return status;
        const Side mate = mate_[side];
        return mate != kNone && copies_[far_[side].corner] != copies_[far_[mate].corner] ? kDone + 1 : kDone;
    }
    /// Codes the corners from the side's corner on, away from the side, then the corners beyond the side.
    void code_fan(Side start, bool at_seam) {
        at_seam_ = at_seam;
        for (const Side first : {start, mate_[start]}) {
            since_ = 0;
            for (Side s = first; s != kNone && copy_[s / 2] == kNone; s = mate_[s ^ 1]) code_corner(s);
        }
    }

    void code_corner(Side side) {
        Link links[2];
        std::uint32_t count = 0;
        for (const Side s : {side, side ^ 1}) {
            const Side mate = mate_[s];
            if (mate != kNone && copy_[mate / 2] != kNone) links[count++] = {end_of(s), copy_[mate / 2]};
        }
        if (count == 2 && links[1].end < links[0].end) std::swap(links[0], links[1]);
        --left_;
        const std::uint32_t copies = std::min(known_, 3U), wanted = wanted_copy(own_[side / 2]);
        std::uint32_t& copy = copy_[side / 2];
        const auto is_copy = [&](BitModel& model, std::uint32_t other) {
            if (coder_.bit(model, wanted == other)) copy = other;
            return copy == other;
        };
        bool found = false;
        if (count == 1) {
            found =
                is_copy(across_[links[0].end][copies - 1][std::min(since_, 3U)][std::min(left_, 3U)], links[0].copy);
        } else if (count == 2 && links[0].copy == links[1].copy) {
            found = is_copy(between_[links[0].end][links[1].end][copies - 1], links[0].copy);
            count = 1;
        } else if (count == 2) {
            found = is_copy(either_[links[0].end][links[1].end][copies - 1], links[0].copy) ||
                    is_copy(other_[links[1].end][copies - 1], links[1].copy);
        }
        if (!found) {
            copy = code_other(wanted, std::span(links).first(count));
            since_ = 0;
        }
        ++since_;
    }

    /// Codes the copy of a corner that has none of the links' copies.
    std::uint32_t code_other(std::uint32_t wanted, std::span<const Link> links) {
        const auto rest = known_ - static_cast<std::uint32_t>(links.size());
        if (rest == 0 ||
            coder_.bit(new_[std::min(rest, 2U) - 1][std::min(left_, 2U)][at_seam_ ? 1 : 0], wanted == kNone)) {
            return known_++;
        }
        std::uint32_t skipped[2] = {kNone, kNone};  // ascending
        for (std::size_t i = 0; i < links.size(); ++i) skipped[i] = links[i].copy;
        if (skipped[1] < skipped[0]) std::swap(skipped[0], skipped[1]);
        std::uint32_t index = wanted - (skipped[0] < wanted ? 1 : 0) - (skipped[1] < wanted ? 1 : 0);
        index = coder_.raw(index, static_cast<std::uint32_t>(std::bit_width(rest - 1)));
        if (index >= rest) {
            bad_ = true;
            return 0;
        }
        for (const std::uint32_t copy : skipped) index += index >= copy ? 1 : 0;
        return index;
    }

    /// Encoders only: the number of the corner's copy at the vertex, or kNone if it is new.
    std::uint32_t wanted_copy(std::uint32_t corner) {
        if constexpr (Coder::kDecodes) return kNone;
        std::uint32_t& place = place_of_given_[given_[corner]];
        if (place != kNone) return place;
        place = known_;
        return kNone;
    }

    void visit_neighbors() {
        const auto sides = static_cast<Side>(mate_.size());
        edges_.clear();
        for (Side s = 0; s < sides; ++s) {
            const Side mate = mate_[s];
            if (mate < s) continue;  // the mate has visited the edge
            const std::uint32_t kind = mate == kNone ? kBorder : copy_[s / 2] != copy_[mate / 2] ? kSeam : kInner;
            edges_.emplace_back(far_[s].vertex, kind);
            std::uint8_t& seams = seams_[far_[s].vertex];
            if (kind == kSeam && seams < 2) ++seams;
        }
        for (const auto& [v, kind] : edges_) decide(v, neighbor_[kind][seams_[v]]);
        for (const bool seams : {false, true}) {  // vertices across seams come next (the stack's top)
            for (const auto& [v, kind] : edges_) {
                if ((kind == kSeam) == seams && status_[v] == kSeveral) stack_.push_back(v);
            }
        }
    }

    Coder& coder_;
    std::span<const std::uint32_t> triangles_;
    const VertexCorners& corners_;
    std::span<const std::uint32_t> given_;
    std::vector<std::uint32_t> place_of_given_;  // number of a given copy at its vertex
    std::vector<std::uint32_t> copies_;
    std::uint32_t count_;
    std::vector<Status> status_;
    // For each vertex v, the number of edges (u, v) that were found to be seams at u; at most 2.
    std::vector<std::uint8_t> seams_;
    std::vector<std::uint32_t> stack_;
    bool bad_ = false;

    // State of the vertex being coded.
    std::span<const std::uint32_t> own_;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> edges_;  // other end, and side or kind
    std::vector<Far> far_;                                        // per side
    std::vector<Side> mate_;                                      // per side
    std::vector<std::uint32_t> copy_;                             // per corner; kNone: not coded yet
    std::uint32_t known_ = 0, left_ = 0, since_ = 0;
    bool at_seam_ = false;

    BitModel first_[2], neighbor_[3][3];
    BitModel across_[kEnds][3][4][4], between_[kEnds][kEnds][3], either_[kEnds][kEnds][3], other_[kEnds][3];
    BitModel new_[2][3][2];
};

}  // namespace lacedring::storage
