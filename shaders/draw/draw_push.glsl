// The push constants of a draw, the same in every stage, and the buffers behind their addresses. Addresses and not
// descriptors, since no descriptor covers more than maxStorageBufferRange bytes; nothing is written through them.
#ifndef LACEDRING_DRAW_PUSH_GLSL
#define LACEDRING_DRAW_PUSH_GLSL
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require
#include "shaders/shared.h"

layout(buffer_reference, std430, buffer_reference_align = 4) readonly buffer Words { uint at[]; };
layout(buffer_reference, std430, buffer_reference_align = 4) readonly buffer Floats { float at[]; };

layout(constant_id = LR_CONSTANT_SEAMS) const bool seams = false;

layout(push_constant) uniform Push { DrawConstants push; };

// From the coordinates of the source into the unit sphere, to the bit as normalise() of renderer/mesh/model.cpp has it.
vec3 unit_position(vec3 position) {
    precise vec3 moved = position - push.unit.xyz;
    precise vec3 scaled = moved * push.unit.w;
    return scaled;
}

#endif
