// Random access to the lean LR stream: the triangle at any slot, in constant time, at most four words read.
// Paper: LR 2011, section 7. Format: lrcore/lean/lean_format.h, the only other file that an engine needs with this one.
//
// Before including it, say where the payload's words (those behind the header) are:
//     #define LR_LEAN_WORD(i) words[(i) + LR_LEAN_HEADER_WORDS]
// Then, for slot in [0, 2*rings2 + rings1 + verbatim):
//     uvec3 triangle = lr_lean_triangle(LrLeanLayout(rings2, rings1, verbatim), slot);
// A triangle whose first two vertices are equal is degenerate: it covers nothing, draw it or skip it. The stream must be
// valid (lr::validate_lean), so a ring has at least three vertices.
#ifndef LACEDRING_LEAN_DECODE_GLSL
#define LACEDRING_LEAN_DECODE_GLSL

#include "lrcore/lean/lean_format.h"

struct LrLeanLayout {
    uint rings2;
    uint rings1;
    uint verbatim;
};

uint lr_lean_slots(LrLeanLayout lean) { return 2u * lean.rings2 + lean.rings1 + lean.verbatim; }

// v.n of vertex v of a two-sided ring, whose left and right words these are.
uint lr_lean_next(uint v, uint left, uint right) {
    if ((left & LR_LEAN_CLOSE_FLAG) != 0u) return left & LR_LEAN_TIP_MASK;
    if ((right & LR_LEAN_CLOSE_FLAG) != 0u) return right & LR_LEAN_TIP_MASK;
    return v + 1u;
}

// v.n of vertex v of a one-sided ring.
uint lr_lean_next(uint v, uint word) {
    return (word & LR_LEAN_CLOSE_FLAG) != 0u ? word & LR_LEAN_TIP_MASK : v + 1u;
}

// The triangle of a ring slot: `word` is the slot's, next = v.n, skip = v.n.n (looked at for a wart only). A free slot's
// tip is one of its edge's own vertices, and so is a right closing slot's: the triangle comes out degenerate by itself.
uvec3 lr_lean_ring_triangle(uint word, uint v, uint next, uint skip, bool right) {
    bool closes = (word & LR_LEAN_CLOSE_FLAG) != 0u;
    uint tip = closes && !right ? v : word & LR_LEAN_TIP_MASK;
    uint end = (word & LR_LEAN_WART_FLAG) != 0u ? skip : next;
    bool flip = (word & LR_LEAN_FLIP_FLAG) != 0u;
    return right != flip ? uvec3(end, tip, v) : uvec3(v, tip, end);
}

#ifdef LR_LEAN_WORD
uvec3 lr_lean_triangle(LrLeanLayout lean, uint slot) {
    uint two_sided = 2u * lean.rings2;
    uint ring_slots = two_sided + lean.rings1;
    if (slot >= ring_slots) {
        uint i = ring_slots + 3u * (slot - ring_slots);
        return uvec3(LR_LEAN_WORD(i), LR_LEAN_WORD(i + 1u), LR_LEAN_WORD(i + 2u));
    }
    // v.n.n needs no third look: behind a closing edge comes the ring's first edge, which never closes.
    if (slot < two_sided) {
        uint v = slot >> 1;
        uint left = LR_LEAN_WORD(2u * v);
        uint right = LR_LEAN_WORD(2u * v + 1u);
        bool is_right = (slot & 1u) != 0u;
        uint word = is_right ? right : left;
        uint next = lr_lean_next(v, left, right);
        uint skip = next + 1u;
        if ((word & LR_LEAN_WART_FLAG) != 0u && next == v + 1u) {
            skip = lr_lean_next(next, LR_LEAN_WORD(2u * next), LR_LEAN_WORD(2u * next + 1u));
        }
        return lr_lean_ring_triangle(word, v, next, skip, is_right);
    }
    uint v = slot - lean.rings2;
    uint word = LR_LEAN_WORD(slot);
    uint next = lr_lean_next(v, word);
    uint skip = next + 1u;
    if ((word & LR_LEAN_WART_FLAG) != 0u && next == v + 1u) skip = lr_lean_next(next, LR_LEAN_WORD(slot + 1u));
    return lr_lean_ring_triangle(word, v, next, skip, false);
}
#endif

#endif
