#include "lrio/gltf/gltf_materials.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>

#include "lrcore/base/try.h"
#include "lrio/gltf/gltf_view.h"

namespace lacedring::detail {
namespace {

using Json = nlohmann::json;

class MaterialReader {
  public:
    MaterialReader(GltfFile& file, Reading& reading) : file_(file), reading_(reading) {}

    Result<Materials> read() {
        for (const Json& from : list("materials")) {
            out_.materials.push_back(material_of(from));
            if (wrong_.empty()) continue;
            return malformed("glTF: material {}: {}", out_.materials.size() - 1, wrong_);
        }
        out_.materials.emplace_back();
        LR_TRY(read_images());
        if (!extensions_.empty()) {
            const std::vector<std::string> names(extensions_.begin(), extensions_.end());
            reading_.report.left_out.push_back("what " + shown_names(names) + " adds to materials");
        }
        return std::move(out_);
    }

  private:
    /// A list of the document; empty if the document lacks it.
    const Json& list(const char* name) const {
        static const Json kNone = Json::array();
        const auto found = file_.document.find(name);
        return found != file_.document.end() && found->is_array() ? *found : kNone;
    }

    /// A member of an object; null if the object lacks it.
    static const Json* member(const Json& object, const char* name) {
        if (!object.is_object()) return nullptr;
        const auto found = object.find(name);
        return found == object.end() ? nullptr : &*found;
    }

    void expect(bool good, const char* name) {
        if (!good && wrong_.empty()) wrong_ = fmt::format("{} is not what it should be", name);
    }

    float number(const Json& object, const char* name, float usual) {
        const Json* found = member(object, name);
        if (found == nullptr) return usual;
        expect(found->is_number(), name);
        const float out = found->is_number() ? found->get<float>() : usual;
        expect(std::isfinite(out), name);
        return out;
    }

    template <std::size_t N>
    std::array<float, N> numbers(const Json& object, const char* name, std::array<float, N> usual) {
        const Json* found = member(object, name);
        if (found == nullptr) return usual;
        expect(found->is_array() && found->size() == N, name);
        for (std::size_t i = 0; i < N && wrong_.empty(); ++i) {
            expect((*found)[i].is_number(), name);
            if (wrong_.empty()) usual[i] = (*found)[i].get<float>();
            expect(std::isfinite(usual[i]), name);
        }
        return usual;
    }

    bool flag(const Json& object, const char* name) {
        const Json* found = member(object, name);
        if (found == nullptr) return false;
        expect(found->is_boolean(), name);
        return found->is_boolean() && found->get<bool>();
    }

    /// The member `name` of the object, an index below `count`; `count` if the object lacks it.
    std::size_t index(const Json& object, const char* name, std::size_t count) {
        const Json* found = member(object, name);
        if (found == nullptr) return count;
        const bool good = found->is_number_unsigned() && found->get<std::uint64_t>() < count;
        expect(good, name);
        return good ? found->get<std::size_t>() : count;
    }

    static TextureWrap wrap_of(std::size_t gl) {
        constexpr std::size_t kClampToEdge = 33071, kMirroredRepeat = 33648;
        return gl == kClampToEdge      ? TextureWrap::clamp
               : gl == kMirroredRepeat ? TextureWrap::mirror
                                       : TextureWrap::repeat;
    }

    /// A property of the texture's sampler, as an OpenGL constant; 0: glTF's default.
    std::size_t sampler_value(const Json& texture, const char* name) {
        const Json& samplers = list("samplers");
        const std::size_t sampler = index(texture, "sampler", samplers.size());
        return sampler == samplers.size() ? 0
                                          : std::min(index(samplers[sampler], name, 1U << 16), std::size_t{1} << 16);
    }

    std::uint32_t set_of(const Json& object) {
        constexpr std::size_t kMost = 1U << 16;
        return static_cast<std::uint32_t>(index(object, "texCoord", kMost) % kMost);
    }

    TextureUse texture_of(const Json& object, const char* name) {
        TextureUse out;
        const Json* info = member(object, name);
        if (info == nullptr) return out;
        const Json& textures = list("textures");
        const std::size_t number = index(*info, "index", textures.size());
        if (number == textures.size()) {
            expect(false, name);
            return out;
        }
        const Json& texture = textures[number];
        const std::size_t images = list("images").size(), source = index(texture, "source", images);
        if (source == images) {
            ++without_image_;
        } else {
            out.image = static_cast<std::uint32_t>(source);
        }
        constexpr std::size_t kSets = 2, kNearest = 9728;
        out.set = set_of(*info);
        out.wrap_u = wrap_of(sampler_value(texture, "wrapS"));
        out.wrap_v = wrap_of(sampler_value(texture, "wrapT"));
        out.nearest = sampler_value(texture, "magFilter") == kNearest;
        if (const Json* extensions = member(*info, "extensions"); extensions != nullptr) {
            if (const Json* moved = member(*extensions, "KHR_texture_transform"); moved != nullptr)
                transform(*moved, out);
        }
        if (out.set >= kSets) {
            extensions_.insert(fmt::format("TEXCOORD_{}", out.set));
            out.image = TextureUse::kNone;
        }
        return out;
    }

