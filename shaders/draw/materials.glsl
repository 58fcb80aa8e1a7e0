// Reads materials and textures from buffers. Texels are interpolated here instead of by samplers, so that materials may
// have any number of images of any size, and every device gives the same picture.
#include "shaders/draw/surface.glsl"

layout(buffer_reference, std430, buffer_reference_align = 16) readonly buffer MaterialTable {
    MaterialHead head;
    MaterialConstants at[];
};

layout(location = 0) in vec3 in_position;
layout(location = 1) in vec3 in_normal;
layout(location = 3) in vec4 in_texture_at;
layout(location = 4) in vec4 in_color;

MaterialConstants material_of(uint triangle) {
    MaterialTable table = MaterialTable(push.materials);
    return table.at[Words(table.head.of_triangle).at[triangle]];
}

// Screen-space derivatives of both sets of texture coordinates. Must be computed before any fragment of a quad is
// discarded.
struct Steps {
    vec4 x, y;
};
Steps texture_steps() { return Steps(dFdx(in_texture_at), dFdy(in_texture_at)); }

vec2 set_of(TextureConstants t, vec4 sets) { return (t.sampling & LR_TEXTURE_SET) != 0u ? sets.zw : sets.xy; }

int wrapped(int i, int size, uint wrap) {
    if (wrap == 2u) return clamp(i, 0, size - 1);
    int period = wrap == 1u ? 2 * size : size;
    int at = i - period * int(floor(float(i) / float(period)));
    at = clamp(at, 0, period - 1);  // needed if i is too large for an exact float
    return at < size ? at : period - 1 - at;
}

vec4 texel(TextureConstants t, uint first, ivec2 size, ivec2 at) {
    int x = wrapped(at.x, size.x, t.sampling >> LR_TEXTURE_WRAP_U & 3u);
    int y = wrapped(at.y, size.y, t.sampling >> LR_TEXTURE_WRAP_V & 3u);
    return unpackUnorm4x8(Words(MaterialTable(push.materials).head.texels).at[first + uint(y * size.x + x)]);
}

// From sRGB to linear, by a cheap approximation, as it is applied to every texel before interpolation.
vec4 linear(vec4 c, bool is_color) {
    return is_color ? vec4(c.rgb * (c.rgb * (c.rgb * 0.305306011 + 0.682171111) + 0.012522878), c.a) : c;
}

vec4 level_at(TextureConstants t, uint level, vec2 uv, bool is_color) {
    uint first = t.first;
    ivec2 size = ivec2(t.size & 0xffffu, t.size >> 16);
    for (uint i = 0u; i < level; ++i) {
        first += uint(size.x * size.y);
        size = max(size / 2, ivec2(1));
    }
    vec2 at = clamp(uv * vec2(size), vec2(-1e8), vec2(1e8));
    if ((t.sampling & LR_TEXTURE_NEAREST) != 0u)
        return linear(texel(t, first, size, ivec2(floor(at))), is_color);
    at -= 0.5;
    ivec2 low = ivec2(floor(at));
    vec2 part = at - vec2(low);
    vec4 a = linear(texel(t, first, size, low), is_color);
    vec4 b = linear(texel(t, first, size, low + ivec2(1, 0)), is_color);
    vec4 c = linear(texel(t, first, size, low + ivec2(0, 1)), is_color);
    vec4 d = linear(texel(t, first, size, low + ivec2(1, 1)), is_color);
    return mix(mix(a, b, part.x), mix(c, d, part.x), part.y);
}

// The texture's value at the fragment; white if there is no texture.
vec4 sampled(TextureConstants t, Steps steps, bool is_color) {
    if (t.size == 0u) return vec4(1.0);
    vec2 set = set_of(t, in_texture_at);
    vec2 uv = vec2(dot(t.u.xy, set) + t.u.z, dot(t.v.xy, set) + t.v.z);
    vec2 size = vec2(t.size & 0xffffu, t.size >> 16), dx = set_of(t, steps.x), dy = set_of(t, steps.y);
    dx = vec2(dot(t.u.xy, dx), dot(t.v.xy, dx)) * size;
    dy = vec2(dot(t.u.xy, dy), dot(t.v.xy, dy)) * size;
    float level = clamp(0.5 * log2(max(max(dot(dx, dx), dot(dy, dy)), 1e-12)), 0.0, float(t.levels - 1u));
    uint low = uint(level);
    vec4 value = level_at(t, low, uv, is_color);
    float part = level - float(low);
    if (part > 0.0) value = mix(value, level_at(t, low + 1u, uv, is_color), part);
    return value;
}

// The surface's color before lighting: material, vertex color and texture.
vec4 base_of(MaterialConstants m, Steps steps) { return m.base_color * in_color * sampled(m.base, steps, true); }

// True if the material hides this fragment. Partly transparent surfaces are dithered: they hide some samples, so that
// the order of triangles does not matter.
bool is_hidden(MaterialConstants m, float alpha) {
    if ((m.flags.x & LR_MATERIAL_DOUBLE_SIDED) == 0u && !gl_FrontFacing) return true;
    if ((m.flags.x & LR_MATERIAL_MASK) != 0u) return alpha < m.emissive.w;
    if ((m.flags.x & LR_MATERIAL_BLEND) == 0u) return false;
    vec2 at = floor(gl_FragCoord.xy);
    return alpha <= fract(52.9829189 * fract(dot(at, vec2(0.06711056, 0.00583715))));
}
