// Unpacks a packed scene to plain glTF.

#include <algorithm>
#include <cstring>
#include <iterator>
#include <set>

#include "lacedring/scene.hpp"
#include "lrcore/base/try.h"
#include "lrio/gltf/gltf_file.h"
#include "lrio/gltf/gltf_names.h"
#include "lrio/scene/packed_scene.h"
#include "lrio/scene/plain_scene.h"
#include "lrio/scene/scene_writer.h"
#include "lrio/scene/stream_decoder.h"
#include "lrio/scene/unpack_plan.h"

namespace lacedring {
namespace {

using namespace detail;

class Unpacker {
  public:
    Unpacker(PackedScene& scene, const Reading& reading, UnpackReport& report)
        : scene_(scene), reading_(reading), report_(report), accessors_(scene.json().root.list("accessors")) {}

    /// `images`: if false, the images' buffer views get no contents.
    Result<SceneFile> run(const std::string& bin_uri, bool images) {
        LR_ASSIGN(auto plan, plan_unpacking(scene_, images));
        report_.primitives = plan.primitives;
        positions_ = std::move(plan.positions);
        LR_TRY(keep_views(plan.kept));
        for (std::size_t i = 0; i < plan.streams.size(); ++i) {
            if (auto good = unpack(plan.streams[i]); !good) {
                return Error{good.error().code, fmt::format("stream {}: {}", i, good.error().message)};
            }
        }
        return finish(bin_uri);
    }

  private:
    JsonValue& root() { return scene_.json().root; }

    /// Copies the views that stay to the new buffer. The indices of the others become free for new views.
    Result<void> keep_views(const std::vector<bool>& keep) {
        auto views = root().list("bufferViews");
        const SceneViews source = scene_.views();
        free_.assign(views.size(), true);
        std::vector<JsonValue> kept(views.size());
        for (std::size_t i = 0; i < views.size(); ++i) {
            if (!keep[i]) continue;
            free_[i] = false;
            LR_ASSIGN(const auto contents, open_view(source, i));
            JsonValue view = views[i].value;
            remove_extension(view, kExtension);
            view.set("buffer", scene_.json().number(0));
            view.set("byteOffset", scene_.json().number(bin_.add(contents)));
            view.set("byteLength", scene_.json().number(contents.size()));
            kept[i] = std::move(view);
        }
        views_ = std::move(kept);
        return {};
    }

    /// The contents of a view. Checks the memory, since a small file can have many views of the same bytes.
    Result<std::vector<std::byte>> open_view(const SceneViews& source, std::uint64_t view) {
        LR_ASSIGN(const auto size, source.size(view));
        LR_TRY(take_memory(2 * static_cast<double>(size), 0));
        return source.contents(view);
    }

    std::uint64_t add_view(JsonValue view) {
        while (next_free_ < free_.size() && !free_[next_free_]) ++next_free_;
        if (next_free_ == free_.size()) {
            views_.push_back(std::move(view));
            free_.push_back(false);
            return next_free_++;
        }
        free_[next_free_] = false;
        views_[next_free_] = std::move(view);
        return next_free_;
    }

    Result<void> unpack(const StreamPlan& stream) {
        LR_ASSIGN(const auto file, open_view(scene_.views(), stream.view));
        std::vector<std::byte> parts;
        if (stream.parts_view) {
            LR_ASSIGN(auto contents, open_view(scene_.views(), *stream.parts_view));
            parts = std::move(contents);
        }
        report_.read.streams.push_back(file.size() + parts.size());
        StreamDecoder::Said said;
        for (const StreamPlan::Part& part : stream.parts) said.set_of_part.push_back(part.set);
        for (const auto& set : stream.sets) {
            if (set.empty()) return malformed("a set without accessors");
            const JsonValue& first = accessors_[set[0]].value;
            const std::uint64_t count = first.integer("count").value_or(UINT32_MAX);
            if (first.find("count") != nullptr && count >= UINT32_MAX) return malformed("accessor {}: count", set[0]);
            said.vertices.push_back(static_cast<std::uint32_t>(count));
        }
        const auto check = [&](const LrFileView& contents) { return check_stream(stream, contents); };
        LR_ASSIGN(auto decoder, StreamDecoder::open(file, parts, std::move(said), check));
        return decode(stream, decoder);
    }

