#include "lrio/gltf/gltf_accessor.h"

#include <algorithm>
#include <cstring>

#include "lrcore/base/try.h"
#include "lrio/gltf/gltf_draco.h"
#include "lrio/gltf/gltf_view.h"
#include "lrio/mesh/read_formats.h"

namespace lacedring::detail {

bool to_component_type(int gltf, ComponentType& out) {
    switch (gltf) {
        case TINYGLTF_COMPONENT_TYPE_BYTE:
            out = ComponentType::i8;
            return true;
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
            out = ComponentType::u8;
            return true;
        case TINYGLTF_COMPONENT_TYPE_SHORT:
            out = ComponentType::i16;
            return true;
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
            out = ComponentType::u16;
            return true;
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
            out = ComponentType::u32;
            return true;
        case TINYGLTF_COMPONENT_TYPE_FLOAT:
            out = ComponentType::f32;
            return true;
        default:
            return false;
    }
}

namespace {

/// `count` elements of `size` bytes in a buffer view, beginning at byte `offset`. `where` is the prefix of errors.
Result<StridedBytes> view_bytes(GltfFile& file, int view_index, std::uint64_t offset, std::size_t count,
                                std::size_t size, const std::string& where) {
    const auto& views = file.model.bufferViews;
    if (view_index < 0 || static_cast<std::size_t>(view_index) >= views.size()) {
        return malformed("{}: buffer view {} does not exist", where, view_index);
    }
    const tinygltf::BufferView& view = views[static_cast<std::size_t>(view_index)];
    const std::size_t stride = view.byteStride == 0 ? size : view.byteStride;
    if (stride < size) return malformed("buffer view {}: a stride of {} bytes is too small", view_index, stride);
    const auto bytes = open_view(file, static_cast<std::size_t>(view_index));
    if (!bytes) return bytes.error();
    if (count == 0) return StridedBytes{nullptr, stride};
    // offset + (count - 1) * stride + size <= byteLength, without overflow
    const bool fits = offset <= view.byteLength && size <= view.byteLength - offset &&
                      count - 1 <= (view.byteLength - offset - size) / stride;
    if (!fits) {
        return malformed("{}: {} elements from byte {} on are not in buffer view {} of {} bytes", where, count, offset,
                         view_index, view.byteLength);
    }
    return StridedBytes{bytes->data() + offset, stride};
}

Result<void> add_sparse(GltfFile& file, const tinygltf::Accessor& accessor, const std::string& where,
                        AccessorView& view) {
    const auto& sparse = accessor.sparse;
    if (sparse.count < 0 || static_cast<std::size_t>(sparse.count) > view.count) {
        return malformed("{}: {} sparse elements of {}", where, sparse.count, view.count);
    }
    if (sparse.indices.byteOffset < 0 || sparse.values.byteOffset < 0) {
        return malformed("{}: a negative offset of sparse elements", where);
    }
    view.sparse_count = static_cast<std::size_t>(sparse.count);
    const bool known = to_component_type(sparse.indices.componentType, view.sparse_type);
    const bool is_unsigned = view.sparse_type == ComponentType::u8 || view.sparse_type == ComponentType::u16 ||
                             view.sparse_type == ComponentType::u32;
    if (!known || !is_unsigned) {
        return malformed("{}: sparse indices of type {}", where, sparse.indices.componentType);
    }
    LR_ASSIGN(const auto indices,
              view_bytes(file, sparse.indices.bufferView, static_cast<std::uint64_t>(sparse.indices.byteOffset),
                         view.sparse_count, size_of(view.sparse_type), where));
    LR_ASSIGN(const auto values,
              view_bytes(file, sparse.values.bufferView, static_cast<std::uint64_t>(sparse.values.byteOffset),
                         view.sparse_count, view.element_bytes(), where));
    view.sparse_indices = indices;
    view.sparse_values = values;
    return {};
}

}  // namespace

bool is_padded_matrix(const tinygltf::Accessor& accessor) {
    const int components = tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(accessor.type));
    ComponentType type{};
    return (components > 4 || accessor.type == TINYGLTF_TYPE_MAT2) && to_component_type(accessor.componentType, type) &&
           size_of(type) < 4;
}

