// Writes GLB files with one mesh, one primitive and one node.

#include <algorithm>
#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>

#include "lrcore/base/try.h"
#include "lrio/gltf/gltf_names.h"
#include "lrio/mesh/write_formats.h"

namespace lacedring::detail {
namespace {

using Json = nlohmann::ordered_json;

class GlbMaker {
  public:
    explicit GlbMaker(const Mesh& mesh) : mesh_(mesh) {}

    Result<void> make(Bytes& head, Bytes& body, WriteNotes& notes) {
        LR_ASSIGN(GltfAttributes fitted, fit_to_gltf(mesh_, notes));
        quantized_ = fitted.quantized;
        find_bounds(fitted.attributes.front());
        nlohmann::json attributes = nlohmann::json::object();
        for (const Attribute& attribute : fitted.attributes) {
            const std::size_t accessor = add_attribute(attribute, attributes.empty());
            attributes.emplace(attribute.name, accessor);
        }
        const std::size_t indices = add_indices();
        const std::string json = document(attributes, indices);
        LR_ASSIGN(Bytes begin, make_glb_head(json, bin_.size()));
        head = std::move(begin);
        body = std::move(bin_);
        return {};
    }

  private:
    /// Computes the bounds of POSITION, which glTF requires.
    void find_bounds(const Attribute& position) {
        low_.assign(3, std::numeric_limits<float>::infinity());
        high_.assign(3, -std::numeric_limits<float>::infinity());
        for (std::size_t i = 0; i < std::size_t{mesh_.vertex_count} * 3; ++i) {
            float value = 0;
            std::memcpy(&value, position.data.data() + i * sizeof(float), sizeof(float));
            low_[i % 3] = std::min(low_[i % 3], value);
            high_[i % 3] = std::max(high_[i % 3], value);
        }
    }

    std::size_t add_attribute(const Attribute& attribute, bool is_position) {
        const std::size_t stride = attribute.stride();
        const std::size_t padded = (stride + 3) / 4 * 4;  // glTF aligns every vertex to 4 bytes
        const std::size_t offset = bin_.size();
        bin_.resize(offset + padded * mesh_.vertex_count);
        for (std::size_t v = 0; v < mesh_.vertex_count; ++v) {
            std::memcpy(bin_.data() + offset + v * padded, attribute.data.data() + v * stride, stride);
        }
        Json view{{"buffer", 0}, {"byteOffset", offset}, {"byteLength", padded * mesh_.vertex_count}};
        // glTF allows strides up to 252 bytes; attributes here have at most 64 bytes.
        view["byteStride"] = padded;
        view["target"] = kGltfVertexTarget;
        views_.push_back(std::move(view));
        Json accessor{{"bufferView", views_.size() - 1},
                      {"componentType", gltf_component_type(attribute.type)},
                      {"count", mesh_.vertex_count},
                      {"type", gltf_type(attribute.components)}};
        if (attribute.normalized && attribute.type != ComponentType::f32) accessor["normalized"] = true;
        if (is_position) {
            accessor["min"] = low_;
            accessor["max"] = high_;
        }
        accessors_.push_back(std::move(accessor));
        return accessors_.size() - 1;
    }

    std::size_t add_indices() {
        const bool narrow = mesh_.vertex_count <= 65535;  // 65535 is not a valid index: it means primitive restart
        const std::size_t size = narrow ? sizeof(std::uint16_t) : sizeof(std::uint32_t);
        const std::size_t offset = bin_.size();
        const std::size_t length = mesh_.indices.size() * size;
        bin_.resize(offset + (length + 3) / 4 * 4);
        if (narrow) {
            for (std::size_t i = 0; i < mesh_.indices.size(); ++i) {
                const auto index = static_cast<std::uint16_t>(mesh_.indices[i]);
                std::memcpy(bin_.data() + offset + i * size, &index, size);
            }
        } else {
            std::memcpy(bin_.data() + offset, mesh_.indices.data(), length);
        }
        views_.push_back({{"buffer", 0}, {"byteOffset", offset}, {"byteLength", length}, {"target", kGltfIndexTarget}});
        accessors_.push_back({{"bufferView", views_.size() - 1},
                              {"componentType", narrow ? kGltfUnsignedShort : kGltfUnsignedInt},
                              {"count", mesh_.indices.size()},
                              {"type", "SCALAR"}});
        return accessors_.size() - 1;
    }

    std::string document(const nlohmann::json& attributes, std::size_t indices) const {
        Json out{{"asset", {{"version", "2.0"}, {"generator", "LacedRing"}}}};
        if (quantized_) {
            out["extensionsUsed"] = Json::array({"KHR_mesh_quantization"});
            out["extensionsRequired"] = Json::array({"KHR_mesh_quantization"});
        }
        out["scene"] = 0;
        out["scenes"] = Json::array({Json{{"nodes", Json::array({0})}}});
        out["nodes"] = Json::array({Json{{"mesh", 0}}});
        const Json primitive{{"attributes", attributes}, {"indices", indices}, {"mode", 4}};
        out["meshes"] = Json::array({Json{{"primitives", Json::array({primitive})}}});
        out["accessors"] = accessors_;
        out["bufferViews"] = views_;
        out["buffers"] = Json::array({Json{{"byteLength", bin_.size()}}});
        return out.dump();
    }

    const Mesh& mesh_;
    Bytes bin_;
    Json views_ = Json::array();
    Json accessors_ = Json::array();
    std::vector<float> low_;
    std::vector<float> high_;
    bool quantized_ = false;
};

}  // namespace

Result<void> make_glb(const Mesh& mesh, Bytes& head, Bytes& body, WriteNotes& notes) {
    return GlbMaker(mesh).make(head, body, notes);
}

}  // namespace lacedring::detail
