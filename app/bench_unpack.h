#pragma once
// Unpacking of a whole mesh, a packed scene in memory, beside Draco's decoder.

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "app/measure.h"
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

}  // namespace lacedring::app
