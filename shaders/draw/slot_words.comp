#version 460
#extension GL_GOOGLE_include_directive : require
// Counts the words of the stream that are loaded to decode each slot, or each group of four slots.
#define LR_COUNT_WORDS
#include "shaders/draw/slot_source.glsl"

layout(local_size_x = LR_COMPUTE_GROUP) in;
layout(std430, binding = 0) writeonly buffer Counts { uint counts[]; };

layout(constant_id = LR_CONSTANT_FOURS) const bool fours = false;

void main() {
    uint local = gl_GlobalInvocationID.x;
    if (local >= push.slots) return;
    uvec3 t = uvec3(0u);
    if (!fours) {
        t = slot_triangle(push.first_slot + local);
    } else if (local % 4u == 0u) {
        read_slot_four(push.first_slot + local, min(push.slots - local, 4u));
        t = slot_four[0] | slot_four[1] | slot_four[2] | slot_four[3];
    }
    // No vertex has this number: the comparison only keeps the decoding from being optimized away.
    counts[local] = words_read + (t.x == 0xffffffffu ? 1u : 0u);
}
