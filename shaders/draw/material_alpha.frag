#version 460
#extension GL_GOOGLE_include_directive : require
// The depth pass for materials: discards fragments that the material hides.
#include "shaders/draw/materials.glsl"

void main() {
    Steps steps = texture_steps();
    MaterialConstants m = material_of(original_triangle());
    if (is_hidden(m, base_of(m, steps).a)) discard;
}
