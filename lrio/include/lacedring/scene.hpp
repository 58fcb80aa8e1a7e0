#pragma once
// Packs whole glTF scenes and unpacks them: triangles become streams of the glTF extension LACEDRING_mesh_compression
// (docs/gltf); everything else stays unchanged.

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
    automatic,  ///< packed if the plain JSON would be more than a fifth of the file without its images, else plain
    plain,      ///< as in any glTF
    packed,     ///< deflated, in a GLB's binary chunk
};

struct PackOptions {
    /// At least as fine as gltfpack's defaults; all 0: lossless. Integers are never quantized.
    AttributeBits bits = {.positions = 14, .normals = 10, .texcoords = 12, .colors = 8, .weights = 8};
    bool keep_order = false;  ///< keeps the order of vertices and triangles, for about 8 more bytes a vertex
    bool fallback = false;    ///< adds plain buffers, for loaders without the extension
    SceneJson json = SceneJson::automatic;
    LrForm form = LrForm::stored;  ///< form of the streams
    /// URI of the binary buffer; empty: the buffer is a GLB's binary chunk. With a bin_uri, the fallback is in the file
    /// of fallback_uri.
    std::string bin_uri, fallback_uri;
};

struct PackReport {
    std::size_t primitives = 0;                             ///< number of compressed primitives
    std::uint64_t triangles = 0;                            ///< of the compressed primitives
    std::uint64_t geometry_before = 0, geometry_after = 0;  ///< bytes of accessors before, of streams after
    std::map<std::string, double> max_error;                ///< largest error of each lossy attribute
    std::map<std::string, std::size_t> not_compressed;      ///< number of primitives for each reason
    std::vector<std::string> notes;                         ///< other changes, a line each
    ReadReport read;
};

/// A glTF: `bin` is buffer 0, `fallback` the buffer of PackOptions::fallback_uri.
struct SceneFile {
    std::string json;
    std::vector<std::byte> bin, fallback;
};

/// Packs a glTF or GLB. The indices of nodes, meshes, accessors etc. and all unknown contents stay unchanged. `name`
/// gives the folder of its buffers (read_mesh). Errors: as read_mesh; unsupported (is packed already); invalid_argument
/// (a packed document with a URI or a fallback). Untrusted input: safe. Cost: as encoding the triangles.
Result<SceneFile> pack_scene(std::span<const std::byte> bytes, const std::filesystem::path& name,
                             const PackOptions& options = {}, const ReadOptions& read = {},
                             PackReport* report = nullptr);

struct UnpackReport {
    std::size_t primitives = 0;
    std::uint64_t triangles = 0;
    ReadReport read;
};

/// Unpacks a glTF or GLB to plain glTF; an input that is not packed is rewritten with one buffer. `name` and errors as
/// in read_mesh. Untrusted input: safe.
Result<SceneFile> unpack_scene(std::span<const std::byte> bytes, const std::filesystem::path& name,
                               const std::string& bin_uri = "", const ReadOptions& read = {},
                               UnpackReport* report = nullptr);

/// Does the glTF have the extension LACEDRING_mesh_compression?
bool is_packed_scene(std::span<const std::byte> bytes);

/// The bytes of a GLB file before those of `bin`. The caller appends `bin`, padded with zeros to a multiple of 4.
/// Errors: too_large (4 GiB).
Result<std::vector<std::byte>> make_glb_head(const SceneFile& scene);

/// The GLB file of a scene whose buffer has no URI. Errors: too_large (4 GiB).
Result<std::vector<std::byte>> make_glb_file(const SceneFile& scene);

}  // namespace lacedring
