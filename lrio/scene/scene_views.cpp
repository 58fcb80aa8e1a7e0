#include "lrio/scene/scene_views.h"

#include <algorithm>
#include <optional>
#include <set>

#include "lrcore/base/try.h"
#include "lrio/gltf/gltf_accessor.h"
#include "lrio/gltf/gltf_view.h"
#include "lrio/gltf/tinygltf.h"
#include "lrio/scene/deflate.h"
#include "lrio/scene/float_coding.h"
#include "lrio/scene/packed_scene.h"

namespace lacedring::detail {

/// The references to a view.
struct SceneViewWriter::Use {
    bool used = false;
    bool image = false;        ///< used by an image
    std::uint32_t width = 0;   ///< floats in a row of an accessor, if tightly packed; 0: other values
    bool mixed = false;        ///< accessors have different widths
    bool quaternions = false;  ///< used by an accessor of rotations
    std::vector<std::pair<std::uint64_t, std::uint64_t>> ranges;  ///< begin and end of the bytes that accessors read
};

namespace {

/// A coding must save at least this number of bytes, since its description makes the document longer.
constexpr std::size_t kWorthCoding = 64;

std::set<std::uint64_t> rotations_of(const JsonValue& root) {
    std::set<std::uint64_t> out;  // accessors
    for (const auto& animation : root.list("animations")) {
        const auto samplers = animation.value.list("samplers");
        for (const auto& channel : animation.value.list("channels")) {
            const JsonValue* target = channel.value.find("target");
            const JsonValue* path = target == nullptr ? nullptr : target->find("path");
            const auto sampler = channel.value.integer("sampler");
            if (path == nullptr || plain_string(*path) != "rotation" || !sampler || *sampler >= samplers.size())
                continue;
            if (const auto output = samplers[static_cast<std::size_t>(*sampler)].value.integer("output")) {
                out.insert(*output);
            }
        }
    }
    return out;
}

/// Marks the source's views that accessors use.
std::vector<bool> views_of_accessors(const GltfFile& file) {
    std::vector<bool> out(file.model.bufferViews.size(), false);
    for (const tinygltf::Accessor& accessor : file.model.accessors) {
        const int view = accessor.bufferView;
        if (view >= 0 && static_cast<std::size_t>(view) < out.size()) out[static_cast<std::size_t>(view)] = true;
    }
    return out;
}

/// Bytes of an accessor's element; 0: its columns are padded or its type is unknown. `floats`: number of floats of an
/// element; 0: it has other values.
std::size_t element_bytes(const tinygltf::Accessor& accessor, std::uint32_t& floats) {
    ComponentType type = ComponentType::f32;
    const int components = tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(accessor.type));
    floats = 0;
    if (components < 1 || !to_component_type(accessor.componentType, type) || is_padded_matrix(accessor)) return 0;
    if (type == ComponentType::f32) floats = static_cast<std::uint32_t>(components);
    return size_of(type) * static_cast<std::size_t>(components);
}

}  // namespace

