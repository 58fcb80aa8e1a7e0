// What a draw is told, in every stage, and what its addresses point to. Through addresses, not descriptors: one piece of
// code whatever the size, and nothing is written.
#ifndef LACEDRING_DRAW_PUSH_GLSL
#define LACEDRING_DRAW_PUSH_GLSL
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require
#include "shaders/shared.h"

layout(buffer_reference, std430, buffer_reference_align = 4) readonly buffer Words { uint at[]; };
layout(buffer_reference, std430, buffer_reference_align = 4) readonly buffer Floats { float at[]; };

layout(push_constant) uniform Push { DrawConstants push; };

// From the coordinates of the source into the unit sphere, to the bit as normalise() of renderer/model.cpp has it.
vec3 unit_position(vec3 position) {
    precise vec3 moved = position - push.unit.xyz;
    precise vec3 scaled = moved * push.unit.w;
    return scaled;
}

#endif
