#pragma once
// SQuad: the connectivity of a triangle mesh in slightly more than two references a triangle, with no table of
// vertices. Gurung, Laney, Lindstrom and Rossignac 2011, "SQuad: Compact representation for triangle meshes", after the
// account of it in LR 2011, section 3: vertices are matched with quads, whose corners hold swings (the S table).
//
// A record is four words of S. Record v < matched is the quad of vertex v: two adjacent triangles that both have v.
// Records from `matched` on are triangles that no vertex took, in pairs where they adjoin. Triangles 2r and 2r+1 are
// record r's:
//
//            3 ------- 2           2r   has corners 8r+0, 8r+1, 8r+2 at the quad's points 0, 1, 2
//            | 2r+1  / |           2r+1 has corners 8r+4, 8r+5, 8r+6 at the quad's points 0, 2, 3
//            |     /   |           v is at point 0, so v.c = 8v.
//            |   /     |           S[4r+j] = the corner at which the star of point j goes on when it leaves the record.
//            | /  2r   |           Swings within the quad (8r+0 to 8r+4, 8r+5 to 8r+2) are not held.
//        v = 0 ------- 1           Corner 8r+4k+i, when it leaves, leaves by word 4r+k+i; 8r+4 leaves by 4r.
//
// A record of one triangle has kSingle in its fourth word; triangle 2r+1 does not exist then. Along a border the swing
// past the last triangle of a fan wraps to its first and says so (kWrap), so every star is one cycle of S; and the
// first word of a vertex's record says that the vertex is on a border (kBorder), so that a walk knows where to begin.
//
// c.v follows S around the unknown vertex until it comes to a corner 8v with v < matched: O(valence); on bunny 1.4
// words on average and 8 at most. The few vertices that got no triangle (there are some where vertices outnumber
// triangles) follow the matched ones in number; a walk that meets no match comes back to where it began, and looks up
// the smallest corner it met in `corners`: O(valence + log unmatched). The walks around a vertex are O(valence) too;
// all else takes constant time: next, previous and triangle are arithmetic; swing is one word (two where the corner is
// a record's first); opposite, left, right and swing_back are one swing, from another corner of the triangle.

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

/// The arrays, wherever they are: in a Squad, or in a memory-mapped file. Holds no copy. The names of Operators.
/// Entries are trusted, as are the arguments: a corner of a triangle that does not exist gives nonsense.
struct SquadView : CornerWalks<SquadView, 4> {
    static constexpr std::uint32_t kWrap = 0x80000000;        ///< in S: across a border, back to the fan's first corner
    static constexpr std::uint32_t kSingle = 0xffffffff;      ///< in S, a record's fourth word: it holds one triangle
    static constexpr std::uint32_t kBorder = 0x40000000;      ///< in S, word 4v: vertex v is on a border
    static constexpr std::uint32_t kMaxRecords = 0x08000000;  ///< 2^27: a corner is 30 bits

    std::uint32_t vertices = 0;              ///< all: matched, unmatched, and of no triangle, in this order
    std::uint32_t matched = 0;               ///< vertices with a record of their own
    std::span<const std::uint32_t> swings;   ///< S, 4 a record
    std::span<const std::uint32_t> corners;  ///< C, 1 an unmatched vertex: the smallest in its cycle; ascending

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

    /// v.c, or at a border the first corner in swing order: O(valence) there. The walks around v begin with it.
    CornerId star_begin(VertexId v) const {
        if (v.value < matched && (swings[4 * v.value] & kBorder) == 0) return corner(v);
        return fan_begin(v);
    }
    /// Calls visit(vertex) for every neighbour of v once, in swing order: on a border from one border neighbour to the
    /// other. O(valence), times the cost of c.v.
    template <class Visit>
    void neighbors(VertexId v, Visit visit) const {
        cycle(star_begin(v), [&](std::uint32_t c, std::uint32_t second, bool wraps) {
            visit(vertex(next(CornerId{c})));
            if (second != c) visit(vertex(next(CornerId{second})));
            if (wraps) visit(vertex(previous(CornerId{second})));  // beyond the last triangle
        });
    }
    /// Edges at v: its triangles, and one more on a border. O(valence).
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
    /// Numbers that triangles have: 2 a record; some name no triangle.
    std::uint32_t triangle_numbers() const { return static_cast<std::uint32_t>(swings.size() / 2); }
    /// 4 a record, 1 an unmatched vertex.
    std::size_t references() const { return swings.size() + corners.size(); }

  private:
    /// The word by which the star of corner c leaves c's record. Not for c = 8r+4: give 8r.
    std::uint32_t leave(std::uint32_t c) const { return swings[c / 8 * 4 + c / 4 % 2 + c % 4]; }

    std::uint32_t follow(std::uint32_t c) const { return leave(c) & ~(kWrap | kBorder); }

    /// The next corner in the cycle around c's vertex, with kWrap if that is across a border; kBorder means nothing.
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

    /// Goes around a vertex by the records there, from `first`, where one is entered: visit(the corner at which the
    /// star enters the record, the second corner that it has there or again the first, does it end at a border).
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
    std::uint32_t quads = 0;        ///< records of a vertex with two triangles
    std::uint32_t singles = 0;      ///< records of a vertex with one
    std::uint32_t extra_quads = 0;  ///< records of no vertex
    std::uint32_t extra_singles = 0;
    std::uint32_t unmatched = 0;  ///< vertices without a record, but with triangles
};

struct Squad {
    std::uint32_t vertices = 0, matched = 0;
    std::vector<std::uint32_t> swings, corners;
    SquadStatistics statistics;

    SquadView view() const { return {{}, vertices, matched, swings, corners}; }
};

struct SquadOptions {
    /// Number the vertices along the walk that matches them, so that neighbours lie near each other in S. Otherwise
    /// matched vertices keep the input's order.
    bool renumber = true;
    /// How many vertices may be asked to shift so that one more gets a quad. 0: the walk and its pairs alone. With 8,
    /// bunny takes what the paper reports, 2.05 references a triangle; from some 100 on little is gained.
    std::uint32_t reach = 32;
};

/// Builds S from a pseudo-manifold corner table (split_fans) and a matching of its own (squad_match.h). Degenerate
/// triangles take no part. The result does not say which triangles the input had the other way round.
/// Cost: O(T) time. `map` may be null; its triangle numbers are 2r and 2r+1.
/// Errors: too_large (more than 2^27 records; a triangle is in one).
Result<Squad> build_squad(const CornerTable& table, const SquadOptions& options = {}, LrMap* map = nullptr);

}  // namespace lacedring
