#pragma once
// The buffer views of a packed scene. Internal to lrio.

#include <cstdint>
#include <span>
#include <vector>

#include "lacedring/scene.hpp"
#include "lrio/gltf/gltf_file.h"
#include "lrio/scene/json_text.h"
#include "lrio/scene/scene_writer.h"

namespace lacedring::detail {

/// Makes the buffer: views that are still referred to, coded where that is smaller and nobody needs them plain; then
/// streams.
class SceneViewWriter {
  public:
    /// Accessors of `json` that have streams have no views any more. `plain`: without codings.
    SceneViewWriter(JsonText& json, GltfFile& file, bool plain) : json_(json), file_(file), plain_(plain) {}

    /// The views that accessors, images and whatever is not known refer to. They get new numbers, unless an extension
    /// may refer to views by theirs. Errors: malformed, those of reading buffers.
    Result<void> keep_others();
    std::uint64_t add_stream(std::span<const std::byte> bytes);
    std::uint64_t add_plain(std::span<const std::byte> bytes, std::size_t stride);

    /// The document with its views and buffers.
    Result<SceneFile> finish(const PackOptions& options);

  private:
    struct Use;
    std::vector<Use> find_uses();
    JsonValue coded_view(const JsonValue& view, std::span<const std::byte> bytes, const Use& use);
    bool deflates_document(const PackOptions& options, const SceneFile& scene) const;
    Result<void> pack_document(SceneFile& out);

    JsonText& json_;
    GltfFile& file_;
    bool plain_;
    JsonValue views_ = JsonText::array();
    BinChunk bin_, fallback_;
    std::vector<std::size_t> plain_views_;  ///< that lie in the buffer of the fallback
    std::size_t placeholder_ = 0;           ///< bytes of the placeholder's buffer
    std::size_t image_bytes_ = 0;
};

}  // namespace lacedring::detail
