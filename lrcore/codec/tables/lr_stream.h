#pragma once
// LR tables as one run of words, as .lr files and memory-mapped files hold them. docs/lr-tables.md has the format.

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "lrcore/base/result.h"
#include "lrcore/codec/tables/compact_lr.h"
#include "lrcore/codec/tables/lr_table.h"

namespace lr {

/// A copy of a vertex whose triangles form several fans (split_fans), and the vertex that it is a copy of; LR numbers.
struct VertexCopy {
    std::uint32_t copy, original;
};

constexpr std::size_t kLrHeaderWords = 10;

/// Header, L and R, VO, VO*, C, copies. 40 bytes beside 4 a reference and 8 a copy.
std::vector<std::uint32_t> serialize(const LrTable& table, std::span<const VertexCopy> copies);
std::vector<std::uint32_t> serialize(const CompactLrTable& table, std::span<const VertexCopy> copies);

/// Tables somewhere in memory. Holds no copy.
template <class View>
struct LrStream {
    View view;
    std::span<const std::uint32_t> copies;  ///< pairs, as VertexCopy
};

/// Reads the header and checks sizes only: what lies behind it is trusted by the operators. Call validate_lr first on
/// anything that was not just made. Errors: malformed. Untrusted input: safe.
Result<LrStream<LrView>> view_lr(std::span<const std::uint32_t> words);
Result<LrStream<CompactLrView>> view_compact_lr(std::span<const std::uint32_t> words);

/// Checks the checksum and every reference; that rings tile and close; that opposite is an involution; that the star of
/// each used vertex has all corners of the vertex; and that near_neighbours agrees with the stars. Then each operator
/// stays in bounds, ends, and agrees with the others. Cost: O(T), and the neighbors of one vertex in memory.
/// Untrusted input: safe.
Result<LrStream<LrView>> validate_lr(std::span<const std::uint32_t> words);
Result<LrStream<CompactLrView>> validate_compact_lr(std::span<const std::uint32_t> words);

/// The triangles, three vertices each, oriented as in the input, copies replaced by their originals.
/// The vertices keep their LR numbers. `words` are valid.
std::vector<std::uint32_t> decode_lr(const LrStream<LrView>& stream);
std::vector<std::uint32_t> decode_lr(const LrStream<CompactLrView>& stream);

}  // namespace lr