std::vector<SceneViewWriter::Use> SceneViewWriter::find_uses() {
    const JsonValue& root = json_.root;
    const auto views = root.list("bufferViews");
    std::vector<Use> uses(views.size());
    const auto use_of = [&](const JsonValue& value) -> Use* {
        const auto number = value.integer("bufferView");
        if (!number || *number >= uses.size()) return nullptr;
        Use& use = uses[static_cast<std::size_t>(*number)];
        use.used = true;
        return &use;
    };
    const auto read = [&](Use* use, std::uint64_t offset, std::uint64_t size, std::uint32_t floats) {
        if (use == nullptr) return;
        use->ranges.emplace_back(offset, offset + size);
        if (use->ranges.size() > 1 && use->width != floats) use->mixed = true;
        use->width = floats;
    };
    const std::set<std::uint64_t> rotations = rotations_of(root);
    std::uint64_t number = 0;
    for (const auto& member : root.list("accessors")) {
        const JsonValue& accessor = member.value;
        const std::uint64_t count = accessor.integer("count").value_or(0);
        std::uint32_t floats = 0;
        const std::size_t known = file_.model.accessors.size();  // accessors added by packing have no views
        const std::size_t bytes = number < known ? element_bytes(file_.model.accessors[number], floats) : 0;
        if (accessor.find("bufferView") != nullptr) {
            Use* use = use_of(accessor);
            if (use != nullptr && bytes == 0) {
                read(use, 0, UINT64_MAX, 0);
            } else if (use != nullptr) {
                const JsonValue& view = views[static_cast<std::size_t>(*accessor.integer("bufferView"))].value;
                const std::uint64_t stride = view.integer("byteStride").value_or(bytes);
                read(use, accessor.integer("byteOffset").value_or(0), count == 0 ? 0 : (count - 1) * stride + bytes,
                     stride == bytes ? floats : 0);
                use->quaternions = use->quaternions || (floats == 4 && rotations.contains(number));
            }
        }
        if (const JsonValue* sparse = accessor.find("sparse")) {
            const std::uint64_t replaced = sparse->integer("count").value_or(0);
            if (const JsonValue* indices = sparse->find("indices")) {
                read(use_of(*indices), indices->integer("byteOffset").value_or(0), 4 * replaced, 0);
            }
            if (const JsonValue* values = sparse->find("values")) {
                read(use_of(*values), values->integer("byteOffset").value_or(0), bytes * replaced, floats);
            }
        }
        ++number;
    }
    for (const auto& image : root.list("images")) {
        if (Use* use = use_of(image.value)) use->image = true;
    }
    return uses;
}

Result<void> SceneViewWriter::keep_others() {
    std::vector<Use> uses = find_uses();
    const bool known = !has_unknown_extensions(file_.document);
    const std::vector<bool> of_accessors = views_of_accessors(file_);
    auto views = json_.root.list("bufferViews");
    std::vector<std::optional<std::uint64_t>> number(views.size());
    for (std::size_t i = 0; i < views.size(); ++i) {
        Use& use = uses[i];
        if (!use.used && known) continue;
        number[i] = views_.size();
        // Only streams replace its contents: keeps an empty view, since an extension may refer to later ones by index.
        if (!use.used && i < of_accessors.size() && of_accessors[i]) {
            JsonValue view = JsonText::object();
            view.set("buffer", json_.number(plain_ ? 0 : 1));
            if (plain_) view.set("byteOffset", json_.number(bin_.add(std::vector<std::byte>(4))));
            view.set("byteLength", json_.number(4));
            placeholder_ = std::max<std::size_t>(placeholder_, plain_ ? 0 : 4);
            views_.members.push_back({{}, std::move(view)});
            continue;
        }
        const auto bytes = open_view(file_, i);
        if (!bytes) return bytes.error();
        // A small file can have many views of the same bytes.
        if (auto room = file_.take_memory(2 * static_cast<double>(bytes->size())); !room) return room;
        std::vector<std::byte> contents(bytes->begin(), bytes->end());
        if (use.image) image_bytes_ += contents.size();
        if (known && !use.image) {
            // Clears the bytes that no accessor reads any more: streams have their values.
            std::sort(use.ranges.begin(), use.ranges.end());
            std::uint64_t end = 0;
            const auto clear = [&](std::uint64_t to) {
                for (std::uint64_t at = end; at < std::min<std::uint64_t>(to, contents.size()); ++at) {
                    contents[static_cast<std::size_t>(at)] = std::byte{0};
                }
            };
            for (const auto& [from, to] : use.ranges) {
                clear(from);
                end = std::max(end, to);
            }
            clear(contents.size());
        }
        views_.members.push_back({{}, coded_view(views[i].value, contents, use)});
    }
    const auto renumber = [&](JsonValue& value) {
        const auto old = value.integer("bufferView");
        if (old && *old < number.size() && number[static_cast<std::size_t>(*old)]) {
            value.set("bufferView", json_.number(*number[static_cast<std::size_t>(*old)]));
        }
    };
    for (auto& accessor : json_.root.list("accessors")) {
        renumber(accessor.value);
        JsonValue* sparse = accessor.value.find("sparse");
        if (sparse == nullptr) continue;
        for (const char* name : {"indices", "values"}) {
            if (JsonValue* part = sparse->find(name)) renumber(*part);
        }
    }
    for (auto& image : json_.root.list("images")) renumber(image.value);
    return {};
}

