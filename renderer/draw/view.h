#pragma once
// What pictures show.

#include <array>
#include <cstdint>

#include "renderer/mesh/gpu_mesh.h"
#include "renderer/mesh/named.h"
#include "shaders/shared.h"

namespace lacedring::gpu {

enum class View : std::uint32_t {
    smooth = LR_VIEW_SMOOTH,          ///< interpolated normals
    flat = LR_VIEW_FLAT,              ///< the triangles' own normals
    triangle_class = LR_VIEW_CLASS,   ///< what each triangle is to the ring, and the ring
    ring = LR_VIEW_RING,              ///< the vertices' order along the ring, and the ring
    wire = LR_VIEW_WIRE,              ///< flat, and the triangles' edges
    offsets = LR_VIEW_OFFSETS,        ///< significant bits of each triangle's offset along the ring, and the ring
    seams = LR_VIEW_SEAMS,            ///< interpolated normals, and the seams
    silhouette = LR_VIEW_SILHOUETTE,  ///< outline, creases and borders, over normals that the device computed
    material = LR_VIEW_MATERIAL,      ///< colors, textures and light as the file's materials say
};

/// To add one: docs/renderer.md, "Views".
constexpr std::array<Named<View>, 9> kViews{{{"material", View::material, "material"},
                                             {"smooth", View::smooth, "smooth"},
                                             {"flat", View::flat, "flat"},
                                             {"class", View::triangle_class, "triangle classes"},
                                             {"ring", View::ring, "ring order"},
                                             {"wire", View::wire, "wireframe"},
                                             {"offsets", View::offsets, "offsets"},
                                             {"seams", View::seams, "seams"},
                                             {"silhouette", View::silhouette, "silhouette"}}};

/// What a view needs on the device beside the triangles.
UploadOptions upload_options(View view);
/// Does it show the ring?
bool has_ring(View view);
/// Are lines drawn over the surface? It is pushed back a little then.
bool has_lines(View view);

}  // namespace lacedring::gpu
