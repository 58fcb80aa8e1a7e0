// What the shaders that use the LR tables (shaders/lacedring_operators.glsl) and C++ both read.
#ifndef LACEDRING_SHADERS_ADJACENCY_SHARED_H
#define LACEDRING_SHADERS_ADJACENCY_SHARED_H

#include "shaders/shared.h"

#ifdef __cplusplus
namespace lr::gpu {
#endif

// Every pass has the tables at binding 0 and the positions, 3 floats an LR vertex, at binding 1.

// vertex_normals.comp: one dispatch, from a vertex on.
struct NormalConstants {
    uint first_vertex;
    uint end_vertex;
};

// silhouette.vert, one picture.
struct SilhouetteFrame {
    mat4 view_from_world;
    mat4 clip_from_view;
    vec4 eye;  // in the world
    vec4 colour;
    float lift;  // as FrameConstants::line_lift
    float pad0, pad1, pad2;
};

// One draw, or one dispatch of silhouette_edges.comp. Line 3t + k is the edge across from corner 4t + k.
struct SilhouetteConstants {
    uint first_line;
    float crease_cos;  // an edge is a crease if its triangles' normals have a smaller cosine than this
};

// Why an edge is drawn.
#define LR_EDGE_BORDER 1u
#define LR_EDGE_SILHOUETTE 2u
#define LR_EDGE_CREASE 4u

#ifdef __cplusplus
}  // namespace lr::gpu
#endif
#endif
