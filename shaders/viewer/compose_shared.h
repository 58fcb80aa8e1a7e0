// Structs and constants shared by the viewer's C++ and compose.comp.
#ifndef LACEDRING_SHADERS_COMPOSE_SHARED_H
#define LACEDRING_SHADERS_COMPOSE_SHARED_H

#include "shaders/shared.h"

#ifdef __cplusplus
namespace lacedring::gpu {
#endif

// compose.comp has three specialization constants: mode, samples per pixel along each side, paint. The modes:
#define LR_COMPOSE_LEFT 0u  // the left picture alone
#define LR_COMPOSE_SPLIT 1u
#define LR_COMPOSE_DIFFERENCE 2u  // red where the two pictures differ

// Paint over the triangles, as bits. The ring's line covers the triangles' colors, and these cover growth.
#define LR_PAINT_NONE 0u
#define LR_PAINT_TRIANGLES 1u
#define LR_PAINT_GROWTH 2u
#define LR_PAINT_RING 4u  // the ring's line
#define LR_PAINT_FLAT 8u  // the view colors the surface itself: keeps only its lines, not the light on it

// One triangle of the mesh during RING-EXPANDER (ring.hpp).
struct GrowthTriangle {
    uint step;  // the triangle's side of the ring is final as soon as step + 1 triangles are invaded
#ifdef __cplusplus
    std::array<uint, 3> across;
#else
    uint across[3];  // triangles across its edges
#endif
};
// Colors of growth: red, green, blue, 0 to 255.
#define LR_GROWTH_INVADED_COLOR 222, 112, 48
#define LR_GROWTH_NEWEST_COLOR 255, 214, 60
#define LR_GROWTH_RIGHT_COLOR 247, 234, 200
#define LR_GROWTH_NOT_YET_COLOR 168, 172, 180
#define LR_GROWTH_LINE_COLOR 24, 24, 28    // ring edges that are final
#define LR_GROWTH_FRONT_COLOR 24, 96, 220  // ring edges that may still be crossed
#define LR_GROWTH_RIGHT 0x80000000u        // flag in `step`: the triangle is never invaded
#define LR_GROWTH_BORDER 0xffffffffu       // in `across`: no triangle

struct ComposeConstants {
    uint divider;    // first column of the right picture
    uint triangles;  // of the mesh
    // Growth:
    uint invaded;        // number of triangles invaded so far
    uint fresh;          // the last `fresh` invaded triangles are highlighted
    uint inner, outer;   // width of the ring's line inside and outside the invaded region, in samples
    float line_opacity;  // of final ring edges
};

#ifdef __cplusplus
}  // namespace lacedring::gpu
#endif
#endif
