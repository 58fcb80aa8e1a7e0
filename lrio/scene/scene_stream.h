#pragma once
// Vertex sets as one .lr file, and back: the extension's streams. Internal to lrio.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "lacedring/lr_file.hpp"
#include "lrio/scene/scene_set.h"

namespace lacedring::detail {

struct SceneStream {
    std::vector<std::byte> file;   ///< .lr
    std::vector<std::byte> parts;  ///< part codes; empty where there is one part
    std::uint32_t degenerate = 0;  ///< triangles that are left out
};

/// A set's mesh as it is encoded: values quantized, copies merged. How each attribute is coded.
struct CodedSet {
    SetMesh set;
    std::vector<VertexOptions> options;       ///< of each attribute
    std::vector<std::uint32_t> part_numbers;  ///< the stream's number of each of its parts
};

/// Sets whose attributes are alike and coded alike as one stream; they are taken over. Positions of different sets are
/// joined where that makes the stream smaller. Cost: O(T). Errors: too_large.
Result<SceneStream> encode_scene_stream(std::vector<CodedSet> sets, bool keep_order, unsigned threads);

/// A set out of a stream.
struct DecodedSet {
    std::uint32_t vertices = 0;
    std::vector<Attribute> attributes;
};
struct DecodedStream {
    std::vector<DecodedSet> sets;
    std::vector<std::vector<std::uint32_t>> parts;  ///< the index list of each part, of its set's vertices
};

/// `set_of_part` says of which set each part is. Sets have as many vertices as `vertices` says, or what the triangles
/// use where that is UINT32_MAX and no order was kept. `check`, where there is one, sees what the file says of itself
/// before memory is taken for it. Errors: malformed, check's. Untrusted input: safe.
Result<DecodedStream> decode_scene_stream(std::span<const std::byte> file, std::span<const std::byte> parts,
                                          std::span<const std::uint32_t> set_of_part,
                                          std::span<const std::uint32_t> vertices,
                                          const std::function<Result<void>(const LrContents&)>& check = {});

}  // namespace lacedring::detail
