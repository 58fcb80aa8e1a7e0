#pragma once
// Distinct types for the three kinds of index, so that mixing them does not compile.

#include <compare>
#include <cstdint>

namespace lr {

/// A 32-bit index of one kind of element. `null` means "none": across a border, or not found.
template <class Tag>
struct Id {
    std::uint32_t value;

    constexpr bool is_null() const { return value == UINT32_MAX; }
    friend constexpr auto operator<=>(Id, Id) = default;
};

template <class Tag>
inline constexpr Id<Tag> null_id{UINT32_MAX};

using VertexId = Id<struct VertexTag>;
using TriangleId = Id<struct TriangleTag>;
using CornerId = Id<struct CornerTag>;

inline constexpr VertexId null_vertex = null_id<VertexTag>;
inline constexpr TriangleId null_triangle = null_id<TriangleTag>;
inline constexpr CornerId null_corner = null_id<CornerTag>;

}  // namespace lr
