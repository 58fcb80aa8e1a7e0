// Encodes seam sections: chooses the home copies of vertices, answers the decoder's questions about each corner, and
// writes the answers as bits. docs/seams-format.md specifies questions and codes.

#include <algorithm>
#include <array>
#include <bit>

#include "lacedring/lacedring.hpp"
#include "lacedring/lacedring_seams.h"
#include "lacedring/seams.hpp"
#include "lrcore/base/message.h"
#include "lrcore/base/try.h"
#include "lrcore/codec/seams/seam_encoder.h"

namespace lacedring {
namespace {

constexpr std::uint32_t kNone = UINT32_MAX;
constexpr std::uint32_t kPrivate = LACEDRING_SEAMS_PRIVATE;

using Triangles = std::span<const std::uint32_t>;

/// The answers for vertices and corners of blocks without copies.
constexpr SeamAnswer kPlainAnswers[] = {{0, LACEDRING_SEAM_V0, 1},     {0, LACEDRING_SEAM_LONE, 1},
                                        {0, LACEDRING_SEAM_RIGHT1, 1}, {1, LACEDRING_SEAM_START_L, 1},
                                        {1, LACEDRING_SEAM_MID_R, 1},  {1, LACEDRING_SEAM_PLAIN, 1}};

/// The answers for all vertices. With `skip_plain`, omits blocks whose vertices have one home copy each.
SeamAnswers answer_vertices(const SeamHomes& homes, std::uint32_t vertices, bool skip_plain) {
    SeamAnswers out;
    for (std::uint32_t first = 0, end = 0; first < vertices; first = end) {
        end = first + std::min(vertices - first, kSeamBlock);
        out.begin.push_back(out.all.size());
        out.copies.push_back(homes.first[end] - homes.first[first] - (end - first));
        if (skip_plain && out.copies.back() == 0) continue;
        for (std::uint32_t v = first, before = 0; v < end; ++v) {
            const std::uint32_t steps = homes.steps(v);
            if (out.flag(LACEDRING_SEAM_V0 + before, steps > 0) && out.flag(LACEDRING_SEAM_MORE, steps > 1)) {
                std::uint32_t n = 2;
                while (n < LACEDRING_SEAMS_MAX_STEPS && out.flag(LACEDRING_SEAM_MANY, steps > n)) ++n;
                out.flag(LACEDRING_SEAM_WRAP, homes.wrap[v] != 0);
            }
            before = std::min(steps, 2U);
        }
    }
    return out;
}

/// Answers the decoder's questions about the triangles' corners, in the order of lacedring_seams.h.
class CornerEncoder {
  public:
    CornerEncoder(Triangles triangles, std::span<const std::uint32_t> copies, const SeamHomes& homes)
        : triangles_(triangles), copies_(copies), homes_(homes), private_(homes.index.size(), kNone) {}

    /// The answers for all corners. With `skip_plain`, omits blocks whose vertices have one copy each.
    SeamAnswers run(bool skip_plain) {
        const auto count = static_cast<std::uint32_t>(triangles_.size() / 3);
        out_.all.reserve(std::size_t{2} * count);
        sides_.resize(count);
        for (first_ = 0; first_ < count; first_ = end_) {
            end_ = std::min(count - first_, kSeamBlock) + first_;
            out_.begin.push_back(out_.all.size());
            const std::size_t before = order_.size();
            if (!skip_plain || !is_plain(first_, end_)) {
                for (std::uint32_t i = first_; i < end_; ++i) encode(i);
            }
            out_.copies.push_back(static_cast<std::uint32_t>(order_.size() - before));
        }
        return std::move(out_);
    }

    /// The private copies in the order of their numbers.
    const std::vector<std::uint32_t>& order() const { return order_; }

  private:
    struct Question {
        std::uint32_t at = 0, at_context = LACEDRING_SEAM_NONE;
        std::uint32_t new_context = 0;
        bool new_first = false;
    };
    struct End {
        std::uint32_t corner, state, far, type;
        bool is_last;
    };

    /// Do all vertices of triangles [first, end) have one copy? Empty slots have no vertices.
    bool is_plain(std::uint32_t first, std::uint32_t end) const {
        const auto corners = triangles_.subspan(std::size_t{3} * first, std::size_t{3} * (end - first));
        return std::ranges::all_of(corners, [&](std::uint32_t v) { return v == kNone || homes_.single[v] != 0; });
    }

