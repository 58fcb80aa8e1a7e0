#pragma once
// The bytes of a glTF's buffers: its BIN chunk, data URIs, and files beside it. Internal to lrio.
//
// A buffer is opened when something of it is asked for, and each file once, however many buffers name it. No more is
// read than the glTF says that a buffer has. A file has to lie in the glTF's own folder, or below, after links are
// resolved: a mesh must not carry other files of its reader away.

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

    /// The buffer's byteLength bytes, which stay where they are. `index` < count().
    /// Errors: cannot_open (a URI that names no file in the folder, too), malformed (too few bytes, no URI).
    Result<std::span<const std::byte>> open(std::size_t index);

    /// All bytes of a file or a data URI, `most` of a file; they stay where they are. Errors: cannot_open, malformed.
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
    std::vector<std::vector<std::byte>> storage_;         ///< never shrinks, so that spans of its vectors stay valid
    std::map<std::filesystem::path, std::size_t> files_;  ///< the latest of storage_ for each
    std::uint64_t loaded_bytes_ = 0;
};

/// %XX as a byte. A % without two hexadecimal digits stands for itself: writers forget to escape it.
std::string decode_percent(std::string_view text);

/// False where a character is not base64's. Padding may be missing.
bool decode_base64(std::string_view text, std::vector<std::byte>& out);

}  // namespace lacedring::detail
