#include "lrio/scene/unpack_plan.h"

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <utility>

#include "lrcore/base/try.h"
#include "lrio/gltf/gltf_file.h"
#include "lrio/scene/scene_plan.h"
#include "lrio/scene/scene_writer.h"

namespace lacedring::detail {
namespace {

class UnpackPlanner {
  public:
    UnpackPlanner(PackedScene& scene, bool images)
        : scene_(scene), images_(images), root_(scene.json().root), accessors_(root_.list("accessors")) {}

    Result<UnpackPlan> run() {
        if (extension_of(root_) != nullptr) {
            LR_TRY(check_extensions());
        }
        LR_TRY(check_buffers());
        LR_TRY(plan());
        LR_TRY(choose_views());
        return std::move(out_);
    }

  private:
    Result<std::uint32_t> accessor_number(const JsonValue* value) {
        const auto number = value == nullptr ? std::nullopt : value->integer();
        if (!number || *number >= accessors_.size()) return malformed("an accessor that does not exist");
        const JsonValue& accessor = accessors_[static_cast<std::size_t>(*number)].value;
        if (!accessor.is_object() || (!scene_.is_document_packed() && !accessor.integer("count"))) {
            return malformed("accessor {}: no count", *number);
        }
        return static_cast<std::uint32_t>(*number);
    }

    Result<void> take_once(std::uint32_t accessor, std::uint32_t stream, std::uint32_t set) {
        if (!set_of_.try_emplace(accessor, stream, set).second)
            return malformed("accessor {} has two values", accessor);
        return {};
    }

    Result<void> plan() {
        const JsonValue* extension = extension_of(root_);
        if (extension != nullptr) {
            std::set<std::uint64_t> views;
            for (const auto& member : extension->list("streams")) {
                if (auto good = plan_stream(member.value, views); !good) {
                    return Error{good.error().code, fmt::format("glTF: {}: stream {}: {}", kExtension,
                                                                out_.streams.size(), good.error().message)};
                }
            }
        }
        std::uint32_t mesh = 0;
        for (auto& member : root_.list("meshes")) parts_left_ += member.value.list("primitives").size();
        for (auto& member : root_.list("meshes")) {
            std::uint32_t number = 0;
            for (auto& primitive : member.value.list("primitives")) {
                if (auto good = plan_primitive(primitive.value); !good) {
                    return Error{good.error().code,
                                 fmt::format("glTF: mesh {}: primitive {}: {}", mesh, number, good.error().message)};
                }
                ++number;
            }
            ++mesh;
        }
        for (std::size_t i = 0; i < out_.streams.size(); ++i) {
            const auto& parts = out_.streams[i].parts;
            if (parts.empty() ||
                std::any_of(parts.begin(), parts.end(), [](const auto& p) { return p.set == UINT32_MAX; })) {
                return malformed("glTF: {}: stream {}: parts without a primitive", kExtension, i);
            }
        }
        return {};
    }

    Result<void> plan_stream(const JsonValue& value, std::set<std::uint64_t>& views) {
        StreamPlan stream;
        const auto view = value.integer("bufferView");
        if (!view || !views.insert(*view).second) return malformed("no buffer view of its own");
        stream.view = *view;
        if (value.find("parts") != nullptr) {
            stream.parts_view = value.integer("parts");
            if (!stream.parts_view || !views.insert(*stream.parts_view).second) {
                return malformed("no buffer view of its own for parts");
            }
        }
        for (const auto& set : value.list("sets")) {
            std::vector<std::uint32_t>& to = stream.sets.emplace_back();
            for (const auto& number : set.value.members) {
                LR_ASSIGN(const auto accessor, accessor_number(&number.value));
                const auto at = static_cast<std::uint32_t>(stream.sets.size() - 1);
                if (auto good = take_once(accessor, static_cast<std::uint32_t>(out_.streams.size()), at); !good)
                    return good;
                to.push_back(accessor);
            }
        }
        if (stream.sets.empty()) return malformed("no sets");
        if (const JsonValue* ordered = value.find("ordered")) {
            stream.ordered = ordered->text == "true";
            if (!stream.ordered && ordered->text != "false") return malformed("ordered is neither true nor false");
        }
        out_.streams.push_back(std::move(stream));
        return {};
    }

