// The push constants of a draw, the same in every stage, and the types of the buffers at their addresses. Buffers are
// read through addresses because a descriptor covers at most maxStorageBufferRange bytes.
#ifndef LACEDRING_DRAW_PUSH_GLSL
#define LACEDRING_DRAW_PUSH_GLSL
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require
#include "shaders/shared.h"

layout(buffer_reference, std430, buffer_reference_align = 4) readonly buffer Words { uint at[]; };
layout(buffer_reference, std430, buffer_reference_align = 4) readonly buffer Floats { float at[]; };

layout(constant_id = LR_CONSTANT_SEAMS) const bool seams = false;

layout(push_constant) uniform Push { DrawConstants push; };

// Moves a position from the source's coordinates into the unit sphere, bit for bit like normalize() in
// renderer/mesh/model.cpp.
vec3 unit_position(vec3 position) {
    precise vec3 moved = position - push.unit.xyz;
    precise vec3 scaled = moved * push.unit.w;
    return scaled;
}

#endif