    /// Before decoding, checks that each set has an accessor for each attribute, and that the memory suffices: a few
    /// bytes may encode many equal vertices.
    Result<void> check_stream(const StreamPlan& stream, const LrFileView& contents) {
        std::size_t stride = 0;
        for (const AttributeView& a : contents.attributes) stride += size_of(a.type) * a.components;
        for (const auto& set : stream.sets) {
            if (set.size() == contents.attributes.size()) continue;
            return malformed("{} accessors for {} attributes", set.size(), contents.attributes.size());
        }
        if (stream.ordered != (!contents.vertex_order.empty() && !contents.corner_order.empty())) {
            return malformed("ordered is {}, and the file's order is {}kept", stream.ordered,
                             stream.ordered ? "not " : "");
        }
        const double vertices = std::max(contents.vertex_count, contents.copy_count);
        return take_memory(vertices * static_cast<double>(stride), contents.input_triangles);
    }

    /// Where an accessor's decoded values are stored.
    struct Target {
        std::size_t size = 0;  ///< bytes of the decoded values
        bool apart = false;    ///< in apart_, because the values must be converted or padded; else in bin_
        std::size_t at = 0;    ///< offset in bin_ or apart_
    };

    std::span<std::byte> bytes_of(const Target& target) {
        return target.apart ? std::span(apart_).subspan(target.at, target.size) : bin_.bytes(target.at, target.size);
    }

    Result<void> decode(const StreamPlan& stream, StreamDecoder& decoder) {
        std::vector<std::vector<Target>> sets(stream.sets.size());
        std::vector<Target> parts(stream.parts.size());
        for (std::size_t s = 0; s < sets.size(); ++s) {
            if (auto good = plan_set(stream.sets[s], decoder, s, sets[s]); !good) return good;
        }
        for (std::size_t p = 0; p < parts.size(); ++p) {
            if (auto good = plan_part(stream.parts[p], decoder, p, parts[p]); !good) return good;
        }
        place(sets, parts);
        for (std::size_t a = 0; a < decoder.attributes().size(); ++a) {
            std::vector<std::span<std::byte>> to;
            to.reserve(sets.size());
            for (auto& set : sets) to.push_back(bytes_of(set[a]));
            if (auto good = decoder.decode_attribute(a, to); !good) return good;
        }
        std::vector<std::span<std::uint32_t>> to;
        to.reserve(parts.size());
        for (Target& part : parts) {
            to.emplace_back(reinterpret_cast<std::uint32_t*>(bytes_of(part).data()), part.size / sizeof(std::uint32_t));
        }
        decoder.decode_parts(to);
        for (std::size_t s = 0; s < sets.size(); ++s) {
            if (auto good = put_set(stream.sets[s], decoder, s, sets[s]); !good) return good;
        }
        for (std::size_t p = 0; p < parts.size(); ++p) {
            JsonValue& accessor = accessors_[*stream.parts[p].indices].value;
            std::size_t at = parts[p].at, size = parts[p].size;
            if (parts[p].apart) {
                size = to[p].size() * index_size(accessor);
                at = bin_.add_zeros(size);
                if (!put_indices(accessor, to[p], bin_.bytes(at, size))) {
                    return malformed("part {}: its accessor does not hold its indices", p);
                }
            }
            accessor.set("bufferView", scene_.json().number(add_view(describe_view(scene_.json(), at, size, 0))));
            report_.triangles += decoder.corners(p) / 3;
        }
        return {};
    }

