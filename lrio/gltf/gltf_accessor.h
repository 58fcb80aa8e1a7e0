#pragma once
// Values out of a glTF model. tinygltf checks few of the numbers in a file, so every bound is checked here.
// Internal to lrio.

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "lacedring/base.hpp"
#include "lacedring/mesh.hpp"
#include "lrio/gltf/gltf_file.h"

namespace lacedring::detail {

/// Elements `stride` bytes apart in a buffer; without `data` they are all zero. In bounds for the accessor's count.
struct StridedBytes {
    const std::byte* data = nullptr;
    std::size_t stride = 0;
};

/// An accessor whose type, stride and bounds are known to be right.
struct AccessorView {
    ComponentType type = ComponentType::f32;
    std::uint8_t components = 1;
    bool normalized = false;
    std::size_t count = 0;
    StridedBytes values;
    std::size_t sparse_count = 0;  ///< this many elements are replaced
    ComponentType sparse_type = ComponentType::u32;
    StridedBytes sparse_indices;
    StridedBytes sparse_values;

    std::size_t element_bytes() const { return size_of(type) * components; }
};

/// glTF's componentType as ours. False: glTF has no such type.
bool to_component_type(int gltf, ComponentType& out);

/// Does the accessor hold matrices whose columns are padded, so that view_accessor refuses it?
bool is_padded_matrix(const tinygltf::Accessor& accessor);

/// Opens the buffers that the accessor lies in, and decodes compressed data. An accessor without bytes of its own is
/// all zeros, and may have any count: nothing may be allocated for it that was not checked. Errors: malformed,
/// unsupported, too_large, memory_limit, GltfBuffers::open's.
Result<AccessorView> view_accessor(GltfFile& file, int index);

/// count * element_bytes() tightly packed bytes, sparse ones replaced. Errors: malformed (a sparse index).
Result<void> copy_elements(const AccessorView& view, std::byte* out);

/// The unsigned value number `i` of packed u8, u16 or u32.
std::uint32_t unsigned_at(const std::byte* packed, ComponentType type, std::size_t i);

/// Component number `i` of packed values as glTF defines it: integers divided by their maximum where normalized.
double component_at(const std::byte* packed, ComponentType type, bool normalized, std::size_t i);

}  // namespace lacedring::detail