Result<AccessorView> view_accessor(GltfFile& file, int index) {
    if (index < 0 || static_cast<std::size_t>(index) >= file.model.accessors.size()) {
        return malformed("accessor {} does not exist", index);
    }
    const tinygltf::Accessor& accessor = file.model.accessors[static_cast<std::size_t>(index)];
    const std::string where = fmt::format("accessor {}", index);
    AccessorView view;
    if (!to_component_type(accessor.componentType, view.type)) {
        return malformed("{}: component type {}", where, accessor.componentType);
    }
    const int components = tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(accessor.type));
    if (components < 1 || components > 16) return malformed("{}: type {}", where, accessor.type);
    view.components = static_cast<std::uint8_t>(components);
    view.normalized = accessor.normalized;
    view.count = accessor.count;
    if (view.count > max_vertices * 3) return Error{ErrorCode::too_large, where + ": too many elements"};
    if (is_padded_matrix(accessor)) return unsupported("{}: a matrix of small integers", where);

    if (file.draco.sources.contains(index)) {
        LR_ASSIGN(const auto values, draco_values(file, index));
        view.count = values.size() / view.element_bytes();
        view.values = {values.data(), view.element_bytes()};
        return view;
    }
    if (accessor.bufferView != -1) {
        LR_ASSIGN(const auto values,
                  view_bytes(file, accessor.bufferView, accessor.byteOffset, view.count, view.element_bytes(), where));
        view.values = values;
    }
    if (accessor.sparse.isSparse) {
        LR_TRY(add_sparse(file, accessor, where, view));
    }
    return view;
}

Result<void> copy_elements(const AccessorView& view, std::byte* out) {
    const std::size_t size = view.element_bytes();
    if (view.values.data == nullptr) {
        std::fill_n(out, view.count * size, std::byte{0});
    } else if (view.values.stride == size) {
        std::memcpy(out, view.values.data, view.count * size);
    } else {
        for (std::size_t i = 0; i < view.count; ++i) {
            std::memcpy(out + i * size, view.values.data + i * view.values.stride, size);
        }
    }
    for (std::size_t i = 0; i < view.sparse_count; ++i) {
        const std::byte* index = view.sparse_indices.data + i * view.sparse_indices.stride;
        const std::uint32_t element = unsigned_at(index, view.sparse_type, 0);
        if (element >= view.count) {
            return malformed("sparse index {} is out of range ({} elements)", element, view.count);
        }
        std::memcpy(out + element * size, view.sparse_values.data + i * view.sparse_values.stride, size);
    }
    return {};
}

namespace {

template <class T>
T load(const std::byte* packed, std::size_t i) {
    T value{};
    std::memcpy(&value, packed + i * sizeof(T), sizeof(T));
    return value;
}

}  // namespace

std::uint32_t unsigned_at(const std::byte* packed, ComponentType type, std::size_t i) {
    if (type == ComponentType::u8) return load<std::uint8_t>(packed, i);
    if (type == ComponentType::u16) return load<std::uint16_t>(packed, i);
    return load<std::uint32_t>(packed, i);
}

double component_at(const std::byte* packed, ComponentType type, bool normalized, std::size_t i) {
    switch (type) {
        case ComponentType::i8: {
            const double value = load<std::int8_t>(packed, i);
            return normalized ? std::max(value / 127.0, -1.0) : value;
        }
        case ComponentType::u8: {
            const double value = load<std::uint8_t>(packed, i);
            return normalized ? value / 255.0 : value;
        }
        case ComponentType::i16: {
            const double value = load<std::int16_t>(packed, i);
            return normalized ? std::max(value / 32767.0, -1.0) : value;
        }
        case ComponentType::u16: {
            const double value = load<std::uint16_t>(packed, i);
            return normalized ? value / 65535.0 : value;
        }
        case ComponentType::i32:
            return load<std::int32_t>(packed, i);
        case ComponentType::u32:
            return load<std::uint32_t>(packed, i);
        case ComponentType::f32:
            return static_cast<double>(load<float>(packed, i));
        case ComponentType::f64:
            return load<double>(packed, i);
    }
    return 0;
}

}  // namespace lacedring::detail
