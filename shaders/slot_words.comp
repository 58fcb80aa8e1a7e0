#version 460
#extension GL_GOOGLE_include_directive : require
// How many words of the stream it takes to decode each slot by itself.
#define LR_COUNT_WORDS
#include "shaders/slot_source.glsl"

layout(local_size_x = LR_COMPUTE_GROUP) in;
layout(std430, binding = 0) writeonly buffer Counts { uint counts[]; };

void main() {
    uint local = gl_GlobalInvocationID.x;
    if (local >= push.slots) return;
    uvec3 t = slot_triangle(push.first_slot + local);
    counts[local] = words_read + (t.x == 0xffffffffu ? 1u : 0u);  // no vertex: so that nothing is optimised away
}
