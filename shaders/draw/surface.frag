#version 460
#extension GL_GOOGLE_include_directive : require
// Color and triangle number of the surface.
#include "shaders/draw/surface.glsl"

layout(early_fragment_tests) in;
layout(constant_id = 0) const uint view = LR_VIEW_SMOOTH;
layout(constant_id = 1) const bool resolve = false;  // only the triangle that claimed the pixel (claim.frag)

layout(binding = 3, r32ui) uniform readonly uimage2D winner;

layout(location = 0) in vec3 in_position;
layout(location = 1) in vec3 in_normal;
layout(location = 2) in vec3 in_ring_color;

layout(location = 0) out vec4 out_color;
layout(location = 1) out uint out_triangle;

// This triangle's byte of `classes`.
uint slot_class() {
    uint i = uint(gl_PrimitiveID);
    return (classes[i / 4u] >> (8u * (i % 4u))) & 0xffu;
}

vec3 class_color() {
    uint c = slot_class();
    if (c == LR_CLASS_T0) return vec3(0.13, 0.42, 0.10);
    if (c == LR_CLASS_T1_LEFT) return vec3(0.82, 0.70, 0.44);
    if (c == LR_CLASS_T1_RIGHT) return vec3(0.84, 0.31, 0.055);
    if (c == LR_CLASS_T2) return vec3(0.06, 0.20, 0.58);
    if (c == LR_CLASS_T0_WART) return vec3(0.58, 0.03, 0.03);
    return vec3(0.30);
}

// Colors for 1 to 16 bits (yellow, red, violet); more bits like 16; T0 green.
vec3 offset_color() {
    uint bits = slot_class();
    if (bits == LR_OFFSET_T0) return vec3(0.13, 0.42, 0.10);
    if (bits == LR_OFFSET_NONE) return vec3(0.30);
    const vec3 stops[4] = vec3[](vec3(0.96, 0.84, 0.36), vec3(0.86, 0.30, 0.07), vec3(0.42, 0.03, 0.16),
                                 vec3(0.10, 0.02, 0.28));
    float x = min(float(bits - 1u) / 5.0, 3.0);
    int i = min(int(x), 2);
    return mix(stops[i], stops[i + 1], x - float(i));
}

float srgb(float x) { return x <= 0.0031308 ? 12.92 * x : 1.055 * pow(x, 1.0 / 2.4) - 0.055; }

// Lights that stay with the camera: a warm key from the upper left, a cool fill from the right, sky and ground.
vec3 lit(vec3 albedo, vec3 n, float gloss) {
    vec3 to_eye = normalize(-in_position);
    const vec3 key = normalize(vec3(-0.45, 0.72, 0.62));
    const vec3 fill = normalize(vec3(0.80, 0.05, 0.45));
    // Wrapped diffuse: the light has no hard edge, which would flicker on dense meshes.
    float k = clamp((dot(n, key) + 0.20) / 1.20, 0.0, 1.0);
    float f = clamp((dot(n, fill) + 0.35) / 1.35, 0.0, 1.0);
    vec3 sky = mix(vec3(0.10, 0.095, 0.095), vec3(0.24, 0.27, 0.32), 0.5 + 0.5 * n.y);
    vec3 light = sky + k * k * vec3(1.02, 0.97, 0.89) + f * vec3(0.10, 0.14, 0.20);
    float highlight = pow(clamp(dot(n, normalize(key + to_eye)), 0.0, 1.0), 48.0);
    float rim = pow(1.0 - clamp(dot(n, to_eye), 0.0, 1.0), 4.0);
    return albedo * light + gloss * (0.16 * highlight * vec3(1.0, 0.97, 0.92) + 0.10 * rim * vec3(0.6, 0.7, 0.9));
}

void main() {
    // Derivatives need the whole quad, so they come before the discard.
    vec3 facet = cross(dFdx(in_position), dFdy(in_position));
    uint triangle = original_triangle();
    if (resolve && imageLoad(winner, ivec2(gl_FragCoord.xy)).x != triangle) discard;

    vec3 albedo = vec3(0.62, 0.60, 0.565);
    float gloss = 1.0;
    if (view == LR_VIEW_CLASS) {
        albedo = class_color();
        gloss = 0.25;
    } else if (view == LR_VIEW_OFFSETS) {
        albedo = offset_color();
        gloss = 0.25;
    } else if (view == LR_VIEW_RING) {
        albedo = in_ring_color;
        gloss = 0.35;
    } else if (view == LR_VIEW_SILHOUETTE) {
        albedo = vec3(0.80, 0.78, 0.74);
        gloss = 0.1;
    } else if (view == LR_VIEW_WIRE) {
        albedo = vec3(0.66, 0.68, 0.70);
        gloss = 0.2;
    }
    vec3 color;
    if (view == LR_VIEW_SMOOTH || view == LR_VIEW_RING || view == LR_VIEW_SILHOUETTE || view == LR_VIEW_SEAMS) {
        // Both sides are lit and blended by the normal's direction, not chosen by gl_FrontFacing: at a silhouette, two
        // neighbors that face toward and away from the eye have nearly the same depth, so rounding decides which is
        // visible, and both must look the same.
        vec3 n = normalize(in_normal);
        float facing = dot(n, normalize(-in_position));
        color = mix(lit(albedo, -n, gloss), lit(albedo, n, gloss), smoothstep(-0.12, 0.12, facing));
    } else {
        vec3 n = dot(facet, facet) > 0.0 ? normalize(facet) : vec3(0.0, 0.0, 1.0);
        color = lit(albedo, dot(n, in_position) > 0.0 ? -n : n, gloss);
    }
    color = min(color, vec3(1.0));
    out_color = vec4(srgb(color.x), srgb(color.y), srgb(color.z), 1.0);
    out_triangle = (triangle + 1u) | (gl_FrontFacing ? LR_FRONT_FLAG : 0u);
}
