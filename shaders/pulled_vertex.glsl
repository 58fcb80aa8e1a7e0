// The vertices of a stream's triangles, fetched by the stage that decodes.
#include "shaders/slot_source.glsl"
#include "shaders/surface_vertex.glsl"

SurfaceVertex pulled_vertex(uint v) {
    Floats vertices = Floats(push.vertices);
    uint at = v * LR_VERTEX_FLOATS;
    vec3 position = vec3(vertices.at[at], vertices.at[at + 1u], vertices.at[at + 2u]);
    vec3 normal = vec3(vertices.at[at + 3u], vertices.at[at + 4u], vertices.at[at + 5u]);
    return surface_vertex(position, normal, view == LR_VIEW_RING ? vertices.at[at + 6u] : -1.0);
}
