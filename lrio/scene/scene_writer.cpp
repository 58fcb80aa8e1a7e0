#include "lrio/scene/scene_writer.h"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>

#include "lrcore/base/try.h"
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
    out.resize(floats.size() / 4 * sizeof(To));
    for (std::size_t i = 0; i < floats.size() / 4; ++i) {
        const float value = float_at(floats, i);
        if (!(value >= static_cast<float>(std::numeric_limits<To>::min()) &&
              value <= static_cast<float>(std::numeric_limits<To>::max())) ||
            value != std::nearbyint(value)) {
            return false;
        }
        const auto integer = static_cast<To>(value);
        std::memcpy(out.data() + i * sizeof integer, &integer, sizeof integer);
    }
    return true;
}

struct Bounds {
    std::array<float, 3> low{}, high{};
};

/// The bounds of at least one vertex of three floats; ignores NaN. Processes four vertices at a time, so that the steps
/// do not depend on each other.
Bounds bounds_of(std::span<const std::byte> positions) {
    std::array<float, 12> low{}, high{}, next{};
    low.fill(INFINITY);
    high.fill(-INFINITY);
    for (std::size_t k = 0; k < 12; ++k) next[k] = float_at(positions, k % 3);  // fills up an incomplete step
    for (std::size_t at = 0; at < positions.size(); at += sizeof next) {
        std::memcpy(next.data(), positions.data() + at, std::min(sizeof next, positions.size() - at));
        for (std::size_t k = 0; k < 12; ++k) {
            low[k] = next[k] < low[k] ? next[k] : low[k];
            high[k] = next[k] > high[k] ? next[k] : high[k];
        }
    }
    Bounds out;
    for (std::size_t c = 0; c < 3; ++c) {
        out.low[c] = std::min({low[c], low[c + 3], low[c + 6], low[c + 9]});
        out.high[c] = std::max({high[c], high[c + 3], high[c + 6], high[c + 9]});
    }
    return out;
}

/// Is `numbers` a JSON array of exactly these floats?
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

std::size_t BinChunk::add_zeros(std::size_t size) {
    const std::size_t at = (bytes_.size() + 3) / 4 * 4;
    bytes_.resize(at + size);
    return at;
}

void BinChunk::expect(std::size_t more) {
    if (more > bytes_.capacity() - bytes_.size()) bytes_.reserve(std::max(bytes_.size() + more, 2 * bytes_.capacity()));
}

void strip_accessor(JsonValue& accessor) {
    for (const char* name : {"bufferView", "byteOffset", "sparse"}) accessor.remove(name);
}

Result<bool> has_type_of(const JsonValue& accessor, const AttributeView& attribute) {
    const std::uint64_t type = accessor.integer("componentType").value_or(0);
    if (!has_shape(accessor, attribute.components)) return malformed("{}: another type", shown(attribute.name));
    if (attribute.v_up) return malformed("{}: v upwards", shown(attribute.name));
    if (type != 0 && type == gltf_component_type(attribute.type)) {
        const JsonValue* normalized = accessor.find("normalized");
        const bool is_normalized = normalized != nullptr && normalized->text == "true";
        if (attribute.type == ComponentType::f32 || is_normalized == attribute.normalized) return true;
        return malformed("{}: normalized in the stream or in the accessor, not in both", shown(attribute.name));
    }
    const bool integers =
        type == kGltfByte || type == kGltfUnsignedByte || type == kGltfShort || type == kGltfUnsignedShort;
    if (attribute.type == ComponentType::f32 && integers) return false;
    return malformed("{}: component type {} does not hold it", shown(attribute.name), type);
}

Result<std::vector<std::byte>> values_as(const JsonValue& accessor, const AttributeView& attribute) {
    LR_ASSIGN(const auto same, has_type_of(accessor, attribute));
    if (same) return std::vector<std::byte>(attribute.data.begin(), attribute.data.end());
    const std::uint64_t type = accessor.integer("componentType").value_or(0);
    std::vector<std::byte> out;
    const bool fits = (type == kGltfByte && convert_all<std::int8_t>(attribute.data, out)) ||
                      (type == kGltfUnsignedByte && convert_all<std::uint8_t>(attribute.data, out)) ||
                      (type == kGltfShort && convert_all<std::int16_t>(attribute.data, out)) ||
                      (type == kGltfUnsignedShort && convert_all<std::uint16_t>(attribute.data, out));
    if (!fits) return malformed("{}: component type {} does not hold it", shown(attribute.name), type);
    return out;
}

