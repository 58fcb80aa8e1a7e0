#pragma once
// Whole meshes, bytes in memory to arrays in memory, beside Draco's decoder.

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "app/bench/measure.h"
#include "lacedring/lacedring.hpp"
#include "lacedring/lr_file.hpp"
#include "lacedring/mesh.hpp"

namespace lacedring::app {

struct UnpackBench {
    std::vector<Candidate> candidates;
    std::map<std::string, std::uint64_t> bytes;               ///< of what a candidate decodes
    std::vector<std::pair<std::string, std::string>> absent;  ///< name, reason
};

/// "lacedring": a GLB of the mesh, packed with the default bits, to plain glTF (unpack_scene); "draco" and
/// "draco_smallest": the same mesh with the same bits by Draco at its tools' level 7, their default, and 10, to
/// attributes and an index list. All from bytes in memory to vectors of their own, on one thread.
UnpackBench unpack_candidates(const Mesh& mesh);

/// "lacedring": an .lr file in storage form to resident streams (parse_lr), which have blocks that decode alone;
/// "lacedring_decoded": from there to positions and an index list, too (decode_lr); "lacedring_arrays": to these
/// straight (lacedring_storage.h), from the file's sections; "draco": the same positions with the same bits by Draco at
/// level 10, its smallest, to positions and an index list. `encoded` is the mesh's, as packed; of its attributes only
/// POSITION is taken. All from bytes in memory, on one thread.
UnpackBench restore_candidates(const Mesh& mesh, Encoded encoded, const AttributeBits& bits);

}  // namespace lacedring::app
