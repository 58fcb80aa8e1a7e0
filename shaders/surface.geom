#version 460
#extension GL_GOOGLE_include_directive : require
// A point becomes the triangles of two slots: of a lean stream's two-sided rings, those of one ring edge.
#include "shaders/pulled_vertex.glsl"

layout(points) in;
layout(triangle_strip, max_vertices = 6) out;

layout(location = 0) out vec3 out_position;
layout(location = 1) out vec3 out_normal;
layout(location = 2) out vec3 out_ring_colour;

invariant gl_Position;

void emit(uint vertex, uint local) {
    SurfaceVertex v = pulled_vertex(vertex);
    gl_Position = v.clip;
    gl_PrimitiveID = int(local);
    out_position = v.position;
    out_normal = v.normal;
    out_ring_colour = v.ring_colour;
    EmitVertex();
}

void main() {
    uint begin = 2u * uint(gl_PrimitiveIDIn);
    uvec3 t[2];
    slot_pair(push.first_slot + begin, t[0], t[1]);
    for (uint i = 0u; i < 2u; ++i) {
        if (t[i].x == t[i].y) continue;  // degenerate
        emit(t[i].x, begin + i);
        emit(t[i].y, begin + i);
        emit(t[i].z, begin + i);
        EndPrimitive();
    }
}
