#version 460
#extension GL_GOOGLE_include_directive : require
// Makes the viewer's picture from one or two drawn pictures of the same size: adds the background, paints triangles by
// their number, and shows two pictures side by side or their difference.
#include "shaders/viewer/compose_shared.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0, rgba8) uniform readonly image2D left_color;
layout(binding = 1, r32ui) uniform readonly uimage2D left_triangles;
layout(binding = 2, rgba8) uniform readonly image2D right_color;
layout(binding = 3, r32ui) uniform readonly uimage2D right_triangles;
layout(binding = 4, rgba8) uniform writeonly image2D composed;
layout(std430, binding = 5) readonly buffer Paint { uint paint[]; };  // RGBA, one per triangle of the mesh
layout(std430, binding = 6) readonly buffer Growth { GrowthTriangle growth[]; };
layout(push_constant) uniform Push { ComposeConstants push; };
// Specialization constants, as a device that executes both sides of every branch (a CPU) would waste time on unused
// ones.
layout(constant_id = 0) const uint kMode = LR_COMPOSE_LEFT;
layout(constant_id = 1) const uint kSamples = 1;  // of the drawn pictures, per pixel along each side
layout(constant_id = 2) const uint kPaint = LR_PAINT_NONE;

// to_linear of every 8-bit value, computed once per workgroup instead of for each sample.
shared float linear_of[256];

float to_linear(float x) { return x <= 0.04045 ? x / 12.92 : pow((x + 0.055) / 1.055, 2.4); }
float to_srgb(float x) { return x <= 0.0031308 ? 12.92 * x : 1.055 * pow(x, 1.0 / 2.4) - 0.055; }
vec3 linear(vec3 c) { return vec3(to_linear(c.x), to_linear(c.y), to_linear(c.z)); }
vec3 srgb(vec3 c) { return vec3(to_srgb(c.x), to_srgb(c.y), to_srgb(c.z)); }

// Same as background() in renderer/draw/picture.cpp.
vec3 background(vec2 at) {
    vec2 d = at - vec2(0.5, 0.42);
    float t = min(1.0, length(d) * 1.25);
    float s = t * t * (3.0 - 2.0 * t);
    return vec3(246.0 - 34.0 * s, 247.0 - 32.0 * s, 249.0 - 28.0 * s) / 255.0;
}

// Replaces the surface's color by `over`, keeping the light on it.
vec3 recolored(vec3 color, vec4 over) {
    vec3 light = linear(color) / vec3(0.62, 0.60, 0.565);
    if ((kPaint & LR_PAINT_FLAT) != 0u) {
        light = vec3(smoothstep(0.002, 0.02, dot(linear(color), vec3(0.2126, 0.7152, 0.0722))));
    }
    vec3 lit = srgb(min(linear(over.rgb) * light, vec3(1.0)));
    return mix(color, lit, over.a);
}

uint triangle_at(bool right, ivec2 at) {
    return right ? imageLoad(right_triangles, at).x : imageLoad(left_triangles, at).x;
}

// The colors that the panel explains (app/view/ui/panel_choices.cpp).
vec3 growth_color(uint step) {
    uint settled = step & ~LR_GROWTH_RIGHT;
    if (settled >= push.invaded) return vec3(LR_GROWTH_NOT_YET_COLOR) / 255.0;
    if (step >= LR_GROWTH_RIGHT) return vec3(LR_GROWTH_RIGHT_COLOR) / 255.0;
    uint age = push.invaded - 1u - settled;
    vec3 invaded = vec3(LR_GROWTH_INVADED_COLOR) / 255.0;
    if (age >= push.fresh) return invaded;
    return mix(vec3(LR_GROWTH_NEWEST_COLOR) / 255.0, invaded, 0.6 * float(age) / float(push.fresh));
}

uvec3 triangles_across(uint i) { return uvec3(growth[i].across[0], growth[i].across[1], growth[i].across[2]); }

bool is_among(uint i, uvec3 triangles) { return i != LR_GROWTH_BORDER && any(equal(triangles, uvec3(i))); }

