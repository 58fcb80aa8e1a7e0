#pragma once
// glTF's numbers and names for types, and the begin of GLB files, for what writes them. Internal to lrio.

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "lacedring/base.hpp"
#include "lacedring/vertices.hpp"

namespace lacedring::detail {

inline constexpr std::uint64_t kGltfByte = 5120, kGltfUnsignedByte = 5121, kGltfShort = 5122, kGltfUnsignedShort = 5123,
                               kGltfUnsignedInt = 5125, kGltfFloat = 5126;
inline constexpr std::uint64_t kGltfVertexTarget = 34962, kGltfIndexTarget = 34963;  ///< of buffer views

/// An accessor's componentType; 0: glTF has none (i32, f64).
std::uint64_t gltf_component_type(ComponentType type);

/// An accessor's type of so many components; empty: glTF has none. A MAT2 has the components of a VEC4.
std::string_view gltf_type(std::uint8_t components);

/// All of a GLB file before the bytes of its BIN chunk, which follow, with zeros up to a multiple of 4. Without such
/// bytes there is no chunk. Errors: too_large (4 GiB).
Result<std::vector<std::byte>> make_glb_head(std::string_view json, std::uint64_t bin_bytes);

}  // namespace lacedring::detail
