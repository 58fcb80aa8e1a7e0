#include "lrio/gltf/gltf_names.h"

#include <cstring>

namespace lacedring::detail {

std::uint64_t gltf_component_type(ComponentType type) {
    constexpr std::uint64_t kNumbers[] = {kGltfByte, kGltfUnsignedByte, kGltfShort, kGltfUnsignedShort,
                                          0,         kGltfUnsignedInt,  kGltfFloat, 0};
    return kNumbers[static_cast<std::size_t>(type)];
}

std::string_view gltf_type(std::uint8_t components) {
    constexpr std::string_view kNames[] = {"", "SCALAR", "VEC2", "VEC3", "VEC4"};
    return components <= 4 ? kNames[components] : components == 9 ? "MAT3" : components == 16 ? "MAT4" : "";
}

Result<std::vector<std::byte>> make_glb_head(std::string_view json, std::uint64_t bin_bytes) {
    const auto align4 = [](std::uint64_t size) { return (size + 3) / 4 * 4; };
    const std::uint64_t head = 12 + 8 + align4(json.size()) + (bin_bytes == 0 ? 0 : 8);
    const std::uint64_t total = head + align4(bin_bytes);
    if (total > UINT32_MAX) return Error{ErrorCode::too_large, "does not fit into GLB's 4 GiB"};
    const auto narrow = [](std::uint64_t size) { return static_cast<std::uint32_t>(size); };
    constexpr std::uint32_t kGltf = 0x46546c67, kJson = 0x4e4f534a, kBin = 0x004e4942;
    const std::uint32_t begin[] = {kGltf, 2, narrow(total), narrow(align4(json.size())), kJson};
    const std::uint32_t behind[] = {narrow(align4(bin_bytes)), kBin};
    std::vector<std::byte> out(narrow(head), std::byte{' '});
    std::memcpy(out.data(), begin, sizeof begin);
    std::memcpy(out.data() + sizeof begin, json.data(), json.size());
    if (bin_bytes != 0) std::memcpy(out.data() + out.size() - sizeof behind, behind, sizeof behind);
    return out;
}

}  // namespace lacedring::detail
