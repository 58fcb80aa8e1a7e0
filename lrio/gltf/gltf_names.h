#pragma once
// glTF's numbers and names of types, and the head of GLB files, for writers. Internal to lrio.

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "lacedring/base.hpp"
#include "lacedring/vertices.hpp"

namespace lacedring::detail {

inline constexpr std::uint64_t kGltfByte = 5120, kGltfUnsignedByte = 5121, kGltfShort = 5122, kGltfUnsignedShort = 5123,
                               kGltfUnsignedInt = 5125, kGltfFloat = 5126;
inline constexpr std::uint64_t kGltfVertexTarget = 34962, kGltfIndexTarget = 34963;  ///< targets of buffer views

/// An accessor's componentType; 0: glTF has none (i32, f64).
std::uint64_t gltf_component_type(ComponentType type);

/// An accessor's type for a number of components; empty: glTF has none. 4 components are a VEC4, never a MAT2.
std::string_view gltf_type(std::uint8_t components);

/// The bytes of a GLB file before the contents of its BIN chunk. The caller appends the contents, padded with zeros to
/// a multiple of 4. If `bin_bytes` is 0, there is no BIN chunk. Errors: too_large (4 GiB).
Result<std::vector<std::byte>> make_glb_head(std::string_view json, std::uint64_t bin_bytes);

}  // namespace lacedring::detail
