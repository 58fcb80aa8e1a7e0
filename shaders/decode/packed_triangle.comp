#version 460
#extension GL_GOOGLE_include_directive : require
// An example of lacedring.glsl, and its test: decodes every triangle of a packed stream by random access, then all of
// them again four at a time.
layout(local_size_x = 64) in;

layout(std430, binding = 0) readonly buffer Words { uint words[]; };
layout(std430, binding = 1) writeonly buffer Indices { uint indices[]; };

#define LR_PACKED_WORD(i) words[i]
#include "shaders/include/lacedring.glsl"

void main() {
    LrPackedLayout p = lr_packed_layout();
    uint triangle = gl_GlobalInvocationID.x, triangles = lr_packed_triangles(p);
    if (triangle >= triangles) return;
    uvec3 v = lr_packed_triangle(p, triangle);
    indices[3u * triangle] = v.x;
    indices[3u * triangle + 1u] = v.y;
    indices[3u * triangle + 2u] = v.z;
    if (triangle % 4u != 0u) return;
    uint count = min(triangles - triangle, 4u);
    lr_packed_triangles_of_quad(p, triangle, count);
    for (uint i = 0u; i < count; ++i) {
        uint at = 3u * (triangles + triangle + i);
        indices[at] = lr_packed_quad[i].x;
        indices[at + 1u] = lr_packed_quad[i].y;
        indices[at + 2u] = lr_packed_quad[i].z;
    }
}