void describe_attribute(JsonText& json, JsonValue& accessor, const AttributeView& attribute, std::uint32_t vertices,
                        bool position) {
    accessor.set("count", json.number(vertices));
    const auto say_nothing = [&] {
        accessor.remove("min");
        accessor.remove("max");
    };
    if (!position || attribute.components != 3 || vertices == 0) return say_nothing();
    std::vector<std::byte> floats;
    std::span<const std::byte> positions = attribute.data;
    if (attribute.type != ComponentType::f32) {
        floats.resize(std::size_t{12} * vertices);
        for (std::size_t i = 0; i < std::size_t{3} * vertices; ++i) {
            const auto value = static_cast<float>(component_at(attribute.data.data(), attribute.type, false, i));
            std::memcpy(floats.data() + 4 * i, &value, sizeof value);
        }
        positions = floats;
    }
    const Bounds bounds = bounds_of(positions);
    const auto is_finite = [](float value) { return std::isfinite(value); };
    if (!std::ranges::all_of(bounds.low, is_finite) || !std::ranges::all_of(bounds.high, is_finite)) {
        return say_nothing();  // morph targets may have infinite values, which JSON cannot express
    }
    const auto put = [&](const char* name, const std::array<float, 3>& values) {
        if (says(accessor.find(name), values)) return;
        JsonValue list = JsonText::array();
        for (const float value : values) list.members.push_back({{}, json.real(value)});
        accessor.set(name, std::move(list));
    };
    put("min", bounds.low);
    put("max", bounds.high);
}

void describe_indices(JsonText& json, JsonValue& accessor, std::size_t count, std::uint32_t vertices) {
    accessor.remove("min");
    accessor.remove("max");
    accessor.set("count", json.number(count));
    // The largest number of each type is not a valid index: it means primitive restart.
    const std::uint64_t needed = vertices <= 0xff     ? kGltfUnsignedByte
                                 : vertices <= 0xffff ? kGltfUnsignedShort
                                                      : kGltfUnsignedInt;
    if (const auto now = accessor.integer("componentType"); now && *now >= needed) return;
    accessor.set("componentType", json.number(std::max(needed, kGltfUnsignedShort)));
}

std::size_t index_size(const JsonValue& accessor) {
    const std::uint64_t type = accessor.integer("componentType").value_or(kGltfUnsignedInt);
    return type == kGltfUnsignedByte ? 1 : type == kGltfUnsignedShort ? 2 : 4;
}

bool is_index_list(const JsonValue& accessor) {
    const std::uint64_t type = accessor.integer("componentType").value_or(0);
    return has_shape(accessor, 1) &&
           (type == kGltfUnsignedByte || type == kGltfUnsignedShort || type == kGltfUnsignedInt);
}

bool put_indices(const JsonValue& accessor, std::span<const std::uint32_t> indices, std::span<std::byte> out) {
    const auto put = [&](auto as) {
        std::uint32_t most = 0;
        for (std::size_t i = 0; i < indices.size(); ++i) {
            most = std::max(most, indices[i]);
            as = static_cast<decltype(as)>(indices[i]);
            std::memcpy(out.data() + i * sizeof as, &as, sizeof as);
        }
        return most < std::numeric_limits<decltype(as)>::max();
    };
    const std::size_t size = index_size(accessor);
    return size == 1 ? put(std::uint8_t{}) : size == 2 ? put(std::uint16_t{}) : put(std::uint32_t{});
}

JsonValue put_rows(JsonText& json, BinChunk& bin, std::span<const std::byte> bytes, std::size_t stride) {
    const std::size_t padded = (stride + 3) / 4 * 4;
    if (padded == stride) return describe_view(json, bin.add(bytes), bytes.size(), stride);
    const std::size_t rows = bytes.size() / stride, at = bin.add_zeros(rows * padded);
    const std::span<std::byte> out = bin.bytes(at, rows * padded);
    for (std::size_t i = 0; i < rows; ++i) std::memcpy(&out[i * padded], bytes.data() + i * stride, stride);
    return describe_view(json, at, out.size(), padded);
}

JsonValue describe_view(JsonText& json, std::size_t at, std::size_t size, std::size_t stride) {
    JsonValue view = JsonText::object();
    view.set("buffer", json.number(0));
    view.set("byteOffset", json.number(at));
    view.set("byteLength", json.number(size));
    if (stride != 0) view.set("byteStride", json.number(stride));
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