JsonValue SceneViewWriter::coded_view(const JsonValue& view, std::span<const std::byte> bytes, const Use& use) {
    JsonValue out = view;
    remove_extension(out, "EXT_meshopt_compression");
    remove_extension(out, "KHR_meshopt_compression");
    std::vector<std::byte> best;
    std::string_view coding;
    const auto attempt = [&](Result<std::vector<std::byte>> coded, std::string_view name) {
        if (!coded || coded->size() + kWorthCoding > bytes.size() || (!best.empty() && coded->size() >= best.size()))
            return;
        best = std::move(*coded);
        coding = name;
    };
    if (!plain_ && !use.image) {
        attempt(deflate_bytes(bytes), "deflate");
        if (use.width > 0 && use.width <= 16 && !use.mixed && bytes.size() % (4 * use.width) == 0) {
            attempt(encode_floats(bytes, use.width, false), "floats");
            if (use.quaternions) attempt(encode_floats(bytes, use.width, true), "floats");
        }
    }
    out.set("byteLength", json_.number(bytes.size()));
    if (best.empty()) {
        out.set("buffer", json_.number(0));
        out.set("byteOffset", json_.number(bin_.add(bytes)));
        return out;
    }
    out.set("buffer", json_.number(1));
    placeholder_ = (placeholder_ + 3) / 4 * 4;
    out.set("byteOffset", json_.number(placeholder_));
    placeholder_ += bytes.size();
    JsonValue extension = JsonText::object();
    extension.set("buffer", json_.number(0));
    extension.set("byteOffset", json_.number(bin_.add(best)));
    extension.set("byteLength", json_.number(best.size()));
    extension.set("coding", json_.string(coding));
    set_extension(out, std::move(extension));
    return out;
}

std::uint64_t SceneViewWriter::add_stream(std::span<const std::byte> bytes) {
    JsonValue view = JsonText::object();
    view.set("buffer", json_.number(0));
    view.set("byteOffset", json_.number(bin_.add(bytes, 8)));  // .lr files are read in place at multiples of 8
    view.set("byteLength", json_.number(bytes.size()));
    views_.members.push_back({{}, std::move(view)});
    return views_.size() - 1;
}

std::uint64_t SceneViewWriter::add_plain(std::span<const std::byte> bytes, std::size_t stride) {
    plain_views_.push_back(views_.size());
    views_.members.push_back({{}, put_rows(json_, fallback_, bytes, stride)});
    return views_.size() - 1;
}

