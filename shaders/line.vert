#version 460
#extension GL_GOOGLE_include_directive : require
// The ring, or the edges of the triangles: over the surface, so a little nearer to the eye, along the same ray.
#include "shaders/shared.h"

layout(binding = 0) uniform Frame { FrameConstants frame; };
layout(location = 0) in vec3 in_position;

void main() {
    vec3 view = (frame.view_from_world * vec4(in_position, 1.0)).xyz;
    gl_Position = frame.clip_from_view * vec4(view * (1.0 - LR_LINE_LIFT), 1.0);
}
