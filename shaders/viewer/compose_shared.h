// What the viewer's C++ and compose.comp both read.
#ifndef LACEDRING_SHADERS_COMPOSE_SHARED_H
#define LACEDRING_SHADERS_COMPOSE_SHARED_H

#include "shaders/shared.h"

#ifdef __cplusplus
namespace lacedring::gpu {
#endif

// Specialization constants of compose.comp: mode, samples a pixel along each side, paint.
#define LR_COMPOSE_LEFT 0u  // the left picture alone
#define LR_COMPOSE_SPLIT 1u
#define LR_COMPOSE_DIFFERENCE 2u  // red where they differ

// What is laid over the triangles, bits; several: the ring's line over colours over growth.
#define LR_PAINT_NONE 0u
#define LR_PAINT_TRIANGLES 1u
#define LR_PAINT_GROWTH 2u
#define LR_PAINT_RING 4u  // the ring's line
#define LR_PAINT_FLAT 8u  // the surface has colours of its own: only its lines stay, else the light on it does

// RING-EXPANDER's way over one triangle of the mesh (ring.hpp).
struct GrowthTriangle {
    uint step;  // it is settled on which side it lies once more triangles than this are invaded
#ifdef __cplusplus
    std::array<uint, 3> across;
#else
    uint across[3];  // triangles across its edges
#endif
};
// Its colours: red, green, blue of 255.
#define LR_GROWTH_INVADED_COLOUR 222, 112, 48
#define LR_GROWTH_NEWEST_COLOUR 255, 214, 60
#define LR_GROWTH_RIGHT_COLOUR 247, 234, 200
#define LR_GROWTH_NOT_YET_COLOUR 168, 172, 180
#define LR_GROWTH_LINE_COLOUR 24, 24, 28    // the ring where it will stay
#define LR_GROWTH_FRONT_COLOUR 24, 96, 220  // where it may still be crossed
#define LR_GROWTH_RIGHT 0x80000000u         // in `step`: it is never invaded
#define LR_GROWTH_BORDER 0xffffffffu        // in `across`: none

struct ComposeConstants {
    uint divider;    // first column of the right picture
    uint triangles;  // of the mesh
    // Growth:
    uint invaded;        // triangles so far
    uint fresh;          // of these, the last ones that are told from the others
    uint inner, outer;   // samples that the ring's line covers inside the invaded region and outside it
    float line_opacity;  // of the ring's line where it will stay
};

#ifdef __cplusplus
}  // namespace lacedring::gpu
#endif
#endif
