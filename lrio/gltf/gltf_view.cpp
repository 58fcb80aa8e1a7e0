#include "lrio/gltf/gltf_view.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <string>
#include <string_view>

#include "lrcore/base/try.h"

#ifdef LACEDRING_MESHOPTIMIZER
#include <meshoptimizer.h>
#endif

namespace lacedring::detail {
namespace {

constexpr const char* kMeshoptNames[] = {"EXT_meshopt_compression", "KHR_meshopt_compression"};

/// Bytes of a buffer. `where` is the prefix of errors.
Result<std::span<const std::byte>> buffer_bytes(GltfFile& file, std::uint64_t buffer, std::uint64_t offset,
                                                std::uint64_t length, const std::string& where) {
    if (buffer >= file.buffers.count()) return malformed("{}: buffer {} does not exist", where, buffer);
    const auto bytes = file.buffers.open(static_cast<std::size_t>(buffer));
    if (!bytes) return bytes.error();
    if (offset > bytes->size() || length > bytes->size() - offset) {
        return malformed("{}: {} bytes from byte {} on are not in buffer {} of {} bytes", where, length, offset, buffer,
                         bytes->size());
    }
    return bytes->subspan(static_cast<std::size_t>(offset), static_cast<std::size_t>(length));
}

Result<std::span<const std::byte>> uncompressed_bytes(GltfFile& file, std::size_t index) {
    const tinygltf::BufferView& view = file.model.bufferViews[index];
    const std::string where = fmt::format("buffer view {}", index);
    if (view.buffer < 0) return malformed("{}: buffer {} does not exist", where, view.buffer);
    return buffer_bytes(file, static_cast<std::uint64_t>(view.buffer), view.byteOffset, view.byteLength, where);
}

/// The extension's object in the JSON document; tinygltf's copy cuts integers to 32 bits. Null: the view has none.
const nlohmann::json* find_meshopt(const GltfFile& file, std::size_t index) {
    const nlohmann::json& view = file.document.at("bufferViews").at(index);
    const auto extensions = view.find("extensions");
    if (extensions == view.end() || !extensions->is_object()) return nullptr;
    for (const char* name : kMeshoptNames) {
        if (const auto found = extensions->find(name); found != extensions->end()) return &*found;
    }
    return nullptr;
}

#ifdef LACEDRING_MESHOPTIMIZER

enum class Mode { attributes, triangles, indices };
enum class Filter { none, octahedral, quaternion, exponential };

/// The parsed object of the extension.
struct Compressed {
    std::uint64_t buffer = 0, offset = 0, length = 0;
    std::size_t stride = 0, count = 0;
    Mode mode = Mode::attributes;
    Filter filter = Filter::none;
};

/// Reads an integer, at least `least`. A missing member has the value `unset`; without `unset` it is an error.
Result<std::uint64_t> take_integer(const nlohmann::json& from, const char* name, std::uint64_t least,
                                   std::optional<std::uint64_t> unset = {}) {
    const auto found = from.find(name);
    if (found == from.end() && unset) return *unset;
    if (found == from.end()) return malformed("{} is missing", name);
    if (!found->is_number_unsigned()) return malformed("{} is not an unsigned integer", name);
    const auto value = found->get<std::uint64_t>();
    if (value < least) return malformed("{} is {}", name, value);
    return value;
}

/// Reads a string that is one of `names`, and returns its index in them. A missing member has the value `unset`; if
/// `unset` is null, it is an error.
Result<std::size_t> take_name(const nlohmann::json& from, const char* name, std::span<const char* const> names,
                              const char* unset) {
    const auto found = from.find(name);
    if (found == from.end() && unset == nullptr) return malformed("{} is missing", name);
    if (found != from.end() && !found->is_string()) return malformed("{} is not a string", name);
    const std::string& value = found == from.end() ? std::string(unset) : *found->get_ptr<const std::string*>();
    const auto known = std::find(names.begin(), names.end(), value);
    if (known == names.end()) return unsupported("{} {} is not read", name, shown(value));
    return static_cast<std::size_t>(known - names.begin());
}

Result<Compressed> parse_compressed(const nlohmann::json& from, const tinygltf::BufferView& view) {
    if (!from.is_object()) return malformed("is not an object");
    Compressed out;
    const auto buffer = take_integer(from, "buffer", 0), offset = take_integer(from, "byteOffset", 0, 0);
    const auto length = take_integer(from, "byteLength", 1), stride = take_integer(from, "byteStride", 1);
    const auto count = take_integer(from, "count", 1);
    for (const auto* number : {&buffer, &offset, &length, &stride, &count}) {
        if (!*number) return number->error();
    }
    constexpr const char* kModes[] = {"ATTRIBUTES", "TRIANGLES", "INDICES"};
    constexpr const char* kFilters[] = {"NONE", "OCTAHEDRAL", "QUATERNION", "EXPONENTIAL"};
    const auto mode = take_name(from, "mode", kModes, nullptr), filter = take_name(from, "filter", kFilters, "NONE");
    if (!mode) return mode.error();
    if (!filter) return filter.error();
    out = {*buffer, *offset, *length, *stride, *count, static_cast<Mode>(*mode), static_cast<Filter>(*filter)};

    const bool fits =
        out.mode == Mode::attributes ? out.stride % 4 == 0 && out.stride <= 256 : out.stride == 2 || out.stride == 4;
    if (!fits) return malformed("byteStride {} does not go with mode {}", out.stride, kModes[*mode]);
    const bool filtered = out.filter == Filter::none ||
                          (out.mode == Mode::attributes && (out.filter == Filter::exponential || out.stride == 8 ||
                                                            (out.filter == Filter::octahedral && out.stride == 4)));
    if (!filtered) {
        return malformed("filter {} does not go with mode {} and byteStride {}", kFilters[*filter], kModes[*mode],
                         out.stride);
    }
    if (out.mode == Mode::triangles && out.count % 3 != 0) return malformed("{} indices are not triangles", out.count);
    if (out.count != view.byteLength / out.stride || view.byteLength % out.stride != 0) {
        return malformed("{} elements of {} bytes are not the view's {} bytes", out.count, out.stride, view.byteLength);
    }
    if (view.byteStride != 0 && view.byteStride != out.stride) {
        return malformed("byteStride {} is not the view's {}", out.stride, view.byteStride);
    }
    return out;
}

/// A lower bound of the compressed size, to refuse false counts before memory is allocated for them. Indices take a
/// byte per triangle or index, plus head and tail. Attributes take 2 bits per 16 bytes in version 0 of the codec, and 2
/// bits per 256 bytes in version 1, plus head and tail.
std::uint64_t fewest_bytes(const Compressed& what, std::byte version) {
    if (what.mode == Mode::triangles) return what.count / 3 + 17;
    if (what.mode == Mode::indices) return what.count + 5;
    const std::uint64_t size = what.count * what.stride;
    return version == std::byte{0xa0} ? size / 64 + 33 : size / 1024 + 25;
}

/// Checks that the installed meshoptimizer reads the data. The first byte has the codec in its upper 4 bits, and the
/// version in its lower 4 bits.
Result<void> check_codec(Mode mode, std::byte first) {
    struct Codec {
        unsigned mark;
        unsigned latest;
        const char* name;
    };
    constexpr unsigned kLatest = MESHOPTIMIZER_VERSION >= 230 ? 1 : 0;  // latest version of the vertex codec
    constexpr Codec kCodecs[] = {{0xa, kLatest, "vertex codec"}, {0xe, 1, "index codec"}, {0xd, 1, "sequence codec"}};
    const Codec& codec = kCodecs[static_cast<std::size_t>(mode)];
    const auto byte = std::to_integer<unsigned>(first);
    if (byte >> 4U != codec.mark) return malformed("the data is not of meshoptimizer's {}", codec.name);
    if ((byte & 15U) > codec.latest) {
        return unsupported(
            "compressed by version {} of meshoptimizer's {}, which the installed meshoptimizer {}.{} "
            "does not read",
            byte & 15U, codec.name, MESHOPTIMIZER_VERSION / 1000, MESHOPTIMIZER_VERSION % 1000 / 10);
    }
    return {};
}

Result<std::vector<std::byte>> decode_meshopt(GltfFile& file, std::size_t index, const nlohmann::json& extension) {
    LR_ASSIGN(const auto what, parse_compressed(extension, file.model.bufferViews[index]));
    const auto data = buffer_bytes(file, what.buffer, what.offset, what.length, "compressed data");
    if (!data) return data.error();
    LR_TRY(check_codec(what.mode, data->front()));
    if (data->size() < fewest_bytes(what, data->front())) {
        return malformed("{} elements of {} bytes are not in {} compressed bytes", what.count, what.stride,
                         data->size());
    }
    const std::size_t size = what.count * what.stride;
    LR_TRY(file.take_memory(static_cast<double>(size)));
    std::vector<std::byte> out(size);
    const auto* from = reinterpret_cast<const unsigned char*>(data->data());
    int failed = 0;
    if (what.mode == Mode::attributes) {
        failed = meshopt_decodeVertexBuffer(out.data(), what.count, what.stride, from, data->size());
    } else if (what.mode == Mode::triangles) {
        failed = meshopt_decodeIndexBuffer(out.data(), what.count, what.stride, from, data->size());
    } else {
        failed = meshopt_decodeIndexSequence(out.data(), what.count, what.stride, from, data->size());
    }
    if (failed != 0) return malformed("meshoptimizer does not decode the data");
    if (what.filter == Filter::octahedral) meshopt_decodeFilterOct(out.data(), what.count, what.stride);
    if (what.filter == Filter::quaternion) meshopt_decodeFilterQuat(out.data(), what.count, what.stride);
    if (what.filter == Filter::exponential) meshopt_decodeFilterExp(out.data(), what.count, what.stride);
    return out;
}

#else

Result<std::vector<std::byte>> decode_meshopt(GltfFile& /*file*/, std::size_t /*index*/,
                                              const nlohmann::json& /*extension*/) {
    return unsupported("compressed by meshoptimizer, and this build has no meshoptimizer");
}

#endif

}  // namespace

bool has_meshoptimizer() {
#ifdef LACEDRING_MESHOPTIMIZER
    return true;
#else
    return false;
#endif
}

Result<std::span<const std::byte>> open_view(GltfFile& file, std::size_t index) {
    const nlohmann::json* extension = find_meshopt(file, index);
    if (extension == nullptr) return uncompressed_bytes(file, index);
    auto known = file.decoded_views.find(index);
    if (known == file.decoded_views.end()) {
        auto decoded = decode_meshopt(file, index, *extension);
        if (!decoded) {
            decoded = Error{decoded.error().code, fmt::format("buffer view {}: {}", index, decoded.error().message)};
        }
        known = file.decoded_views.emplace(index, std::move(decoded)).first;
    }
    const auto& decoded = known->second;
    if (decoded) return std::span<const std::byte>(*decoded);
    if (decoded.error().code == ErrorCode::unsupported && !file.requires_any_of(kMeshoptNames)) {
        if (auto bytes = uncompressed_bytes(file, index)) return bytes;
    }
    return decoded.error();
}

}  // namespace lacedring::detail
