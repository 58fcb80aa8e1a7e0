#version 460
#extension GL_GOOGLE_include_directive : require
// Turns each input point into the triangles of LR_GEOMETRY_SLOTS slots.
#include "shaders/draw/pulled_vertex.glsl"

layout(points) in;
layout(triangle_strip, max_vertices = 3 * LR_GEOMETRY_SLOTS) out;

layout(location = 0) out vec3 out_position;
layout(location = 1) out vec3 out_normal;
layout(location = 2) out vec3 out_ring_color;
layout(location = 3) out vec4 out_texture_at;
layout(location = 4) out vec4 out_color;

invariant gl_Position;

void emit(uint vertex, uint local) {
    SurfaceVertex v = pulled_vertex(vertex);
    gl_Position = v.clip;
    gl_PrimitiveID = int(local);
    out_position = v.position;
    out_normal = v.normal;
    out_ring_color = v.ring_color;
    out_texture_at = v.texture_at;
    out_color = v.color;
    EmitVertex();
}

void main() {
    uint begin = LR_GEOMETRY_SLOTS * uint(gl_PrimitiveIDIn);
    read_slot_four(push.first_slot + begin, min(push.slots - begin, LR_GEOMETRY_SLOTS));
    for (uint i = 0u; i < LR_GEOMETRY_SLOTS; ++i) {
        uvec3 t = slot_four[i];
        if (t.x == t.y) continue;  // degenerate, or past the last slot
        emit(t.x, begin + i);
        emit(t.y, begin + i);
        emit(t.z, begin + i);
        EndPrimitive();
    }
}
