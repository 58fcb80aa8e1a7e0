#pragma once
// A glTF or GLB file: its JSON, tinygltf's model of its geometry, and its buffers. Internal to lrio.
//
// tinygltf gets only nodes, meshes, accessors and buffer views. Given the whole file, it would open every buffer and
// image, and refuse the file for an invalid animation or sampler.

#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "lacedring/base.hpp"
#include "lrio/gltf/gltf_buffers.h"
#include "lrio/gltf/tinygltf.h"
#include "lrio/mesh/read_formats.h"

namespace lacedring::detail {

/// The chunks of a GLB file. For a JSON file, `json` is the whole file.
struct GltfChunks {
    std::string_view json;
    std::optional<std::span<const std::byte>> bin;
};
/// Splits a glTF or GLB file. Errors: malformed, unsupported (a version), too_large (4 GiB).
Result<GltfChunks> split_gltf(std::span<const std::byte> bytes);

/// Does the document use extensions that may refer to buffer views by index?
bool has_unknown_extensions(const nlohmann::json& document);

/// Checks that the text is JSON, nested at most as deep as load_gltf allows. Errors: malformed.
Result<void> check_json(std::string_view text);

/// The data of KHR_draco_mesh_compression (gltf_draco.h).
struct DracoData {
    struct Source {
        int view = 0;                 ///< the buffer view of Draco's data
        std::int64_t attribute = -1;  ///< Draco's unique id; -1: the indices
        friend auto operator<=>(const Source&, const Source&) = default;
    };
    std::map<int, Source> sources;                 ///< source of each accessor
    std::map<int, std::vector<int>> accessors;     ///< accessors of each buffer view
    std::map<int, Result<void>> decoded;           ///< result of decoding each buffer view so far
    std::map<int, std::vector<std::byte>> values;  ///< decoded values of each accessor, tightly packed
};

struct GltfFile {
    std::string_view text;    ///< the JSON text, in the file's bytes
    nlohmann::json document;  ///< the parsed JSON
    tinygltf::Model model;    ///< its geometry; no buffers, materials, images, animations, ...
    GltfBuffers buffers;      ///< refers to `document` and to the file's bytes
    const Reading* reading = nullptr;
    std::size_t file_bytes = 0;
    double decoded_bytes = 0;  ///< memory for decoded data so far
    /// Buffer views decoded by meshoptimizer (gltf_view.h).
    std::map<std::size_t, Result<std::vector<std::byte>>> decoded_views = {};
    DracoData draco = {};

    /// Is one of the names in extensionsRequired?
    bool requires_any_of(std::span<const char* const> names) const;

    /// Checks that `bytes` of decoded data, and `passing` bytes needed only during decoding, are within the memory
    /// limit; counts `bytes`. Compressed data may claim to be far larger than the file. Errors: memory_limit.
    Result<void> take_memory(double bytes, double passing = 0);
};

enum class GltfUse : std::uint8_t {
    triangles,   ///< reads only triangles; unknown required extensions are errors
    everything,  ///< keeps all contents; unknown extensions are kept, too
};

/// Parses JSON or GLB, and reports to `reading` which contents are not read; `bytes` and `reading` outlive the result.
/// Opens no buffers. Errors: malformed, unsupported (a version, or a required extension), too_large.
Result<GltfFile> load_gltf(std::span<const std::byte> bytes, Reading& reading, GltfUse use = GltfUse::triangles);

/// Loads a file that is already split into its chunks. `file_bytes`: size of the original file.
Result<GltfFile> load_gltf(const GltfChunks& chunks, std::size_t file_bytes, Reading& reading,
                           GltfUse use = GltfUse::triangles);

}  // namespace lacedring::detail
