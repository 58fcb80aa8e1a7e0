#pragma once
// A glTF to read triangles from, plain in memory where the file is packed. Internal to lrio.

#include <cstddef>
#include <optional>
#include <span>

#include "lacedring/scene.hpp"
#include "lrio/gltf/gltf_file.h"
#include "lrio/mesh/read_formats.h"

namespace lacedring::detail {

class PlainScene {
  public:
    /// `bytes` outlive it. What unpacking takes is limited by itself, as what other compressed geometry decodes to.
    /// Errors: unpack_scene's.
    static Result<PlainScene> open(std::span<const std::byte> bytes, Reading& reading);

    /// Valid as long as this is, and stays where it is. Errors: split_gltf's.
    Result<GltfChunks> chunks() const;

    std::size_t file_bytes = 0;  ///< as they were read, packed, with those of files beside it that unpacking opened

  private:
    std::span<const std::byte> bytes_;
    std::optional<SceneFile> unpacked_;
};

}  // namespace lacedring::detail
