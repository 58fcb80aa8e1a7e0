#version 460
#extension GL_GOOGLE_include_directive : require
// Three vertices per triangle, without index buffer and vertex input.
#include "stream.glsl"
#include "vertices.glsl"

layout(push_constant) uniform Push { mat4 camera; };
layout(location = 0) out vec3 position;

void main() {
    uvec3 triangle = smallest_first(stream_triangle(uint(gl_VertexIndex) / 3u));
    position = vertex(triangle[gl_VertexIndex % 3]);
    gl_Position = camera * vec4(position, 1.0);
}
