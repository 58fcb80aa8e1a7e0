#version 460
#extension GL_GOOGLE_include_directive : require
// The vertex shader of Path::compute: reads vertex and index buffers.
#include "shaders/draw/surface_vertex.glsl"

layout(location = 0) in vec3 in_position;
layout(location = 1) in vec3 in_normal;
layout(location = 2) in float in_ring;

layout(location = 0) out vec3 out_position;
layout(location = 1) out vec3 out_normal;
layout(location = 2) out vec3 out_ring_color;
layout(location = 3) out vec4 out_texture_at;
layout(location = 4) out vec4 out_color;

invariant gl_Position;

void main() {
    SurfaceVertex v = surface_vertex(in_position, in_normal, in_ring, uint(gl_VertexIndex));
    gl_Position = v.clip;
    out_position = v.position;
    out_normal = v.normal;
    out_ring_color = v.ring_color;
    out_texture_at = v.texture_at;
    out_color = v.color;
}
