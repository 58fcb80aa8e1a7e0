#pragma once
// Decoding whole meshes from bytes in memory to arrays in memory, beside Draco's decoder.

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
    std::map<std::string, std::uint64_t> bytes;               ///< input size of each candidate
    std::vector<std::pair<std::string, std::string>> absent;  ///< name, reason
};

/// Candidates, each on one thread and to vectors of its own:
/// "lacedring": unpack_scene of a GLB of the mesh, packed with the default bits, to plain glTF;
/// "draco", "draco_smallest": Draco at level 7, its tools' default, and at level 10, with the same bits, to attributes
/// and an index list.
UnpackBench unpack_candidates(const Mesh& mesh);

/// Candidates, each on one thread, for the mesh with POSITION as its only attribute:
/// "lacedring": parse_lr of an .lr file in storage form to resident streams, whose blocks decode alone;
/// "lacedring_decoded": parse_lr, then decode_lr to positions and an index list;
/// "lacedring_arrays": from the file's sections directly to positions and an index list (lacedring_storage.h);
/// "draco": Draco at level 10, its smallest, with the same bits, to positions and an index list.
/// `encoded`: the packed stream of the mesh.
UnpackBench restore_candidates(const Mesh& mesh, Encoded encoded, const AttributeBits& bits);

}  // namespace lacedring::app
