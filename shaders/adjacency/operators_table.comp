#version 460
#extension GL_GOOGLE_include_directive : require
// For tests: evaluates every operator of lacedring_operators.glsl at every corner and vertex.
#include "shaders/shared.h"

layout(local_size_x = LR_COMPUTE_GROUP) in;
layout(constant_id = 0) const bool kVertices = false;

layout(push_constant) uniform Push {
    uint first;  // corner or vertex
    uint end;
} push;
layout(std430, binding = 0) readonly buffer Tables { uint words[]; };
layout(std430, binding = 1) writeonly buffer Out { uint results[]; };
// Start of each vertex's neighbors in `neighbors`; one more entry for the end of the last.
layout(std430, binding = 2) readonly buffer Begins { uint begins[]; };
layout(std430, binding = 3) writeonly buffer Neighbors { uint neighbors[]; };

// Clamped, as tests also pass malformed tables.
#define LR_TABLE_WORD(i) words[min(i, uint(words.length()) - 1u)]
#include "shaders/include/lacedring_operators.glsl"

void corner_operators(LrOpLayout lr, uint c, uint at) {
    results[at] = lr_next(c);
    results[at + 1u] = lr_previous(c);
    results[at + 2u] = lr_vertex(lr, c);
    results[at + 3u] = lr_canonical(lr, c);
    results[at + 4u] = lr_opposite(lr, c);
    results[at + 5u] = lr_left(lr, c);
    results[at + 6u] = lr_right(lr, c);
    results[at + 7u] = lr_swing(lr, c);
    results[at + 8u] = lr_swing_back(lr, c);
    results[at + 9u] = lr_is_canonical(lr, c / 4u) ? 1u : 0u;
}

void vertex_operators(LrOpLayout lr, uint v, uint at) {
    uint first = lr_star_first(lr, v), c = first, last = LR_TABLE_NULL, count = 0u;
    uint begin = begins[v - push.first], room = begins[v - push.first + 1u] - begin;
    for (uint left = lr_triangle_numbers(lr); c != LR_TABLE_NULL && left > 0u; --left) {
        if (count < room) neighbors[begin + count] = lr_vertex(lr, lr_next(c));
        ++count;
        last = c;
        c = lr_swing(lr, c);
        if (c == first) break;
    }
    if (last != LR_TABLE_NULL && c == LR_TABLE_NULL) {
        if (count < room) neighbors[begin + count] = lr_vertex(lr, lr_previous(last));
        ++count;
    }
    results[at] = lr_corner(lr, v);
    results[at + 1u] = first;
    results[at + 2u] = lr_valence(lr, v);
    results[at + 3u] = count;
}

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (push.first + i >= push.end) return;
    LrOpLayout lr = lr_op_layout();
    if (kVertices) {
        vertex_operators(lr, push.first + i, 4u * i);
    } else if ((i & 3u) != 3u) {
        corner_operators(lr, push.first + i, 10u * i);
    }
}
