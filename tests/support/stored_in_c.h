#pragma once
// Decodes the storage form with lacedring_storage.h and lacedring_stored_seams.h, in buffers of exactly their size.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "lacedring/lacedring_storage.h"
#include "lacedring/lacedring_stored_seams.h"
#include "lacedring/vertices.hpp"
#include "lrcore/codec/storage/vertex_places.h"
#include "tests/support/exact_copy.h"

namespace lacedring::test {

/// The triangles of a stored packed stream; nothing if it is refused.
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

/// The integers and values of a stored vertex stream; nothing if it is refused.
inline std::optional<AttributeInC> attribute_in_c(std::span<const std::uint32_t> stored,
                                                  std::span<const std::uint32_t> triangles, std::uint32_t vertices,
                                                  const storage::VertexPlaces& places = {}) {
    const auto words = exact_copy(stored), corners = exact_copy(triangles);
    const auto positions = exact_copy(places.positions), vertex_of = exact_copy(places.vertex_of);
    const lacedring_positions given{positions.get(), static_cast<std::uint32_t>(places.positions.size() / 3),
                                    places.vertex_of.empty() ? nullptr : vertex_of.get()};
    const lacedring_positions* where_from = places.positions.empty() ? nullptr : &given;
    const auto count = static_cast<std::uint32_t>(triangles.size() / 3);
    lacedring_stored_vertices attribute;
    if (lacedring_stored_vertices_open(words.get(), stored.size(), vertices, &attribute, nullptr) !=
        LACEDRING_STATUS_OK)
        return {};
    const auto scratch =
        std::make_unique<std::byte[]>(lacedring_stored_vertices_scratch(&attribute, count, where_from));
    const std::size_t size = std::size_t{vertices} * attribute.attribute.components;
    const auto integers = std::make_unique<std::uint32_t[]>(size);
    std::uint64_t where = 0;
    if (lacedring_stored_vertices_decode(&attribute, corners.get(), count, where_from, scratch.get(), integers.get(),
                                         &where) != LACEDRING_STATUS_OK)
        return {};
    constexpr std::uint8_t kSizes[] = {1, 1, 2, 2, 4, 4, 4, 8};
    const std::size_t bytes =
        std::size_t{vertices} * lacedring_vertices_values(&attribute.attribute) * kSizes[attribute.attribute.type];
    const auto values = std::make_unique<std::byte[]>(bytes);
    lacedring_stored_vertices_values(&attribute, integers.get(), values.get());
    return AttributeInC{
        attribute.attribute, {integers.get(), integers.get() + size}, {values.get(), values.get() + bytes}};
}

struct SeamsInC {
    std::vector<std::uint32_t> copies;    ///< by corner
    std::vector<std::uint32_t> vertices;  ///< by copy
};

/// The copies of a stored seam section; nothing if it is refused or has more than `most` copies.
inline std::optional<SeamsInC> seams_in_c(std::span<const std::uint32_t> stored,
                                          std::span<const std::uint32_t> triangles, std::uint32_t vertices,
                                          std::uint32_t most) {
    const auto words = exact_copy(stored), slots = exact_copy(triangles);
    lacedring_stored_seams seams;
    if (lacedring_stored_seams_open(words.get(), stored.size(), vertices,
                                    static_cast<std::uint32_t>(triangles.size() / 3), most, &seams,
                                    nullptr) != LACEDRING_STATUS_OK)
        return {};
    const auto scratch = std::make_unique<std::byte[]>(lacedring_stored_seams_scratch(&seams));
    const auto copies = std::make_unique<std::uint32_t[]>(triangles.size());
    const auto vertex_of = std::make_unique<std::uint32_t[]>(seams.most_copies);
    std::uint64_t where = 0;
    if (lacedring_stored_seams_decode(&seams, slots.get(), scratch.get(), copies.get(), vertex_of.get(), &where) !=
        LACEDRING_STATUS_OK)
        return {};
    return SeamsInC{{copies.get(), copies.get() + triangles.size()}, {vertex_of.get(), vertex_of.get() + seams.copies}};
}

}  // namespace lacedring::test
