// The declarations of every shader that reads a stream: the buffer of its words, and the include.
layout(std430, binding = 0) readonly buffer Stream { uint words[]; };

#ifdef PACKED
#define LR_PACKED_WORD(i) words[i]
#include "lacedring.glsl"
uvec3 stream_triangle(uint t) { return lr_packed_triangle(lr_packed_layout(), t); }
uint stream_triangles() { return lr_packed_triangles(lr_packed_layout()); }
#else
#define LR_LEAN_WORD(i) words[i]
#include "lacedring.glsl"
uvec3 stream_triangle(uint t) { return lr_lean_triangle(lr_lean_layout(), t); }
uint stream_triangles() { return lr_lean_slots(lr_lean_layout()); }
#endif

// For the comparison only: the last bit of pixels depends on the first corner of a triangle.
uvec3 smallest_first(uvec3 v) {
    if (v.y < v.x && v.y < v.z) return v.yzx;
    return v.z < v.x && v.z < v.y ? v.zxy : v;
}
