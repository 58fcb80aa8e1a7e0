#pragma once
// The views: what pictures show of a mesh.

#include <array>
#include <cstdint>

#include "renderer/mesh/gpu_mesh.h"
#include "renderer/mesh/named.h"
#include "shaders/shared.h"

namespace lacedring::gpu {

enum class View : std::uint32_t {
    smooth = LR_VIEW_SMOOTH,          ///< interpolated normals
    flat = LR_VIEW_FLAT,              ///< the triangles' own normals
    triangle_class = LR_VIEW_CLASS,   ///< the class of each triangle (LR_CLASS_*), and the ring
    ring = LR_VIEW_RING,              ///< the vertices' order along the ring, and the ring
    wire = LR_VIEW_WIRE,              ///< flat, and the triangles' edges
    offsets = LR_VIEW_OFFSETS,        ///< significant bits of each triangle's offset along the ring, and the ring
    seams = LR_VIEW_SEAMS,            ///< interpolated normals, and the seams
    silhouette = LR_VIEW_SILHOUETTE,  ///< smooth, with normals computed on the device; outline, creases and borders
    material = LR_VIEW_MATERIAL,      ///< the file's materials, lit
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

/// The data that a view needs on the device besides the triangles.
UploadOptions upload_options(View view);
/// True if the view shows the ring.
bool has_ring(View view);
/// True if lines are drawn over the surface, which is then pushed back a little.
bool has_lines(View view);

}  // namespace lacedring::gpu
