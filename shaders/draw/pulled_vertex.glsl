// Fetches a vertex of a stream's triangle, in the stage that decodes the triangle. Decodes the position if it comes
// from a vertex stream.
#include "shaders/draw/slot_source.glsl"
#include "shaders/draw/surface_vertex.glsl"
#include "shaders/draw/vertex_source.glsl"

layout(constant_id = LR_CONSTANT_VERTEX_STREAM) const bool vertex_stream = false;

SurfaceVertex pulled_vertex(uint v) {
    Floats vertices = Floats(push.vertices);
    uint at = v * (vertex_stream ? LR_VERTEX_FLOATS - LR_POSITION_FLOATS : LR_VERTEX_FLOATS);
    vec3 position;
    if (vertex_stream) {
        position = uintBitsToFloat(stream_position(stream_vertex(v)));
    } else {
        position = vec3(vertices.at[at], vertices.at[at + 1u], vertices.at[at + 2u]);
        at += LR_POSITION_FLOATS;
    }
    vec3 normal = vec3(vertices.at[at], vertices.at[at + 1u], vertices.at[at + 2u]);
    return surface_vertex(position, normal, view == LR_VIEW_RING ? vertices.at[at + 3u] : -1.0, v);
}
