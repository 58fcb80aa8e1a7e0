#pragma once
// Encodes vertex sets to a stream of the extension: an .lr file, and part codes. Internal to lrio.

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
    std::vector<std::byte> file;   ///< the .lr file
    std::vector<std::byte> parts;  ///< part codes; empty if there is one part
    std::uint32_t degenerate = 0;  ///< number of degenerate triangles, which are left out
};

/// A set's mesh to encode, with quantized values, and the coding of its attributes.
struct CodedSet {
    SetMesh set;
    std::vector<VertexOptions> options;       ///< coding of each attribute
    std::vector<std::uint32_t> part_numbers;  ///< number in the stream of each part
};

/// Encodes sets with the same attributes and coding to one stream. Joins equal positions of different sets if that
/// makes the stream smaller. Cost: O(T). Errors: too_large.
Result<SceneStream> encode_scene_stream(std::vector<CodedSet> sets, bool keep_order, LrForm form, unsigned threads);

}  // namespace lacedring::detail
