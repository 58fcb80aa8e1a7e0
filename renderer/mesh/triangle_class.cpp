#include "renderer/mesh/triangle_class.h"

#include <algorithm>
#include <array>

#include "lacedring/streams.hpp"
#include "lrcore/codec/lean/lean_format.h"
#include "lrlab/paper/offsets.h"
#include "shaders/shared.h"

namespace lacedring::gpu {
namespace {

/// The successor v.n of every ring vertex.
std::vector<std::uint32_t> ring_next(const LeanView& lean) {
    const std::uint32_t rings = lean.rings2 + lean.rings1;
    std::vector<std::uint32_t> next(rings);
    for (std::uint32_t v = 0; v < rings; ++v) {
        next[v] = v + 1;
        const bool two = v < lean.rings2;
        const std::uint32_t slot = two ? 2 * v : v + lean.rings2;
        for (std::uint32_t side = 0; side < (two ? 2U : 1U); ++side) {
            const std::uint32_t word = lean.payload[slot + side];
            if ((word & LR_LEAN_CLOSE_FLAG) != 0) next[v] = word & LR_LEAN_TIP_MASK;
        }
    }
    return next;
}

}  // namespace

std::vector<std::uint8_t> slot_classes(const LeanView& lean) {
    const std::vector<std::uint32_t> next = ring_next(lean);
    const auto follows = [&](std::uint32_t a, std::uint32_t b) { return a < next.size() && next[a] == b; };
    std::vector<std::uint8_t> out(lean.slots(), LR_CLASS_NONE);
    for (std::uint32_t slot = 0; slot < lean.slots(); ++slot) {
        const Triangle t = decode_lean_slot(lean, slot);
        if (t.degenerate()) continue;
        const bool in_ring = slot < lean.ring_slots();
        if (in_ring && (lean.payload[slot] & LR_LEAN_WART_FLAG) != 0) {
            out[slot] = LR_CLASS_T0_WART;
            continue;
        }
        std::uint32_t forward = 0, backward = 0;  // edges along the ring's direction, and against it
        for (int i = 0; i < 3; ++i) {
            const std::uint32_t a = t.v[i], b = t.v[(i + 1) % 3];
            if (follows(a, b)) ++forward;
            if (follows(b, a)) ++backward;
        }
        if (forward + backward == 0) {
            out[slot] = LR_CLASS_T0;
        } else if (forward + backward >= 2) {
            out[slot] = LR_CLASS_T2;
        } else if (slot < 2 * lean.rings2) {
            out[slot] = slot % 2 == 0 ? LR_CLASS_T1_LEFT : LR_CLASS_T1_RIGHT;
        } else if (in_ring) {
            out[slot] = LR_CLASS_T1_LEFT;
        } else {
            // A verbatim triangle beside a one-sided ring. A left triangle is (v, tip, v.n): its ring edge is backward.
            out[slot] = backward != 0 ? LR_CLASS_T1_LEFT : LR_CLASS_T1_RIGHT;
        }
    }
    // The T2 beside a wart is in the slot of the vertex that the wart's edge skips, on the same side.
    for (std::uint32_t slot = 0; slot < lean.ring_slots(); ++slot) {
        if (out[slot] != LR_CLASS_T0_WART) continue;
        const bool two = slot < 2 * lean.rings2;
        const std::uint32_t skipped = next[two ? slot / 2 : slot - lean.rings2];
        const std::uint32_t t2 = two ? 2 * skipped + slot % 2 : skipped + lean.rings2;
        if (out[t2] == LR_CLASS_T2) out[t2] = LR_CLASS_T2_WART;
    }
    return out;
}

std::vector<std::uint8_t> slot_offset_bits(const LeanView& lean) {
    const std::uint32_t rings = lean.rings2 + lean.rings1;
    std::vector<std::uint8_t> out(lean.slots(), LR_OFFSET_NONE);
    for (std::uint32_t slot = 0; slot < lean.slots(); ++slot) {
        const bool two = slot < 2 * lean.rings2;
        const std::uint32_t v = two ? slot / 2 : slot - lean.rings2;
        if (decode_lean_slot(lean, slot).degenerate()) continue;
        if (slot >= lean.ring_slots()) {
            out[slot] = LR_OFFSET_T0;
        } else if (const std::uint32_t tip = lean.payload[slot] & LR_LEAN_TIP_MASK; tip < rings) {
            out[slot] = static_cast<std::uint8_t>(offset_bits(v, tip, rings));
        }
    }
    return out;
}

std::vector<std::uint8_t> of_triangles(std::span<const std::uint8_t> by_slot,
                                       std::span<const std::uint32_t> slot_triangle, std::size_t triangles) {
    std::vector<std::uint8_t> out(triangles, LR_CLASS_NONE);
    for (std::size_t slot = 0; slot < by_slot.size(); ++slot) {
        if (slot_triangle[slot] < triangles) out[slot_triangle[slot]] = by_slot[slot];
    }
    return out;
}

std::vector<std::uint32_t> mesh_edges(std::span<const std::uint32_t> indices) {
    std::vector<std::uint64_t> edges;
    edges.reserve(indices.size());
    for (std::size_t i = 0; i < indices.size(); ++i) {
        const std::uint64_t a = indices[i], b = indices[i % 3 == 2 ? i - 2 : i + 1];
        if (a != b) edges.push_back(std::min(a, b) << 32 | std::max(a, b));
    }
    std::sort(edges.begin(), edges.end());
    edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
    std::vector<std::uint32_t> out;
    out.reserve(2 * edges.size());
    for (const std::uint64_t edge : edges) {
        out.push_back(static_cast<std::uint32_t>(edge >> 32));
        out.push_back(static_cast<std::uint32_t>(edge));
    }
    return out;
}

std::vector<std::uint32_t> seam_lines(std::span<const std::uint32_t> indices, std::span<const std::uint32_t> surface) {
    if (surface.empty()) return {};
    struct Side {
        std::array<std::uint32_t, 2> edge, copies;
        auto operator<=>(const Side&) const = default;
    };
    std::vector<Side> sides;
    sides.reserve(indices.size());
    for (std::size_t i = 0; i < indices.size(); ++i) {
        std::array<std::uint32_t, 2> ends{indices[i], indices[i % 3 == 2 ? i - 2 : i + 1]};
        if (surface[ends[0]] > surface[ends[1]]) std::swap(ends[0], ends[1]);
        if (ends[0] != ends[1]) sides.push_back({{surface[ends[0]], surface[ends[1]]}, ends});
    }
    std::sort(sides.begin(), sides.end());
    std::vector<std::uint32_t> out;
    for (std::size_t i = 0, next = 0; i < sides.size(); i = next) {
        while (next < sides.size() && sides[next].edge == sides[i].edge) ++next;
        if (sides[i] != sides[next - 1]) out.insert(out.end(), sides[i].copies.begin(), sides[i].copies.end());
    }
    return out;
}

std::vector<std::uint32_t> ring_lines(const LeanView& lean) {
    const std::vector<std::uint32_t> next = ring_next(lean);
    std::vector<std::uint32_t> out;
    out.reserve(2 * next.size());
    for (std::uint32_t v = 0; v < next.size(); ++v) {
        out.push_back(v);
        out.push_back(next[v]);
    }
    return out;
}

}  // namespace lacedring::gpu
