#version 460
#extension GL_GOOGLE_include_directive : require
// Writes slot_triangle of every slot as an index list, to compare the decoding of the drawing stages with the CPU.
#include "shaders/draw/slot_source.glsl"

layout(local_size_x = LR_COMPUTE_GROUP) in;
layout(std430, binding = 0) writeonly buffer Indices { uint indices[]; };

void main() {
    uint local = gl_GlobalInvocationID.x;
    if (local >= push.slots) return;
    uvec3 t = slot_triangle(push.first_slot + local);
    indices[3u * local] = t.x;
    indices[3u * local + 1u] = t.y;
    indices[3u * local + 2u] = t.z;
}
