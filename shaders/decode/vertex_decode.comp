#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require
// Decodes a vertex stream, one block per invocation, into vertices of any stride. Writes the bits of floats; for
// octahedral streams, the three integers of a direction.
#include "shaders/shared.h"

layout(local_size_x = LR_VERTEX_GROUP_SIZE) in;

layout(push_constant) uniform Push { VertexConstants push; };
layout(std430, binding = 0) writeonly buffer Values { uint values[]; };
layout(buffer_reference, std430, buffer_reference_align = 4) readonly buffer Words { uint at[]; };

layout(constant_id = LR_CONSTANT_COMPONENTS) const uint LR_VERTEX_COMPONENTS = 3u;
layout(constant_id = LR_CONSTANT_INTEGERS) const bool integers = false;
layout(constant_id = LR_CONSTANT_MAPPING) const uint mapping = 1u;
#define LR_VERTEX_MAPPING mapping

void put(uint vertex);
#define LR_VERTEX_WORD(i) Words(push.stream).at[i]
#define LR_VERTEX_PUT(i) put(i)
#include "shaders/include/lacedring_vertices.glsl"

LrVertexLayout p;

void put(uint vertex) {
    uint at = (vertex - push.first_block * LR_VERTEX_BLOCK) * push.stride;
    if (!integers && LR_VERTEX_MAPPING == LR_MAPPING_OCTAHEDRAL) {
        ivec3 direction = lr_vertex_direction(p, lr_vertex_value[0], LR_VERTEX_COMPONENTS > 1u ? lr_vertex_value[1] : 0u);
        for (uint c = 0u; c < 3u; ++c) values[at + c] = uint(direction[c]);
        return;
    }
    for (uint c = 0u; c < LR_VERTEX_COMPONENTS; ++c) {
        uint value = lr_vertex_value[c];
        values[at + c] = integers ? value : lr_vertex_float(p, LR_VERTEX_COMPONENTS * vertex + c, value);
    }
}

void main() {
    p = lr_vertex_layout();
    uint block = gl_GlobalInvocationID.x;
    if (block < push.blocks) lr_vertex_block(p, push.first_block + block, LR_VERTEX_BLOCK);
}
