#version 460
#extension GL_GOOGLE_include_directive : require
// For tests: writes the decision of silhouette.vert (LR_EDGE_*) for every line.
#include "shaders/adjacency/adjacency_shared.h"

layout(local_size_x = LR_COMPUTE_GROUP) in;
layout(push_constant) uniform Push {
    SilhouetteConstants push;
    float eye_x, eye_y, eye_z;
};
layout(std430, binding = 0) readonly buffer Tables { uint words[]; };
layout(std430, binding = 1) readonly buffer Positions { float positions[]; };
layout(std430, binding = 2) writeonly buffer Kinds { uint kinds[]; };

#define LR_TABLE_WORD(i) words[i]
#include "shaders/include/lacedring_operators.glsl"
vec3 lr_position(uint v) { return vec3(positions[3u * v], positions[3u * v + 1u], positions[3u * v + 2u]); }
#include "shaders/adjacency/silhouette.glsl"

void main() {
    LrOpLayout lr = lr_op_layout();
    uint line = push.first_line + gl_GlobalInvocationID.x;
    if (line >= 3u * lr_triangle_numbers(lr)) return;
    kinds[line] = lr_edge(lr, line / 3u, line % 3u, vec3(eye_x, eye_y, eye_z), push.crease_cos).kind;
}
