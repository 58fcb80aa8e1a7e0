#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require
// Computes smooth normals from positions and LR tables alone. A vertex's normal is the sum of the cross products of the
// triangles around it, which weights triangles by area, like vertex_normals of lrcore/topology/geometry.h.
//
// The cross product of a needle is a difference of nearly equal products, and the triangles at a vertex may nearly
// cancel: single floats would lose all digits. So each number is a pair of floats hi + lo with about 46 bits (Dekker
// 1971; Knuth). This needs neither shaderFloat64 nor fma (which Vulkan need not fuse): exact products come from halves
// of 12 bits. `precise` keeps compilers from contracting or reordering, which would break the method. It requires
// rounding to nearest, which Vulkan does not guarantee, but every known device does. If the exact sum is zero, the
// result is a rounding error.
#include "shaders/adjacency/adjacency_shared.h"

layout(local_size_x = LR_COMPUTE_GROUP) in;

layout(push_constant) uniform Push { NormalConstants push; };
layout(buffer_reference, std430, buffer_reference_align = 4) readonly buffer Words { uint at[]; };
layout(buffer_reference, std430, buffer_reference_align = 4) buffer Floats { float at[]; };

#define LR_TABLE_WORD(i) Words(push.tables).at[i]
#include "shaders/include/lacedring_operators.glsl"

struct Vec3x2 {
    vec3 hi, lo;
};

// Scaled lengths from 2^-38 to 2^33 have products that neither overflow nor lose bits to denormals. For a mesh in the
// unit sphere, this covers lengths down to 2^-68.
const float kScale = 1073741824.0;
vec3 position(uint v) {
    Floats positions = Floats(push.positions);
    return kScale * vec3(positions.at[3u * v], positions.at[3u * v + 1u], positions.at[3u * v + 2u]);
}

Vec3x2 sum_of(vec3 a, vec3 b) {
    precise vec3 hi = a + b;
    precise vec3 b_part = hi - a;
    precise vec3 lo = (a - (hi - b_part)) + (b - b_part);
    return Vec3x2(hi, lo);
}
// Requires |a| >= |b|, or that the bits of a and b do not overlap.
Vec3x2 quick_sum_of(vec3 a, vec3 b) {
    precise vec3 hi = a + b;
    precise vec3 lo = b - (hi - a);
    return Vec3x2(hi, lo);
}
vec3 upper_half(vec3 a) { return uintBitsToFloat(floatBitsToUint(a) & 0xfffff000u); }
Vec3x2 product_of(vec3 a, vec3 b) {
    vec3 a_hi = upper_half(a), b_hi = upper_half(b);
    precise vec3 a_lo = a - a_hi, b_lo = b - b_hi;
    precise vec3 hi = a * b;
    precise vec3 lo = ((a_hi * b_hi - hi) + a_hi * b_lo + a_lo * b_hi) + a_lo * b_lo;
    return Vec3x2(hi, lo);
}
Vec3x2 add(Vec3x2 a, Vec3x2 b) {
    Vec3x2 hi = sum_of(a.hi, b.hi), lo = sum_of(a.lo, b.lo);
    precise vec3 rest = hi.lo + lo.hi;
    Vec3x2 s = quick_sum_of(hi.hi, rest);
    precise vec3 tail = s.lo + lo.lo;
    return quick_sum_of(s.hi, tail);
}
Vec3x2 times(Vec3x2 a, Vec3x2 b) {
    Vec3x2 p = product_of(a.hi, b.hi);
    precise vec3 lo = p.lo + (a.hi * b.lo + a.lo * b.hi);
    return quick_sum_of(p.hi, lo);
}
Vec3x2 cross_of(Vec3x2 a, Vec3x2 b) {
    Vec3x2 p = times(Vec3x2(a.hi.yzx, a.lo.yzx), Vec3x2(b.hi.zxy, b.lo.zxy));
    Vec3x2 q = times(Vec3x2(a.hi.zxy, a.lo.zxy), Vec3x2(b.hi.yzx, b.lo.yzx));
    return add(p, Vec3x2(-q.hi, -q.lo));
}

void main() {
    uint v = push.first_vertex + gl_GlobalInvocationID.x;
    if (v >= push.end_vertex) return;
    LrOpLayout lr = lr_op_layout();
    vec3 at = position(v);
    Vec3x2 sum = Vec3x2(vec3(0.0), vec3(0.0));
    for (LrStar s = lr_star(lr, v); s.corner != LR_TABLE_NULL; lr_star_step(lr, s)) {
        // The difference of two floats is exact as a pair of floats.
        Vec3x2 a = sum_of(position(lr_vertex(lr, lr_next(s.corner))), -at);
        Vec3x2 b = sum_of(position(lr_vertex(lr, lr_previous(s.corner))), -at);
        sum = add(sum, cross_of(a, b));
    }
    vec3 n = sum.hi, size = abs(n);
    float most = max(size.x, max(size.y, size.z));
    n = most > 0.0 ? normalize(n / most) : vec3(0.0, 0.0, 1.0);
    Floats normals = Floats(push.normals);
    normals.at[3u * v] = n.x;
    normals.at[3u * v + 1u] = n.y;
    normals.at[3u * v + 2u] = n.z;
}
