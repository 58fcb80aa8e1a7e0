// For the fragment shaders of the surface: the buffers they share, and the original triangle of a fragment.
#include "shaders/draw/draw_push.glsl"

layout(binding = 0) uniform Frame { FrameConstants frame; };
layout(std430, binding = 1) readonly buffer SlotTriangle { uint slot_triangle[]; };
layout(std430, binding = 2) readonly buffer Classes { uint classes[]; };  // four bytes per word

uint original_triangle() {
    uint i = uint(gl_PrimitiveID);
    return push.ordered != 0u ? slot_triangle[i] : push.first_slot + i;
}