    std::uint32_t& state(std::uint32_t c) { return state_[c - 3 * first_]; }
    std::uint32_t state(std::uint32_t c) const { return state_[c - 3 * first_]; }

    bool is_home(std::uint32_t c) const { return homes_.index[copies_[c]] != kNone; }
    bool has_state(std::uint32_t c, std::uint32_t state) const {
        if (is_home(c)) return homes_.copy_at(triangles_[c], state) == homes_.index[copies_[c]];
        return private_[copies_[c]] != kNone && state == (kPrivate | private_[copies_[c]]);
    }

    /// Answers the questions about corner c, whose copy differs from that of state `current`; returns its state.
    std::uint32_t choose(std::uint32_t c, std::uint32_t current, const Question& q) {
        const std::uint32_t v = triangles_[c];
        std::uint32_t asked[2] = {kNone, kNone}, left = homes_.count(v);
        if (current < kPrivate) {
            asked[0] = homes_.copy_at(v, current);
            --left;
        }
        const bool is_new = !is_home(c) && private_[copies_[c]] == kNone;
        const auto ask_new = [&] { return out_.flag(q.new_context, is_new); };
        bool made = q.new_first && ask_new();
        if (!made && q.at_context != LACEDRING_SEAM_NONE && homes_.copy_at(v, q.at) != asked[0]) {
            if (out_.flag(q.at_context, has_state(c, q.at))) return q.at;
            asked[1] = homes_.copy_at(v, q.at);
            --left;
        }
        if (!q.new_first) made = ask_new();
        if (made) {
            private_[copies_[c]] = static_cast<std::uint32_t>(order_.size());
            order_.push_back(copies_[c]);
            return kPrivate | private_[copies_[c]];
        }
        if (left > 0 && out_.flag(LACEDRING_SEAM_HOME, is_home(c))) {
            const std::uint32_t copy = homes_.index[copies_[c]];
            const std::uint32_t skipped = (asked[0] < copy ? 1U : 0U) + (asked[1] < copy ? 1U : 0U);
            out_.bits(copy - skipped, static_cast<std::uint32_t>(std::bit_width(left - 1)));
            return copy;
        }
        out_.golomb(static_cast<std::uint32_t>(order_.size()) - 1 - private_[copies_[c]], 2);
        return kPrivate | private_[copies_[c]];
    }

    End end_of(std::uint32_t i, std::uint32_t parent, std::uint32_t j, std::uint32_t other) const {
        const std::uint32_t c = 3 * i + j, v = triangles_[c], steps = homes_.steps(v);
        const std::uint32_t* p = &triangles_[std::size_t{3} * parent];
        const std::uint32_t in_parent = lacedring_seam_corner(p, v);
        const bool precedes = p[in_parent > 0 ? in_parent - 1 : 2] == triangles_[3 * i + other];
        std::uint32_t more = 1;
        while (more < 3 && (i + more >= end_ || lacedring_seam_corner(&triangles_[std::size_t{3} * (i + more)], v) < 3))
            ++more;
        End e{c, state(3 * parent + in_parent), (sides_[i] == 0) == precedes ? 0 : steps, 0, more == 1};
        if (sides_[i] == 0) {
            const std::uint32_t distance =
                e.state >= kPrivate ? 0 : std::max(e.far, e.state) - std::min(e.far, e.state);
            e.type = distance > 0 ? (distance < more ? 2 : 3) : steps > 0 ? 1 : 0;
        } else {
            e.type = homes_.copy_at(v, e.state) != homes_.copy_at(v, e.far) ? 2 : steps > 0 ? 1 : 0;
        }
        return e;
    }

    std::uint32_t change(std::uint32_t side, const End& e) {
        const std::uint32_t steps = homes_.steps(triangles_[e.corner]);
        if (side == 0) {
            std::uint32_t to = e.far;
            if (e.state < kPrivate) {
                to = e.far > e.state ? e.state + 1 : e.state - 1;
                if (e.far == e.state) to = steps == 0 ? 0 : e.far == 0 ? 1 : e.far - 1;
            }
            return choose(e.corner, e.state, {to, LACEDRING_SEAM_STEP_L, LACEDRING_SEAM_NEW_L});
        }
        if (e.type < 2) return choose(e.corner, e.state, {.new_context = LACEDRING_SEAM_LEAVE});
        return choose(e.corner, e.state,
                      {e.far, e.is_last ? LACEDRING_SEAM_LAST_R : LACEDRING_SEAM_NEXT_R, LACEDRING_SEAM_NEW_R});
    }

