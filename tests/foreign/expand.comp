#version 460
#extension GL_GOOGLE_include_directive : require
// Expands the stream to an index buffer, one invocation per triangle.
layout(local_size_x = 64) in;

#include "stream.glsl"
layout(std430, binding = 2) writeonly buffer Indices { uint indices[]; };

void main() {
    uint t = gl_GlobalInvocationID.x;
    if (t >= stream_triangles()) return;
    uvec3 triangle = smallest_first(stream_triangle(t));
    for (uint i = 0u; i < 3u; ++i) indices[3u * t + i] = triangle[i];
}
