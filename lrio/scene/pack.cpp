// Packs a glTF scene: plans the streams, encodes them, and edits the document.

#include <algorithm>

#include "lacedring/scene.hpp"
#include "lrcore/base/try.h"
#include "lrio/gltf/gltf_accessor.h"
#include "lrio/gltf/gltf_file.h"
#include "lrio/gltf/gltf_names.h"
#include "lrio/gltf/tinygltf.h"
#include "lrio/scene/packed_scene.h"
#include "lrio/scene/quantization.h"
#include "lrio/scene/scene_plan.h"
#include "lrio/scene/scene_set.h"
#include "lrio/scene/scene_stream.h"
#include "lrio/scene/scene_views.h"
#include "lrio/scene/scene_writer.h"
#include "lrio/scene/stream_decoder.h"

namespace lacedring {
namespace {

using namespace detail;

/// Sets of at least kAlone triangles get their own stream. Smaller sets share streams of up to kTogether triangles:
/// this spreads a stream's fixed cost, and still a loader that needs one mesh need not decode everything.
constexpr std::size_t kAlone = 16384, kTogether = 65536;

class Packer {
  public:
    Packer(GltfFile& file, const PackOptions& options, Reading& reading, PackReport& report)
        : file_(file), options_(options), reading_(reading), report_(report), json_(file.text) {}

    Result<SceneFile> run() {
        if (is_packed()) return unsupported("is packed already");
        name_draco_accessors();
        accessors_ = json_.root.find("accessors");
        meshes_json_ = json_.root.list("meshes");
        LR_ASSIGN(auto plan, plan_scene(json_.root, file_, options_.keep_order));
        plan_ = std::move(plan);
        report_.not_compressed = plan_.not_compressed;
        LR_TRY(read_sets());
        group_sets();
        for (const Group& group : groups_) {
            LR_TRY(encode(group));
        }
        return finish();
    }

  private:
    double file_bytes() const { return static_cast<double>(file_.file_bytes + file_.buffers.loaded_bytes()); }

    /// The sets of a stream.
    struct Group {
        std::vector<std::uint32_t> sets;
        std::size_t triangles = 0;
        bool keep_order = false;
    };

    /// Does any part of the document use the extension?
    bool is_packed() const {
        const auto has_extension = [](const JsonValue::Member& member) {
            return extension_of(member.value) != nullptr;
        };
        const auto any = [&](std::span<const JsonValue::Member> list) {
            return std::any_of(list.begin(), list.end(), has_extension);
        };
        const auto meshes = std::as_const(json_.root).list("meshes");
        return extension_of(json_.root) != nullptr || any(json_.root.list("bufferViews")) ||
               std::any_of(meshes.begin(), meshes.end(),
                           [&](const auto& mesh) { return any(mesh.value.list("primitives")); });
    }

    /// Edits Draco primitives in the document to their decoded form (gltf_draco.h): triangle lists with own accessors.
    void name_draco_accessors() {
        const auto& accessors = file_.model.accessors;
        for (std::size_t i = json_.root.list("accessors").size(); i < accessors.size(); ++i) {
            JsonValue made = JsonText::object();
            made.set("componentType", json_.number(static_cast<std::uint64_t>(accessors[i].componentType)));
            made.set("count", json_.number(0));
            const int components = tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(accessors[i].type));
            made.set("type", json_.string(gltf_type(static_cast<std::uint8_t>(std::clamp(components, 0, 16)))));
            if (accessors[i].normalized) made.set("normalized", json_.boolean(true));
            if (json_.root.find("accessors") == nullptr) json_.root.set("accessors", JsonText::array());
            json_.root.find("accessors")->members.push_back({{}, std::move(made)});
        }
        auto meshes = json_.root.list("meshes");
        for (std::size_t m = 0; m < std::min(meshes.size(), file_.model.meshes.size()); ++m) {
            auto primitives = meshes[m].value.list("primitives");
            const auto& models = file_.model.meshes[m].primitives;
            for (std::size_t p = 0; p < std::min(primitives.size(), models.size()); ++p) {
                JsonValue& primitive = primitives[p].value;
                if (!models[p].extensions.contains("KHR_draco_mesh_compression")) continue;
                if (models[p].indices >= 0) {
                    primitive.set("indices", json_.number(static_cast<std::uint64_t>(models[p].indices)));
                }
                if (primitive.find("mode") != nullptr) primitive.set("mode", json_.number(4));
                JsonValue* attributes = primitive.find("attributes");
                if (attributes == nullptr) continue;
                for (auto& attribute : attributes->members) {
                    const auto found = models[p].attributes.find(plain_key(attribute.key));
                    if (found == models[p].attributes.end() || found->second < 0) continue;
                    attribute.value = json_.number(static_cast<std::uint64_t>(found->second));
                }
            }
        }
    }

