// The corner operators on LR tables, each in constant time, in any shader stage. This file needs no other.
// Paper: LR 2011, sections 4.4 to 4.7 and 5.
//
// Define a macro that reads words of the LR stream (made by lacedring::encode_lr, or from an .lr file of kind lr),
// include this file, and call:
//     layout(std430, binding = 0) readonly buffer Tables { uint words[]; };  // or a buffer reference
//     #define LR_TABLE_WORD(i) words[i]
//     #include "lacedring_operators.glsl"
//     ...
//     LrOpLayout lr = lr_op_layout();
//     uint across = lr_opposite(lr, c);  // LR_TABLE_NULL across a border
// Corners are numbers, as in lacedring::Operators: triangle t has corners 4t, 4t+1 and 4t+2. Triangle numbers are t <
// lr_triangle_numbers(lr) with lr_is_canonical(lr, t); other numbers are redundant copies and borders. Vertices are
// numbered in the stream's order (vertex_order maps them to the mesh's). To visit the corners around a vertex in the
// order of lacedring::Operators::star (at a border, starting at the corner that no swing leads to):
//     uint first = lr_star_first(lr, v), c = first;
//     for (uint left = lr_triangle_numbers(lr); c != LR_TABLE_NULL && left > 0u; --left) {
//         ...  // c's triangle is c / 4; lr_vertex(lr, lr_next(c)) is a neighbor of v
//         c = lr_swing(lr, c);
//         if (c == first) break;
//     }
// If the order does not matter, this loop is twice as fast, as it need not search for a border first:
//     for (LrStar s = lr_star(lr, v); s.corner != LR_TABLE_NULL; lr_star_step(lr, s)) ...  // s.corner
// Triangles have the tables' orientation, which is consistent across every edge; LR_TABLE_FLIP marks triangles with the
// opposite orientation in the input. The stream must be valid (lacedring::validate_lr) and have fewer than 2^32 words;
// with any other, every loop still ends, but words past its end may be read. No operator accepts LR_TABLE_NULL.
//
// streams.hpp and docs/lr-tables.md explain the constants. A C++ file may include this file to get them.
#ifndef LACEDRING_OPERATORS_GLSL
#define LACEDRING_OPERATORS_GLSL

#define LR_TABLE_MAGIC 0x5443524cu
#define LR_TABLE_VERSION 1u
#define LR_TABLE_HEADER_WORDS 10u
#define LR_TABLE_WORD_MAGIC 0u
#define LR_TABLE_WORD_VERSION 1u
#define LR_TABLE_WORD_VERTICES 2u
#define LR_TABLE_WORD_RING 3u
#define LR_TABLE_WORD_T0 4u
#define LR_TABLE_WORD_STAR 5u
#define LR_TABLE_WORD_ISOLATED 6u
#define LR_TABLE_NULL 0xffffffffu

#define LR_TABLE_TIP 0x0fffffffu
#define LR_TABLE_WART 0x80000000u
#define LR_TABLE_IRREGULAR 0x40000000u
#define LR_TABLE_FLIP 0x20000000u
#define LR_TABLE_SPECIAL 0x10000000u
#define LR_TABLE_REDUNDANT 0x10000000u
#define LR_TABLE_BORDER 0x50000000u
#define LR_TABLE_CLOSING 0x90000000u
#define LR_TABLE_KIND 0xd0000000u
#define LR_TABLE_T0_FLIP 0x80000000u

#if !defined(__cplusplus) && defined(LR_TABLE_WORD)

struct LrOpLayout {
    uint vertices;
    uint ring;      // m_r: vertices on rings
    uint t0;        // T0 triangles
    uint isolated;  // isolated vertices
    uint vo;        // first word of VO
    uint star;      // first word of VO*
    uint c;         // first word of C
};

