#version 460
#extension GL_GOOGLE_include_directive : require
// Decodes a vertex stream: an invocation a block. Writes its integers, and behind them, where it stands for floats, their bits; of
// octahedral ones, the direction's three integers.
#include "shaders/shared.h"

layout(local_size_x = 32) in;

layout(std430, binding = 0) readonly buffer Words { uint words[]; };
layout(std430, binding = 1) writeonly buffer Values { uint values[]; };

layout(constant_id = LR_CONSTANT_COMPONENTS) const uint LR_VERTEX_COMPONENTS = 3u;

void put(uint vertex);
#define LR_VERTEX_WORD(i) words[i]
#define LR_VERTEX_PUT(i) put(i)
#include "shaders/lacedring_vertices.glsl"

LrVertexLayout p;

void put(uint vertex) {
    for (uint c = 0u; c < LR_VERTEX_COMPONENTS; ++c) {
        uint at = LR_VERTEX_COMPONENTS * vertex + c;
        values[at] = lr_vertex_value[c];
        if (p.mapping == LR_MAPPING_OCTAHEDRAL) continue;
        values[LR_VERTEX_COMPONENTS * p.vertices + at] = lr_vertex_float(p, at, lr_vertex_value[c]);
    }
    if (p.mapping != LR_MAPPING_OCTAHEDRAL) return;
    ivec3 direction = lr_vertex_direction(p, lr_vertex_value[0], LR_VERTEX_COMPONENTS > 1u ? lr_vertex_value[1] : 0u);
    for (uint c = 0u; c < 3u; ++c) values[LR_VERTEX_COMPONENTS * p.vertices + 3u * vertex + c] = uint(direction[c]);
}

void main() {
    p = lr_vertex_layout();
    uint block = gl_GlobalInvocationID.x;
    if (block < (p.vertices + LR_VERTEX_BLOCK - 1u) / LR_VERTEX_BLOCK) lr_vertex_block(p, block, LR_VERTEX_BLOCK);
}
