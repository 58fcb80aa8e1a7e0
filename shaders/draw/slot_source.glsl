// Decodes the triangles of a stream, for drawing stages (Path::pull, geometry, mesh). If the surface has seams, reads
// the triangles from `copies` instead.
#include "shaders/draw/draw_push.glsl"

layout(constant_id = LR_CONSTANT_PACKED) const bool packed_stream = false;
layout(constant_id = LR_CONSTANT_ROTATE) const bool rotate = false;

#ifdef LR_COUNT_WORDS
uint words_read = 0u;
uint stream_word(uint i) {
    ++words_read;
    return Words(push.stream).at[i];
}
#define LR_LEAN_WORD(i) stream_word(i)
#define LR_PACKED_WORD(i) stream_word(i)
#else
#define LR_LEAN_WORD(i) Words(push.stream).at[i]
#define LR_PACKED_WORD(i) Words(push.stream).at[i]
#endif
#include "shaders/include/lacedring.glsl"

// Rotates a triangle like rotate.comp.
uvec3 rotated(uvec3 t) {
    Words original = Words(push.vertex_order);
    uint a = original.at[t.x];
    uint b = original.at[t.y];
    uint c = original.at[t.z];
    if (b < a && b <= c) return t.yzx;
    if (c < a && c < b) return t.zxy;
    return t;
}

LrLeanLayout lean_layout() { return LrLeanLayout(push.stream_layout.x, push.stream_layout.y, push.stream_layout.z); }
LrPackedLayout packed_layout() {
    return LrPackedLayout(push.stream_layout.x, push.stream_layout.y, push.stream_layout.z, push.stream_layout.w);
}

uvec3 slot_triangle(uint slot) {
    if (seams) {
        Words copies = Words(push.copies);
        uvec3 c = uvec3(copies.at[3u * slot], copies.at[3u * slot + 1u], copies.at[3u * slot + 2u]);
        return rotate ? rotated(c) : c;
    }
    uvec3 t = packed_stream ? lr_packed_triangle(packed_layout(), slot) : lr_lean_triangle(lean_layout(), slot);
    return rotate ? rotated(t) : t;
}

// The triangles of slots 2i and 2i + 1 of a lean stream, not rotated. The two triangles of a ring edge share its two
// words.
void slot_pair(uint slot, out uvec3 t0, out uvec3 t1) {
    LrLeanLayout lean = lean_layout();
    if (slot >= 2u * lean.rings2) {
        t0 = lr_lean_triangle(lean, slot);
        t1 = slot + 1u < push.first_slot + push.slots ? lr_lean_triangle(lean, slot + 1u) : uvec3(0u);
        return;
    }
    uint v = slot >> 1, left = lr_lean_word(slot), right = lr_lean_word(slot + 1u);
    uint next = lr_lean_next(v, left, right), skip = next + 1u;
    if (((left | right) & LR_LEAN_WART_FLAG) != 0u && next == v + 1u) {
        skip = lr_lean_next(next, lr_lean_word(2u * next), lr_lean_word(2u * next + 1u));
    }
    t0 = lr_lean_ring_triangle(left, v, next, skip, false);
    t1 = lr_lean_ring_triangle(right, v, next, skip, true);
}

// The triangles of slots 4i to 4i + 3; only the first `count` exist.
uvec3 slot_four[4];
void read_slot_four(uint slot, uint count) {
    if (seams) {
        for (uint i = 0u; i < 4u; ++i) slot_four[i] = i < count ? slot_triangle(slot + i) : uvec3(0u);
        return;
    }
    if (packed_stream) {
        lr_packed_triangles_of_quad(packed_layout(), slot, count);
        for (uint i = 0u; i < 4u; ++i) slot_four[i] = lr_packed_quad[i];
    } else {
        for (uint i = 0u; i < count; i += 2u) slot_pair(slot + i, slot_four[i], slot_four[i + 1u]);
    }
    for (uint i = 0u; i < 4u; ++i) {
        if (i >= count) {
            slot_four[i] = uvec3(0u);
        } else if (rotate) {
            slot_four[i] = rotated(slot_four[i]);
        }
    }
}