    void transform(const Json& moved, TextureUse& out) {
        const auto offset = numbers<2>(moved, "offset", {0, 0}), scale = numbers<2>(moved, "scale", {1, 1});
        const float angle = number(moved, "rotation", 0);
        const float c = std::cos(angle), s = std::sin(angle);
        out.transform = {c * scale[0], s * scale[1], offset[0], -s * scale[0], c * scale[1], offset[1]};
        if (member(moved, "texCoord") != nullptr) out.set = set_of(moved);
    }

    Material material_of(const Json& from) {
        Material out;
        expect(from.is_object(), "it");
        if (const Json* pbr = member(from, "pbrMetallicRoughness"); pbr != nullptr) {
            out.base_color = numbers<4>(*pbr, "baseColorFactor", out.base_color);
            out.metallic = number(*pbr, "metallicFactor", 1);
            out.roughness = number(*pbr, "roughnessFactor", 1);
            out.base = texture_of(*pbr, "baseColorTexture");
            out.metallic_roughness = texture_of(*pbr, "metallicRoughnessTexture");
        }
        out.emissive = numbers<3>(from, "emissiveFactor", out.emissive);
        out.emitting = texture_of(from, "emissiveTexture");
        out.normal = texture_of(from, "normalTexture");
        out.occluding = texture_of(from, "occlusionTexture");
        if (const Json* normal = member(from, "normalTexture"); normal != nullptr)
            out.normal_scale = number(*normal, "scale", 1);
        if (const Json* occlusion = member(from, "occlusionTexture"); occlusion != nullptr)
            out.occlusion = number(*occlusion, "strength", 1);
        if (const Json* mode = member(from, "alphaMode"); mode != nullptr) {
            out.alpha = *mode == "MASK" ? AlphaMode::mask : *mode == "BLEND" ? AlphaMode::blend : AlphaMode::opaque;
        }
        out.cutoff = number(from, "alphaCutoff", out.cutoff);
        out.double_sided = flag(from, "doubleSided");
        if (const Json* extensions = member(from, "extensions"); extensions != nullptr) extend(*extensions, out);
        return out;
    }

    void extend(const Json& extensions, Material& out) {
        for (const auto& [name, values] : extensions.items()) {
            if (name == "KHR_materials_unlit") {
                out.unlit = true;
            } else if (name == "KHR_materials_emissive_strength") {
                const float strength = number(values, "emissiveStrength", 1);
                for (float& color : out.emissive) color *= strength;
            } else if (name.starts_with("KHR_materials_") || name.starts_with("EXT_materials_")) {
                extensions_.insert(name);
            }
        }
    }

    /// Reads the images that a material uses.
    Result<void> read_images() {
        const Json& images = list("images");
        out_.images.resize(images.size());
        std::set<std::uint32_t> used;
        for (const Material& m : out_.materials) {
            for (const TextureUse* use : {&m.base, &m.metallic_roughness, &m.normal, &m.occluding, &m.emitting}) {
                if (use->image != TextureUse::kNone) used.insert(use->image);
            }
        }
        std::vector<std::string> unread;
        for (const std::uint32_t i : used) {
            const auto bytes = open_image(images[i]);
            if (!bytes && bytes.error().code == ErrorCode::memory_limit) return bytes.error();
            if (!bytes) {
                unread.push_back(fmt::format("image {}: {}", i, bytes.error().message));
                continue;
            }
            if (auto room = file_.take_memory(static_cast<double>(bytes->size())); !room) return room;
            out_.images[i].assign(bytes->begin(), bytes->end());
        }
        constexpr std::size_t kSaid = 4;
        if (unread.size() > kSaid) {
            reading_.leave_out(unread.size() - kSaid, "other image", "other images");
            unread.resize(kSaid);
        }
        std::ranges::move(unread, std::back_inserter(reading_.report.left_out));
        reading_.leave_out(without_image_, "texture without an image that is read",
                           "textures without an image that is read");
        return {};
    }

    Result<std::span<const std::byte>> open_image(const Json& image) {
        constexpr std::uint64_t kMost = std::uint64_t{256} << 20;
        if (const Json* uri = member(image, "uri"); uri != nullptr && uri->is_string())
            return file_.buffers.open_uri(*uri->get_ptr<const std::string*>(), kMost);
        const std::size_t views = file_.model.bufferViews.size(), view = index(image, "bufferView", views);
        if (view == views) return malformed("neither a file nor a buffer view");
        return open_view(file_, view);
    }

    GltfFile& file_;
    Reading& reading_;
    Materials out_;
    std::string wrong_;                 ///< error of the material being read, or empty
    std::set<std::string> extensions_;  ///< used extensions that are not read
    std::size_t without_image_ = 0;
};

}  // namespace

Result<Materials> read_materials(GltfFile& file, Reading& reading) {
    return MaterialReader(file, reading).read();
}

}  // namespace lacedring::detail
