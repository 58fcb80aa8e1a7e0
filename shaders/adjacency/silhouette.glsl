// Decides from the LR tables which edges of a mesh are drawn as its outline; there is no edge list. Include after
// lacedring_operators.glsl, in a shader that defines vec3 lr_position(uint v).
#include "shaders/adjacency/adjacency_shared.h"

struct LrEdge {
    uint kind;  // LR_EDGE_*, or 0: nothing to draw
    uint from, to;
};

// The edge opposite corner k of triangle t. An edge with two opposite corners is drawn from the one with the smaller
// number. Positions are scaled by 2^20, so that the normals (cross products) of the smallest triangles do not
// underflow. A triangle without area faces away, and its edges are no creases.
LrEdge lr_edge(LrOpLayout lr, uint t, uint k, vec3 eye, float crease_cos) {
    LrEdge edge = LrEdge(0u, 0u, 0u);
    if (!lr_is_canonical(lr, t)) return edge;
    uint c = 4u * t + k, o = lr_opposite(lr, c);
    if (o < c) return edge;
    edge.from = lr_vertex(lr, lr_next(c));
    edge.to = lr_vertex(lr, lr_previous(c));
    if (o == LR_TABLE_NULL) {
        edge.kind = LR_EDGE_BORDER;
        return edge;
    }
    const float scale = 1048576.0;
    vec3 a = lr_position(edge.from), b = lr_position(edge.to);
    vec3 along = (b - a) * scale;
    precise vec3 near = cross(along, (lr_position(lr_vertex(lr, c)) - a) * scale);
    precise vec3 far = cross((lr_position(lr_vertex(lr, o)) - a) * scale, along);
    precise float near_faces = dot(near, eye - a), far_faces = dot(far, eye - a);
    if ((near_faces > 0.0) != (far_faces > 0.0)) edge.kind |= LR_EDGE_SILHOUETTE;
    float lengths = length(near) * length(far);
    if (lengths > 0.0 && dot(near, far) < crease_cos * lengths) edge.kind |= LR_EDGE_CREASE;
    return edge;
}
