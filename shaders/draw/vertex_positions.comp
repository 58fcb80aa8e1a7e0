#version 460
#extension GL_GOOGLE_include_directive : require
// Writes stream_position (which the drawing stages call) of each vertex, to compare with the CPU.
#include "shaders/draw/vertex_source.glsl"

layout(local_size_x = LR_COMPUTE_GROUP) in;
layout(std430, binding = 0) writeonly buffer Positions { uint positions[]; };

void main() {
    uint local = gl_GlobalInvocationID.x;
    if (local >= push.slots) return;  // `slots` and `first_slot` count vertices here
    uvec3 position = stream_position(push.first_slot + local);
    for (uint c = 0u; c < 3u; ++c) positions[3u * local + c] = position[c];
}
