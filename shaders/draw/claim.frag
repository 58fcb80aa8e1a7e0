#version 460
#extension GL_GOOGLE_include_directive : require
// Of the nearest triangles at a pixel (all at the same depth), the one with the smallest original number claims it.
#include "shaders/draw/surface.glsl"

// Without this the shader would run, and claim, before the depth test.
layout(early_fragment_tests) in;
layout(binding = 3, r32ui) uniform uimage2D winner;

void main() { imageAtomicMin(winner, ivec2(gl_FragCoord.xy), original_triangle()); }
