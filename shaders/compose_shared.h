// What the viewer's C++ and compose.comp both read.
#ifndef LACEDRING_SHADERS_COMPOSE_SHARED_H
#define LACEDRING_SHADERS_COMPOSE_SHARED_H

#include "shaders/shared.h"

#ifdef __cplusplus
namespace lr::gpu {
#endif

#define LR_COMPOSE_LEFT 0u  // the left picture alone
#define LR_COMPOSE_SPLIT 1u
#define LR_COMPOSE_DIFFERENCE 2u  // red where they differ

#define LR_PAINT_NONE 0u
#define LR_PAINT_LIT 1u   // in the light of the surface, which is grey
#define LR_PAINT_FLAT 2u  // the surface has colours of its own; only its lines stay

struct ComposeConstants {
    uint mode;
    uint divider;  // first column of the right picture
    uint samples;  // of the pictures, a pixel along each side
    uint paint;
    uint triangles;  // of the mesh
};

#ifdef __cplusplus
}  // namespace lr::gpu
#endif
#endif
