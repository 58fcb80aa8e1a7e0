#pragma once
// A glTF or GLB file as tinygltf's model of its geometry, and its buffers. Internal to lrio.
//
// tinygltf reads nodes, meshes, accessors and buffer views. It never sees the rest of the file: it would open every
// buffer and image, and refuse a file for an animation or a sampler that it does not like.

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

/// The chunks of a GLB file; of a file that is JSON, all of it.
struct GltfChunks {
    std::string_view json;
    std::optional<std::span<const std::byte>> bin;
};
/// Errors: malformed, unsupported (a version), too_large (4 GiB).
Result<GltfChunks> split_gltf(std::span<const std::byte> bytes);

/// Does it use extensions that may refer to buffer views by their numbers?
bool has_unknown_extensions(const nlohmann::json& document);

/// Is it JSON that is nested no deeper than parsers go? Errors: malformed.
Result<void> check_json(std::string_view text);

/// The data of KHR_draco_mesh_compression (gltf_draco.h).
struct DracoData {
    struct Source {
        int view = 0;                 ///< the buffer view of Draco's data
        std::int64_t attribute = -1;  ///< Draco's unique id; -1: the indices
        friend auto operator<=>(const Source&, const Source&) = default;
    };
    std::map<int, Source> sources;                 ///< of accessors
    std::map<int, std::vector<int>> accessors;     ///< of buffer views
    std::map<int, Result<void>> decoded;           ///< buffer views that were decoded, or not
    std::map<int, std::vector<std::byte>> values;  ///< of accessors, tightly packed
};

struct GltfFile {
    std::string_view text;    ///< of the document, in the file's bytes
    nlohmann::json document;  ///< the whole file
    tinygltf::Model model;    ///< its geometry; no buffers, materials, images, animations, ...
    GltfBuffers buffers;      ///< refers to `document` and to the file's bytes
    const Reading* reading = nullptr;
    std::size_t file_bytes = 0;
    double decoded_bytes = 0;                                                  ///< taken so far
    std::map<std::size_t, Result<std::vector<std::byte>>> decoded_views = {};  ///< of meshoptimizer (gltf_view.h)
    DracoData draco = {};

    /// Is one of the names in extensionsRequired?
    bool requires_any_of(std::span<const char* const> names) const;

    /// Asks for memory for decoded data, `passing` bytes of it only until it is decoded: compressed data can say that
    /// it is far larger than the file. Errors: memory_limit.
    Result<void> take_memory(double bytes, double passing = 0);
};

enum class GltfUse : std::uint8_t {
    triangles,   ///< what else the file has is lost
    everything,  ///< nothing is: extensions that are not known do no harm
};

/// Parses JSON or GLB, and tells `reading` what is not read of it; both outlive the result. No buffer is opened yet.
/// Errors: malformed, unsupported (a version or an extension without which the geometry cannot be read), too_large.
Result<GltfFile> load_gltf(std::span<const std::byte> bytes, Reading& reading, GltfUse use = GltfUse::triangles);

/// The same of a file that is split. `file_bytes`: of the file as it was read.
Result<GltfFile> load_gltf(const GltfChunks& chunks, std::size_t file_bytes, Reading& reading,
                           GltfUse use = GltfUse::triangles);

}  // namespace lacedring::detail
