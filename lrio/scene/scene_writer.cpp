#include "lrio/scene/scene_writer.h"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>

#include "lrio/gltf/gltf_accessor.h"
#include "lrio/gltf/gltf_names.h"
#include "lrio/mesh/read_formats.h"

namespace lacedring::detail {
namespace {

bool has_shape(const JsonValue& accessor, std::uint8_t components) {
    const JsonValue* type = accessor.find("type");
    if (type == nullptr) return false;
    const std::string name = plain_string(*type);
    return (!name.empty() && name == gltf_type(components)) || (components == 4 && name == "MAT2");
}

float float_at(std::span<const std::byte> data, std::size_t i) {
    float value = 0;
    std::memcpy(&value, data.data() + 4 * i, sizeof value);
    return value;
}

template <class To>
bool convert_all(std::span<const std::byte> floats, std::vector<std::byte>& out) {
    for (std::size_t i = 0; i < floats.size() / 4; ++i) {
        const float value = float_at(floats, i);
        if (!(value >= static_cast<float>(std::numeric_limits<To>::min()) &&
              value <= static_cast<float>(std::numeric_limits<To>::max())) ||
            value != std::nearbyint(value)) {
            return false;
        }
        const auto integer = static_cast<To>(value);
        const auto bytes = std::as_bytes(std::span(&integer, 1));
        out.insert(out.end(), bytes.begin(), bytes.end());
    }
    return true;
}

/// Do the numbers say these floats?
bool says(const JsonValue* numbers, std::span<const float> values) {
    if (numbers == nullptr || !numbers->is_array() || numbers->size() != values.size()) return false;
    for (std::size_t i = 0; i < values.size(); ++i) {
        const std::string_view text = numbers->members[i].value.text;
        double value = 0;
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
        if (error != std::errc() || end != text.data() + text.size() || static_cast<float>(value) != values[i]) {
            return false;
        }
    }
    return true;
}

}  // namespace

std::size_t BinChunk::add(std::span<const std::byte> bytes, std::size_t align) {
    bytes_.resize((bytes_.size() + align - 1) / align * align);
    const std::size_t at = bytes_.size();
    bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
    return at;
}

void BinChunk::expect(std::size_t more) {
    if (more > bytes_.capacity() - bytes_.size()) bytes_.reserve(std::max(bytes_.size() + more, 2 * bytes_.capacity()));
}

void strip_accessor(JsonValue& accessor) {
    for (const char* name : {"bufferView", "byteOffset", "sparse"}) accessor.remove(name);
}

Result<std::vector<std::byte>> values_as(const JsonValue& accessor, Attribute attribute) {
    const std::uint64_t type = accessor.integer("componentType").value_or(0);
    if (!has_shape(accessor, attribute.components)) return malformed("{}: another type", shown(attribute.name));
    if (type != 0 && type == gltf_component_type(attribute.type)) return std::move(attribute.data);
    std::vector<std::byte> out;
    const bool fits = attribute.type == ComponentType::f32 &&
                      ((type == kGltfByte && convert_all<std::int8_t>(attribute.data, out)) ||
                       (type == kGltfUnsignedByte && convert_all<std::uint8_t>(attribute.data, out)) ||
                       (type == kGltfShort && convert_all<std::int16_t>(attribute.data, out)) ||
                       (type == kGltfUnsignedShort && convert_all<std::uint16_t>(attribute.data, out)));
    if (!fits) return malformed("{}: component type {} does not hold it", shown(attribute.name), type);
    return out;
}

void describe_attribute(JsonText& json, JsonValue& accessor, const Attribute& attribute, std::uint32_t vertices) {
    accessor.set("count", json.number(vertices));
    const bool is_position = attribute.name.starts_with("POSITION") && attribute.components == 3;
    if (!is_position || vertices == 0) {
        accessor.remove("min");
        accessor.remove("max");
        return;
    }
    std::array<float, 3> low{}, high{};
    const bool floats = attribute.type == ComponentType::f32;
    for (std::size_t v = 0; v < vertices; ++v) {
        std::array<float, 3> at{};
        if (floats) std::memcpy(at.data(), attribute.data.data() + 12 * v, sizeof at);
        for (std::size_t c = 0; c < 3 && !floats; ++c) {
            at[c] = static_cast<float>(component_at(attribute.data.data(), attribute.type, false, 3 * v + c));
        }
        if (v == 0) low = high = at;
        for (std::size_t c = 0; c < 3; ++c) {
            low[c] = std::min(low[c], at[c]);
            high[c] = std::max(high[c], at[c]);
        }
    }
    const auto put = [&](const char* name, const std::array<float, 3>& values) {
        if (says(accessor.find(name), values)) return;
        JsonValue list = JsonText::array();
        for (const float value : values) list.members.push_back({{}, json.real(value)});
        accessor.set(name, std::move(list));
    };
    put("min", low);
    put("max", high);
}

void describe_indices(JsonText& json, JsonValue& accessor, std::size_t count, std::uint32_t vertices) {
    accessor.remove("min");
    accessor.remove("max");
    accessor.set("count", json.number(count));
    // The highest number of each type restarts strips, and is no index.
    const std::uint64_t needed = vertices <= 0xff     ? kGltfUnsignedByte
                                 : vertices <= 0xffff ? kGltfUnsignedShort
                                                      : kGltfUnsignedInt;
    if (const auto now = accessor.integer("componentType"); now && *now >= needed) return;
    accessor.set("componentType", json.number(std::max(needed, kGltfUnsignedShort)));
}

std::vector<std::byte> indices_as(const JsonValue& accessor, std::span<const std::uint32_t> indices) {
    const std::uint64_t type = accessor.integer("componentType").value_or(kGltfUnsignedInt);
    const std::size_t size = type == kGltfUnsignedByte ? 1 : type == kGltfUnsignedShort ? 2 : 4;
    std::vector<std::byte> out(indices.size() * size);
    if (size == 4) {
        if (!indices.empty()) std::memcpy(out.data(), indices.data(), out.size());
        return out;
    }
    for (std::size_t i = 0; i < indices.size(); ++i) std::memcpy(out.data() + i * size, &indices[i], size);
    return out;
}

JsonValue view_of(JsonText& json, BinChunk& bin, std::uint32_t buffer, std::span<const std::byte> bytes,
                  std::size_t stride) {
    const std::size_t padded = (stride + 3) / 4 * 4;
    std::size_t size = bytes.size(), at = 0;
    if (padded == stride) {
        at = bin.add(bytes);
    } else {
        const std::size_t rows = bytes.size() / stride;
        std::vector<std::byte> out(rows * padded);
        for (std::size_t i = 0; i < rows; ++i) std::memcpy(out.data() + i * padded, bytes.data() + i * stride, stride);
        size = out.size();
        at = bin.add(out);
    }
    JsonValue view = JsonText::object();
    view.set("buffer", json.number(buffer));
    view.set("byteOffset", json.number(at));
    view.set("byteLength", json.number(size));
    if (stride != 0) view.set("byteStride", json.number(padded));
    view.set("target", json.number(stride != 0 ? kGltfVertexTarget : kGltfIndexTarget));
    return view;
}

void describe_buffers(JsonText& json, std::size_t size, const std::string& uri) {
    if (size == 0) return json.root.remove("buffers");
    JsonValue buffer = JsonText::object();
    if (!uri.empty()) buffer.set("uri", json.string(uri));
    buffer.set("byteLength", json.number(size));
    JsonValue list = JsonText::array();
    list.members.push_back({{}, std::move(buffer)});
    json.root.set("buffers", std::move(list));
}

void list_extension(JsonText& json, std::string_view list) {
    JsonValue* names = json.root.find(list);
    if (names == nullptr || !names->is_array()) names = &json.root.set(list, JsonText::array());
    names->members.push_back({{}, json.string(kExtension)});
}

void unlist_extension(JsonValue& root, std::string_view list, std::string_view name) {
    JsonValue* names = root.find(list);
    if (names == nullptr) return;
    const std::size_t before = names->size();
    std::erase_if(names->members, [name](const auto& member) { return plain_string(member.value) == name; });
    if (names->members.empty() && before > 0) root.remove(list);
}

const JsonValue* extension_of(const JsonValue& value) {
    const JsonValue* extensions = value.find("extensions");
    return extensions == nullptr ? nullptr : extensions->find(kExtension);
}

void set_extension(JsonValue& value, JsonValue extension) {
    JsonValue* extensions = value.find("extensions");
    if (extensions == nullptr || !extensions->is_object()) extensions = &value.set("extensions", JsonText::object());
    extensions->set(kExtension, std::move(extension));
}

void remove_extension(JsonValue& value, std::string_view name) {
    JsonValue* extensions = value.find("extensions");
    if (extensions == nullptr || extensions->find(name) == nullptr) return;
    extensions->remove(name);
    if (extensions->members.empty()) value.remove("extensions");
}

}  // namespace lacedring::detail
