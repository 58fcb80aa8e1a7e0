#pragma once
// The storage form decoded by lacedring_storage.h, in buffers of exactly their size.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "lacedring/lacedring_storage.h"

namespace lacedring::test {

template <class T>
std::unique_ptr<T[]> exact_copy(std::span<const T> from) {
    auto out = std::make_unique<T[]>(from.size());
    std::copy(from.begin(), from.end(), out.get());
    return out;
}

/// The triangles of a stored packed stream; none: it is refused.
inline std::optional<std::vector<std::uint32_t>> triangles_in_c(std::span<const std::uint32_t> stored,
                                                                std::uint32_t vertices, std::uint32_t triangles) {
    const auto words = exact_copy(stored);
    lacedring_stored_packed mesh;
    if (lacedring_stored_packed_open(words.get(), stored.size(), vertices, triangles, &mesh, nullptr) !=
        LACEDRING_STATUS_OK)
        return {};
    const auto scratch = std::make_unique<std::byte[]>(lacedring_stored_packed_scratch(&mesh));
    const std::size_t size = std::size_t{3} * mesh.triangles;
    const auto out = std::make_unique<std::uint32_t[]>(size);
    std::uint64_t where = 0;
    if (lacedring_stored_packed_decode(&mesh, scratch.get(), out.get(), &where) != LACEDRING_STATUS_OK) return {};
    return std::vector<std::uint32_t>(out.get(), out.get() + size);
}

struct AttributeInC {
    lacedring_vertices header;
    std::vector<std::uint32_t> integers;
    std::vector<std::byte> values;
};

/// The integers and the values of a stored vertex stream; none: it is refused.
inline std::optional<AttributeInC> attribute_in_c(std::span<const std::uint32_t> stored,
                                                  std::span<const std::uint32_t> triangles, std::uint32_t vertices) {
    const auto words = exact_copy(stored), corners = exact_copy(triangles);
    const auto count = static_cast<std::uint32_t>(triangles.size() / 3);
    lacedring_stored_vertices attribute;
    if (lacedring_stored_vertices_open(words.get(), stored.size(), vertices, &attribute, nullptr) !=
        LACEDRING_STATUS_OK)
        return {};
    const auto scratch = std::make_unique<std::byte[]>(lacedring_stored_vertices_scratch(&attribute, count));
    const std::size_t size = std::size_t{vertices} * attribute.attribute.components;
    const auto integers = std::make_unique<std::uint32_t[]>(size);
    std::uint64_t where = 0;
    if (lacedring_stored_vertices_decode(&attribute, corners.get(), count, scratch.get(), integers.get(), &where) !=
        LACEDRING_STATUS_OK)
        return {};
    constexpr std::uint8_t kSizes[] = {1, 1, 2, 2, 4, 4, 4, 8};
    const std::size_t bytes =
        std::size_t{vertices} * lacedring_vertices_values(&attribute.attribute) * kSizes[attribute.attribute.type];
    const auto values = std::make_unique<std::byte[]>(bytes);
    lacedring_stored_vertices_values(&attribute, integers.get(), values.get());
    return AttributeInC{
        attribute.attribute, {integers.get(), integers.get() + size}, {values.get(), values.get() + bytes}};
}

}  // namespace lacedring::test
