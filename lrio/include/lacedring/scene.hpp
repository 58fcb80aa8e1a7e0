#pragma once
// glTF scenes in and out, whole: triangles become streams of the glTF extension LACEDRING_mesh_compression
// (docs/gltf), and all else stays as it is.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "lacedring/base.hpp"
#include "lacedring/lr_file.hpp"
#include "lacedring/mesh_files.hpp"

namespace lacedring {

/// How the JSON document of a packed scene is stored.
enum class SceneJson : std::uint8_t {
    automatic,  ///< deflated in a GLB's binary chunk where it would be more than a fifth of the file without its images
    plain,      ///< as in any glTF
    packed,     ///< deflated
};

struct PackOptions {
    /// As gltfpack's defaults, and finer; all 0: lossless. Integers stay as they are.
    AttributeBits bits = {.positions = 14, .normals = 10, .texcoords = 12, .colors = 8, .weights = 8};
    bool keep_order = false;  ///< of vertices and triangles: about 8 bytes a vertex more
    bool fallback = false;    ///< plain buffers beside the streams, for loaders without the extension
    SceneJson json = SceneJson::automatic;
    LrForm form = LrForm::stored;  ///< of the streams
    /// URI of the binary buffer; empty: it is a GLB's. One with a URI has its fallback in a file of its own.
    std::string bin_uri, fallback_uri;
};

struct PackReport {
    std::size_t primitives = 0;                             ///< that are compressed
    std::uint64_t triangles = 0;                            ///< of those
    std::uint64_t geometry_before = 0, geometry_after = 0;  ///< of accessors, and of streams
    std::map<std::string, double> max_error;                ///< by attribute, of those that lose something
    std::map<std::string, std::size_t> not_compressed;      ///< primitives, by what they are
    std::vector<std::string> notes;                         ///< a line each: what changed beside that
    ReadReport read;
};

/// A glTF: `bin` is buffer 0, `fallback` the buffer of PackOptions::fallback_uri.
struct SceneFile {
    std::string json;
    std::vector<std::byte> bin, fallback;
};

/// Packs a glTF or GLB. Numbers of nodes, meshes, accessors and the like stay what they are, and so does what nobody
/// knows. `name` gives the folder of its buffers (read_mesh). Cost: that of encoding the triangles. Errors: those of
/// read_mesh; unsupported (is packed already); invalid_argument (a packed document with a URI or a fallback). Untrusted
/// input: safe.
Result<SceneFile> pack_scene(std::span<const std::byte> bytes, const std::filesystem::path& name,
                             const PackOptions& options = {}, const ReadOptions& read = {},
                             PackReport* report = nullptr);

struct UnpackReport {
    std::size_t primitives = 0;
    std::uint64_t triangles = 0;
    ReadReport read;
};

/// Plain glTF of a packed one; of one that is not packed, the same with one buffer. Errors and the rest as above.
Result<SceneFile> unpack_scene(std::span<const std::byte> bytes, const std::filesystem::path& name,
                               const std::string& bin_uri = "", const ReadOptions& read = {},
                               UnpackReport* report = nullptr);

/// Does the glTF have the extension?
bool is_packed_scene(std::span<const std::byte> bytes);

/// All of a GLB file before the bytes of `bin`, which follow, with zeros up to a multiple of 4. Errors: too_large (4
/// GiB).
Result<std::vector<std::byte>> make_glb_head(const SceneFile& scene);

/// A GLB file of a scene whose buffer has no URI. Errors: too_large (4 GiB).
Result<std::vector<std::byte>> make_glb_file(const SceneFile& scene);

}  // namespace lacedring
