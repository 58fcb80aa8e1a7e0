// What the viewer's C++ and compose.comp both read.
#ifndef LACEDRING_SHADERS_COMPOSE_SHARED_H
#define LACEDRING_SHADERS_COMPOSE_SHARED_H

#include "shaders/shared.h"

#ifdef __cplusplus
namespace lr::gpu {
#endif

// Specialization constants of compose.comp: mode, samples a pixel along each side, paint.
#define LR_COMPOSE_LEFT 0u  // the left picture alone
#define LR_COMPOSE_SPLIT 1u
#define LR_COMPOSE_DIFFERENCE 2u  // red where they differ

#define LR_PAINT_NONE 0u
#define LR_PAINT_TRIANGLES 1u

struct ComposeConstants {
    uint divider;    // first column of the right picture
    uint triangles;  // of the mesh
};

#ifdef __cplusplus
}  // namespace lr::gpu
#endif
#endif