Result<SceneFile> SceneViewWriter::finish(const PackOptions& options) {
    SceneFile out;
    JsonValue& root = json_.root;
    // In a GLB the fallback is in the same buffer. With a bin_uri it is in a separate file, which readers of streams
    // need not load.
    const bool apart = !options.bin_uri.empty() && fallback_.size() > 0;
    if (!apart && fallback_.size() > 0) {
        const std::vector<std::byte> bytes = fallback_.take();
        const std::size_t base = bin_.add(bytes);
        for (const std::size_t i : plain_views_) {
            JsonValue& view = views_.members[i].value;
            view.set("byteOffset", json_.number(view.integer("byteOffset").value_or(0) + base));
        }
    }
    if (apart) {
        for (const std::size_t i : plain_views_) views_.members[i].value.set("buffer", json_.number(1));
    }
    if (bin_.size() == 0 && views_.size() > 0) bin_.add(std::vector<std::byte>(4));  // views need a buffer
    if (views_.size() > 0) {
        root.set("bufferViews", std::move(views_));
    } else {
        root.remove("bufferViews");
    }
    out.bin = bin_.take();
    describe_buffers(json_, out.bin.size(), options.bin_uri);
    if (out.bin.empty()) {
        // no buffers, since there are no views
    } else if (apart) {
        out.fallback = fallback_.take();
        JsonValue buffer = JsonText::object();
        buffer.set("uri", json_.string(options.fallback_uri));
        buffer.set("byteLength", json_.number(out.fallback.size()));
        root.find("buffers")->members.push_back({{}, std::move(buffer)});
    } else if (placeholder_ > 0) {
        JsonValue buffer = JsonText::object(), extensions = JsonText::object(), extension = JsonText::object();
        extension.set("placeholder", json_.boolean(true));
        extensions.set(kExtension, std::move(extension));
        buffer.set("byteLength", json_.number(placeholder_));
        buffer.set("extensions", std::move(extensions));
        root.find("buffers")->members.push_back({{}, std::move(buffer)});
    }
    out.json = text_of(root);
    if (deflates_document(options, out)) {
        LR_TRY(pack_document(out));
    }
    return out;
}

bool SceneViewWriter::deflates_document(const PackOptions& options, const SceneFile& scene) const {
    if (options.json != SceneJson::automatic) return options.json == SceneJson::packed;
    if (options.fallback || !options.bin_uri.empty()) return false;
    std::size_t images = 0;
    for (const auto& image : json_.root.list("images")) {
        if (const JsonValue* uri = image.value.find("uri")) images += uri->text.size();
    }
    const std::size_t json = scene.json.size() - images;
    return 5 * json > json + scene.bin.size() - image_bytes_;
}

Result<void> SceneViewWriter::pack_document(SceneFile& out) {
    // Removes data that readers get from the streams: bounds, counts, and each primitive's stream and part, since parts
    // are numbered in the order of the primitives.
    auto accessors = json_.root.list("accessors");
    for (const auto& stream : extension_of(json_.root)->list("streams")) {
        const bool ordered = stream.value.find("ordered") != nullptr;
        for (const auto& set : stream.value.list("sets")) {
            for (const auto& number : set.value.members) {
                JsonValue& accessor = accessors[static_cast<std::size_t>(*number.value.integer())].value;
                accessor.remove("min");
                accessor.remove("max");
                if (!ordered) accessor.remove("count");
            }
        }
    }
    for (auto& mesh : json_.root.list("meshes")) {
        for (auto& primitive : mesh.value.list("primitives")) {
            if (extension_of(primitive.value) == nullptr) continue;
            remove_extension(primitive.value, kExtension);
            accessors[static_cast<std::size_t>(*primitive.value.integer("indices"))].value.remove("count");
        }
    }
    out.json = text_of(json_.root);
    LR_ASSIGN(const auto packed, deflate_bytes(std::as_bytes(std::span(out.json))));
    BinChunk bin;
    bin.add(out.bin);
    JsonValue view = JsonText::object(), views = JsonText::array(), extension = JsonText::object(),
              extensions = JsonText::object();
    view.set("buffer", json_.number(0));
    view.set("byteOffset", json_.number(bin.add(packed)));
    view.set("byteLength", json_.number(packed.size()));
    views.members.push_back({{}, std::move(view)});
    extension.set("document", json_.number(0));
    extensions.set(kExtension, std::move(extension));
    JsonText outer("{}");
    if (const JsonValue* asset = json_.root.find("asset")) outer.root.set("asset", *asset);
    list_extension(outer, "extensionsUsed");
    list_extension(outer, "extensionsRequired");
    outer.root.set("extensions", std::move(extensions));
    outer.root.set("bufferViews", std::move(views));
    out.bin = bin.take();
    describe_buffers(outer, out.bin.size(), "");
    out.json = text_of(outer.root);
    return {};
}

}  // namespace lacedring::detail
