// Builds a SQuad from a matching: fills S with the swings that leave the records.

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "lrlab/rivals/squad.h"
#include "lrlab/rivals/squad_match.h"

namespace lacedring {
namespace {

constexpr std::uint32_t kNone = UINT32_MAX;
static_assert(std::uint64_t{8} * SquadView::kMaxRecords <= SquadView::kBorder, "corners 8r+0 to 8r+6 leave two bits");

class Builder {
  public:
    Builder(const CornerTable& table, SquadMatching matching)
        : table_(table), matching_(std::move(matching)), place_(table.triangle_count(), kNone) {}

    Squad build(LrMap* map) {
        for (std::uint32_t r = 0; r < matching_.records.size(); ++r) {
            const SquadRecord& record = matching_.records[r];
            place(record.first, 2 * r);
            if (record.quad) place(table_.swing(record.first), 2 * r + 1);
        }
        out_.vertices = table_.vertex_count;
        out_.matched = matching_.matched;
        out_.swings.resize(4 * matching_.records.size());
        for (std::uint32_t r = 0; r < matching_.records.size(); ++r) fill(r);
        for (std::uint32_t v = 0; v < out_.matched; ++v) {
            if (out_.view().is_border(VertexId{v})) out_.swings[4 * std::size_t{v}] |= SquadView::kBorder;
        }
        sort_unmatched();
        count();
        if (map != nullptr) fill(*map);
        return std::move(out_);
    }

  private:
    /// Gives c's triangle the number t and c as first corner.
    void place(CornerId c, std::uint32_t t) { place_[triangle(c).value] = 4 * t + c.value % 3; }
    /// The SQuad's number of a corner of the table.
    std::uint32_t number(CornerId c) const {
        const std::uint32_t p = place_[triangle(c).value];
        const std::uint32_t i = c.value % 3 + 3 - p % 4;
        return (p & ~3U) + (i >= 3 ? i - 3 : i);
    }
    void fill(std::uint32_t r) {
        const SquadRecord& record = matching_.records[r];
        std::uint32_t* words = out_.swings.data() + 4 * std::size_t{r};
        const CornerId a = record.first;
        if (record.quad) {
            const CornerId b = table_.swing(a);
            words[0] = beyond(b);
            words[3] = beyond(previous(b));
        } else {
            words[0] = beyond(a);
            words[3] = SquadView::kSingle;
        }
        words[1] = beyond(next(a));
        words[2] = beyond(previous(a));
    }
    /// The word of S for c: the corner that follows c around its vertex.
    std::uint32_t beyond(CornerId c) const {
        if (const CornerId s = table_.swing(c); !s.is_null()) return number(s);
        for (CornerId b = c; !b.is_null(); b = table_.swing_back(b)) c = b;
        return number(c) | SquadView::kWrap;
    }

    /// Sorts the unmatched vertices by the smallest corner of their cycle in S, and fills `corners`.
    void sort_unmatched() {
        std::vector<std::uint32_t> wanted(matching_.unmatched.empty() ? 0 : table_.vertex_count, kNone);
        for (std::uint32_t i = 0; i < matching_.unmatched.size(); ++i) wanted[matching_.unmatched[i].value] = i;
        std::vector<VertexId>& unmatched = matching_.unmatched;
        std::vector<std::uint32_t> smallest(unmatched.size(), kNone);
        const auto look = [&](CornerId c, std::uint32_t corner) {
            const std::uint32_t i = wanted[table_.vertex(c).value];
            if (i != kNone) smallest[i] = std::min(smallest[i], corner);
        };
        for (std::uint32_t r = 0; r < matching_.records.size() && !unmatched.empty(); ++r) {
            const auto [a, quad] = matching_.records[r];
            look(a, 8 * r);
            look(next(a), 8 * r + 1);
            if (quad) {
                const CornerId b = table_.swing(a);
                look(next(b), 8 * r + 5);
                look(previous(b), 8 * r + 6);
            } else {
                look(previous(a), 8 * r + 2);
            }
        }
        std::vector<std::uint32_t> order(unmatched.size());
        std::iota(order.begin(), order.end(), 0U);
        std::sort(order.begin(), order.end(),
                  [&](std::uint32_t a, std::uint32_t b) { return smallest[a] < smallest[b]; });
        std::vector<VertexId> sorted;
        sorted.reserve(order.size());
        for (const std::uint32_t i : order) {
            sorted.push_back(unmatched[i]);
            out_.corners.push_back(smallest[i]);
        }
        unmatched = std::move(sorted);
    }

    void count() {
        SquadStatistics& s = out_.statistics;
        for (std::uint32_t r = 0; r < matching_.records.size(); ++r) {
            const bool quad = matching_.records[r].quad;
            ++(r < matching_.matched ? quad ? s.quads : s.singles : quad ? s.extra_quads : s.extra_singles);
        }
        s.unmatched = static_cast<std::uint32_t>(matching_.unmatched.size());
    }

    void fill(LrMap& map) const {
        map.vertex.clear();
        map.vertex.reserve(table_.vertex_count);
        std::vector<bool> numbered(table_.vertex_count, false);
        const auto give = [&](VertexId v) {
            map.vertex.push_back(v);
            numbered[v.value] = true;
        };
        for (std::uint32_t r = 0; r < matching_.matched; ++r) give(matched_vertex(r));
        for (const VertexId v : matching_.unmatched) give(v);
        for (std::uint32_t v = 0; v < table_.vertex_count; ++v) {
            if (!numbered[v]) map.vertex.push_back(VertexId{v});
        }
        map.triangle.assign(2 * matching_.records.size(), kNullTriangle);
        map.start.assign(map.triangle.size(), 0);
        for (std::uint32_t t = 0; t < table_.triangle_count(); ++t) {
            if (place_[t] == kNone) continue;
            map.triangle[place_[t] / 4] = TriangleId{t};
            map.start[place_[t] / 4] = place_[t] % 4;
        }
    }
    VertexId matched_vertex(std::uint32_t r) const { return table_.vertex(matching_.records[r].first); }

    const CornerTable& table_;
    SquadMatching matching_;
    std::vector<std::uint32_t>
        place_;  // for each triangle of the table: 4 * its new number + index of its first corner
    Squad out_;
};

Error too_large(std::size_t count, const char* what) {
    return {ErrorCode::too_large, fmt::format("{} {}; a SQuad holds {} records", count, what, SquadView::kMaxRecords)};
}

}  // namespace

Result<Squad> build_squad(const CornerTable& table, const SquadOptions& options, LrMap* map) {
    // A record has at most two triangles: too many triangles mean too many records.
    const std::size_t triangles = table.triangle_count() - table.topology.degenerate;
    if (triangles / 2 > SquadView::kMaxRecords) return too_large(triangles, "triangles");
    SquadMatching matching = match_squad(table, options.renumber, options.reach);
    if (matching.records.size() > SquadView::kMaxRecords)
        return too_large(matching.records.size(), "quads and triangles");
    return Builder(table, std::move(matching)).build(map);
}

}  // namespace lacedring
