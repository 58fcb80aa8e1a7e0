#pragma once
// A glTF or GLB file as tinygltf's model of its geometry, and its buffers. Internal to lrio.
//
// tinygltf reads nodes, meshes, accessors and buffer views. It never sees the rest of the file: it would open every
// buffer and image, and refuse a file for an animation or a sampler that it does not like.

#include <map>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "lacedring/base.hpp"
#include "lrio/gltf/gltf_buffers.h"
#include "lrio/gltf/tinygltf.h"
#include "lrio/mesh/read_formats.h"

namespace lacedring::detail {

/// What KHR_draco_mesh_compression holds (gltf_draco.h).
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

/// Parses JSON or GLB, and tells `reading` what is not read of it; both outlive the result. No buffer is opened yet.
/// Errors: malformed, unsupported (a version or an extension without which the geometry cannot be read), too_large.
Result<GltfFile> load_gltf(std::span<const std::byte> bytes, Reading& reading);

}  // namespace lacedring::detail