    Result<void> plan_set(const std::vector<std::uint32_t>& numbers, const StreamDecoder& decoder, std::size_t set,
                          std::vector<Target>& targets) {
        const std::uint32_t vertices = decoder.vertices(set);
        for (std::size_t a = 0; a < numbers.size(); ++a) {
            const AttributeView& attribute = decoder.attributes()[a];
            JsonValue& accessor = accessors_[numbers[a]].value;
            if (accessor.find("count") != nullptr && accessor.integer("count") != vertices) {
                return malformed("accessor {}: its set has {} vertices", numbers[a], vertices);
            }
            const auto same = has_type_of(accessor, attribute);
            if (!same) return in_accessor(numbers[a], same.error());
            const std::size_t stride = size_of(attribute.type) * attribute.components;
            Target& target = targets.emplace_back();
            target.size = vertices * stride;
            target.apart = !*same || stride % 4 != 0;
        }
        return {};
    }

    Result<void> plan_part(const StreamPlan::Part& part, const StreamDecoder& decoder, std::size_t number,
                           Target& target) {
        JsonValue& accessor = accessors_[*part.indices].value;
        const std::size_t corners = decoder.corners(number);
        if (accessor.find("count") != nullptr && accessor.integer("count") != corners) {
            return malformed("part {} has {} indices, its accessor another count", number, corners);
        }
        if (!is_index_list(accessor)) return malformed("part {}: its accessor is not of indices", number);
        strip_accessor(accessor);
        accessor.remove("min");
        accessor.remove("max");
        accessor.set("count", scene_.json().number(corners));
        target.size = corners * sizeof(std::uint32_t);
        target.apart = index_size(accessor) != sizeof(std::uint32_t);
        return {};
    }

    /// Places all targets before decoding, since adding bytes to bin_ may move decoded values.
    void place(std::vector<std::vector<Target>>& sets, std::vector<Target>& parts) {
        std::size_t all = 0, apart = 0;
        const auto visit = [&](const auto& use) {
            for (auto& set : sets) std::ranges::for_each(set, use);
            std::ranges::for_each(parts, use);
        };
        visit([&](const Target& target) { all += target.size; });
        bin_.expect(all);
        visit([&](Target& target) {
            target.at = target.apart ? apart : bin_.add_zeros(target.size);
            if (target.apart) apart += (target.size + 3) / 4 * 4;
        });
        if (apart > apart_.size()) apart_.resize(apart);
    }

    static Error in_accessor(std::uint32_t number, const Error& error) {
        return {error.code, fmt::format("accessor {}: {}", number, error.message)};
    }

    Result<void> put_set(const std::vector<std::uint32_t>& numbers, const StreamDecoder& decoder, std::size_t set,
                         std::vector<Target>& targets) {
        const std::uint32_t vertices = decoder.vertices(set);
        for (std::size_t a = 0; a < numbers.size(); ++a) {
            JsonValue& accessor = accessors_[numbers[a]].value;
            AttributeView attribute = decoder.attributes()[a];
            attribute.data = bytes_of(targets[a]);
            strip_accessor(accessor);
            describe_attribute(scene_.json(), accessor, attribute, vertices, positions_.contains(numbers[a]));
            JsonValue view;
            if (!targets[a].apart) {
                view = describe_view(scene_.json(), targets[a].at, targets[a].size,
                                     size_of(attribute.type) * attribute.components);
            } else {
                const auto values = values_as(accessor, attribute);
                if (!values) return in_accessor(numbers[a], values.error());
                view = put_rows(scene_.json(), bin_, *values, vertices == 0 ? 4 : values->size() / vertices);
            }
            accessor.set("bufferView", scene_.json().number(add_view(std::move(view))));
        }
        return {};
    }

    /// Checks the memory of all views and streams so far.
    Result<void> take_memory(double bytes, double triangles) {
        taken_bytes_ += bytes;
        taken_triangles_ += triangles;
        return reading_.check_memory(1, taken_bytes_, taken_triangles_, scene_.bytes());
    }

