#pragma once
// A glTF from which triangles are read; a packed one is unpacked in memory. Internal to lrio.

#include <cstddef>
#include <optional>
#include <span>

#include "lacedring/scene.hpp"
#include "lrio/gltf/gltf_file.h"
#include "lrio/mesh/read_formats.h"

namespace lacedring::detail {

class PlainScene {
  public:
    /// `bytes` outlives the result. The memory of unpacking has a limit of its own, separate from the mesh's. Errors:
    /// those of unpack_scene.
    static Result<PlainScene> open(std::span<const std::byte> bytes, Reading& reading);

    /// Valid as long as this object, which must not move. Errors: those of split_gltf.
    Result<GltfChunks> chunks() const;

    std::size_t file_bytes = 0;  ///< bytes of the original file and of other files that unpacking opened

  private:
    std::span<const std::byte> bytes_;
    std::optional<SceneFile> unpacked_;
};

}  // namespace lacedring::detail