LrOpLayout lr_op_layout() {
    LrOpLayout lr;
    lr.vertices = LR_TABLE_WORD(LR_TABLE_WORD_VERTICES);
    lr.ring = LR_TABLE_WORD(LR_TABLE_WORD_RING);
    lr.t0 = LR_TABLE_WORD(LR_TABLE_WORD_T0);
    lr.isolated = LR_TABLE_WORD(LR_TABLE_WORD_ISOLATED);
    lr.vo = LR_TABLE_HEADER_WORDS + 2u * lr.ring;
    lr.star = lr.vo + 6u * lr.t0;
    lr.c = lr.star + LR_TABLE_WORD(LR_TABLE_WORD_STAR);
    return lr;
}

uint lr_triangle_numbers(LrOpLayout lr) { return 2u * lr.ring + lr.t0; }

// The word of a slot. side: 0 left, 1 right. operators.hpp and LrView have the same functions.
uint lr_slot_word(uint v, uint side) { return LR_TABLE_WORD(LR_TABLE_HEADER_WORDS + 2u * v + side); }
bool lr_word_closes(uint w) { return (w & LR_TABLE_KIND) == LR_TABLE_CLOSING; }
bool lr_word_skips(uint w) { return (w & (LR_TABLE_SPECIAL | LR_TABLE_WART)) == LR_TABLE_WART; }
// True if w is a redundant copy or a T0w: the triangle in the next slot is then a T2.
bool lr_word_precedes_t2(uint w) { return (w & LR_TABLE_WART) != 0u || (w & LR_TABLE_KIND) == LR_TABLE_REDUNDANT; }
uint lr_word_tip(LrOpLayout lr, uint w) {
    uint i = w & LR_TABLE_TIP;
    return (w & (LR_TABLE_SPECIAL | LR_TABLE_IRREGULAR)) == LR_TABLE_IRREGULAR ? LR_TABLE_WORD(lr.star + i) : i;
}

// v.n and v.p of a vertex on a ring.
uint lr_ring_next(uint v) {
    uint w = lr_slot_word(v, 0u);
    return lr_word_closes(w) ? w & LR_TABLE_TIP : v + 1u;
}
uint lr_ring_previous(LrOpLayout lr, uint v) {
    // On the left of a ring's first vertex is a T2 between the ring's last and first edges: its tip is the ring's last
    // vertex.
    if (v == 0u || lr_word_closes(lr_slot_word(v - 1u, 0u))) return lr_word_tip(lr, lr_slot_word(v, 0u));
    return v - 1u;
}

// The roles of a slot's corners: start (at v), tip, and end (at v.n, or v.n.n if the edge skips a wart).
#define LR_ROLE_START 0u
#define LR_ROLE_TIP 1u
#define LR_ROLE_END 2u
uint lr_slot_corner(uint v, uint side, uint role) { return 8u * v + (side == 0u ? role : 6u - role); }
uint lr_corner_role(uint c) { return (c & 4u) == 0u ? c & 3u : 2u - (c & 3u); }

// The vertex at which the edge of v's slot ends; w is the slot's word.
uint lr_slot_end(uint v, uint w) {
    uint n = lr_ring_next(v);
    return lr_word_skips(w) ? lr_ring_next(n) : n;
}
// The vertex of the slot whose edge ends at v: v.p, or v.p.p if its slot skips v.p.
uint lr_slot_before(LrOpLayout lr, uint v, uint side) {
    uint p = lr_ring_previous(lr, v), pp = lr_ring_previous(lr, p);
    return lr_word_skips(lr_slot_word(pp, side)) ? pp : p;
}
// The third vertex of the triangle in a slot, even of a redundant copy; null if the slot has no triangle.
uint lr_slot_tip(LrOpLayout lr, uint w) {
    uint kind = w & LR_TABLE_KIND;
    if (kind == LR_TABLE_BORDER) return LR_TABLE_NULL;
    if (kind == LR_TABLE_CLOSING) return lr_ring_next(w & LR_TABLE_TIP);
    return lr_word_tip(lr, w);
}

