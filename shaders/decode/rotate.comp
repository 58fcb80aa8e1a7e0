#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require
// Rotates every triangle of an index buffer so that the vertex with the smallest original number comes first. Index
// buffers that differ only in rotations then give the same interpolated bits (docs/renderer.md).
#include "shaders/shared.h"

layout(local_size_x = LR_COMPUTE_GROUP) in;

layout(push_constant) uniform Push { RotateConstants push; };
layout(std430, binding = 0) buffer Indices { uvec4 indices[]; };
layout(buffer_reference, std430, buffer_reference_align = 4) readonly buffer Words { uint at[]; };

uint original(uint v) { return push.ordered == 0u ? v : Words(push.vertex_order).at[v]; }

uvec3 rotated(uvec3 t) {
    uint a = original(t.x);
    uint b = original(t.y);
    uint c = original(t.z);
    if (b < a && b <= c) return t.yzx;
    if (c < a && c < b) return t.zxy;
    return t;
}

void main() {
    uint local = gl_GlobalInvocationID.x * LR_TRIANGLES_PER_INVOCATION;
    if (local >= push.triangles) return;
    uint at = gl_GlobalInvocationID.x * 3u;
    uvec4 p = indices[at];
    uvec4 q = indices[at + 1u];
    uvec4 r = indices[at + 2u];
    // The buffer is padded to whole invocations with vertex 0: the last one may rotate triangles that are not drawn.
    uvec3 t0 = rotated(p.xyz);
    uvec3 t1 = rotated(uvec3(p.w, q.xy));
    uvec3 t2 = rotated(uvec3(q.zw, r.x));
    uvec3 t3 = rotated(r.yzw);
    indices[at] = uvec4(t0, t1.x);
    indices[at + 1u] = uvec4(t1.yz, t2.xy);
    indices[at + 2u] = uvec4(t2.z, t3);
}