    Result<SceneFile> finish(const std::string& bin_uri) {
        JsonText& json = scene_.json();
        for (auto& mesh : root().list("meshes")) {
            for (auto& primitive : mesh.value.list("primitives")) remove_extension(primitive.value, kExtension);
        }
        remove_extension(root(), kExtension);
        unlist_extension(root(), "extensionsUsed", kExtension);
        unlist_extension(root(), "extensionsRequired", kExtension);
        JsonValue list = JsonText::array();
        if (!views_.empty() && bin_.size() < 4) bin_.add(std::vector<std::byte>(4));  // views need a buffer
        for (std::size_t i = 0; i < views_.size(); ++i) {
            if (free_[i]) {  // an unused index gets a dummy view, so that other views keep their indices
                JsonValue view = JsonText::object();
                view.set("buffer", json.number(0));
                view.set("byteLength", json.number(4));
                views_[i] = std::move(view);
            }
            list.members.push_back({{}, std::move(views_[i])});
        }
        if (!list.members.empty()) root().set("bufferViews", std::move(list));
        SceneFile out;
        out.bin = bin_.take();
        describe_buffers(json, out.bin.size(), bin_uri);
        out.json = text_of(root());
        return out;
    }

    PackedScene& scene_;
    const Reading& reading_;
    UnpackReport& report_;
    std::span<JsonValue::Member> accessors_;
    std::set<std::uint32_t> positions_;  ///< UnpackPlan's
    std::vector<JsonValue> views_;
    std::vector<bool> free_;  ///< marks view indices that are not used yet
    std::size_t next_free_ = 0;
    BinChunk bin_;
    std::vector<std::byte> apart_;
    double taken_bytes_ = 0, taken_triangles_ = 0;
};

}  // namespace

Result<SceneFile> unpack_scene(std::span<const std::byte> bytes, const std::filesystem::path& name,
                               const std::string& bin_uri, const ReadOptions& read, UnpackReport* report) {
    UnpackReport unwanted;
    UnpackReport& told = report != nullptr ? *report : unwanted;
    Reading reading{read, told.read, name};
    return caught([&]() -> Result<SceneFile> {
        LR_ASSIGN(auto scene, PackedScene::load(bytes, reading));
        return Unpacker(scene, reading, told).run(bin_uri, true);
    });
}

namespace detail {

Result<PlainScene> PlainScene::open(std::span<const std::byte> bytes, Reading& reading) {
    PlainScene out;
    out.bytes_ = bytes;
    out.file_bytes = bytes.size();
    if (!is_packed_scene(bytes)) return out;
    ReadOptions options = reading.options;
    options.triangle_bytes = 0;  // the caller needs them only after the unpacked scene is freed
    UnpackReport report;
    Reading unpacking{options, report.read, reading.name};
    auto scene = PackedScene::load(bytes, unpacking);
    Result<SceneFile> plain =
        scene ? Unpacker(*scene, unpacking, report).run("", reading.materials != nullptr) : scene.error();
    std::ranges::move(report.read.files, std::back_inserter(reading.report.files));
    if (!plain) return plain.error();
    reading.report.streams = std::move(report.read.streams);
    out.file_bytes = static_cast<std::size_t>(scene->bytes());
    out.unpacked_ = std::move(*plain);
    return out;
}

Result<GltfChunks> PlainScene::chunks() const {
    if (!unpacked_) return split_gltf(bytes_);
    return GltfChunks{unpacked_->json, std::span<const std::byte>(unpacked_->bin)};
}

}  // namespace detail

bool is_packed_scene(std::span<const std::byte> bytes) {
    const auto chunks = split_gltf(bytes);
    if (!chunks || chunks->json.find(kExtension) == std::string_view::npos || !check_json(chunks->json)) return false;
    return extension_of(JsonText(chunks->json).root) != nullptr;
}

Result<std::vector<std::byte>> make_glb_head(const SceneFile& scene) {
    return detail::make_glb_head(scene.json, scene.bin.size());
}

Result<std::vector<std::byte>> make_glb_file(const SceneFile& scene) {
    Result<std::vector<std::byte>> head = lacedring::make_glb_head(scene);
    if (!head) return head;
    std::vector<std::byte> out(head->size() + (scene.bin.size() + 3) / 4 * 4);
    std::memcpy(out.data(), head->data(), head->size());
    if (!scene.bin.empty()) std::memcpy(out.data() + head->size(), scene.bin.data(), scene.bin.size());
    return out;
}

}  // namespace lacedring