    Result<void> read_sets() {
        SetSize all;
        for (const VertexSet& set : plan_.sets) {
            LR_ASSIGN(const auto size, size_of_set(file_, set));
            all.vertices += size.vertices * size.stride;
            all.triangles += size.triangles;
        }
        if (auto room = reading_.check_memory(1, all.vertices, all.triangles, file_bytes()); !room) return room;
        std::vector<VertexSet> kept;
        for (VertexSet& set : plan_.sets) {
            LR_ASSIGN(auto read, read_set(file_, set));
            const bool finite = has_finite_positions(read.mesh);
            if (!finite || !every_part_has_triangles(read)) {
                if (file_.draco.sources.contains(static_cast<int>(set.attributes[0].accessor))) {
                    return unsupported(
                        "a primitive compressed with Draco, of no triangles or of positions that are not finite");
                }
                std::size_t primitives = 0;
                for (const ScenePart& part : set.parts) primitives += part.primitives.size();
                report_.not_compressed[finite ? "no triangles but degenerate ones"
                                              : "triangles with positions that are not finite"] += primitives;
                continue;
            }
            report_.geometry_before += size_before(set);
            kept.push_back(std::move(set));
            meshes_.push_back(std::move(read));
        }
        plan_.sets = std::move(kept);
        return {};
    }

    static bool every_part_has_triangles(const SetMesh& set) {
        const std::vector<std::uint32_t>& indices = set.mesh.indices;
        for (std::size_t part = 0; part + 1 < set.first_triangle.size(); ++part) {
            bool any = false;
            for (std::size_t t = set.first_triangle[part]; t < set.first_triangle[part + 1] && !any; ++t) {
                const std::uint32_t a = indices[3 * t], b = indices[3 * t + 1], c = indices[3 * t + 2];
                any = a != b && b != c && c != a;
            }
            if (!any) return false;
        }
        return true;
    }

    std::uint64_t size_before(const VertexSet& set) {
        std::uint64_t bytes = 0;
        const auto add = [&](std::uint32_t accessor) {
            const auto view = view_accessor(file_, static_cast<int>(accessor));
            if (view) bytes += view->count * view->element_bytes();
        };
        for (const SceneAttribute& a : set.attributes) add(a.accessor);
        for (const ScenePart& part : set.parts) {
            if (part.indices) add(*part.indices);
        }
        return bytes;
    }

    void group_sets() {
        quantization_.emplace(plan_, meshes_, options_.bits);
        std::map<std::string, std::size_t> open;  // by kind: the group to which small sets are added
        for (std::uint32_t s = 0; s < plan_.sets.size(); ++s) {
            const std::size_t triangles = meshes_[s].mesh.triangle_count();
            const std::string kind = quantization_->kind_of(s) + (plan_.sets[s].keep_order ? "|order" : "");
            if (triangles >= kAlone) {
                groups_.push_back({{s}, triangles, plan_.sets[s].keep_order});
                continue;
            }
            auto [at, added] = open.try_emplace(kind, groups_.size());
            if (added || groups_[at->second].triangles + triangles > kTogether) {
                at->second = groups_.size();
                groups_.push_back({{}, 0, plan_.sets[s].keep_order});
            }
            groups_[at->second].sets.push_back(s);
            groups_[at->second].triangles += triangles;
        }
    }

    /// out[s][p]: the number of part p of set s. Parts are numbered by the order of their first primitives in the
    /// document.
    std::vector<std::vector<std::uint32_t>> number_parts(const Group& group) const {
        std::vector<std::vector<std::uint32_t>> out;
        std::map<std::pair<std::uint32_t, std::uint32_t>, std::pair<std::size_t, std::size_t>> places;
        for (const std::uint32_t s : group.sets) {
            const std::vector<ScenePart>& parts = plan_.sets[s].parts;
            for (std::size_t p = 0; p < parts.size(); ++p) {
                const PrimitivePlace at = parts[p].primitives.front();
                places[{at.mesh, at.primitive}] = {out.size(), p};
            }
            out.emplace_back(parts.size());
        }
        std::uint32_t number = 0;
        for (const auto& [at, part] : places) out[part.first][part.second] = number++;
        return out;
    }

