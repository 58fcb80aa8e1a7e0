// Decodes the position of one vertex from the vertex stream.
#include "shaders/draw/draw_push.glsl"

#define LR_VERTEX_WORD(i) Words(push.vertex_stream).at[i]
#define LR_VERTEX_COMPONENTS 3u
#define LR_VERTEX_PUT(i)
#include "shaders/include/lacedring_vertices.glsl"

// The bits of the position's floats; v is a vertex of the stream. Decodes the vertex's block up to it.
uvec3 stream_position(uint v) {
    LrVertexLayout p = lr_vertex_layout();
    lr_vertex_block(p, v / LR_VERTEX_BLOCK, v % LR_VERTEX_BLOCK + 1u);
    return uvec3(lr_vertex_float(p, 3u * v, lr_vertex_value[0]), lr_vertex_float(p, 3u * v + 1u, lr_vertex_value[1]),
                 lr_vertex_float(p, 3u * v + 2u, lr_vertex_value[2]));
}

// The stream's vertex of a drawn vertex v.
uint stream_vertex(uint v) { return seams ? Words(push.copy_vertices).at[v] : v; }