    static std::uint32_t spoke_context(std::uint32_t side, const End& a, const End& b) {
        if (side == 0) {
            if (a.type == 0) return LACEDRING_SEAM_LONE;
            if (a.type > 1) return LACEDRING_SEAM_LEFT2;
            return b.type < 3 ? LACEDRING_SEAM_LEFT0 : LACEDRING_SEAM_LEFT1;
        }
        if (a.type == 1 || b.type == 1) return LACEDRING_SEAM_RIGHT0;
        if (a.type == 2) return LACEDRING_SEAM_RIGHT4;
        if (b.type == 0) return LACEDRING_SEAM_RIGHT1;
        return a.is_last ? LACEDRING_SEAM_RIGHT2 : LACEDRING_SEAM_RIGHT3;
    }

    void encode_spoke(std::uint32_t i, std::uint32_t parent, const std::uint32_t (&pair)[2]) {
        End a = end_of(i, parent, pair[0], pair[1]), b = end_of(i, parent, pair[1], pair[0]);
        if (b.type < a.type) std::swap(a, b);
        const bool a_changes = !has_state(a.corner, a.state), b_changes = !has_state(b.corner, b.state);
        const std::uint32_t context = spoke_context(sides_[i], a, b);
        if (out_.flag(context, a_changes || b_changes)) {
            const bool lone = context == LACEDRING_SEAM_LONE;
            const bool usual = b_changes && a_changes == !lone;
            if (!out_.flag(a.type == 0 ? LACEDRING_SEAM_HALF : LACEDRING_SEAM_BOTH, usual)) {
                out_.bits(b_changes ? 0 : 1, 1);
            }
        }
        state(a.corner) = a_changes ? change(sides_[i], a) : a.state;
        state(b.corner) = b_changes ? change(sides_[i], b) : b.state;
    }

    void encode_start(std::uint32_t i, std::uint32_t j, bool has_parent) {
        const std::uint32_t* t = &triangles_[std::size_t{3} * i];
        const std::uint32_t c = 3 * i + j, steps = homes_.steps(t[j]);
        const std::uint32_t neighbors[2] = {lacedring_seam_corner(t, t[j] - 1), lacedring_seam_corner(t, t[j] + 1)};
        Question q;
        if (neighbors[0] == 3 && neighbors[1] < 3) q.at = steps;
        if (sides_[i] == 0) {
            const bool middle = neighbors[0] == 3 && neighbors[1] == 3 && steps > 0;
            q.at_context = middle ? LACEDRING_SEAM_MID_L : LACEDRING_SEAM_START_L;
            q.new_context = LACEDRING_SEAM_NEW_L;
        } else {
            q.at_context = steps > 0 ? LACEDRING_SEAM_MID_R2 : LACEDRING_SEAM_MID_R;
            q.new_context = steps > 0 ? LACEDRING_SEAM_NEW_M : LACEDRING_SEAM_NEW_R;
            for (std::uint32_t n = 0; n < 2 && has_parent; ++n) {
                if (neighbors[n] == 3) continue;
                const std::uint32_t other = t[neighbors[n]];
                const std::uint32_t end = homes_.copy_at(other, n == 0 ? homes_.steps(other) : 0);
                if (homes_.copy_at(other, state(3 * i + neighbors[n])) == end) {
                    q = {n == 0 ? 0 : steps, LACEDRING_SEAM_PLAIN, LACEDRING_SEAM_NEW_R};
                    break;
                }
                q = {n == 0 ? steps : 0, LACEDRING_SEAM_LEAVE,
                     steps > 0 ? LACEDRING_SEAM_SEAMED2 : LACEDRING_SEAM_SEAMED, true};
            }
        }
        state(c) = choose(c, kNone, q);
    }

