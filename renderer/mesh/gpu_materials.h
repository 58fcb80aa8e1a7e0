#pragma once
// Materials on the device.

#include <string>
#include <vector>

#include "lacedring/materials.hpp"
#include "renderer/vk/buffer.h"
#include "renderer/vk/transfer.h"

namespace lacedring::gpu {

/// The buffers that the shaders of View::material read through addresses.
struct GpuMaterials {
    Buffer table;  ///< MaterialHead, then MaterialConstants
    Buffer of_triangle, texels;
    std::vector<std::string> notes;  ///< images that are not drawn (Textures::notes)
};

/// Decodes the images and uploads everything. If `materials` is null or has no triangles, all `triangles` get one gray
/// material. Errors: kNoDevice (memory), invalid_argument (materials of another mesh).
Result<GpuMaterials> upload_materials(Context& context, Transfer& transfer, const Materials* materials,
                                      std::uint32_t triangles);

}  // namespace lacedring::gpu