    Result<void> encode(const Group& group) {
        std::vector<CodedSet> sets;
        std::vector<std::uint32_t> vertices;
        const std::vector<VertexOptions> options = quantization_->options_of(group.sets);
        const std::vector<std::vector<std::uint32_t>> part_numbers = number_parts(group);
        for (const std::uint32_t s : group.sets) {
            CodedSet& coded = sets.emplace_back();
            coded.set = std::move(meshes_[s]);
            coded.options = options;
            coded.part_numbers = part_numbers[sets.size() - 1];
            if (auto good = quantize(coded, report_.max_error); !good) return good;
            if (!group.keep_order) unused_ += drop_unused_vertices(coded.set.mesh);
            vertices.push_back(group.keep_order ? coded.set.mesh.vertex_count : UINT32_MAX);
        }
        carry_errors(sets);
        auto stream = encode_scene_stream(std::move(sets), group.keep_order, options_.form, options_.bits.threads);
        if (!stream) return stream.error();
        degenerate_ += stream->degenerate;
        // Counts, bounds and the fallback come from the decoded stream, so that they match what readers decode.
        StreamDecoder::Said said{{}, std::move(vertices)};
        for (const auto& numbers : part_numbers) said.set_of_part.resize(said.set_of_part.size() + numbers.size());
        for (std::size_t s = 0; s < group.sets.size(); ++s) {
            for (const std::uint32_t number : part_numbers[s]) said.set_of_part[number] = static_cast<std::uint32_t>(s);
        }
        LR_ASSIGN(auto decoder, StreamDecoder::open(stream->file, stream->parts, std::move(said)));
        LR_ASSIGN(const auto decoded, decode(decoder, group.sets.size()));
        return describe(group, part_numbers, std::move(*stream), decoded);
    }

    struct Decoded {
        struct Set {
            std::uint32_t vertices = 0;
            std::vector<Attribute> attributes;
        };
        std::vector<Set> sets;
        std::vector<std::vector<std::uint32_t>> parts;
    };

    static Result<Decoded> decode(StreamDecoder& decoder, std::size_t sets) {
        Decoded out;
        out.sets.resize(sets);
        for (std::size_t s = 0; s < sets; ++s) out.sets[s].vertices = decoder.vertices(s);
        for (std::size_t a = 0; a < decoder.attributes().size(); ++a) {
            const AttributeView& from = decoder.attributes()[a];
            std::vector<std::span<std::byte>> to;
            for (Decoded::Set& set : out.sets) {
                Attribute& made = set.attributes.emplace_back();
                made = {std::string(from.name), from.type, from.components, from.normalized, {}, from.v_up};
                made.data.resize(set.vertices * made.stride());
                to.emplace_back(made.data);
            }
            LR_TRY(decoder.decode_attribute(a, to));
        }
        std::vector<std::span<std::uint32_t>> to;
        out.parts.resize(decoder.parts());
        for (std::size_t p = 0; p < out.parts.size(); ++p) {
            out.parts[p].resize(decoder.corners(p));
            to.emplace_back(out.parts[p]);
        }
        decoder.decode_parts(to);
        return out;
    }

    /// Edits the accessors and primitives of the group's sets in the document.
    Result<void> describe(const Group& group, const std::vector<std::vector<std::uint32_t>>& part_numbers,
                          SceneStream stream, const Decoded& decoded) {
        const std::size_t number = streams_.size();
        JsonValue value = JsonText::object(), sets = JsonText::array();
        for (std::size_t s = 0; s < group.sets.size(); ++s) {
            const VertexSet& set = plan_.sets[group.sets[s]];
            JsonValue accessors = JsonText::array();
            for (std::size_t a = 0; a < set.attributes.size(); ++a) {
                const std::uint32_t accessor = set.attributes[a].accessor;
                accessors.members.push_back({{}, json_.number(accessor)});
                const Decoded::Set& from = decoded.sets[s];
                if (auto good = put_attribute(accessor, from.attributes[a], from.vertices); !good) return good;
            }
            sets.members.push_back({{}, std::move(accessors)});
            for (std::size_t p = 0; p < set.parts.size(); ++p) {
                const std::uint32_t part = part_numbers[s][p];
                put_part(set.parts[p], number, part, decoded.parts[part], decoded.sets[s].vertices);
            }
        }
        value.set("sets", std::move(sets));
        if (group.keep_order) value.set("ordered", json_.boolean(true));
        report_.geometry_after += stream.file.size() + stream.parts.size();
        streams_.push_back({std::move(value), std::move(stream.file), std::move(stream.parts)});
        return {};
    }

    JsonValue& accessor_at(std::uint64_t number) { return accessors_->members[static_cast<std::size_t>(number)].value; }

    Result<void> put_attribute(std::uint32_t number, const Attribute& attribute, std::uint32_t vertices) {
        JsonValue& accessor = accessor_at(number);
        strip_accessor(accessor);
        const AttributeView decoded{attribute.name, attribute.type, attribute.components, attribute.normalized,
                                    attribute.v_up, false,          attribute.data,       {}};
        describe_attribute(json_, accessor, decoded, vertices, decoded.name.starts_with("POSITION"));
        LR_ASSIGN(auto values, values_as(accessor, decoded));
        const std::size_t stride = values.size() / vertices;
        if (options_.fallback) fallback_.push_back({number, std::move(values), stride});
        return {};
    }

