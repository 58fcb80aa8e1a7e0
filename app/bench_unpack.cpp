#include "app/bench_unpack.h"

#include <algorithm>
#include <memory>
#include <thread>

#include "app/formats.h"
#include "lacedring/mesh_files.hpp"
#include "lacedring/scene.hpp"
#include "lrlab/rivals/whole_mesh.h"

namespace lacedring::app {
namespace {

constexpr ReadOptions kNoLimit{.max_bytes = UINT64_MAX};

Result<std::vector<std::byte>> packed_glb(const Mesh& mesh) {
    const auto plain = mesh_file_bytes(mesh, MeshFormat::gltf);
    if (!plain) return plain.error();
    PackOptions options;
    options.bits.threads = std::max(1U, std::thread::hardware_concurrency());
    const Result<SceneFile> packed = pack_scene(*plain, {}, options, kNoLimit);
    if (!packed) return packed.error();
    return make_glb_file(*packed);
}

}  // namespace

UnpackBench unpack_candidates(const Mesh& mesh) {
    UnpackBench out;
    Mesh proper = mesh;
    proper.indices = without_degenerate(mesh.indices);
    const auto add = [&](const char* name, Result<std::vector<std::byte>> made, const auto& decode) {
        if (made) {
            if (auto good = decode(*made); !good) made = good.error();
        }
        if (!made) {
            out.absent.emplace_back(name, made.error().message);
            return;
        }
        out.bytes[name] = made->size();
        // Candidates are copied; the bytes are shared.
        const auto bytes = std::make_shared<const std::vector<std::byte>>(std::move(*made));
        out.candidates.push_back({name, [bytes, decode] { (void)decode(*bytes); }, {}, {}});
    };
    add("lacedring", packed_glb(proper),
        [](std::span<const std::byte> bytes) { return unpack_scene(bytes, {}, "", kNoLimit); });
    const AttributeBits bits = PackOptions{}.bits;
    add("draco", draco_bytes(proper, bits, 7), decode_draco);
    add("draco_smallest", draco_bytes(proper, bits, 10), decode_draco);
    return out;
}

}  // namespace lacedring::app
