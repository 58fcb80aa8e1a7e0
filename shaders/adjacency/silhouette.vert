#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require
// A line (two vertices) per corner, without vertex and index buffers. The LR tables tell if the edge opposite the
// corner is drawn; if not, both ends go to the same point outside the picture.
#include "shaders/adjacency/adjacency_shared.h"

layout(push_constant) uniform Push { SilhouetteConstants push; };
layout(binding = 0) uniform Frame { SilhouetteFrame frame; };

layout(buffer_reference, std430, buffer_reference_align = 4) readonly buffer Words { uint at[]; };
layout(buffer_reference, std430, buffer_reference_align = 4) readonly buffer Floats { float at[]; };

#define LR_TABLE_WORD(i) Words(push.tables).at[i]
#include "shaders/include/lacedring_operators.glsl"
vec3 lr_position(uint v) {
    Floats positions = Floats(push.positions);
    return vec3(positions.at[3u * v], positions.at[3u * v + 1u], positions.at[3u * v + 2u]);
}
#include "shaders/adjacency/silhouette.glsl"

void main() {
    uint line = push.first_line + uint(gl_VertexIndex) / 2u;
    LrEdge edge = lr_edge(lr_op_layout(), line / 3u, line % 3u, frame.eye.xyz, push.crease_cos);
    gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
    if (edge.kind == 0u) return;
    vec3 world = lr_position((gl_VertexIndex & 1) == 0 ? edge.from : edge.to);
    vec3 view = (frame.view_from_world * vec4(world, 1.0)).xyz;
    gl_Position = frame.clip_from_view * vec4(view * (1.0 - LR_LINE_LIFT), 1.0);
}
