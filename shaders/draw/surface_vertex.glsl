// Computes a vertex of the surface, for every stage that emits vertices. All use this code, as passes compare depths
// for equality.
#include "shaders/draw/draw_push.glsl"

layout(binding = 0) uniform Frame { FrameConstants frame; };
layout(constant_id = 0) const uint view = LR_VIEW_SMOOTH;  // data that the view does not use is not fetched

struct SurfaceVertex {
    vec4 clip;
    vec3 position;  // position and normal are in view space
    vec3 normal;
    vec3 ring_color;
    vec4 texture_at;  // two sets of texture coordinates
    vec4 color;
};

vec3 ring_color(float t) {
    if (t < 0.0) return vec3(0.42);
    // Blue, teal, sand, red, in even steps of lightness, so that neighboring corridors can be told apart.
    const vec3 stops[5] = vec3[](vec3(0.045, 0.085, 0.50), vec3(0.03, 0.34, 0.72), vec3(0.62, 0.78, 0.72),
                                 vec3(0.92, 0.46, 0.12), vec3(0.52, 0.02, 0.03));
    float x = clamp(t, 0.0, 1.0) * 4.0;
    int i = min(int(x), 3);
    return mix(stops[i], stops[i + 1], x - float(i));
}

// position: in the source's coordinates; ring: position along the rings in [0, 1], negative if on no ring; number: of the
// vertex, among the drawn vertices.
SurfaceVertex surface_vertex(vec3 position, vec3 normal, float ring, uint number) {
    SurfaceVertex v;
    precise vec4 from_eye = frame.view_from_world * vec4(unit_position(position), 1.0);
    precise vec4 clip = frame.clip_from_view * from_eye;
    v.clip = clip;
    v.position = from_eye.xyz;
    v.normal = mat3(frame.view_from_world) * normal;
    v.ring_color = view == LR_VIEW_RING ? ring_color(ring) : vec3(0.0);
    v.texture_at = vec4(0.0);
    v.color = vec4(1.0);
    if (view == LR_VIEW_MATERIAL) {
        Words shading = Words(push.shading);
        uint at = LR_SHADING_WORDS * number;
        v.texture_at = uintBitsToFloat(
            uvec4(shading.at[at], shading.at[at + 1u], shading.at[at + 2u], shading.at[at + 3u]));
        v.color = vec4(unpackUnorm2x16(shading.at[at + 4u]), unpackUnorm2x16(shading.at[at + 5u]));
    }
    return v;
}
