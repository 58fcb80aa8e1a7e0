#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require
// Decodes a seam section, an invocation a block: first vertex blocks, to where each vertex has its copies, then triangle blocks, to
// an index buffer over the copies.
#include "shaders/shared.h"

layout(local_size_x = LR_VERTEX_GROUP_SIZE) in;

layout(push_constant) uniform Push { SeamConstants push; };
layout(std430, binding = 0) buffer Decoded { uint decoded[]; };  // homes, or copies
layout(std430, binding = 1) readonly buffer Indices { uint indices[]; };
layout(buffer_reference, std430, buffer_reference_align = 4) readonly buffer Words { uint at[]; };

layout(constant_id = LR_CONSTANT_CORNERS) const bool corners = false;

uint section_word(uint i) { return Words(push.section).at[min(i, push.words - 1u)]; }
uint home_of(uint v) { return Words(push.home).at[min(v, push.vertices)]; }

#define LR_SEAM_WORD(i) section_word(i)
#define LR_SEAM_PUT_HOME(v, value) decoded[(v) - push.first_block * LR_SEAM_BLOCK] = value
#define LR_SEAM_HOME(v) home_of(v)
#define LR_SEAM_VERTEX(k) indices[(k) - 3u * push.first_block * LR_SEAM_BLOCK]
#define LR_SEAM_COPY(k) decoded[(k) - 3u * push.first_block * LR_SEAM_BLOCK]
#include "shaders/lacedring_seams.glsl"

void main() {
    if (gl_GlobalInvocationID.x >= push.blocks) return;
    uint block = push.first_block + gl_GlobalInvocationID.x;
    LrSeamLayout p = lr_seam_layout(push.vertices, push.slots);
    if (corners) {
        lr_seam_triangle_block(p, block);
        // rotate.comp reads whole invocations' triangles.
        for (uint k = 3u * min((block + 1u) * LR_SEAM_BLOCK, push.slots); k % (3u * LR_TRIANGLES_PER_INVOCATION) != 0u; ++k) {
            LR_SEAM_COPY(k) = 0u;
        }
    } else {
        lr_seam_vertex_block(p, block);
    }
}
