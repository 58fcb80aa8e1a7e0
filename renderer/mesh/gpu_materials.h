#pragma once
// Materials on the device.

#include <string>
#include <vector>

#include "lacedring/materials.hpp"
#include "renderer/vk/buffer.h"
#include "renderer/vk/transfer.h"

namespace lacedring::gpu {

/// What View::material reads, through addresses.
struct GpuMaterials {
    Buffer table;  ///< MaterialHead, then MaterialConstants
    Buffer of_triangle, texels;
    std::vector<std::string> notes;  ///< Textures::notes
};

/// Decodes the images and uploads all. `materials` may be null, or of no triangle: one gray material is of all
/// `triangles`. Errors: kNoDevice (memory), invalid_argument (materials of another mesh).
Result<GpuMaterials> upload_materials(Context& context, Transfer& transfer, const Materials* materials,
                                      std::uint32_t triangles);

}  // namespace lacedring::gpu
