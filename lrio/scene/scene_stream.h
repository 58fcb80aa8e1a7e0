#pragma once
// Vertex sets as one .lr file: the extension's streams. Internal to lrio.

#include <cstddef>
#include <cstdint>
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
Result<SceneStream> encode_scene_stream(std::vector<CodedSet> sets, bool keep_order, LrForm form, unsigned threads);

}  // namespace lacedring::detail
