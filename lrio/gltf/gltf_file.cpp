#include "lrio/gltf/gltf_file.h"

#include <algorithm>
#include <cstring>
#include <limits>
#include <optional>
#include <string>
#include <string_view>

#include "lrcore/base/try.h"
#include "lrio/gltf/draco_mesh.h"
#include "lrio/gltf/gltf_draco.h"
#include "lrio/gltf/gltf_view.h"

namespace lacedring::detail {
namespace {

constexpr std::size_t kDeepest = 256;

/// JSON parsers are recursive: deeply nested values would overflow the stack.
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
            if (++depth > kDeepest) return true;
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

/// A parser's error message as one short printable line, without the parser's "[...]" prefix.
std::string one_line(std::string_view complaint) {
    if (complaint.starts_with('[')) complaint.remove_prefix(std::min(complaint.find(']') + 1, complaint.size()));
    std::string out;
    for (const char c : complaint.substr(0, 300)) out += (c >= ' ' && c <= '~') ? c : ' ';
    out.erase(0, std::min(out.find_first_not_of(' '), out.size()));
    out.erase(std::min(out.find_last_not_of(" .") + 1, out.size()));
    return out.empty() ? "is not glTF" : "glTF: " + out;
}

std::size_t size_of_array(const nlohmann::json& document, const char* name) {
    const auto found = document.find(name);
    return found != document.end() && found->is_array() ? found->size() : 0;
}

/// Parses a version such as "2.0".
bool parse_version(const nlohmann::json& asset, const char* name, int& major, int& minor) {
    const auto found = asset.find(name);
    if (found == asset.end() || !found->is_string()) return false;
    const std::string& text = *found->get_ptr<const std::string*>();
    char behind = 0;
    return text.size() < 20 && std::sscanf(text.c_str(), "%d.%d%c", &major, &minor, &behind) == 2;
}

Result<void> check_version(const nlohmann::json& document) {
    const auto asset = document.find("asset");
    int major = 0, minor = 0;
    if (asset == document.end() || !asset->is_object() || !parse_version(*asset, "version", major, minor)) {
        return malformed("glTF: asset.version is missing");
    }
    if (major != 2) return unsupported("glTF: version {}.{} is not read", major, minor);
    if (parse_version(*asset, "minVersion", major, minor) && (major != 2 || minor != 0)) {
        return unsupported("glTF: needs a reader of version {}.{}", major, minor);
    }
    return {};
}

/// The library that decodes an extension's geometry. Null: the extension does not compress geometry.
const char* library_for(std::string_view name) {
    if (name == "KHR_draco_mesh_compression") return "libdraco";
    return name == "EXT_meshopt_compression" || name == "KHR_meshopt_compression" ? "meshoptimizer" : nullptr;
}

bool has_library_for(std::string_view name) {
    return name == "KHR_draco_mesh_compression" ? has_draco() : has_meshoptimizer();
}

/// Is the extension read, or without effect on triangles and attributes? Data of the latter kind is lost and reported.
bool is_harmless(std::string_view name) {
    constexpr std::string_view kPrefixes[] = {"KHR_materials_", "EXT_materials_", "ADOBE_materials_", "KHR_lights_",
                                              "EXT_lights_",    "KHR_texture_",   "EXT_texture_",     "VRMC_"};
    constexpr std::string_view kNames[] = {
        "KHR_mesh_quantization",
        "EXT_mesh_gpu_instancing",
        "KHR_animation_pointer",
        "KHR_techniques_webgl",
        "KHR_xmp",
        "KHR_xmp_json_ld",
        "KHR_audio_emitter",
        "EXT_mesh_manifold",
        "EXT_mesh_features",
        "EXT_instance_features",
        "EXT_feature_metadata",
        "EXT_structural_metadata",
        "CESIUM_primitive_outline",
        "MSFT_texture_dds",
        "MSFT_lod",
        "AGI_articulations",
        "AGI_stk_metadata",
        "GODOT_single_root",
        "VRM",
    };
    return std::any_of(std::begin(kPrefixes), std::end(kPrefixes),
                       [name](std::string_view prefix) { return name.starts_with(prefix); }) ||
           std::find(std::begin(kNames), std::end(kNames), name) != std::end(kNames);
}

std::vector<std::string> names_in(const nlohmann::json& document, const char* list) {
    std::vector<std::string> out;
    const auto found = document.find(list);
    if (found == document.end() || !found->is_array()) return out;
    for (const nlohmann::json& name : *found) {
        if (name.is_string()) out.push_back(*name.get_ptr<const std::string*>());
    }
    return out;
}

Result<void> check_extensions(const nlohmann::json& document, Reading& reading, GltfUse use) {
    for (const std::string& name : names_in(document, "extensionsRequired")) {
        if (const char* library = library_for(name); library != nullptr) {
            if (has_library_for(name)) continue;
            return unsupported("glTF: the geometry is compressed with {}, and this build has no {}", name, library);
        }
        if (use == GltfUse::triangles && !is_harmless(name))
            return unsupported("glTF: needs the extension {}, which is not read", shown(name));
    }
    for (const std::string& name : names_in(document, "extensionsUsed")) {
        if (library_for(name) == nullptr && !is_harmless(name)) {
            reading.report.left_out.push_back("the extension " + shown(name));
        }
    }
    return {};
}

/// tinygltf treats a list of the wrong JSON type as empty.
Result<void> check_lists(const nlohmann::json& document) {
    for (const char* name : {"scenes", "nodes", "meshes", "accessors", "bufferViews", "buffers"}) {
        const auto found = document.find(name);
        if (found != document.end() && !found->is_array()) return malformed("glTF: {} is not an array", name);
    }
    return {};
}

void tell_what_is_left_out(const nlohmann::json& document, Reading& reading) {
    const auto leave_out = [&](const char* list, std::string_view one, std::string_view many) {
        reading.leave_out(size_of_array(document, list), one, many);
    };
    if (reading.materials == nullptr) {
        leave_out("materials", "material", "materials");
        leave_out("textures", "texture", "textures");
        leave_out("images", "image", "images");
    }
    leave_out("skins", "skin", "skins");
    leave_out("animations", "animation", "animations");
    leave_out("cameras", "camera", "cameras");
    if (const auto extensions = document.find("extensions"); extensions != document.end() && extensions->is_object()) {
        if (const auto lights = extensions->find("KHR_lights_punctual"); lights != extensions->end()) {
            reading.leave_out(lights->is_object() ? size_of_array(*lights, "lights") : 0, "light", "lights");
        }
    }
    if (const std::size_t scenes = size_of_array(document, "scenes"); scenes > 1) {
        reading.leave_out(scenes - 1, "other scene", "other scenes");
    }
}

/// The document for tinygltf: only the geometry. Accessors without a buffer view get one, because tinygltf refuses them
/// as indices; `zeros` marks these accessors.
nlohmann::json geometry_of(const nlohmann::json& document, std::vector<bool>& zeros) {
    nlohmann::json out = nlohmann::json::object();
    for (const char* name : {"asset", "scene", "scenes", "nodes", "meshes", "accessors", "bufferViews"}) {
        if (const auto found = document.find(name); found != document.end()) out[name] = *found;
    }
    const std::size_t views = size_of_array(out, "bufferViews");
    zeros.assign(size_of_array(out, "accessors"), false);
    if (zeros.empty()) return out;
    for (std::size_t i = 0; i < zeros.size(); ++i) {
        nlohmann::json& accessor = out["accessors"][i];
        if (!accessor.is_object() || accessor.contains("bufferView")) continue;
        accessor["bufferView"] = views;
        zeros[i] = true;
    }
    out["bufferViews"].push_back({{"buffer", 0}, {"byteLength", 1}});
    return out;
}

Result<tinygltf::Model> load_model(const nlohmann::json& document) {
    std::vector<bool> zeros;
    const std::string json =
        geometry_of(document, zeros).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
    if (json.size() > std::numeric_limits<std::uint32_t>::max()) return Error{ErrorCode::too_large, "glTF: too long"};
    tinygltf::Model model;
    std::string complaint, warning;
    tinygltf::TinyGLTF loader;
    if (!loader.LoadASCIIFromString(&model, &complaint, &warning, json.data(), static_cast<unsigned>(json.size()),
                                    "")) {
        return Error{ErrorCode::malformed, one_line(complaint)};
    }
    if (!zeros.empty()) model.bufferViews.pop_back();
    for (std::size_t i = 0; i < zeros.size(); ++i) {
        if (zeros[i]) model.accessors[i].bufferView = -1;
    }
    return model;
}

}  // namespace

bool GltfFile::requires_any_of(std::span<const char* const> names) const {
    const std::vector<std::string> required = names_in(document, "extensionsRequired");
    return std::find_first_of(required.begin(), required.end(), names.begin(), names.end()) != required.end();
}

Result<void> GltfFile::take_memory(double bytes, double passing) {
    auto room = reading->check_memory(decoded_bytes + bytes + passing, 1, 0,
                                      static_cast<double>(file_bytes + buffers.loaded_bytes()));
    if (room) decoded_bytes += bytes;
    return room;
}

Result<GltfChunks> split_gltf(std::span<const std::byte> bytes) {
    if (bytes.size() > std::numeric_limits<std::uint32_t>::max()) {
        return Error{ErrorCode::too_large, "glTF of more than 4 GiB"};
    }
    const auto text = [](std::span<const std::byte> part) {
        return std::string_view(reinterpret_cast<const char*>(part.data()), part.size());
    };
    if (!text(bytes).starts_with("glTF")) return GltfChunks{text(bytes), {}};
    constexpr std::size_t kHeader = 12, kChunkHeader = 8;
    constexpr std::uint32_t kJson = 0x4e4f534a, kBin = 0x004e4942;
    if (bytes.size() < kHeader + kChunkHeader) return malformed("{} bytes are too few for a GLB file", bytes.size());
    if (word_at(bytes, 4) != 2) return unsupported("byte 4: GLB version {}", word_at(bytes, 4));
    const std::uint32_t length = word_at(bytes, 8);
    if (length > bytes.size())
        return malformed("byte 8: the header says {} bytes, the file has {}", length, bytes.size());
    bytes = bytes.first(length);
    GltfChunks out;
    // The first chunk is JSON; the second, if any, is usually BIN; further chunks are ignored. The last chunk may lack
    // its padding to 4 bytes.
    for (std::size_t at = kHeader, number = 0; number < 2 && at + kChunkHeader <= bytes.size(); ++number) {
        const std::uint32_t size = word_at(bytes, at), kind = word_at(bytes, at + 4);
        if (size > bytes.size() - at - kChunkHeader) {
            return malformed("byte {}: a chunk of {} bytes does not fit into the file", at, size);
        }
        const auto contents = bytes.subspan(at + kChunkHeader, size);
        if (number == 0 && kind != kJson) return malformed("byte {}: the first chunk is not JSON", at);
        if (number == 0) out.json = text(contents);
        if (number == 1 && kind == kBin) out.bin = contents;
        at += kChunkHeader + size;
    }
    // Some writers pad the JSON chunk with zeros instead of spaces.
    while (out.json.ends_with('\0')) out.json.remove_suffix(1);
    return out;
}

bool has_unknown_extensions(const nlohmann::json& document) {
    const auto refers = [](std::string_view name) {
        return name == "KHR_audio_emitter" || name.ends_with("_metadata") ||
               (!is_harmless(name) && library_for(name) == nullptr);
    };
    for (const std::string& name : names_in(document, "extensionsUsed")) {
        if (refers(name)) return true;
    }
    return false;
}

Result<void> check_json(std::string_view text) {
    if (nests_too_deep(text)) return malformed("glTF: values are nested more than {} deep", kDeepest);
    if (!nlohmann::json::accept(text)) return malformed("glTF: is no JSON");
    return {};
}

Result<GltfFile> load_gltf(std::span<const std::byte> bytes, Reading& reading, GltfUse use) {
    LR_ASSIGN(const auto chunks, split_gltf(bytes));
    return load_gltf(chunks, bytes.size(), reading, use);
}

Result<GltfFile> load_gltf(const GltfChunks& chunks, std::size_t file_bytes, Reading& reading, GltfUse use) {
    if (nests_too_deep(chunks.json)) return malformed("glTF: values are nested more than {} deep", kDeepest);
    nlohmann::json document;
    try {
        document = nlohmann::json::parse(chunks.json);
    } catch (const nlohmann::json::exception& exception) {
        return Error{ErrorCode::malformed, one_line(exception.what())};
    }
    if (!document.is_object()) return malformed("glTF: is not a JSON object");
    LR_TRY(check_version(document));
    LR_TRY(check_extensions(document, reading, use));
    LR_TRY(check_lists(document));
    LR_ASSIGN(auto model, load_model(document));
    tell_what_is_left_out(document, reading);

    GltfFile file{chunks.json, std::move(document), std::move(model), {}, &reading, file_bytes};
    LR_ASSIGN(auto buffers, GltfBuffers::make(file.document, chunks.bin, reading));
    file.buffers = std::move(buffers);
    LR_TRY(find_draco_primitives(file));
    return file;
}

}  // namespace lacedring::detail
