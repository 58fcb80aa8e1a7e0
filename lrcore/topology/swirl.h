#pragma once
// Rossignac's chapter, section 9: the depth-first traversal that winds around the surface like a spiral.
//
//     swirl(c) { if (!c.t.m) { c.t.m = true; swirl(c.l); swirl(c.r); } }
//
// The chapter's c.l is opposite(previous(c)), our right; its c.r is our left. Its recursion is as deep as the mesh is
// large. Here there is no recursion and no stack: the mark of a triangle remembers the corner at which it was entered,
// and the opposite of that corner is the way back.

#include <cstdint>
#include <vector>

#include "lrcore/topology/corner_table.h"

namespace lr {

/// The marks of one or several swirls over a corner table, which must outlive it unchanged.
/// Memory: a quarter of a byte a triangle.
class Swirl {
  public:
    explicit Swirl(const CornerTable& table)
        : table_(table), marks_((std::size_t{table.triangle_count()} + kPerWord - 1) / kPerWord, 0) {}

    /// Was the triangle visited by a swirl?
    bool visited(TriangleId t) const { return mark(t) != 0; }

    /// Calls visit(c) once for every triangle of the seed's shell that was not visited before and can be reached
    /// through such ones, in the order of the chapter's swirl(seed). c is the corner at which the triangle is entered:
    /// the edge that it faces was crossed. Where the chapter's procedure ends, the seed's own edge is crossed too,
    /// which nobody does there: it leads to new triangles only where there are borders. Cost: O(triangles visited)
    /// time; no memory.
    template <class Visit>
    void run(CornerId seed, Visit visit) {
        if (visited(triangle(seed))) return;
        const auto enter = [&](CornerId c) {
            set_mark(c);
            visit(c);
            return c;
        };
        CornerId at = enter(seed);     // where the present triangle was entered
        CornerId side = previous(at);  // faces the edge to cross next
        for (;;) {
            const CornerId to = table_.opposite(side);
            if (!to.is_null() && !visited(triangle(to))) {
                at = enter(to);
                side = previous(at);
                continue;
            }
            while (side != previous(at) && at != seed) {  // both sides done: back to where it was entered from
                side = table_.opposite(at);
                at = corner(triangle(side), mark(triangle(side)) - 1);
            }
            if (side == seed) return;
            side = side == previous(at) ? next(at) : seed;
        }
    }

  private:
    static constexpr std::uint32_t kPerWord = 32;

    /// 0, or 1 + the index in its triangle of the corner at which it was entered.
    std::uint32_t mark(TriangleId t) const {
        return static_cast<std::uint32_t>(marks_[t.value / kPerWord] >> (t.value % kPerWord * 2)) & 3;
    }
    void set_mark(CornerId c) {
        const TriangleId t = triangle(c);
        marks_[t.value / kPerWord] |= std::uint64_t{1 + c.value % 3} << (t.value % kPerWord * 2);
    }

    const CornerTable& table_;
    std::vector<std::uint64_t> marks_;
};

/// Swirls over every shell, each from the first corner of its first triangle, and calls visit(shell, c) for every
/// triangle that is not degenerate; shells are numbered 0, 1, 2, ... Returns how many there are: the chapter's
/// edge-connected components (section 8). Cost: O(T) time, a quarter of a byte a triangle.
template <class Visit>
std::uint32_t swirl_shells(const CornerTable& table, Visit visit) {
    Swirl swirl(table);
    std::uint32_t shells = 0;
    for (std::uint32_t t = 0; t < table.triangle_count(); ++t) {
        if (swirl.visited({t}) || table.degenerate({t})) continue;
        swirl.run(corner({t}, 0), [&](CornerId c) { visit(shells, c); });
        ++shells;
    }
    return shells;
}

}  // namespace lr
