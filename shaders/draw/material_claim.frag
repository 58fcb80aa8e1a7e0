#version 460
#extension GL_GOOGLE_include_directive : require
// Like claim.frag, but discards fragments that the material hides.
#include "shaders/draw/materials.glsl"

layout(early_fragment_tests) in;
layout(binding = 3, r32ui) uniform uimage2D winner;

void main() {
    Steps steps = texture_steps();
    uint triangle = original_triangle();
    MaterialConstants m = material_of(triangle);
    if (is_hidden(m, base_of(m, steps).a)) discard;
    imageAtomicMin(winner, ivec2(gl_FragCoord.xy), triangle);
}