    /// The stream and set of a primitive's attributes. None: the primitive is not compressed. Errors: malformed (its
    /// attributes are not of one set).
    Result<std::optional<std::pair<std::uint32_t, std::uint32_t>>> set_of(const JsonValue& primitive) {
        std::optional<std::pair<std::uint32_t, std::uint32_t>> out;
        bool first = true;
        const auto visit = [&](const std::string& name, std::uint32_t accessor) -> Result<void> {
            const auto found = set_of_.find(accessor);
            const bool has = found != set_of_.end() && found->second.first != UINT32_MAX;
            if (!first && (has != out.has_value() || (has && *out != found->second))) {
                return malformed("{}: not of one set with the attributes before", shown(name));
            }
            if (has) out = found->second;
            if (has && (name == "POSITION" || name.starts_with("POSITION@"))) out_.positions.insert(accessor);
            first = false;
            return {};
        };
        LR_TRY(visit_attributes(primitive, visit));
        return out;
    }

    Result<void> plan_primitive(const JsonValue& primitive) {
        const JsonValue* extension = extension_of(primitive);
        const bool triangles = primitive.integer("mode").value_or(4) == 4;
        // Points and lines may use the vertices of a set, and other attributes.
        if (extension == nullptr && (!scene_.is_document_packed() || !triangles)) return {};
        const auto set = set_of(primitive);
        if (!set) return set.error();
        if (!*set) return extension == nullptr ? Result<void>() : malformed("its attributes have no stream");
        const auto [number, of_stream] = **set;
        StreamPlan& stream = out_.streams[number];
        if (!triangles) return malformed("parts are triangles");
        const auto indices = accessor_number(primitive.find("indices"));
        if (!indices) return indices.error();
        std::optional<std::uint64_t> part;
        if (extension != nullptr) {
            if (extension->integer("stream") != number) return malformed("its attributes are of stream {}", number);
            part = extension->integer("part");
        } else {  // parts are numbered in the document's order
            part = part_of_.try_emplace({number, *indices}, stream.parts.size()).first->second;
        }
        if (!part) return malformed("no part");
        if (*part >= stream.parts.size()) {
            const std::uint64_t skipped = *part - stream.parts.size();
            if (skipped >= parts_left_) return malformed("part {}, of fewer primitives", *part);
            parts_left_ -= skipped + 1;
            stream.parts.resize(static_cast<std::size_t>(*part) + 1);
        }
        StreamPlan::Part& at = stream.parts[static_cast<std::size_t>(*part)];
        if (at.set == UINT32_MAX) {
            at = {of_stream, *indices};
            if (auto good = take_once(*indices, UINT32_MAX, 0); !good) return good;
        } else if (at.set != of_stream || at.indices != *indices) {
            return malformed("another set or other indices than part {} has elsewhere", *part);
        }
        ++out_.primitives;
        return {};
    }

    /// Refuses files that also use other compression extensions, since these refer to buffer views themselves.
    Result<void> check_extensions() {
        for (const auto& member : std::as_const(root_).list("extensionsUsed")) {
            const std::string name = member.value.is_string() ? plain_string(member.value) : "";
            for (const char* other :
                 {"EXT_meshopt_compression", "KHR_meshopt_compression", "KHR_draco_mesh_compression"}) {
                if (name == other) return malformed("glTF: {} beside {}", other, kExtension);
            }
        }
        return {};
    }

    /// Checks that placeholder buffers have no bytes and that their views are in range.
    Result<void> check_buffers() {
        const auto buffers = std::as_const(root_).list("buffers");
        std::vector<std::optional<std::uint64_t>> room(buffers.size());
        for (std::size_t i = 0; i < buffers.size(); ++i) {
            const JsonValue* extension = extension_of(buffers[i].value);
            if (extension == nullptr) continue;
            const JsonValue* placeholder = extension->find("placeholder");
            if (placeholder == nullptr || placeholder->text != "true" || buffers[i].value.find("uri") != nullptr ||
                (i == 0 && scene_.has_bin_chunk())) {
                return malformed("glTF: buffer {}: {}: no placeholder, or one with bytes", i, kExtension);
            }
            room[i] = buffers[i].value.integer("byteLength").value_or(0);
        }
        const auto views = std::as_const(root_).list("bufferViews");
        for (std::size_t i = 0; i < views.size(); ++i) {
            const auto buffer = views[i].value.integer("buffer");
            if (!buffer || *buffer >= room.size() || !room[static_cast<std::size_t>(*buffer)]) continue;
            const std::uint64_t all = *room[static_cast<std::size_t>(*buffer)],
                                offset = views[i].value.integer("byteOffset").value_or(0),
                                length = views[i].value.integer("byteLength").value_or(UINT64_MAX);
            if (offset <= all && length <= all - offset) continue;
            return malformed("glTF: buffer view {} is not in the placeholder, buffer {}", i, *buffer);
        }
        return {};
    }

