#version 460
#extension GL_GOOGLE_include_directive : require
// A packed stream into an index buffer, one invocation a block of 256 triangles: each event is read once.
layout(local_size_x = 64) in;

layout(std430, binding = 0) readonly buffer Stream { uint words[]; };
layout(std430, binding = 2) writeonly buffer Indices { uint indices[]; };

uint warts[8];  // a bit for each triangle of the block
#define LR_PACKED_WORD(i) words[i]
#define LR_PACKED_SEE_WART(r, i) warts[(i) / 32u] |= 1u << ((i) & 31u)
#include "lacedring.glsl"

bool is_wart(uint i) { return (warts[i / 32u] >> (i & 31u) & 1u) != 0u; }

void put(uint t, uvec3 v) {
    if (v.y < v.x && v.y < v.z) v = v.yzx;  // for the comparison only, as in stream.glsl
    else if (v.z < v.x && v.z < v.y) v = v.zxy;
    for (uint i = 0u; i < 3u; ++i) indices[3u * t + i] = v[i];
}

void main() {
    LrPackedLayout p = lr_packed_layout();
    LrPackedReader r;
    r.first = LR_PACKED_BLOCK * gl_GlobalInvocationID.x;
    if (r.first >= p.triangles) return;
    uint end = min(p.triangles - r.first, LR_PACKED_BLOCK);
    for (uint k = 0u; k < 8u; ++k) warts[k] = 0u;
    for (uint i = 0u; i < end; i = r.stop) {  // a block is one record, or four
        lr_packed_open(p, r, i);
        if (r.plain) {
            for (; r.i < r.stop; ++r.i) put(r.first + r.i, lr_packed_plain(p, r, r.i));
        }
        while (r.i < r.stop) {
            LrPackedStep s = lr_packed_step(p, r);
            uint end_of_run = s.first + s.run;
            bool behind_wart = s.first > 0u && !s.jumped && is_wart(s.first - 1u);
            for (uint t = s.first; t < end_of_run; ++t) {
                bool up = lr_packed_turn(r.first + t), wart = is_wart(t);
                uint inner = up ? s.a : s.b, by = wart ? 2u : 1u;
                put(r.first + t, behind_wart ? lr_packed_oriented(inner - 1u, inner, inner + 1u, s.reversed)
                                             : lr_packed_oriented(s.a, up ? s.a + by : s.b - by, s.b, s.reversed));
                s.a += up ? 1u : 0u;
                s.b -= up ? 0u : 1u;
                behind_wart = wart;
            }
            if (s.third) put(r.first + end_of_run, lr_packed_oriented(s.a, s.x, s.b, s.reversed));
        }
    }
}
