#version 460
#extension GL_GOOGLE_include_directive : require
// One vertex shader for every pass over the triangles: the passes compare depths for equality.
#include "shaders/shared.h"

layout(binding = 0) uniform Frame { FrameConstants frame; };

layout(location = 0) in vec3 in_position;
layout(location = 1) in vec3 in_normal;
layout(location = 2) in float in_ring;  // place along the rings in [0, 1], or negative: on no ring

layout(location = 0) out vec3 out_position;  // in view space, as is the normal
layout(location = 1) out vec3 out_normal;
layout(location = 2) out vec3 out_ring_colour;

invariant gl_Position;

vec3 ring_colour(float t) {
    if (t < 0.0) return vec3(0.42);
    // Blue, teal, sand, red: even steps of lightness, so that neighbouring corridors can be told apart.
    const vec3 stops[5] = vec3[](vec3(0.045, 0.085, 0.50), vec3(0.03, 0.34, 0.72), vec3(0.62, 0.78, 0.72),
                                 vec3(0.92, 0.46, 0.12), vec3(0.52, 0.02, 0.03));
    float x = clamp(t, 0.0, 1.0) * 4.0;
    int i = min(int(x), 3);
    return mix(stops[i], stops[i + 1], x - float(i));
}

void main() {
    vec4 view = frame.view_from_world * vec4(in_position, 1.0);
    gl_Position = frame.clip_from_view * view;
    out_position = view.xyz;
    out_normal = mat3(frame.view_from_world) * in_normal;
    out_ring_colour = ring_colour(in_ring);
}