    /// Shortcut of the general case below, for three vertices with one copy each.
    void encode_plain(std::uint32_t i, const std::uint32_t (&pair)[2]) {
        const std::uint32_t* t = &triangles_[std::size_t{3} * i];
        const bool has_parent = pair[0] < 3;
        if (has_parent) out_.flag(sides_[i] == 0 ? LACEDRING_SEAM_LONE : LACEDRING_SEAM_RIGHT1, false);
        for (std::uint32_t j = 0; j < 3; ++j) {
            state(3 * i + j) = 0;
            if (j == pair[0] || j == pair[1]) continue;
            const bool by_ring = lacedring_seam_corner(t, t[j] - 1) < 3 || lacedring_seam_corner(t, t[j] + 1) < 3;
            out_.flag(sides_[i] == 0          ? LACEDRING_SEAM_START_L
                      : has_parent && by_ring ? LACEDRING_SEAM_PLAIN
                                              : LACEDRING_SEAM_MID_R,
                      true);
        }
    }

    void encode(std::uint32_t i) {
        if (lacedring_seam_is_empty(&triangles_[std::size_t{3} * i])) return;
        std::uint32_t pair[2] = {3, 3};
        const std::uint32_t back = lacedring_seam_parent(&triangles_[std::size_t{3} * first_], i - first_, pair);
        const std::uint32_t side = lacedring_seam_side(&triangles_[std::size_t{3} * i]);
        sides_[i] = static_cast<std::uint8_t>(side < 2 ? side : back > 0 ? sides_[i - back] : 0U);
        if (is_plain(i, i + 1)) return encode_plain(i, pair);
        if (back > 0) encode_spoke(i, i - back, pair);
        for (std::uint32_t j = 0; j < 3; ++j) {
            if (j != pair[0] && j != pair[1]) encode_start(i, j, back > 0);
        }
    }

