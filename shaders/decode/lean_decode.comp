#version 460
#extension GL_GOOGLE_include_directive : require
// Expands a lean LR stream into an index buffer, and writes the commands that draw it. Paper: LR 2011, section 7.
#include "shaders/shared.h"

layout(local_size_x = LR_COMPUTE_GROUP) in;

// All slots of the dispatch belong to two-sided rings. This has its own pipeline, as lavapipe executes both sides of a
// branch and would spend three quarters of its time on the other side.
layout(constant_id = 0) const bool two_sided = true;

layout(push_constant) uniform Push { DecodeConstants push; };

// The stream's header, and the part of the stream that this dispatch reads (as words, and as groups of four words).
layout(std430, binding = 0) readonly buffer Header { uint header[]; };
layout(std430, binding = 1) readonly buffer Words { uint words[]; };
layout(std430, binding = 1) readonly buffer WordQuads { uvec4 word_quads[]; };
layout(std430, binding = 2) writeonly buffer Indices { uvec4 indices[]; };

#define LR_BINDING_COMMANDS 3
#include "shaders/decode/draw_commands.glsl"

#define LR_LEAN_HEADER(i) header[i]
#define LR_LEAN_SLOTS(i) words[(i) - push.first_word]
#include "shaders/include/lacedring.glsl"

void main() {
    LrLeanLayout lean = lr_lean_layout();
    uint slots = lr_lean_slots(lean);
    uint invocation = gl_GlobalInvocationID.x;
    if (invocation == 0u) write_commands(push.draws, push.draw_slots, slots);

    uint local = invocation * LR_TRIANGLES_PER_INVOCATION;
    if (local >= push.slots) return;
    uint slot = push.first_slot + local;

    uvec3 t0, t1, t2, t3;
    if (two_sided) {
        // Two ring vertices: one load for their four words, and one for the words of the vertex after them (for a
        // wart).
        uint quad = (slot + LR_LEAN_HEADER_WORDS - push.first_word) / 4u;
        uvec4 w = word_quads[quad];
        uvec2 behind = word_quads[quad + 1u].xy;
        uint v = slot >> 1;
        uint u = v + 1u;
        uint v_next = lr_lean_next(v, w.x, w.y);
        uint u_next = lr_lean_next(u, w.z, w.w);
        uint v_skip = v_next == u ? u_next : v_next + 1u;
        uint u_skip = u_next == u + 1u ? lr_lean_next(u_next, behind.x, behind.y) : u_next + 1u;
        t0 = lr_lean_ring_triangle(w.x, v, v_next, v_skip, false);
        t1 = lr_lean_ring_triangle(w.y, v, v_next, v_skip, true);
        t2 = lr_lean_ring_triangle(w.z, u, u_next, u_skip, false);
        t3 = lr_lean_ring_triangle(w.w, u, u_next, u_skip, true);
    } else {
        // One-sided or verbatim slots, perhaps across the end of a section. Past the last slot: zeros, which are not
        // drawn.
        t0 = lr_lean_triangle(lean, slot);
        t1 = slot + 1u < slots ? lr_lean_triangle(lean, slot + 1u) : uvec3(0u);
        t2 = slot + 2u < slots ? lr_lean_triangle(lean, slot + 2u) : uvec3(0u);
        t3 = slot + 3u < slots ? lr_lean_triangle(lean, slot + 3u) : uvec3(0u);
    }
    uint to = 3u * invocation;
    indices[to] = uvec4(t0, t1.x);
    indices[to + 1u] = uvec4(t1.yz, t2.xy);
    indices[to + 2u] = uvec4(t2.z, t3);
}
