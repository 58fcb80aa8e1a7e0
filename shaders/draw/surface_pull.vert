#version 460
#extension GL_GOOGLE_include_directive : require
// The vertex shader of Path::pull, without index and vertex buffers: each of a slot's three vertices decodes the
// triangle.
#include "shaders/draw/pulled_vertex.glsl"

layout(location = 0) out vec3 out_position;
layout(location = 1) out vec3 out_normal;
layout(location = 2) out vec3 out_ring_color;
layout(location = 3) out vec4 out_texture_at;
layout(location = 4) out vec4 out_color;

invariant gl_Position;

void main() {
    uint i = uint(gl_VertexIndex);
    uint local = i / 3u, corner = i - 3u * local;
    uvec3 t = slot_triangle(push.first_slot + local);
    SurfaceVertex v = pulled_vertex(corner == 0u ? t.x : corner == 1u ? t.y : t.z);
    gl_Position = v.clip;
    out_position = v.position;
    out_normal = v.normal;
    out_ring_color = v.ring_color;
    out_texture_at = v.texture_at;
    out_color = v.color;
}
