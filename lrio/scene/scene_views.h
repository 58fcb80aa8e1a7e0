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

/// Makes the buffer of a packed scene: first the views that are still used, coded if that is smaller and allowed; then
/// the streams.
class SceneViewWriter {
  public:
    /// The accessors of `json` that have streams have no buffer views. `plain`: views are not coded.
    SceneViewWriter(JsonText& json, GltfFile& file, bool plain) : json_(json), file_(file), plain_(plain) {}

    /// Adds the views that accessors and images use, renumbered. If unknown extensions may refer to views by index,
    /// keeps all views and their indices. Errors: malformed, those of reading buffers.
    Result<void> keep_others();
    /// Adds the bytes of a stream; returns the index of the new view.
    std::uint64_t add_stream(std::span<const std::byte> bytes);
    /// The same for an accessor of the fallback, with rows of `stride` bytes.
    std::uint64_t add_plain(std::span<const std::byte> bytes, std::size_t stride);

    /// Returns the document with its views and buffers.
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
    std::vector<std::size_t> plain_views_;  ///< indices of the fallback's views
    std::size_t placeholder_ = 0;           ///< byteLength of the placeholder buffer
    std::size_t image_bytes_ = 0;
};

}  // namespace lacedring::detail
