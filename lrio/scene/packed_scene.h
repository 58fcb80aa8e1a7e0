#pragma once
// A packed glTF as it is read: its document, and the bytes of its buffer views. Internal to lrio.

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "lrio/gltf/gltf_buffers.h"
#include "lrio/mesh/read_formats.h"
#include "lrio/scene/json_text.h"

namespace lacedring::detail {

/// The bytes of buffer view `index` of a document, decoded where the extension codes them.
class SceneViews {
  public:
    SceneViews(const JsonValue& root, GltfBuffers& buffers)
        : views_(root.list("bufferViews")), buffer_list_(root.list("buffers")), buffers_(&buffers) {}

    /// As they lie in the buffer. Errors: malformed, GltfBuffers'.
    Result<std::span<const std::byte>> raw(std::uint64_t index) const;
    /// How many bytes they stand for, as the view says. Errors: raw's, and those of the bytes that are coded.
    Result<std::uint64_t> size(std::uint64_t index) const;
    /// What they stand for: a copy. Errors: malformed.
    Result<std::vector<std::byte>> contents(std::uint64_t index) const;
    /// Does the view stand for nothing, its buffer being a placeholder?
    bool is_placeholder(std::uint64_t index) const;
    /// Are its bytes coded?
    bool is_coded(std::uint64_t index) const;

  private:
    Result<std::span<const std::byte>> range(const JsonValue& place) const;
    /// The bytes of a view as they are in the file, coded or not.
    Result<std::span<const std::byte>> stored(std::uint64_t index) const;
    std::span<const JsonValue::Member> views_, buffer_list_;
    GltfBuffers* buffers_;
};

/// The document of a glTF and its buffers, the packed document taken out of its buffer view.
class PackedScene {
  public:
    /// `bytes` and `reading` outlive it. Errors: malformed, unsupported.
    static Result<PackedScene> load(std::span<const std::byte> bytes, Reading& reading);

    JsonText& json() { return *json_; }
    SceneViews views() { return {json_->root, *buffers_}; }
    /// Was the document in a buffer view? What its streams say as well is then left out of it.
    bool is_document_packed() const { return text_ != nullptr; }
    bool has_bin_chunk() const { return has_bin_chunk_; }
    /// Of the file, and of those that were opened beside it.
    double bytes() const { return file_bytes_ + static_cast<double>(buffers_->loaded_bytes()); }

  private:
    double file_bytes_ = 0;
    bool has_bin_chunk_ = false;
    std::unique_ptr<std::string> text_;  ///< of a packed document
    std::unique_ptr<JsonText> json_;
    std::unique_ptr<nlohmann::json> buffer_list_;
    std::unique_ptr<GltfBuffers> buffers_;
};

}  // namespace lacedring::detail
