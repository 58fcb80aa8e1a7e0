#version 460
#extension GL_GOOGLE_include_directive : require
// Color and triangle number of a surface with a material: metallic-roughness shading as in glTF, under lights and a sky
// that stay with the camera.
#include "shaders/draw/materials.glsl"

layout(constant_id = 1) const bool resolve = false;  // only the triangle that claimed the pixel (material_claim.frag)

layout(binding = 3, r32ui) uniform readonly uimage2D winner;

layout(location = 0) out vec4 out_color;
layout(location = 1) out uint out_triangle;

float srgb(float x) { return x <= 0.0031308 ? 12.92 * x : 1.055 * pow(x, 1.0 / 2.4) - 0.055; }

// Light that arrives from a direction: ground, horizon, sky and a wide lamp. Rougher surfaces see them more blurred.
vec3 sky(vec3 from, float rough) {
    const vec3 ground = vec3(0.17, 0.155, 0.145), horizon = vec3(0.88, 0.90, 0.92), zenith = vec3(0.42, 0.50, 0.62);
    float blur = mix(0.08, 1.0, rough);
    vec3 above = mix(horizon, zenith, smoothstep(0.0, 1.0, max(from.y, 0.0)));
    vec3 plain = mix(ground, above, smoothstep(-blur, blur, from.y));
    const vec3 lamp = normalize(vec3(-0.50, 0.55, 0.67));
    float near = clamp(dot(from, lamp), 0.0, 1.0);
    float width = mix(0.030, 0.50, rough);
    return plain + smoothstep(1.0 - 2.0 * width, 1.0 - 0.5 * width, near) * mix(2.6, 0.35, sqrt(rough));
}

// The normal of the surface, modified by the normal map. The map's x axis points along increasing u, its y axis along
// decreasing v.
vec3 normal_of(MaterialConstants m, Steps steps, vec3 dx, vec3 dy) {
    vec3 n = normalize(in_normal);
    if (!gl_FrontFacing) n = -n;
    if ((m.flags.x & LR_MATERIAL_FLAT) != 0u) {
        vec3 facet = cross(dx, dy);
        if (dot(facet, facet) > 0.0) n = normalize(dot(facet, in_position) > 0.0 ? -facet : facet);
    }
    if (m.normal.size == 0u) return n;
    vec2 sx = set_of(m.normal, steps.x), sy = set_of(m.normal, steps.y);
    sx = vec2(dot(m.normal.u.xy, sx), dot(m.normal.v.xy, sx));
    sy = vec2(dot(m.normal.u.xy, sy), dot(m.normal.v.xy, sy));
    vec3 across_y = cross(dy, n), across_x = cross(n, dx);
    vec3 along_u = across_y * sx.x + across_x * sy.x, along_v = across_y * sx.y + across_x * sy.y;
    float size = max(dot(along_u, along_u), dot(along_v, along_v));
    vec3 map = sampled(m.normal, steps, false).xyz * 2.0 - 1.0;
    map.xy *= m.surface.z;
    if (!(size > 0.0)) return n;
    vec3 turned = (along_u * map.x - along_v * map.y) * inversesqrt(size) * (gl_FrontFacing ? 1.0 : -1.0) + n * map.z;
    return dot(turned, turned) > 0.0 ? normalize(turned) : n;
}

// The part of light of strength 1 from direction `from` that is reflected toward the eye, dot(n, from) included.
vec3 reflected(vec3 n, vec3 from, vec3 to_eye, vec3 diffuse, vec3 f0, float rough) {
    vec3 h = normalize(from + to_eye);
    float nl = clamp(dot(n, from), 0.0, 1.0), nv = clamp(dot(n, to_eye), 1e-3, 1.0);
    float nh = clamp(dot(n, h), 0.0, 1.0), vh = clamp(dot(to_eye, h), 0.0, 1.0);
    float a = rough * rough, aa = a * a;
    float d = nh * nh * (aa - 1.0) + 1.0;
    float k = nl * sqrt(nv * nv * (1.0 - aa) + aa) + nv * sqrt(nl * nl * (1.0 - aa) + aa);
    vec3 f = f0 + (1.0 - f0) * pow(1.0 - vh, 5.0);
    return ((1.0 - f) * diffuse + f * (aa / (d * d)) * (0.5 / max(k, 1e-5))) * nl;
}

// Khronos PBR Neutral tone mapping, which keeps hues in strong light.
vec3 toned(vec3 c) {
    const float start = 0.76, desaturation = 0.15;
    float low = min(c.r, min(c.g, c.b));
    c -= low < 0.08 ? low - 6.25 * low * low : 0.04;
    float peak = max(c.r, max(c.g, c.b));
    if (peak < start) return c;
    const float room = 1.0 - start;
    float top = 1.0 - room * room / (peak + room - start);
    c *= top / peak;
    return mix(c, vec3(top), 1.0 - 1.0 / (desaturation * (peak - top) + 1.0));
}

vec3 lit(MaterialConstants m, Steps steps, vec3 base, vec3 dx, vec3 dy) {
    vec4 said = sampled(m.metallic_roughness, steps, false);
    float metallic = clamp(m.surface.x * said.b, 0.0, 1.0), rough = clamp(m.surface.y * said.g, 0.05, 1.0);
    float open = 1.0 - m.surface.w * (1.0 - sampled(m.occluding, steps, false).r);
    vec3 n = normal_of(m, steps, dx, dy), to_eye = normalize(-in_position);
    vec3 diffuse = base * (1.0 - metallic), f0 = mix(vec3(0.04), base, metallic);
    const vec3 key = normalize(vec3(-0.45, 0.72, 0.62)), fill = normalize(vec3(0.80, 0.05, 0.45));
    vec3 color = reflected(n, key, to_eye, diffuse, f0, rough) * vec3(0.94, 0.89, 0.82) +
                  reflected(n, fill, to_eye, diffuse, f0, rough) * vec3(0.16, 0.19, 0.24);
    // Adds the light of the sky: its mean over the hemisphere, and its reflection.
    float nv = clamp(dot(n, to_eye), 0.0, 1.0);
    vec4 r = rough * vec4(-1.0, -0.0275, -0.572, 0.022) + vec4(1.0, 0.0425, 1.04, -0.04);
    float a = min(r.x * r.x, exp2(-9.28 * nv)) * r.x + r.y;
    vec2 part = vec2(-1.04, 1.04) * a + r.zw;
    color += open * (0.54 * diffuse * sky(n, 1.0) + (f0 * part.x + part.y) * sky(reflect(-to_eye, n), rough));
    return color;
}

void main() {
    Steps steps = texture_steps();
    vec3 dx = dFdx(in_position), dy = dFdy(in_position);
    uint triangle = original_triangle();
    MaterialConstants m = material_of(triangle);
    vec4 base = base_of(m, steps);
    if (resolve && imageLoad(winner, ivec2(gl_FragCoord.xy)).x != triangle) discard;
    if (is_hidden(m, base.a)) discard;
    vec3 color = base.rgb;
    if ((m.flags.x & LR_MATERIAL_UNLIT) == 0u) {
        color = lit(m, steps, base.rgb, dx, dy) + m.emissive.rgb * sampled(m.emitting, steps, true).rgb;
        color = toned(color);
    }
    color = clamp(color, vec3(0.0), vec3(1.0));
    out_color = vec4(srgb(color.x), srgb(color.y), srgb(color.z), 1.0);
    out_triangle = (triangle + 1u) | (gl_FrontFacing ? LR_FRONT_FLAG : 0u);
}
