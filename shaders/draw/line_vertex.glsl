// A vertex of a line over the surface.
#include "shaders/draw/draw_push.glsl"

layout(binding = 0) uniform Frame { FrameConstants frame; };

vec4 line_vertex(vec3 position) {
    vec3 view = (frame.view_from_world * vec4(unit_position(position), 1.0)).xyz;
    return frame.clip_from_view * vec4(view * (1.0 - LR_LINE_LIFT), 1.0);
}
