#include "lrio/scene/packed_scene.h"

#include "lrcore/base/try.h"
#include "lrio/gltf/gltf_file.h"
#include "lrio/scene/deflate.h"
#include "lrio/scene/float_coding.h"
#include "lrio/scene/scene_writer.h"

namespace lacedring::detail {
namespace {

template <class T>
Result<T> in_view(std::uint64_t index, Result<T> result) {
    if (result) return result;
    return Error{result.error().code, fmt::format("buffer view {}: {}", index, result.error().message)};
}

}  // namespace

Result<std::span<const std::byte>> SceneViews::range(const JsonValue& place) const {
    const auto buffer = place.integer("buffer"), length = place.integer("byteLength");
    const std::uint64_t offset = place.integer("byteOffset").value_or(0);
    if (!buffer || !length || *buffer >= buffers_->count()) return malformed("buffer view without a buffer");
    auto bytes = buffers_->open(static_cast<std::size_t>(*buffer));
    if (!bytes) return bytes;
    if (offset > bytes->size() || *length > bytes->size() - offset) {
        return malformed("{} bytes from byte {} on are not in buffer {} of {} bytes", *length, offset, *buffer,
                         bytes->size());
    }
    return bytes->subspan(static_cast<std::size_t>(offset), static_cast<std::size_t>(*length));
}

Result<std::span<const std::byte>> SceneViews::raw(std::uint64_t index) const {
    if (index >= views_.size()) return malformed("buffer view {} does not exist", index);
    return in_view(index, range(views_[static_cast<std::size_t>(index)].value));
}

Result<std::span<const std::byte>> SceneViews::stored(std::uint64_t index) const {
    if (index >= views_.size()) return malformed("buffer view {} does not exist", index);
    const JsonValue& view = views_[static_cast<std::size_t>(index)].value;
    const JsonValue* coded = extension_of(view);
    return in_view(index, range(coded == nullptr ? view : *coded));
}

Result<std::uint64_t> SceneViews::size(std::uint64_t index) const {
    LR_TRY(stored(index));
    const auto length = views_[static_cast<std::size_t>(index)].value.integer("byteLength");
    if (!length) return malformed("buffer view {}: no byteLength", index);
    return *length;
}

Result<std::vector<std::byte>> SceneViews::contents(std::uint64_t index) const {
    const auto bytes = stored(index);
    if (!bytes) return bytes.error();
    const JsonValue& view = views_[static_cast<std::size_t>(index)].value;
    const JsonValue* coded = extension_of(view);
    if (coded == nullptr) return std::vector<std::byte>(bytes->begin(), bytes->end());
    const auto length = view.integer("byteLength");
    const JsonValue* coding = coded->find("coding");
    const std::string name = coding == nullptr ? "" : plain_string(*coding);
    if (!length || (name != "deflate" && name != "floats")) {
        return malformed("buffer view {}: unknown coding {}", index, shown(name));
    }
    auto out = in_view(index, name == "deflate" ? inflate_bytes(*bytes, *length) : decode_floats(*bytes, *length));
    if (out && out->size() != *length) {
        return malformed("buffer view {}: {} bytes, where byteLength is {}", index, out->size(), *length);
    }
    return out;
}

bool SceneViews::is_placeholder(std::uint64_t index) const {
    if (index >= views_.size()) return false;
    const JsonValue& view = views_[static_cast<std::size_t>(index)].value;
    const auto buffer = view.integer("buffer");
    return buffer && *buffer < buffer_list_.size() && extension_of(view) == nullptr &&
           extension_of(buffer_list_[static_cast<std::size_t>(*buffer)].value) != nullptr;
}

bool SceneViews::is_coded(std::uint64_t index) const {
    return index < views_.size() && extension_of(views_[static_cast<std::size_t>(index)].value) != nullptr;
}

Result<PackedScene> PackedScene::load(std::span<const std::byte> bytes, Reading& reading) {
    LR_ASSIGN(const auto chunks, split_gltf(bytes));
    PackedScene out;
    out.has_bin_chunk_ = chunks.bin.has_value();
    const auto open = [&](std::string_view text) -> Result<void> {
        if (auto good = check_json(text); !good) return good;
        out.json_ = std::make_unique<JsonText>(text);
        if (!out.json_->root.is_object()) return malformed("glTF: is not a JSON object");
        // GltfBuffers needs only the buffers, as nlohmann's JSON.
        const JsonValue* buffers = out.json_->root.find("buffers");
        out.buffer_list_ = std::make_unique<nlohmann::json>(nlohmann::json::object());
        if (buffers != nullptr && buffers->is_array()) {
            (*out.buffer_list_)["buffers"] = nlohmann::json::parse(text_of(*buffers), nullptr, false);
        }
        LR_ASSIGN(auto made, GltfBuffers::make(*out.buffer_list_, chunks.bin, reading));
        out.buffers_ = std::make_unique<GltfBuffers>(std::move(made));
        return {};
    };
    LR_TRY(open(chunks.json));
    const auto document = [&]() -> const JsonValue* {
        const JsonValue* extension = extension_of(out.json_->root);
        return extension == nullptr ? nullptr : extension->find("document");
    };
    const auto file_bytes = static_cast<double>(bytes.size());
    if (const JsonValue* view = document()) {
        const auto index = view->integer();
        const auto packed = out.views().raw(index.value_or(UINT64_MAX));
        if (!packed) return packed.error();
        // The parsed JSON takes up to 32 times its text. Limits the text to a 40th of the memory limit, or less.
        std::uint64_t most = 64;
        while (most < UINT32_MAX / 2 && reading.check_memory(1, 80.0 * static_cast<double>(most), 0, file_bytes)) {
            most *= 2;
        }
        auto text = inflate_bytes(*packed, most, ErrorCode::memory_limit);
        if (!text) return Error{text.error().code, "the packed document: " + text.error().message};
        out.text_ = std::make_unique<std::string>(reinterpret_cast<const char*>(text->data()), text->size());
        LR_TRY(open(*out.text_));
        if (document() != nullptr) return malformed("a packed document in a packed document");
    }
    out.file_bytes_ = file_bytes;
    return out;
}

}  // namespace lacedring::detail
