#pragma once
// The bytes of a glTF's buffers: its BIN chunk, data URIs, and other files. Internal to lrio.
//
// A buffer is opened at its first use. Buffers in the same file share its bytes, and at most byteLength bytes are read
// for a buffer. After links are resolved, a file must be in the glTF's folder or below it: otherwise a converted mesh
// could contain private files of the user.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "lacedring/base.hpp"
#include "lrio/mesh/read_formats.h"

namespace lacedring::detail {

class GltfBuffers {
  public:
    /// No buffers.
    GltfBuffers() = default;

    /// `document` is the glTF's JSON, and `bin` the BIN chunk of a GLB file; both outlive this. Errors: malformed.
    static Result<GltfBuffers> make(const nlohmann::json& document, std::optional<std::span<const std::byte>> bin,
                                    Reading& reading);

    std::size_t count() const { return buffers_.size(); }

    /// The buffer's byteLength bytes, valid as long as this object. `index` < count().
    /// Errors: cannot_open (also a URI of a file outside the folder), malformed (too few bytes, no URI).
    Result<std::span<const std::byte>> open(std::size_t index);

    /// The bytes of a data URI, or the first `most` bytes of a file or all if it is shorter; valid as long as this
    /// object. Errors: cannot_open, malformed.
    Result<std::span<const std::byte>> open_uri(const std::string& uri, std::uint64_t most);

    /// Bytes of the files and data URIs opened so far.
    std::uint64_t loaded_bytes() const { return loaded_bytes_; }

  private:
    struct Buffer {
        std::uint64_t length = 0;
        const std::string* uri = nullptr;  ///< null: the buffer has none
        std::optional<std::span<const std::byte>> bytes;
    };
    explicit GltfBuffers(Reading& reading) : reading_(&reading) {}
    Result<std::span<const std::byte>> load(std::size_t index, const Buffer& buffer);
    Result<std::span<const std::byte>> load_file(const std::string& uri, std::uint64_t length);

    Reading* reading_ = nullptr;
    std::optional<std::span<const std::byte>> bin_;
    std::vector<Buffer> buffers_;
    std::vector<std::vector<std::byte>> storage_;         ///< vectors are never removed: spans of them stay valid
    std::map<std::filesystem::path, std::size_t> files_;  ///< index into storage_ of each file's latest bytes
    std::uint64_t loaded_bytes_ = 0;
};

/// Replaces each %XX by its byte. A % without two hexadecimal digits is kept: some writers do not escape it.
std::string decode_percent(std::string_view text);

/// Decodes base64; the padding may be missing. False: the text is not base64.
bool decode_base64(std::string_view text, std::vector<std::byte>& out);

}  // namespace lacedring::detail