    void put_part(const ScenePart& part, std::size_t stream, std::uint32_t number,
                  const std::vector<std::uint32_t>& indices, std::uint32_t vertices) {
        const std::uint64_t accessor = part.indices.value_or(static_cast<std::uint32_t>(accessors_->size()));
        if (!part.indices) {
            JsonValue made = JsonText::object();
            made.set("componentType", json_.number(kGltfUnsignedByte));
            made.set("type", json_.string("SCALAR"));
            accessors_->members.push_back({{}, std::move(made)});
        }
        JsonValue& to = accessor_at(accessor);
        strip_accessor(to);
        describe_indices(json_, to, indices.size(), vertices);
        if (options_.fallback) {
            std::vector<std::byte> bytes(indices.size() * index_size(to));
            put_indices(to, indices, bytes);
            fallback_.push_back({accessor, std::move(bytes), 0});
        }
        for (const PrimitivePlace place : part.primitives) {
            JsonValue& primitive = meshes_json_[place.mesh].value.list("primitives")[place.primitive].value;
            remove_extension(primitive, "KHR_draco_mesh_compression");
            if (part.mode != 4) primitive.set("mode", json_.number(4));
            primitive.set("indices", json_.number(accessor));
            JsonValue extension = JsonText::object();
            extension.set("stream", json_.number(stream));
            extension.set("part", json_.number(number));
            set_extension(primitive, std::move(extension));
            ++report_.primitives;
        }
        if (part.mode != 4) strips_ += part.primitives.size();
        report_.triangles += indices.size() / 3;
    }

    Result<SceneFile> finish() {
        SceneViewWriter views(json_, file_, options_.fallback);
        LR_TRY(views.keep_others());
        JsonValue list = JsonText::array();
        for (Stream& stream : streams_) {
            stream.json.set("bufferView", json_.number(views.add_stream(stream.file)));
            if (!stream.parts.empty()) stream.json.set("parts", json_.number(views.add_stream(stream.parts)));
            list.members.push_back({{}, std::move(stream.json)});
        }
        for (const Plain& plain : fallback_) {
            accessor_at(plain.accessor).set("bufferView", json_.number(views.add_plain(plain.bytes, plain.stride)));
        }
        JsonValue extension = JsonText::object();
        extension.set("streams", std::move(list));
        set_extension(json_.root, std::move(extension));
        for (const char* name : {"EXT_meshopt_compression", "KHR_meshopt_compression", "KHR_draco_mesh_compression"}) {
            unlist_extension(json_.root, "extensionsUsed", name);
            unlist_extension(json_.root, "extensionsRequired", name);
        }
        list_extension(json_, "extensionsUsed");
        if (!options_.fallback) list_extension(json_, "extensionsRequired");
        tell();
        return views.finish(options_);
    }

    void tell() {
        const auto note = [&](std::size_t count, const char* text) {
            if (count > 0) report_.notes.push_back(fmt::format("{} {}", count, text));
        };
        note(degenerate_, "degenerate triangles dropped");
        note(unused_, "vertices that no triangle uses dropped");
        note(strips_, "strips and fans become lists of triangles");
    }

    struct Stream {
        JsonValue json;
        std::vector<std::byte> file, parts;
    };
    struct Plain {
        std::uint64_t accessor = 0;
        std::vector<std::byte> bytes;
        std::size_t stride = 0;
    };

    GltfFile& file_;
    const PackOptions& options_;
    Reading& reading_;
    PackReport& report_;
    JsonText json_;
    JsonValue* accessors_ = nullptr;            ///< "accessors" of the document
    std::span<JsonValue::Member> meshes_json_;  ///< "meshes" of the document
    ScenePlan plan_;
    std::vector<SetMesh> meshes_;
    std::optional<SceneQuantization> quantization_;
    std::vector<Group> groups_;
    std::vector<Stream> streams_;
    std::vector<Plain> fallback_;
    std::size_t degenerate_ = 0, unused_ = 0, strips_ = 0;
};

}  // namespace

Result<SceneFile> pack_scene(std::span<const std::byte> bytes, const std::filesystem::path& name,
                             const PackOptions& options, const ReadOptions& read, PackReport* report) {
    PackReport unwanted;
    PackReport& told = report != nullptr ? *report : unwanted;
    Reading reading{read, told.read, name};
    if (options.json == SceneJson::packed && (options.fallback || !options.bin_uri.empty())) {
        return Error{ErrorCode::invalid_argument, "a packed document needs a GLB without a fallback"};
    }
    return caught([&]() -> Result<SceneFile> {
        LR_ASSIGN(auto file, load_gltf(bytes, reading, GltfUse::everything));
        told.read.left_out.clear();  // load_gltf lists what a mesh would lack; packing keeps everything
        return Packer(file, options, reading, told).run();
    });
}

}  // namespace lacedring
