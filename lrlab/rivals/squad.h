#pragma once
// SQuad: the connectivity of a triangle mesh in slightly more than two references a triangle, without a vertex table.
// Gurung, Laney, Lindstrom and Rossignac 2011, "SQuad: Compact representation for triangle meshes"; implemented from
// the description in LR 2011, section 3: vertices are matched with quads, whose corners store swings (the S table).
//
// A record is four words of S. Record v < matched is the quad of vertex v: two adjacent triangles that both have v.
// Records from `matched` on hold the triangles that no vertex owns, in pairs of adjacent ones if possible. Record r has
// the triangles 2r and 2r+1:
//
//            3 ------- 2           2r   has corners 8r+0, 8r+1, 8r+2 at the quad's points 0, 1, 2
//            | 2r+1  / |           2r+1 has corners 8r+4, 8r+5, 8r+6 at the quad's points 0, 2, 3
//            |     /   |           v is at point 0, so v.c = 8v.
//            |   /     |           S[4r+j] = the corner at which the star of point j continues outside the record.
//            | /  2r   |           Swings within the quad (8r+0 to 8r+4, 8r+5 to 8r+2) are not stored.
//        v = 0 ------- 1           The word of corner 8r+4k+i is 4r+k+i; that of 8r+4 is 4r.
//
// A record of one triangle has kSingle in its fourth word; triangle 2r+1 does not exist then. At a border, the swing
// past the last triangle of a fan leads to its first triangle and has the flag kWrap, so each star is a cycle of S. The
// flag kBorder in the first word of a vertex's record marks a border vertex, so that a walk knows where to begin.
//
// c.v follows S around the unknown vertex to a corner 8v with v < matched: O(valence); on bunny 1.4 words on average
// and at most 8. Unmatched vertices, which own no triangle, are rare (they must exist if there are more vertices than
// triangles); their numbers follow those of the matched ones. If a walk returns to its beginning without finding a
// matched vertex, the smallest corner of the cycle is searched in `corners`: O(valence + log unmatched). The walks
// around a vertex take O(valence), too; all other operators take constant time: next, previous and triangle are
// arithmetic; swing reads one word (two if the corner is a record's first); opposite, left, right and swing_back are a
// swing from another corner of the triangle.

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "lacedring/base.hpp"
#include "lacedring/corner_walks.hpp"
#include "lacedring/lacedring.hpp"
#include "lacedring/streams.hpp"

namespace lacedring {

/// A view of the arrays of a Squad, or of a memory-mapped file; does not own them. Has the interface of Operators.
/// Entries and arguments are not checked: results for a corner of a triangle that does not exist are meaningless.
struct SquadView : CornerWalks<SquadView, 4> {
    static constexpr std::uint32_t kWrap = 0x80000000;        ///< in S: leads across a border to the fan's first corner
    static constexpr std::uint32_t kSingle = 0xffffffff;      ///< fourth word of a record: the record has one triangle
    static constexpr std::uint32_t kBorder = 0x40000000;      ///< in word 4v of S: vertex v is on a border
    static constexpr std::uint32_t kMaxRecords = 0x08000000;  ///< 2^27: a corner has 30 bits

    std::uint32_t vertices = 0;              ///< number of vertices: matched, then unmatched, then unused ones
    std::uint32_t matched = 0;               ///< number of vertices with a record
    std::span<const std::uint32_t> swings;   ///< S: four words per record
    std::span<const std::uint32_t> corners;  ///< C: the smallest corner in the cycle of each unmatched vertex

    using CornerWalks::corner;

    /// c.v: O(valence).
    VertexId vertex(CornerId c) const {
        std::uint32_t x = c.value % 4 == 0 ? c.value & ~4U : c.value;  // both triangles begin at point 0
        if (const std::uint32_t v = std::rotr(x, 3); v < matched) return VertexId{v};  // x = 8v
        const std::uint32_t begin = x = follow(x);
        for (;;) {
            if (const std::uint32_t v = std::rotr(x, 3); v < matched) return VertexId{v};
            x = follow(x);
            if (x == begin) return unmatched_vertex(begin);
        }
    }

    /// c.s: the next corner around c's vertex, null at a border.
    CornerId swing(CornerId c) const {
        const std::uint32_t x = next_in_cycle(c.value);
        return (x & kWrap) != 0 ? kNullCorner : CornerId{x & ~kBorder};
    }
    /// c.o: null across a border.
    CornerId opposite(CornerId c) const {
        const CornerId s = swing(previous(c));
        return s.is_null() ? s : previous(s);
    }
    /// v.c: null for a vertex of no triangle.
    CornerId corner(VertexId v) const {
        if (v.value < matched) return CornerId{8 * v.value};
        return v.value - matched < corners.size() ? CornerId{corners[v.value - matched]} : kNullCorner;
    }