// True for corners of T0 triangles, and for null.
bool lr_is_t0(LrOpLayout lr, uint c) { return c >= 8u * lr.ring; }
// A T0 has six words: three vertices (array = 0), then three opposite corners (array = 3).
uint lr_t0_word(LrOpLayout lr, uint c, uint array) {
    uint i = c - 8u * lr.ring;
    return LR_TABLE_WORD(lr.vo + i / 4u * 6u + (i & 3u) + array);
}

// c.n, c.p
uint lr_next(uint c) { return (c & 3u) == 2u ? c - 2u : c + 1u; }
uint lr_previous(uint c) { return (c & 3u) == 0u ? c + 2u : c - 1u; }

// True if the triangle exists and this is its canonical number (not the number of a T2's first copy).
bool lr_is_canonical(LrOpLayout lr, uint triangle) {
    return triangle >= 2u * lr.ring || (lr_slot_word(triangle / 2u, triangle & 1u) & LR_TABLE_SPECIAL) == 0u;
}

// For a corner of a T2's first copy, the same corner of its second copy in the next slot; else c. Null stays null.
uint lr_turned(LrOpLayout lr, uint c) {
    if (lr_is_t0(lr, c)) return c;
    uint v = c / 8u, side = c / 4u & 1u, w = lr_slot_word(v, side);
    if ((w & LR_TABLE_SPECIAL) == 0u) return c;
    if ((w & LR_TABLE_KIND) == LR_TABLE_BORDER) return LR_TABLE_NULL;
    uint role = lr_corner_role(c);  // start, tip, end of the first copy are tip, end, start of the second
    return lr_slot_corner(lr_ring_next(v), side, role == LR_ROLE_END ? LR_ROLE_START : role + 1u);
}
// The canonical number of a corner. Null for a corner of a border slot, which has no triangle.
// A triangle with three ring edges has three copies, so lr_turned is applied twice.
uint lr_canonical(LrOpLayout lr, uint c) { return lr_turned(lr, lr_turned(lr, c)); }

// c.v
uint lr_vertex(LrOpLayout lr, uint c) {
    if (lr_is_t0(lr, c)) return lr_t0_word(lr, c, 0u) & ~LR_TABLE_T0_FLIP;
    uint v = c / 8u, role = lr_corner_role(c);
    if (role == LR_ROLE_START) return v;
    uint w = lr_slot_word(v, c / 4u & 1u);
    return role == LR_ROLE_TIP ? lr_slot_tip(lr, w) : lr_slot_end(v, w);
}

// A fast path of c.o: applies if neither the slot nor the slots next to it have flags. Reads two or three words. Returns
// LR_TABLE_NULL if it does not apply.
uint lr_plain_opposite(LrOpLayout lr, uint c) {
    uint v = c / 8u, side = c / 4u & 1u;
    if (v < 2u || v + 1u >= lr.ring) return LR_TABLE_NULL;
    uint w = lr_slot_word(v, side), other = lr_slot_word(v, 1u - side), left = side == 0u ? w : other;
    if ((c & 3u) == 1u) return (w | other) <= LR_TABLE_TIP ? c ^ 4u : LR_TABLE_NULL;
    uint before = lr_slot_word(v - 1u, side);
    if ((w | before) > LR_TABLE_TIP || lr_word_closes(left)) return LR_TABLE_NULL;
    if ((c & 7u) % 6u == 0u) {  // at v: the opposite slot starts at v.n or ends at the tip
        uint after = lr_slot_word(v + 1u, side);
        if (after > LR_TABLE_TIP) return LR_TABLE_NULL;
        if (after == w) return side == 0u ? c + 10u : c + 6u;
        if (w < 2u || w >= lr.ring) return LR_TABLE_NULL;
        uint u = w - 1u;
        bool found = lr_slot_word(u, side) == v + 1u && !lr_word_skips(lr_slot_word(u - 1u, side)) &&
                     !lr_word_closes(lr_slot_word(u, 0u));
        return found ? 8u * u + (c & 7u) : LR_TABLE_NULL;
    }
    // At v.n: the opposite slot ends at v or starts at the tip.
    if (lr_word_skips(lr_slot_word(v - 2u, side)) || lr_word_closes(lr_slot_word(v - 1u, 0u)) ||
        lr_word_closes(lr_slot_word(v - 2u, 0u))) {
        return LR_TABLE_NULL;
    }
    if (before == w) return side == 0u ? c - 10u : c - 6u;
    return w < lr.ring && lr_slot_word(w, side) == v ? 8u * w + (c & 7u) : LR_TABLE_NULL;
}

