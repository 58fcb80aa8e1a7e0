#include "app/bench/unpack.h"

#include <algorithm>
#include <memory>
#include <thread>
#include <utility>

#include "app/formats/formats.h"
#include "lacedring/lr_file.hpp"
#include "lacedring/mesh_files.hpp"
#include "lacedring/scene.hpp"
#include "lrlab/rivals/whole_mesh.h"

namespace lacedring::app {
namespace {

constexpr ReadOptions kNoLimit{.max_bytes = UINT64_MAX};
constexpr int kSmallestDraco = 10;  // the level

using Bytes = std::vector<std::byte>;

Result<Bytes> packed_glb(const Mesh& mesh) {
    const auto plain = mesh_file_bytes(mesh, MeshFormat::gltf);
    if (!plain) return plain.error();
    PackOptions options;
    options.bits.threads = std::max(1U, std::thread::hardware_concurrency());
    options.form = LrForm::resident;  // `restore` times the other one
    const Result<SceneFile> packed = pack_scene(*plain, {}, options, kNoLimit);
    if (!packed) return packed.error();
    return make_glb_file(*packed);
}

/// Adds a candidate that decodes what was made, or says why it is absent.
template <class Decode>
void add(UnpackBench& out, const char* name, Result<Bytes> made, const Decode& decode) {
    if (made) {
        if (auto good = decode(*made); !good) made = good.error();
    }
    if (!made) {
        out.absent.emplace_back(name, made.error().message);
        return;
    }
    out.bytes[name] = made->size();
    // Candidates are copied; the bytes are shared.
    const auto bytes = std::make_shared<const Bytes>(std::move(*made));
    out.candidates.push_back({name, [bytes, decode] { (void)decode(*bytes); }, {}, {}});
}

}  // namespace

UnpackBench unpack_candidates(const Mesh& mesh) {
    UnpackBench out;
    const Mesh proper{mesh.vertex_count, without_degenerate(mesh.indices), mesh.attributes};
    add(out, "lacedring", packed_glb(proper),
        [](std::span<const std::byte> bytes) { return unpack_scene(bytes, {}, "", kNoLimit); });
    const AttributeBits bits = PackOptions{}.bits;
    add(out, "draco", draco_bytes(proper, bits, 7), decode_draco);
    add(out, "draco_smallest", draco_bytes(proper, bits, kSmallestDraco), decode_draco);
    return out;
}

UnpackBench restore_candidates(const Mesh& mesh, Encoded encoded, const AttributeBits& bits) {
    UnpackBench out;
    const auto position = std::ranges::find(mesh.attributes, "POSITION", &Attribute::name);
    Mesh alone{mesh.vertex_count, mesh.indices, {*position}};
    LrFile file = make_lr_file(alone, std::move(encoded), false);
    if (const auto compressed = compress_attributes(file, bits); !compressed) {
        out.absent.emplace_back("lacedring", compressed.error().message);
        return out;
    }
    const Bytes stored = serialize_lr(file, LrForm::stored);
    add(out, "lacedring", stored, [](std::span<const std::byte> bytes) { return parse_lr(bytes); });
    add(out, "lacedring_decoded", stored, [](std::span<const std::byte> bytes) -> Result<Mesh> {
        const Result<LrFile> restored = parse_lr(bytes);
        return restored ? decode_lr(*restored) : Result<Mesh>(restored.error());
    });
    alone.indices = without_degenerate(mesh.indices);
    add(out, "draco", draco_bytes(alone, bits, kSmallestDraco), decode_draco);
    return out;
}

}  // namespace lacedring::app
