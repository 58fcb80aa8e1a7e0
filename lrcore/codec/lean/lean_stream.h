#pragma once
// The lean LR index stream: one vertex reference per ring side, and the few triangles without a ring edge verbatim.
// Paper: LR 2011, section 7 and section 5 (wart skipping).
//
// A mesh's stream is at most 3 references a triangle and a 32-byte header, whatever its shape.
//
// Slots are numbered: [0, 2*rings2) two-sided, then rings1 one-sided, then verbatim. Each slot is one triangle of the
// index buffer, degenerate (its first two vertices equal) where it is the redundant copy of a T2, a border, or closes a
// ring.

#include <cstddef>
#include <cstdint>
#include <span>

#include "lrcore/base/result.h"

namespace lr {

/// A lean stream somewhere in memory, its header read. Holds no copy.
struct LeanView {
    std::span<const std::uint32_t> payload;
    std::uint32_t vertices = 0;
    std::uint32_t rings2 = 0;
    std::uint32_t rings1 = 0;
    std::uint32_t verbatim = 0;
    std::uint32_t triangles = 0;

    std::uint32_t ring_slots() const { return 2 * rings2 + rings1; }
    std::uint32_t slots() const { return ring_slots() + verbatim; }
    /// Bytes of the whole stream, header included.
    std::size_t bytes() const;
    /// References stored: one per ring slot, three per verbatim triangle.
    std::size_t references() const { return std::size_t{ring_slots()} + std::size_t{3} * verbatim; }
};

/// CRC-32 of a stream without its checksum word. `words` is at least the header.
std::uint32_t lean_checksum(std::span<const std::uint32_t> words);

/// Reads the header of `words` and checks sizes only. What lies behind it is trusted by decode_lean: call validate_lean
/// first on anything that was not just encoded. Errors: malformed. Untrusted input: safe.
Result<LeanView> view_lean(std::span<const std::uint32_t> words);

/// Checks the checksum and everything that decoders rely on: rings tile their sections and close, tips are vertices, as
/// many triangles are not degenerate as the header says. Cost: O(T). Untrusted input: safe.
Result<LeanView> validate_lean(std::span<const std::uint32_t> words);

/// Expands every slot: indices holds 3 * view.slots() entries. The stream must be valid (validate_lean).
/// Triangle 2v is (v, L[v], v.n), 2v+1 is (v.n, R[v], v). Cost: O(slots), no allocation.
void decode_lean(const LeanView& view, std::span<std::uint32_t> indices);

/// The triangle at one slot; constant time, at most four words read.
struct LeanTriangle {
    std::uint32_t v[3];
    bool degenerate() const { return v[0] == v[1]; }
};
LeanTriangle decode_lean_slot(const LeanView& view, std::uint32_t slot);

}  // namespace lr
