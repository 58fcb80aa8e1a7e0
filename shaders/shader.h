#pragma once
// A compiled shader. The generated headers "spirv/NAME_STAGE.h" each define one.

#include <cstdint>
#include <span>
#include <string_view>

namespace lacedring::gpu {

struct Shader {
    std::string_view name;  ///< path of its source in this folder: "draw/surface.frag"
    std::span<const std::uint32_t> words;
};

}  // namespace lacedring::gpu
