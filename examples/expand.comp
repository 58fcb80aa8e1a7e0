#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
layout(std430, binding = 0) readonly buffer Stream { uint words[]; };
layout(std430, binding = 1) writeonly buffer Indices { uint indices[]; };
layout(std430, binding = 2) writeonly buffer Command { uint command[5]; };
#define LR_LEAN_WORD(i) words[i]
#include "lacedring.glsl"

void main() {
    LrLeanLayout lean = lr_lean_layout();
    uint slot = gl_GlobalInvocationID.x, slots = lr_lean_slots(lean);
    if (slot == 0u) command = uint[](3u * slots, 1u, 0u, 0u, 0u);
    if (slot >= slots) return;
    uvec3 v = lr_lean_triangle(lean, slot);
    for (uint i = 0u; i < 3u; ++i) indices[3u * slot + i] = v[i];
}
