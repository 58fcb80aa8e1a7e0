#pragma once
// Reads a packed glTF: its document, and the bytes of its buffer views. Internal to lrio.

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "lrio/gltf/gltf_buffers.h"
#include "lrio/mesh/read_formats.h"
#include "lrio/scene/json_text.h"

namespace lacedring::detail {

/// The buffer views of a document. If the extension codes a view, its contents are the decoded bytes, not the bytes at
/// its place in the file.
class SceneViews {
  public:
    SceneViews(const JsonValue& root, GltfBuffers& buffers)
        : views_(root.list("bufferViews")), buffer_list_(root.list("buffers")), buffers_(&buffers) {}

    /// The bytes of the view's own range in its buffer, ignoring the extension. Errors: malformed, those of
    /// GltfBuffers::open.
    Result<std::span<const std::byte>> raw(std::uint64_t index) const;
    /// The view's byteLength, which is the size of contents(). Errors: malformed, those of GltfBuffers::open.
    Result<std::uint64_t> size(std::uint64_t index) const;
    /// A copy of the view's bytes, decoded if they are coded. Errors: malformed, those of GltfBuffers::open.
    Result<std::vector<std::byte>> contents(std::uint64_t index) const;
    /// Is the view in a placeholder buffer and not coded, so that it has no contents?
    bool is_placeholder(std::uint64_t index) const;
    /// Are its bytes coded?
    bool is_coded(std::uint64_t index) const;

  private:
    Result<std::span<const std::byte>> range(const JsonValue& place) const;
    /// The bytes of a view in the file: the coded bytes if it is coded.
    Result<std::span<const std::byte>> stored(std::uint64_t index) const;
    std::span<const JsonValue::Member> views_, buffer_list_;
    GltfBuffers* buffers_;
};

/// The document of a glTF, unpacked from its buffer view if it is packed, and its buffers.
class PackedScene {
  public:
    /// `bytes` and `reading` outlive it. Errors: malformed, unsupported.
    static Result<PackedScene> load(std::span<const std::byte> bytes, Reading& reading);

    JsonText& json() { return *json_; }
    SceneViews views() { return {json_->root, *buffers_}; }
    /// Was the document packed in a buffer view? It then lacks the data that its streams have, too.
    bool is_document_packed() const { return text_ != nullptr; }
    bool has_bin_chunk() const { return has_bin_chunk_; }
    /// Bytes of the file and of other files opened for its buffers.
    double bytes() const { return file_bytes_ + static_cast<double>(buffers_->loaded_bytes()); }

  private:
    double file_bytes_ = 0;
    bool has_bin_chunk_ = false;
    std::unique_ptr<std::string> text_;  ///< the text of a packed document; null: the document is plain
    std::unique_ptr<JsonText> json_;
    std::unique_ptr<nlohmann::json> buffer_list_;
    std::unique_ptr<GltfBuffers> buffers_;
};

}  // namespace lacedring::detail