// The ring so far separates invaded triangles from the others. A sample of a triangle is on the ring's line if a sample
// nearby shows a triangle across one of its ring edges, or around the end of one. So the surface hides the line as it
// hides itself, no line is drawn where parts of the surface merely overlap, and the cost depends on the samples, not on
// the triangles.
vec4 ring_line(uint i, bool right, ivec2 at) {
    uint step = growth[i].step;
    uvec3 across = triangles_across(i);
    bool inside = step < push.invaded;  // false if LR_GROWTH_RIGHT is set
    ivec2 last = imageSize(left_triangles) - 1;
    // Looks at the full reach first, then nearer: the sample at full reach may lie beyond the neighboring triangle.
    for (int d = int(inside ? push.inner : push.outer); d > 0; d /= 2) {
        for (int k = 0; k < 4; ++k) {
            ivec2 to = clamp(at + d * (k < 2 ? ivec2(2 * k - 1, 0) : ivec2(0, 2 * k - 5)), ivec2(0), last);
            uint other = triangle_at(right, to) & ~LR_FRONT_FLAG;
            if (other == i + 1u) continue;
            if (other == 0u) {
                if (inside && any(equal(across, uvec3(LR_GROWTH_BORDER)))) {
                    return vec4(vec3(LR_GROWTH_LINE_COLOR) / 255.0, push.line_opacity);
                }
                continue;
            }
            uint j = other - 1u;
            uint beyond = growth[j].step;
            if (inside == (beyond < push.invaded)) continue;
            if (!is_among(j, across)) {
                uvec3 there = triangles_across(j);
                if (!is_among(across.x, there) && !is_among(across.y, there) && !is_among(across.z, there)) continue;
            }
            bool stays = ((inside ? beyond : step) & ~LR_GROWTH_RIGHT) < push.invaded;
            if (stays) return vec4(vec3(LR_GROWTH_LINE_COLOR) / 255.0, push.line_opacity);
            return vec4(vec3(LR_GROWTH_FRONT_COLOR) / 255.0, max(push.line_opacity, 0.75));
        }
    }
    return vec4(0.0);
}

vec3 painted(vec3 color, uint triangle, bool right, ivec2 at) {
    if (kPaint == LR_PAINT_NONE || triangle == 0u) return color;
    uint i = (triangle & ~LR_FRONT_FLAG) - 1u;
    if (i >= push.triangles) return color;
    vec4 over = (kPaint & LR_PAINT_TRIANGLES) != 0u ? unpackUnorm4x8(paint[i]) : vec4(0.0);
    vec3 lit = color;
    if (over.a != 0.0) {
        lit = recolored(color, over);
    } else if ((kPaint & LR_PAINT_GROWTH) != 0u) {
        vec3 grown = growth_color(growth[i].step);
        // Approximates recolored() by treating sRGB as a pure power, a few percent off: this runs every frame.
        lit = (kPaint & LR_PAINT_FLAT) != 0u ? recolored(color, vec4(grown, 1.0))
                                             : min(grown * color / vec3(0.808, 0.797, 0.776), vec3(1.0));
    }
    if ((kPaint & LR_PAINT_RING) == 0u) return lit;
    vec4 line = ring_line(i, right, at);
    return mix(lit, line.rgb, line.a);
}

// The color of one sample on the background.
vec3 sample_at(vec4 c, bool right, ivec2 at, vec3 behind) {
    vec3 over = c.a == 1.0 ? painted(c.rgb, triangle_at(right, at), right, at) : c.rgb;
    return floor((over + (1.0 - c.a) * behind) * 255.0 + 0.5) / 255.0;
}

void main() {
    if (kSamples > 1u) {
        for (uint k = gl_LocalInvocationIndex; k < 256u; k += 64u) linear_of[k] = to_linear(float(k) / 255.0);
        barrier();
    }
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    ivec2 size = imageSize(composed);
    if (at.x >= size.x || at.y >= size.y) return;
    vec3 behind = background((vec2(at) + 0.5) / vec2(size));
    int n = int(kSamples);
    vec3 color;
    if (kMode == LR_COMPOSE_DIFFERENCE) {
        bool same = true;
        vec3 pale = vec3(0.0);
        for (int j = 0; j < n; ++j) {
            for (int i = 0; i < n; ++i) {
                ivec2 s = at * n + ivec2(i, j);
                same = same && imageLoad(left_color, s) == imageLoad(right_color, s) &&
                       imageLoad(left_triangles, s).x == imageLoad(right_triangles, s).x;
                pale += sample_at(imageLoad(left_color, s), false, s, behind);
            }
        }
        float gray = dot(pale / float(n * n), vec3(0.299, 0.587, 0.114));
        color = same ? mix(vec3(gray), vec3(1.0), 0.55) : vec3(0.85, 0.06, 0.06);
    } else {
        bool right = kMode == LR_COMPOSE_SPLIT && at.x >= int(push.divider);
        if (n == 1) {
            color = sample_at(right ? imageLoad(right_color, at) : imageLoad(left_color, at), right, at, behind);
        } else {
            vec3 sum = vec3(0.0);
            int empty = 0;
            for (int j = 0; j < n; ++j) {
                for (int i = 0; i < n; ++i) {
                    ivec2 s = at * n + ivec2(i, j);
                    vec4 drawn = right ? imageLoad(right_color, s) : imageLoad(left_color, s);
                    if (drawn.a == 0.0) {
                        ++empty;
                        continue;
                    }
                    uvec3 level = uvec3(sample_at(drawn, right, s, behind) * 255.0 + 0.5);
                    sum += vec3(linear_of[level.x], linear_of[level.y], linear_of[level.z]);
                }
            }
            behind = floor(behind * 255.0 + 0.5) / 255.0;
            color = empty == n * n ? behind : srgb((sum + float(empty) * linear(behind)) / float(n * n));
        }
    }
    imageStore(composed, at, vec4(color, 1.0));
}