    Triangles triangles_;
    std::span<const std::uint32_t> copies_;
    const SeamHomes& homes_;
    std::vector<std::uint32_t> private_;                              // number of each private copy
    std::vector<std::uint32_t> order_;                                // copy by private number
    std::array<std::uint32_t, std::size_t{3} * kSeamBlock> state_{};  // states of the block's corners
    std::vector<std::uint8_t> sides_;
    std::uint32_t first_ = 0, end_ = 0;  // triangles of the block
    SeamAnswers out_;
};

/// Does a block without copies take no bits with this table?
bool is_plain_free(const SeamTable& table) {
    return std::ranges::all_of(kPlainAnswers, [&](const SeamAnswer& a) { return table.likely[a.context] == a.value; });
}

Error invalid_seams(std::string message) {
    return {ErrorCode::invalid_argument, "seams: " + std::move(message)};
}

}  // namespace

SeamWords write_seams(const SeamCopies& copies, const VertexCorners& corners, const SeamTableChoice& choose,
                      bool skip_plain) {
    SeamHomes homes = find_homes(copies.triangles, copies.vertices, copies.copies, copies.count, corners);
    SeamAnswers of_vertices = answer_vertices(homes, copies.vertices, skip_plain);
    std::vector<std::uint32_t> made;  // private copies
    const auto answer_corners = [&](bool skip) {
        CornerEncoder encoder(copies.triangles, copies.copies, homes);
        SeamAnswers answers = encoder.run(skip);
        made = encoder.order();
        return answers;
    };
    SeamAnswers of_corners = answer_corners(skip_plain);
    const SeamTable table = choose(of_vertices, of_corners);
    if (skip_plain && !is_plain_free(table)) {
        of_vertices = answer_vertices(homes, copies.vertices, false);
        of_corners = answer_corners(false);
    }
    SeamWords out{write_section(homes.first.back(), of_vertices, of_corners, table), std::move(homes.copy)};
    out.order.insert(out.order.end(), made.begin(), made.end());
    return out;
}

Result<EncodedSeams> encode_seams(std::span<const std::uint32_t> triangles, std::uint32_t vertices,
                                  std::span<const std::uint32_t> copies) {
    using detail::message;
    const Error too_large{ErrorCode::too_large, "seams: more than 2^30 copies, or 4 GiB"};
    if (triangles.size() % 3 != 0 || copies.size() != triangles.size()) {
        return invalid_seams(message(triangles.size(), " corners, ", copies.size(), " copies"));
    }
    if (triangles.size() > UINT32_MAX || vertices > LACEDRING_SEAMS_MAX_COPIES) return too_large;
    for (std::size_t i = 0; i < triangles.size(); i += 3) {
        const std::uint32_t a = triangles[i], b = triangles[i + 1], c = triangles[i + 2];
        if ((a & b & c) == kNone) continue;
        if (std::max({a, b, c}) >= vertices || a == b || b == c || c == a) {
            return invalid_seams(message("triangle ", i / 3, " has a vertex out of range or a repeated vertex"));
        }
    }
    // The caller's numbers of copies, and for each corner the index of its number.
    std::vector<std::uint32_t> numbers;
    numbers.reserve(copies.size());
    for (std::size_t c = 0; c < copies.size(); ++c) {
        if (triangles[c] != kNone) numbers.push_back(copies[c]);
    }
    std::ranges::sort(numbers);
    numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
    std::vector<std::uint32_t> own(copies.size()), owner(numbers.size(), kNone);
    for (std::size_t c = 0; c < copies.size(); ++c) {
        if (triangles[c] == kNone) continue;
        own[c] = static_cast<std::uint32_t>(std::ranges::lower_bound(numbers, copies[c]) - numbers.begin());
        std::uint32_t& of = owner[own[c]];
        if (of == kNone) of = triangles[c];
        if (of != triangles[c]) {
            return invalid_seams(message("copy ", copies[c], " belongs to vertices ", of, " and ", triangles[c]));
        }
    }
    if (numbers.size() + vertices > LACEDRING_SEAMS_MAX_COPIES) return too_large;
    const SeamCopies sound{triangles, vertices, own, static_cast<std::uint32_t>(numbers.size())};
    SeamWords made = write_seams(sound, VertexCorners(triangles, vertices), best_table, false);
    if (made.words.empty()) return too_large;
    EncodedSeams out{std::move(made.words), std::move(made.order)};
    for (std::uint32_t& copy : out.copy_order) copy = copy == kNone ? kNone : numbers[copy];
    return out;
}

Result<EncodedSeams> encode_seams(const Encoded& surface, std::span<const std::uint32_t> indices,
                                  std::span<const std::uint32_t> vertex_of) {
    using detail::message;
    LR_ASSIGN(const StreamView view, view_stream(surface.words));
    std::vector<std::uint32_t> first(surface.vertex_order.size(), kNone);  // a mesh vertex of each surface vertex
    for (std::uint32_t v = 0; v < vertex_of.size(); ++v) {
        if (vertex_of[v] >= first.size())
            return invalid_seams(message("surface vertex ", vertex_of[v], " is out of range"));
        if (first[vertex_of[v]] == kNone) first[vertex_of[v]] = v;
    }
    const std::vector<std::uint32_t> slots = slot_triangles(view);
    std::vector<std::uint32_t> copies(slots.size(), kNone);
    std::size_t triangle = 0;
    for (std::size_t i = 0; i < slots.size(); i += 3) {
        if (slots[i] == kNone) continue;
        const std::size_t t = triangle < surface.triangle_order.size() ? surface.triangle_order[triangle++] : kNone;
        if (t >= indices.size() / 3) return invalid_seams("a triangle that the mesh lacks");
        const std::uint32_t* corners = &indices[3 * t];
        const std::uint32_t begin = surface.vertex_order[slots[i]];
        std::uint32_t place = 0;
        while (place < 3 && (corners[place] >= vertex_of.size() || vertex_of[corners[place]] != begin)) ++place;
        if (place == 3)
            return invalid_seams(message("triangle ", t, " of the mesh has other vertices than the surface's"));
        for (std::uint32_t j = 0; j < 3; ++j) copies[i + j] = corners[(place + j) % 3];
    }
    Result<EncodedSeams> out = encode_seams(slots, view.vertices(), copies);
    if (!out) return out;
    LR_ASSIGN(const SeamView seams, view_seams(out->words, view.slots(), view.vertices()));
    std::vector<std::uint32_t> homes(std::size_t{view.vertices()} + 1);
    first_copies(seams, homes);
    for (std::uint32_t v = 0; v < view.vertices(); ++v) {
        std::uint32_t& copy = out->copy_order[homes[v]];
        if (copy == kNone) copy = first[surface.vertex_order[v]];
    }
    std::vector<bool> found(vertex_of.size());
    for (const std::uint32_t v : out->copy_order) {
        if (v != kNone) found[v] = true;
    }
    const auto lost = std::ranges::find(found, false);
    if (lost == found.end()) return out;
    return invalid_seams(
        message("vertex ", lost - found.begin(), " has no corner, and its surface vertex has other vertices"));
}

}  // namespace lacedring
