#pragma once
// Decodes one slot of any format. Internal to codec/.

#include <optional>

#include "lacedring/streams.hpp"
#include "lrcore/codec/tables/tables_decode.h"

namespace lacedring::detail {

inline std::optional<Triangle> decode_slot(const LeanView& view, std::uint32_t slot) {
    const Triangle t = decode_lean_slot(view, slot);
    return t.degenerate() ? std::nullopt : std::optional(t);
}

inline std::optional<Triangle> decode_slot(const PackedView& view, std::uint32_t slot) {
    return decode_packed_triangle(view, slot);
}

}  // namespace lacedring::detail
