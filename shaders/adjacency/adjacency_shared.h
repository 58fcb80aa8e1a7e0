// What the shaders that use the LR tables (shaders/include/lacedring_operators.glsl) and C++ both read.
#ifndef LACEDRING_SHADERS_ADJACENCY_SHARED_H
#define LACEDRING_SHADERS_ADJACENCY_SHARED_H

#include "shaders/shared.h"

#ifdef __cplusplus
namespace lacedring::gpu {
#endif

// Addresses of the tables and of positions and normals, 3 floats an LR vertex: no descriptor needs to cover them. The
// shaders of tests have the first two at bindings 0 and 1 instead.

// vertex_normals.comp: one dispatch, from a vertex on.
struct NormalConstants {
    uvec2 tables;
    uvec2 positions;
    uvec2 normals;
    uint first_vertex;
    uint end_vertex;
};

// silhouette.vert, one picture.
struct SilhouetteFrame {
    mat4 view_from_world;
    mat4 clip_from_view;
    vec4 eye;  // in the world
    vec4 colour;
};

// One draw, or one dispatch of silhouette_edges.comp. Line 3t + k is the edge across from corner 4t + k.
struct SilhouetteConstants {
    uvec2 tables;
    uvec2 positions;
    uint first_line;
    float crease_cos;  // an edge is a crease if its triangles' normals have a smaller cosine than this
};

// Why an edge is drawn.
#define LR_EDGE_BORDER 1u
#define LR_EDGE_SILHOUETTE 2u
#define LR_EDGE_CREASE 4u

#ifdef __cplusplus
}  // namespace lacedring::gpu
#endif
#endif
