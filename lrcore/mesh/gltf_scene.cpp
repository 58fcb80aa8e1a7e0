#include "lrcore/mesh/gltf_scene.h"

#include <algorithm>
#include <cctype>
#include <cstring>
#include <limits>
#include <string>
#include <string_view>

#include "lrcore/base/file.h"
#include "lrcore/mesh/read_formats.h"

namespace lr::detail {
namespace {

constexpr std::size_t deepest_json = 256;

/// tinygltf calls itself for nested values: deep ones would overflow the stack.
bool nests_too_deep(std::string_view json) {
    std::size_t depth = 0;
    bool in_string = false;
    for (std::size_t i = 0; i < json.size(); ++i) {
        const char c = json[i];
        if (in_string) {
            if (c == '\\') ++i;
            if (c == '"') in_string = false;
        } else if (c == '"') {
            in_string = true;
        } else if (c == '{' || c == '[') {
            if (++depth > deepest_json) return true;
        } else if (c == '}' || c == ']') {
            if (depth > 0) --depth;
        }
    }
    return false;
}

std::uint32_t word_at(std::span<const std::byte> bytes, std::size_t offset) {
    std::uint32_t word = 0;
    std::memcpy(&word, bytes.data() + offset, 4);
    return word;
}

/// The JSON chunk of a GLB file whose chunks are known to lie inside of it.
Result<std::string_view> glb_json(std::span<const std::byte> bytes) {
    constexpr std::size_t header = 12;
    constexpr std::size_t chunk_header = 8;
    if (bytes.size() < header + chunk_header) return malformed("{} bytes are too few for a GLB file", bytes.size());
    if (word_at(bytes, 4) != 2) return unsupported("byte 4: GLB version {}", word_at(bytes, 4));
    const std::uint64_t length = word_at(bytes, 8);
    if (length > bytes.size()) return malformed("byte 8: {} bytes long, but has {}", length, bytes.size());
    const std::uint64_t json = word_at(bytes, 12);
    if (header + chunk_header + json > length) return malformed("byte 12: the JSON chunk does not fit into the file");
    // tinygltf forgets the chunk's own header when it compares these
    const std::uint64_t bin = header + chunk_header + json;
    if (bin != length && (bin + chunk_header > length || bin + chunk_header + word_at(bytes, bin) > length)) {
        return malformed("byte {}: the second chunk does not fit into the file", bin);
    }
    return std::string_view(reinterpret_cast<const char*>(bytes.data()) + header + chunk_header, json);
}

/// Buffers come from regular files with absolute names (tinygltf looks in the working directory too, and expands
/// names as a shell would, which nobody wants). Images are said to be missing, which tinygltf takes as a warning.
bool file_exists(const std::string& name, void*) {
    const std::filesystem::path path(name);
    std::string extension = path.extension().string();
    for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    for (const char* image : {".png", ".jpg", ".jpeg", ".webp", ".ktx2", ".basis", ".dds", ".bmp", ".gif", ".tga"}) {
        if (extension == image) return false;
    }
    std::error_code error;
    return path.is_absolute() && std::filesystem::is_regular_file(path, error);
}

std::string keep_file_path(const std::string& name, void*) {
    return name;
}

bool read_whole_file(std::vector<unsigned char>* out, std::string* error, const std::string& name, void*) {
    const auto bytes = read_file(name);
    if (!bytes) {
        *error += bytes.error().message;
        return false;
    }
    const auto* begin = reinterpret_cast<const unsigned char*>(bytes->data());
    out->assign(begin, begin + bytes->size());
    return true;
}

bool write_no_file(std::string*, const std::string&, const std::vector<unsigned char>&, void*) {
    return false;
}

bool ignore_image(tinygltf::Image*, int, std::string*, std::string*, int, int, const unsigned char*, int, void*) {
    return true;
}

/// tinygltf's complaints are several lines with the name of the folder in them.
std::string one_line(std::string_view complaint, const std::string& folder) {
    std::string out;
    for (const char c : complaint.substr(0, 300)) out += (c >= ' ' && c <= '~') ? c : ' ';
    for (std::size_t at = 0; !folder.empty() && (at = out.find(folder + "/")) != std::string::npos;) {
        out.erase(at, folder.size() + 1);
    }
    out.erase(std::min(out.find_last_not_of(" .") + 1, out.size()));
    return out.empty() ? "is not glTF" : "glTF: " + out;
}

/// An extension in whose buffers the geometry is hidden.
Result<void> check_extensions(const tinygltf::Model& model, bool loaded) {
    // Where they are not required, the file has the plain geometry too, unless it does not even load without them.
    for (const std::string& name : loaded ? model.extensionsRequired : model.extensionsUsed) {
        if (name == "KHR_draco_mesh_compression" || name == "EXT_meshopt_compression" ||
            name == "KHR_meshopt_compression") {
            return unsupported("glTF: the geometry is compressed with {}, which is not read", name);
        }
        if (loaded && name == "EXT_mesh_gpu_instancing") return unsupported("glTF: {} is not read", name);
    }
    return {};
}

}  // namespace

Result<tinygltf::Model> load_gltf(std::span<const std::byte> bytes, const std::filesystem::path& folder) {
    const bool binary = bytes.size() >= 4 && std::memcmp(bytes.data(), "glTF", 4) == 0;
    std::string_view json(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    if (bytes.size() > std::numeric_limits<std::uint32_t>::max()) {
        return Error{ErrorCode::too_large, "glTF of more than 4 GiB"};
    }
    if (binary) {
        const auto chunk = glb_json(bytes);
        if (!chunk) return chunk.error();
        json = *chunk;
    }
    if (nests_too_deep(json)) return malformed("glTF: values are nested more than {} deep", deepest_json);

    std::error_code error;
    const std::string base = std::filesystem::absolute(folder.empty() ? "." : folder, error).string();
    tinygltf::Model model;
    std::string complaint;
    std::string warning;
    tinygltf::TinyGLTF loader;
    loader.SetImageLoader(ignore_image, nullptr);
    loader.SetFsCallbacks({file_exists, keep_file_path, read_whole_file, write_no_file, nullptr});
    const auto size = static_cast<unsigned>(bytes.size());
    const bool loaded =
        binary ? loader.LoadBinaryFromMemory(&model, &complaint, &warning,
                                             reinterpret_cast<const unsigned char*>(bytes.data()), size, base)
               : loader.LoadASCIIFromString(&model, &complaint, &warning, json.data(), size, base);
    if (auto good = check_extensions(model, true); !good) return good.error();
    if (!loaded) {
        if (auto good = check_extensions(model, false); !good) return good.error();
        return Error{ErrorCode::malformed, one_line(complaint, base)};
    }
    return model;
}

namespace {

template <std::size_t count>
bool take(const std::vector<double>& from, std::array<double, count>& to) {
    if (from.size() == count) std::copy(from.begin(), from.end(), to.begin());
    return from.empty() || from.size() == count;
}

bool local_transform(const tinygltf::Node& node, Transform& out) {
    if (!node.matrix.empty()) return take(node.matrix, out.m);
    if (node.translation.empty() && node.rotation.empty() && node.scale.empty()) return true;
    Vector3 translation{0, 0, 0};
    std::array<double, 4> rotation{0, 0, 0, 1};
    Vector3 scale{1, 1, 1};
    const bool good = take(node.translation, translation) && take(node.rotation, rotation) && take(node.scale, scale);
    if (good) out = from_parts(translation, rotation, scale);
    return good;
}

Result<std::vector<int>> root_nodes(const tinygltf::Model& model) {
    if (!model.scenes.empty()) {
        const int scene = model.defaultScene == -1 ? 0 : model.defaultScene;
        if (scene < 0 || static_cast<std::size_t>(scene) >= model.scenes.size()) {
            return malformed("glTF: scene {} does not exist", scene);
        }
        return model.scenes[static_cast<std::size_t>(scene)].nodes;
    }
    std::vector<bool> is_child(model.nodes.size(), false);
    for (const tinygltf::Node& node : model.nodes) {
        for (const int child : node.children) {
            if (child >= 0 && static_cast<std::size_t>(child) < is_child.size()) {
                is_child[static_cast<std::size_t>(child)] = true;
            }
        }
    }
    std::vector<int> roots;
    for (std::size_t i = 0; i < is_child.size(); ++i) {
        if (!is_child[i]) roots.push_back(static_cast<int>(i));
    }
    return roots;
}

}  // namespace

Result<std::vector<MeshInstance>> place_meshes(const tinygltf::Model& model) {
    std::vector<MeshInstance> instances;
    if (model.nodes.empty()) {
        for (std::size_t mesh = 0; mesh < model.meshes.size(); ++mesh) instances.push_back({mesh, {}});
        return instances;
    }
    const auto roots = root_nodes(model);
    if (!roots) return roots.error();

    struct Visit {
        int node;
        Transform parent;
        bool is_root;
    };
    std::vector<Visit> stack;  // not recursion: hostile files nest nodes deep
    for (auto root = roots->rbegin(); root != roots->rend(); ++root) stack.push_back({*root, {}, true});
    std::vector<bool> visited(model.nodes.size(), false);
    while (!stack.empty()) {
        const Visit visit = stack.back();
        stack.pop_back();
        if (visit.node < 0 || static_cast<std::size_t>(visit.node) >= model.nodes.size()) {
            return malformed("glTF: node {} does not exist", visit.node);
        }
        const auto index = static_cast<std::size_t>(visit.node);
        const tinygltf::Node& node = model.nodes[index];
        if (visited[index]) return malformed("glTF: node {} is in a cycle or has two parents", index);
        visited[index] = true;
        Transform transform;
        if (!local_transform(node, transform))
            return malformed("glTF: node {}: the transform has a wrong length", index);
        if (!visit.is_root) transform = visit.parent * transform;
        if (node.mesh != -1) {
            if (node.mesh < 0 || static_cast<std::size_t>(node.mesh) >= model.meshes.size()) {
                return malformed("glTF: node {}: mesh {} does not exist", index, node.mesh);
            }
            instances.push_back({static_cast<std::size_t>(node.mesh), transform});
        }
        for (auto child = node.children.rbegin(); child != node.children.rend(); ++child) {
            stack.push_back({*child, transform, false});
        }
    }
    return instances;
}

}  // namespace lr::detail
