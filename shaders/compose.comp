#version 460
#extension GL_GOOGLE_include_directive : require
// The viewer's picture of what was drawn: on the background, with colours laid over triangles by their number, and two
// pictures of the same size side by side or compared.
#include "shaders/compose_shared.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0, rgba8) uniform readonly image2D left_colour;
layout(binding = 1, r32ui) uniform readonly uimage2D left_triangles;
layout(binding = 2, rgba8) uniform readonly image2D right_colour;
layout(binding = 3, r32ui) uniform readonly uimage2D right_triangles;
layout(binding = 4, rgba8) uniform writeonly image2D composed;
layout(std430, binding = 5) readonly buffer Paint { uint paint[]; };  // RGBA, one a triangle of the mesh
layout(push_constant) uniform Push { ComposeConstants push; };

float to_linear(float x) { return x <= 0.04045 ? x / 12.92 : pow((x + 0.055) / 1.055, 2.4); }
float to_srgb(float x) { return x <= 0.0031308 ? 12.92 * x : 1.055 * pow(x, 1.0 / 2.4) - 0.055; }
vec3 linear(vec3 c) { return vec3(to_linear(c.x), to_linear(c.y), to_linear(c.z)); }
vec3 srgb(vec3 c) { return vec3(to_srgb(c.x), to_srgb(c.y), to_srgb(c.z)); }

// As finish() (renderer/picture.cpp) has it.
vec3 background(vec2 at) {
    vec2 d = at - vec2(0.5, 0.42);
    float t = min(1.0, length(d) * 1.25);
    float s = t * t * (3.0 - 2.0 * t);
    return vec3(246.0 - 34.0 * s, 247.0 - 32.0 * s, 249.0 - 28.0 * s) / 255.0;
}

vec3 painted(vec3 colour, uint triangle) {
    if (push.paint == LR_PAINT_NONE || triangle == 0u) return colour;
    uint i = (triangle & ~LR_FRONT_FLAG) - 1u;
    if (i >= push.triangles) return colour;
    vec4 over = unpackUnorm4x8(paint[i]);
    if (over.a == 0.0) return colour;
    // The light on it stays: the surface's own colour is replaced, not its shading.
    vec3 light = linear(colour) / vec3(0.62, 0.60, 0.565);
    if (push.paint == LR_PAINT_FLAT) {
        light = vec3(smoothstep(0.002, 0.02, dot(linear(colour), vec3(0.2126, 0.7152, 0.0722))));
    }
    vec3 lit = srgb(min(linear(over.rgb) * light, vec3(1.0)));
    return mix(colour, lit, over.a);
}

// One sample, on the background.
vec3 sample_at(bool right, ivec2 at, vec3 behind) {
    vec4 c = right ? imageLoad(right_colour, at) : imageLoad(left_colour, at);
    uint triangle = right ? imageLoad(right_triangles, at).x : imageLoad(left_triangles, at).x;
    vec3 over = c.a == 1.0 ? painted(c.rgb, triangle) : c.rgb;
    return floor((over + (1.0 - c.a) * behind) * 255.0 + 0.5) / 255.0;
}

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    ivec2 size = imageSize(composed);
    if (at.x >= size.x || at.y >= size.y) return;
    vec3 behind = background((vec2(at) + 0.5) / vec2(size));
    int n = int(push.samples);
    vec3 colour;
    if (push.mode == LR_COMPOSE_DIFFERENCE) {
        bool same = true;
        vec3 pale = vec3(0.0);
        for (int j = 0; j < n; ++j) {
            for (int i = 0; i < n; ++i) {
                ivec2 s = at * n + ivec2(i, j);
                same = same && imageLoad(left_colour, s) == imageLoad(right_colour, s) &&
                       imageLoad(left_triangles, s).x == imageLoad(right_triangles, s).x;
                pale += sample_at(false, s, behind);
            }
        }
        float grey = dot(pale / float(n * n), vec3(0.299, 0.587, 0.114));
        colour = same ? mix(vec3(grey), vec3(1.0), 0.55) : vec3(0.85, 0.06, 0.06);
    } else {
        bool right = push.mode == LR_COMPOSE_SPLIT && at.x >= int(push.divider);
        if (n == 1) {
            colour = sample_at(right, at, behind);
        } else {
            vec3 sum = vec3(0.0);
            for (int j = 0; j < n; ++j) {
                for (int i = 0; i < n; ++i) sum += linear(sample_at(right, at * n + ivec2(i, j), behind));
            }
            colour = srgb(sum / float(n * n));
        }
    }
    imageStore(composed, at, vec4(colour, 1.0));
}
