#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require
// Decodes a seam section in passes: vertex blocks give each vertex's home copies, then triangle blocks give an index
// buffer over copies, one block per invocation. If positions come from a vertex stream of the surface, a third pass gives
// each copy its vertex's position, one copy per invocation.
#include "shaders/shared.h"

layout(local_size_x = LR_VERTEX_GROUP_SIZE) in;

layout(push_constant) uniform Push { SeamConstants push; };
layout(std430, binding = 0) buffer Decoded { uint decoded[]; };  // homes, copies, or vertices
layout(std430, binding = 1) readonly buffer Indices { uint indices[]; };
layout(buffer_reference, std430, buffer_reference_align = 4) readonly buffer Words { uint at[]; };
layout(buffer_reference, std430, buffer_reference_align = 4) writeonly buffer Written { uint at[]; };

layout(constant_id = LR_CONSTANT_SEAM_PASS) const uint pass = LR_SEAM_PASS_VERTICES;

uint section_word(uint i) { return Words(push.section).at[min(i, push.words - 1u)]; }
uint home_of(uint v) { return Words(push.homes).at[min(v, push.vertices)]; }
void put_vertex(uint copy, uint v) {
    if (copy < push.copies) Written(push.copy_vertices).at[copy] = v;
}

#define LR_SEAM_WORD(i) section_word(i)
#define LR_SEAM_PUT_HOME(v, value) decoded[(v) - push.first_block * LR_SEAM_BLOCK] = value
#define LR_SEAM_HOME(v) home_of(v)
#define LR_SEAM_VERTEX(k) indices[(k) - 3u * push.first_block * LR_SEAM_BLOCK]
#define LR_SEAM_COPY(k) decoded[(k) - 3u * push.first_block * LR_SEAM_BLOCK]
#define LR_SEAM_PUT_VERTEX(copy, v) put_vertex(copy, v)
#include "shaders/include/lacedring_seams.glsl"

void main() {
    uint i = gl_GlobalInvocationID.x, block = push.first_block + i;
    if (i >= push.blocks) return;
    if (pass == LR_SEAM_PASS_POSITIONS) {
        uint from = 3u * min(Words(push.copy_vertices).at[block], push.vertices - 1u);
        for (uint c = 0u; c < 3u; ++c) decoded[LR_VERTEX_FLOATS * i + c] = Words(push.positions).at[from + c];
        return;
    }
    LrSeamLayout p = lr_seam_layout(push.vertices, push.slots);
    if (pass == LR_SEAM_PASS_VERTICES) {
        lr_seam_vertex_block(p, block);
    } else {
        lr_seam_triangle_block(p, block);
        // Pads with vertex 0, as rotate.comp reads LR_TRIANGLES_PER_INVOCATION triangles at a time.
        for (uint k = 3u * min((block + 1u) * LR_SEAM_BLOCK, push.slots); k % (3u * LR_TRIANGLES_PER_INVOCATION) != 0u; ++k) {
            LR_SEAM_COPY(k) = 0u;
        }
    }
}
