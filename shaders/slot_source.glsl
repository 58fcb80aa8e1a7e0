// The triangles of a stream, for the stages that decode by themselves. Through addresses, not descriptors: one piece of
// code whatever the size, and nothing is written.
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require
#include "shaders/shared.h"

layout(buffer_reference, std430, buffer_reference_align = 4) readonly buffer Words { uint at[]; };
layout(buffer_reference, std430, buffer_reference_align = 4) readonly buffer Floats { float at[]; };

layout(push_constant) uniform Push { DrawConstants push; };
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
#include "shaders/lacedring.glsl"

// As rotate.comp turns the triangles of an index buffer.
uvec3 rotated(uvec3 t) {
    Words original = Words(push.vertex_order);
    uint a = original.at[t.x];
    uint b = original.at[t.y];
    uint c = original.at[t.z];
    if (b < a && b <= c) return t.yzx;
    if (c < a && c < b) return t.zxy;
    return t;
}

uvec3 slot_triangle(uint slot) {
    uvec3 t;
    if (packed_stream) {
        uint widths = push.stream_layout.w;
        LrPackedLayout p = LrPackedLayout(push.stream_layout.x, push.stream_layout.y, push.stream_layout.z, widths & 0xffu, widths >> 8);
        t = lr_packed_triangle(p, slot);
    } else {
        t = lr_lean_triangle(LrLeanLayout(push.stream_layout.x, push.stream_layout.y, push.stream_layout.z), slot);
    }
    return rotate ? rotated(t) : t;
}