// The corner that faces v's ring edge on side `side`; not yet canonical (may belong to a first copy).
uint lr_across_ring(uint v, uint side) {
    uint w = lr_slot_word(v, side);
    if ((w & LR_TABLE_KIND) == LR_TABLE_BORDER) return LR_TABLE_NULL;
    // A T2 has its first copy here (perhaps replaced by a T0w): the end corner of its second copy faces this edge.
    return lr_word_precedes_t2(w) ? lr_slot_corner(lr_ring_next(v), side, LR_ROLE_END)
                                  : lr_slot_corner(v, side, LR_ROLE_TIP);
}

// The corner opposite edge (tip, end) (facing_start) or (start, tip) of the triangle in v's slot, if its word does not
// store it: looks at the slot at the edge's end or start, then at the slot at the tip. Not yet canonical (may belong to
// a first copy).
uint lr_infer_opposite(LrOpLayout lr, uint v, uint side, uint w, bool facing_start) {
    uint u = lr_word_tip(lr, w);
    uint near = facing_start ? lr_slot_end(v, w) : lr_slot_before(lr, v, side);
    if (lr_slot_tip(lr, lr_slot_word(near, side)) == u) {
        return lr_slot_corner(near, side, facing_start ? LR_ROLE_END : LR_ROLE_START);
    }
    if (u >= lr.ring) return LR_TABLE_NULL;
    uint far = facing_start ? lr_slot_before(lr, u, side) : u;
    if (lr_slot_tip(lr, lr_slot_word(far, side)) != (facing_start ? near : v)) return LR_TABLE_NULL;
    return lr_slot_corner(far, side, facing_start ? LR_ROLE_START : LR_ROLE_END);
}

// c.o: a canonical corner, or null across a border.
uint lr_opposite(LrOpLayout lr, uint c) {
    if (lr_is_t0(lr, c)) return lr_t0_word(lr, c, 3u);
    uint plain = lr_plain_opposite(lr, c);
    if (plain != LR_TABLE_NULL) return plain;
    c = lr_canonical(lr, c);
    if (c == LR_TABLE_NULL) return c;
    uint v = c / 8u, side = c / 4u & 1u, role = lr_corner_role(c), w = lr_slot_word(v, side);
    // If the edge opposite c is a ring edge: the vertex at which it starts.
    uint across = LR_TABLE_NULL;
    if (role == LR_ROLE_TIP) {
        if ((w & LR_TABLE_WART) != 0u) return lr_slot_corner(lr_ring_next(v), side, LR_ROLE_START);  // the T2w's tip
        across = v;
    } else {
        uint p = lr_ring_previous(lr, v), before = lr_slot_word(p, side);
        if (role == LR_ROLE_START) {
            if (lr_word_skips(before)) return lr_slot_corner(p, side, LR_ROLE_TIP);  // v is a wart's tip
            if (lr_word_precedes_t2(before)) {
                uint pp = lr_slot_word(lr_ring_previous(lr, p), side);
                // All three edges are ring edges.
                if (lr_word_precedes_t2(pp) && (pp & LR_TABLE_SPECIAL) != 0u) across = lr_ring_next(v);
            }
        } else if (lr_word_precedes_t2(before)) {
            across = p;
        }
    }
    uint o;
    if (across != LR_TABLE_NULL) {
        o = lr_across_ring(across, 1u - side);
    } else if ((w & LR_TABLE_IRREGULAR) != 0u) {
        return LR_TABLE_WORD(lr.star + (w & LR_TABLE_TIP) + (role == LR_ROLE_START ? 1u : 2u));
    } else {
        o = lr_infer_opposite(lr, v, side, w, role == LR_ROLE_START);
    }
    return lr_canonical(lr, o);
}

