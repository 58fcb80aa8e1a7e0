// Structs and constants shared by C++ and the shaders that use LR tables (shaders/include/lacedring_operators.glsl).
#ifndef LACEDRING_SHADERS_ADJACENCY_SHARED_H
#define LACEDRING_SHADERS_ADJACENCY_SHARED_H

#include "shaders/shared.h"

#ifdef __cplusplus
namespace lacedring::gpu {
#endif

// Tables, positions and normals (3 floats per LR vertex) are passed as addresses, so that no descriptor must cover
// them. The shaders of tests have tables and positions at bindings 0 and 1 instead.

// vertex_normals.comp: one dispatch over vertices [first_vertex, end_vertex).
struct NormalConstants {
    uvec2 tables;
    uvec2 positions;
    uvec2 normals;
    uint first_vertex;
    uint end_vertex;
};

// silhouette.vert: constants of one frame.
struct SilhouetteFrame {
    mat4 view_from_world;
    mat4 clip_from_view;
    vec4 eye;  // in world space
    vec4 color;
};

// Constants of one draw, or of one dispatch of silhouette_edges.comp. Line 3t + k is the edge opposite corner 4t + k.
struct SilhouetteConstants {
    uvec2 tables;
    uvec2 positions;
    uint first_line;
    float crease_cos;  // an edge is a crease if the cosine between its triangles' normals is smaller than this
};

// Reasons for drawing an edge.
#define LR_EDGE_BORDER 1u
#define LR_EDGE_SILHOUETTE 2u
#define LR_EDGE_CREASE 4u

#ifdef __cplusplus
}  // namespace lacedring::gpu
#endif
#endif
