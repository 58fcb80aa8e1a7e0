#version 460
#extension GL_GOOGLE_include_directive : require
layout(points) in;
layout(triangle_strip, max_vertices = 3) out;

#include "stream.glsl"
#include "vertices.glsl"

layout(push_constant) uniform Push { mat4 camera; };
layout(location = 0) out vec3 position;

void main() {
    uvec3 triangle = smallest_first(stream_triangle(uint(gl_PrimitiveIDIn)));
    if (triangle.x == triangle.y) return;
    for (uint i = 0u; i < 3u; ++i) {
        position = vertex(triangle[i]);
        gl_Position = camera * vec4(position, 1.0);
        EmitVertex();
    }
}