    /// Does the document use extensions that may refer to views by index?
    bool has_unknown_extensions() const {
        const JsonValue* used = std::as_const(root_).find("extensionsUsed");
        if (used == nullptr || !used->is_array()) return false;
        nlohmann::json names = nlohmann::json::parse(text_of(*used), nullptr, false);
        for (auto& name : names) {
            if (name == kExtension) name = nullptr;
        }
        return detail::has_unknown_extensions({{"extensionsUsed", std::move(names)}});
    }

    /// Drops the views of streams, placeholders and the fallback. Keeps unused views only if unknown extensions may
    /// refer to them.
    Result<void> choose_views() {
        const std::size_t count = root_.list("bufferViews").size();
        const SceneViews source = scene_.views();
        std::vector<bool> hollow(count, false);  // views of streams and placeholders: references to them are errors
        for (const StreamPlan& stream : out_.streams) {
            for (const std::uint64_t view : {stream.view, stream.parts_view.value_or(stream.view)}) {
                if (view >= count) return malformed("buffer view {} does not exist", view);
                if (source.is_coded(view)) return malformed("buffer view {}: a stream that is coded", view);
                hollow[static_cast<std::size_t>(view)] = true;
            }
        }
        for (std::size_t i = 0; i < count; ++i) {
            if (source.is_placeholder(i)) hollow[i] = true;
        }
        std::vector<bool> fallback(count, false);
        const auto use = [&](const JsonValue* value, const char* list, std::size_t number,
                             std::vector<bool>& users) -> Result<void> {
            const auto view = value == nullptr ? std::nullopt : value->integer("bufferView");
            if (!view || *view >= count) return {};
            if (hollow[static_cast<std::size_t>(*view)]) {
                return malformed("glTF: {} {}: buffer view {} is a stream's, or has no contents", list, number, *view);
            }
            users[static_cast<std::size_t>(*view)] = true;
            return {};
        };
        out_.kept.assign(count, false);
        for (std::size_t i = 0; i < accessors_.size(); ++i) {
            const bool has_stream = set_of_.contains(static_cast<std::uint32_t>(i));
            const JsonValue& accessor = accessors_[i].value;
            if (auto good = use(&accessor, "accessor", i, has_stream ? fallback : out_.kept); !good) return good;
            const JsonValue* sparse = has_stream ? nullptr : accessor.find("sparse");
            if (sparse == nullptr) continue;
            for (const char* name : {"indices", "values"}) {
                if (auto good = use(sparse->find(name), "accessor", i, out_.kept); !good) return good;
            }
        }
        std::vector<bool> of_images(count, false);
        std::size_t number = 0;
        for (const auto& image : std::as_const(root_).list("images")) {
            if (auto good = use(&image.value, "image", number++, of_images); !good) return good;
        }
        const bool all = extension_of(root_) == nullptr || has_unknown_extensions();
        for (std::size_t i = 0; i < count; ++i) {
            if (of_images[i] ? images_ : all && !hollow[i] && !fallback[i]) out_.kept[i] = true;
        }
        return {};
    }

    PackedScene& scene_;
    bool images_;
    JsonValue& root_;
    std::span<const JsonValue::Member> accessors_;
    UnpackPlan out_;
    /// Stream and set of each accessor; stream UINT32_MAX: the accessor has the indices of a part.
    std::map<std::uint32_t, std::pair<std::uint32_t, std::uint32_t>> set_of_;
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint64_t> part_of_;  ///< by stream and indices accessor
    std::uint64_t parts_left_ = 0;  ///< number of further parts that all streams together may have
};

}  // namespace

Result<UnpackPlan> plan_unpacking(PackedScene& scene, bool images) {
    return UnpackPlanner(scene, images).run();
}

}  // namespace lacedring::detail
