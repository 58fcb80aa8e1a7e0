#pragma once
// Buffer views for GltfMaker, compressed by meshoptimizer.
#include <meshoptimizer.h>

#include <random>

#include "tests/lrio/gltf_maker.h"

namespace lacedring::test {

enum class Mode { attributes, triangles, indices };
inline constexpr const char* kModes[] = {"ATTRIBUTES", "TRIANGLES", "INDICES"};

inline std::string index_bytes(const Indices& indices, std::size_t stride) {
    std::string out;
    for (const std::uint32_t index : indices) {
        if (stride == 2) put(out, static_cast<std::uint16_t>(index));
        if (stride == 4) put(out, index);
    }
    return out;
}

inline Indices indices_in(const std::string& bytes, std::size_t stride) {
    Indices out(bytes.size() / stride, 0);
    for (std::size_t i = 0; i < out.size(); ++i) std::memcpy(&out[i], bytes.data() + i * stride, stride);
    return out;
}

inline std::string compress(Mode mode, const std::string& bytes, std::size_t stride) {
    const std::size_t count = bytes.size() / stride;
    std::vector<unsigned char> out;
    if (mode == Mode::attributes) {
        out.resize(meshopt_encodeVertexBufferBound(count, stride));
        out.resize(meshopt_encodeVertexBuffer(out.data(), out.size(), bytes.data(), count, stride));
    } else if (mode == Mode::triangles) {
        const Indices indices = indices_in(bytes, stride);
        meshopt_encodeIndexVersion(1);
        out.resize(meshopt_encodeIndexBufferBound(count, count));
        out.resize(meshopt_encodeIndexBuffer(out.data(), out.size(), indices.data(), count));
    } else {
        const Indices indices = indices_in(bytes, stride);
        out.resize(meshopt_encodeIndexSequenceBound(count, 1U << 31U));
        out.resize(meshopt_encodeIndexSequence(out.data(), out.size(), indices.data(), count));
    }
    return {out.begin(), out.end()};
}

/// Adds a view of `bytes`, compressed or not.
inline int add_view(GltfMaker& maker, bool compressed, Mode mode, const std::string& bytes, std::size_t stride,
                    const std::string& more = "", const char* name = "EXT_meshopt_compression") {
    const bool has_stride = mode == Mode::attributes;
    if (!compressed) return maker.add_view(bytes, has_stride ? static_cast<int>(stride) : 0);
    const std::string data = compress(mode, bytes, stride);
    const std::size_t offset = maker.append(data);
    return maker.add_view_json(fmt::format(
        R"("buffer":1,"byteOffset":0,"byteLength":{}{},"extensions":{{"{}":{{"buffer":0,"byteOffset":{},"byteLength":{},"byteStride":{},"count":{},"mode":"{}"{}}}}})",
        bytes.size(), has_stride ? fmt::format(R"(,"byteStride":{})", stride) : "", name, offset, data.size(), stride,
        bytes.size() / stride, kModes[static_cast<std::size_t>(mode)], more));
}

inline std::string accessor(int view, int offset, int type, std::size_t count, const char* shape,
                            bool normalized = false) {
    return fmt::format(R"("bufferView":{},"byteOffset":{},"componentType":{},"count":{},"type":"{}"{})", view, offset,
                       type, count, shape, normalized ? R"(,"normalized":true)" : "");
}

inline const std::string kPlaceholder =
    R"(,{"byteLength":1000000,"extensions":{"EXT_meshopt_compression":{"fallback":true}}})";
inline const std::string kRequired = R"("extensionsRequired":["EXT_meshopt_compression"],)";

// 900 vertices are several blocks of the vertex codec.
inline constexpr std::uint32_t kSide = 30;

inline Indices grid_indices() {
    Indices out;
    for (std::uint32_t y = 0; y + 1 < kSide; ++y) {
        for (std::uint32_t x = 0; x + 1 < kSide; ++x) {
            const std::uint32_t c = y * kSide + x;
            out.insert(out.end(), {c, c + 1, c + kSide, c + 1, c + kSide + 1, c + kSide});
        }
    }
    return out;
}

/// 16 bytes per vertex: 3 floats, 3 signed bytes, a byte of padding.
inline std::string grid_vertices() {
    std::mt19937 random(7);
    std::string out;
    for (std::uint32_t v = 0; v < kSide * kSide; ++v) {
        put(out, static_cast<float>(v % kSide));
        put(out, static_cast<float>(v / kSide));  // NOLINT
        put(out, static_cast<float>(random() % 1000) / 1000);
        for (int i = 0; i < 3; ++i) put(out, static_cast<std::int8_t>(random() % 255));
        put(out, std::int8_t{0});
    }
    return out;
}

inline std::string message_of(const Result<Mesh>& mesh) {
    return mesh ? "" : mesh.error().message;
}

}  // namespace lacedring::test