// c.l = c.n.o, c.r = c.p.o
uint lr_left(LrOpLayout lr, uint c) { return lr_opposite(lr, lr_next(c)); }
uint lr_right(LrOpLayout lr, uint c) { return lr_opposite(lr, lr_previous(c)); }
// c.s: the next corner around c's vertex, null at a border; lr_swing_back is its inverse.
uint lr_swing(LrOpLayout lr, uint c) {
    uint l = lr_left(lr, c);
    return l == LR_TABLE_NULL ? l : lr_next(l);
}
uint lr_swing_back(LrOpLayout lr, uint c) {
    uint r = lr_right(lr, c);
    return r == LR_TABLE_NULL ? r : lr_previous(r);
}

// v.c: a canonical corner; null if no triangle uses the vertex.
uint lr_corner(LrOpLayout lr, uint v) {
    if (v < lr.ring) return lr_canonical(lr, 8u * v);  // the left slot of a ring vertex always has a triangle
    return v < lr.ring + lr.isolated ? LR_TABLE_WORD(lr.c + (v - lr.ring)) : LR_TABLE_NULL;
}

// Visits every triangle at a vertex once: swings from v.c; at a border, continues from v.c in the other direction.
struct LrStar {
    uint corner;  // null at the end
    uint first;
    bool border;  // a border was met: now swings back
    uint left;    // ends after this many triangles, even if tables are malformed
};
LrStar lr_star(LrOpLayout lr, uint v) {
    uint first = lr_corner(lr, v);
    return LrStar(first, first, false, lr_triangle_numbers(lr));
}
// Moves to the next corner of the star. Only the step that meets the border runs the loop twice.
void lr_star_step(LrOpLayout lr, inout LrStar s) {
    uint c = s.corner;
    s.corner = LR_TABLE_NULL;
    for (uint looks = s.border ? 1u : 0u; looks < 2u; ++looks) {
        uint o = lr_opposite(lr, s.border ? lr_previous(c) : lr_next(c));
        if (o != LR_TABLE_NULL) {
            s.corner = s.border ? lr_previous(o) : lr_next(o);
            break;
        }
        s.border = true;
        c = s.first;
    }
    s.left -= min(s.left, 1u);
    if (s.corner == s.first || s.left == 0u) s.corner = LR_TABLE_NULL;
}

// v.c; if v is on a border, the corner of v that no swing leads to. O(valence).
uint lr_star_first(LrOpLayout lr, uint v) {
    uint first = lr_corner(lr, v), c = first;
    for (uint left = lr_triangle_numbers(lr); c != LR_TABLE_NULL && left > 0u; --left) {
        uint back = lr_swing_back(lr, c);
        if (back == LR_TABLE_NULL) return c;
        if (back == first) break;
        c = back;
    }
    return first;
}

// The number of edges at v: the number of triangles, plus one on a border. O(valence).
uint lr_valence(LrOpLayout lr, uint v) {
    uint count = 0u;
    LrStar s = lr_star(lr, v);
    for (; s.corner != LR_TABLE_NULL; lr_star_step(lr, s)) ++count;
    return s.border ? count + 1u : count;
}

#endif  // LR_TABLE_WORD
#endif  // LACEDRING_OPERATORS_GLSL