    /// v.c; at a border the first corner in swing order, in O(valence). The walks around v begin with this corner.
    CornerId star_begin(VertexId v) const {
        if (v.value < matched && (swings[4 * v.value] & kBorder) == 0) return corner(v);
        return fan_begin(v);
    }
    /// Calls visit(vertex) once for each neighbor of v, in swing order; at a border from one border neighbor to the
    /// other. O(valence), times the cost of c.v.
    template <class Visit>
    void neighbors(VertexId v, Visit visit) const {
        cycle(star_begin(v), [&](std::uint32_t c, std::uint32_t second, bool wraps) {
            visit(vertex(next(CornerId{c})));
            if (second != c) visit(vertex(next(CornerId{second})));
            if (wraps) visit(vertex(previous(CornerId{second})));  // the last border neighbor
        });
    }
    /// Number of edges at v: that of its triangles, plus one at a border. O(valence).
    std::uint32_t valence(VertexId v) const {
        std::uint32_t count = 0;
        cycle(corner(v), [&](std::uint32_t c, std::uint32_t second, bool wraps) {
            count += 1 + std::uint32_t{second != c} + std::uint32_t{wraps};
        });
        return count;
    }

    bool is_quad(std::uint32_t record) const { return swings[4 * record + 3] != kSingle; }
    /// Does the triangle exist?
    bool is_canonical(TriangleId t) const { return t.value % 2 == 0 || is_quad(t.value / 2); }
    /// The range of triangle numbers: 2 per record; some numbers have no triangle.
    std::uint32_t triangle_numbers() const { return static_cast<std::uint32_t>(swings.size() / 2); }
    /// 4 per record and 1 per unmatched vertex.
    std::size_t references() const { return swings.size() + corners.size(); }

  private:
    /// The word with which the star of corner c leaves c's record. For c = 8r+4, pass 8r instead.
    std::uint32_t leave(std::uint32_t c) const { return swings[c / 8 * 4 + c / 4 % 2 + c % 4]; }

    std::uint32_t follow(std::uint32_t c) const { return leave(c) & ~(kWrap | kBorder); }

    /// The next corner in the cycle around c's vertex, with kWrap if it is across a border; ignore kBorder.
    std::uint32_t next_in_cycle(std::uint32_t c) const {
        switch (c % 8) {
            case 0:
                return is_quad(c / 8) ? c + 4 : leave(c);
            case 4:
                return leave(c - 4);
            case 5:
                return c - 3;
            default:
                return leave(c);
        }
    }

    /// v.c, or at a border the first corner in swing order.
    CornerId fan_begin(VertexId v) const {
        const CornerId first = corner(v);
        if (first.is_null()) return first;
        std::uint32_t c = first.value;
        bool wraps = false;
        do {
            wraps = (leave(c) & kWrap) != 0;
            c = follow(c);
        } while (c != first.value && !wraps);
        return CornerId{c};
    }

    /// Visits the records around a vertex. `first` is a corner at which the cycle enters a record. Calls visit(a, b,
    /// wraps): a is the corner at which the cycle enters the record, b its second corner there (or a, if there is only
    /// one), and wraps says whether the fan ends at a border after b.
    template <class Visit>
    void cycle(CornerId first, Visit visit) const {
        if (first.is_null()) return;
        std::uint32_t c = first.value;
        do {
            const std::uint32_t word = leave(c);
            const std::uint32_t role = c % 8;
            visit(c, role == 5 ? c - 3 : role == 0 && is_quad(c / 8) ? c + 4 : c, (word & kWrap) != 0);
            c = word & ~(kWrap | kBorder);
        } while (c != first.value);
    }

    VertexId unmatched_vertex(std::uint32_t begin) const {
        std::uint32_t smallest = begin;
        for (std::uint32_t x = follow(begin); x != begin; x = follow(x)) {
            smallest = std::min(smallest, x);
        }
        const auto at = std::lower_bound(corners.begin(), corners.end(), smallest);
        return VertexId{matched + static_cast<std::uint32_t>(at - corners.begin())};
    }
};

struct SquadStatistics {
    std::uint32_t quads = 0;          ///< records of a vertex with two triangles
    std::uint32_t singles = 0;        ///< records of a vertex with one triangle
    std::uint32_t extra_quads = 0;    ///< records without a vertex, with two triangles
    std::uint32_t extra_singles = 0;  ///< records without a vertex, with one triangle
    std::uint32_t unmatched = 0;      ///< vertices with triangles, but without a record
};

struct Squad {
    std::uint32_t vertices = 0, matched = 0;
    std::vector<std::uint32_t> swings, corners;
    SquadStatistics statistics;

    SquadView view() const { return {{}, vertices, matched, swings, corners}; }
};

struct SquadOptions {
    /// Number the vertices in the order of the matching walk, so that neighbors are near each other in S. Otherwise
    /// matched vertices keep the input's order.
    bool renumber = true;
    /// Number of vertices that the search for one more quad may visit (step 3 of squad_match.h); 0: no search. With 8,
    /// bunny takes 2.05 references a triangle, as in the paper; above about 100 there is little gain.
    std::uint32_t reach = 32;
};

/// Matches (squad_match.h) and builds S for a pseudo-manifold corner table (split_fans). Ignores degenerate triangles.
/// The result does not record which triangles were flipped in the input. `map` may be null; its triangle numbers are 2r
/// and 2r+1. Cost: O(T) time. Errors: too_large (more than 2^27 records).
Result<Squad> build_squad(const CornerTable& table, const SquadOptions& options = {}, LrMap* map = nullptr);

}  // namespace lacedring
