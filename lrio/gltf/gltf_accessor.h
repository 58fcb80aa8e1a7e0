#pragma once
// Reads accessor values of a glTF model. tinygltf checks few of a file's numbers, so all bounds are checked here.
// Internal to lrio.

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "lacedring/base.hpp"
#include "lacedring/mesh.hpp"
#include "lrio/gltf/gltf_file.h"

namespace lacedring::detail {

/// Elements `stride` bytes apart in a buffer; if `data` is null, all are zero. In bounds for the accessor's count.
struct StridedBytes {
    const std::byte* data = nullptr;
    std::size_t stride = 0;
};

/// An accessor whose type, stride and bounds have been checked.
struct AccessorView {
    ComponentType type = ComponentType::f32;
    std::uint8_t components = 1;
    bool normalized = false;
    std::size_t count = 0;
    StridedBytes values;
    std::size_t sparse_count = 0;  ///< number of elements that sparse values replace
    ComponentType sparse_type = ComponentType::u32;
    StridedBytes sparse_indices;
    StridedBytes sparse_values;

    std::size_t element_bytes() const { return size_of(type) * components; }
};

/// Converts a glTF componentType. False: glTF has no such type.
bool to_component_type(int gltf, ComponentType& out);

/// Does the accessor hold matrices with padded columns, which view_accessor refuses?
bool is_padded_matrix(const tinygltf::Accessor& accessor);

/// Opens the accessor's buffers and decodes compressed data. An accessor without a buffer view is all zeros and may
/// have any count: check the memory limit before allocating for it. Errors: malformed, unsupported, too_large,
/// memory_limit, those of GltfBuffers::open.
Result<AccessorView> view_accessor(GltfFile& file, int index);

/// Writes the elements to `out`, count * element_bytes() tightly packed bytes, and replaces the sparse ones. Errors:
/// malformed (a sparse index).
Result<void> copy_elements(const AccessorView& view, std::byte* out);

/// The unsigned value number `i` of packed u8, u16 or u32.
std::uint32_t unsigned_at(const std::byte* packed, ComponentType type, std::size_t i);

/// Component number `i` of packed values; normalized integers are divided by their maximum, as glTF defines it.
double component_at(const std::byte* packed, ComponentType type, bool normalized, std::size_t i);

}  // namespace lacedring::detail
