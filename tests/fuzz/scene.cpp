// The target for scenes: unpacks and packs any bytes. Accepted scenes are written, read and unpacked again.

#include "lacedring/scene.hpp"

#include <string>

#include "lacedring/mesh_files.hpp"
#include "tests/fuzz/gltf.h"
#include "tests/fuzz/use.h"

namespace lacedring::fuzz {
namespace {

/// kLimits keeps the target fast. The results may be larger: kAgain is for them.
constexpr ReadOptions kLimits{.max_bytes = 8 << 20}, kAgain{.max_bytes = std::uint64_t{1} << 30};

/// Checks an unpacked scene: unpacking and reading it fails only for its size.
void check_unpacked(const SceneFile& scene) {
    const Result<Bytes> glb = make_glb_file(scene);
    REQUIRE(glb);
    REQUIRE(!is_packed_scene(*glb));
    const Result<SceneFile> again = unpack_scene(*glb, {}, "", kAgain);
    REQUIRE(again);
    const Result<Mesh> mesh = read_mesh(*glb, {}, {.format = MeshFormat::gltf, .max_bytes = 8 << 20});
    if (mesh) {
        check_mesh(*mesh);
    } else {
        check_message(mesh.error());  // parts that unpacking keeps unread may be invalid
    }
}

bool try_unpack(std::span<const std::byte> bytes) {
    const Result<SceneFile> scene = unpack_scene(bytes, {}, "", kLimits);
    if (!scene) {
        check_message(scene.error());
        return false;
    }
    check_unpacked(*scene);
    return true;
}

/// The input's length selects the options, so that mutations reach all of them.
bool try_pack(std::span<const std::byte> bytes) {
    PackOptions options;
    if (bytes.size() % 2 == 0) options.bits = {};
    options.keep_order = bytes.size() / 2 % 2 != 0;
    options.fallback = bytes.size() / 4 % 4 == 0;
    options.json = bytes.size() / 16 % 2 == 0 ? SceneJson::plain : SceneJson::packed;
    PackReport packed;
    const Result<SceneFile> scene = pack_scene(bytes, {}, options, kLimits, &packed);
    if (!scene) {
        check_message(scene.error());
        return false;
    }
    const Result<Bytes> glb = make_glb_file(*scene);
    REQUIRE(glb);
    REQUIRE(is_packed_scene(*glb));
    REQUIRE(!pack_scene(*glb, {}, options, kAgain));
    UnpackReport unpacked;
    const Result<SceneFile> plain = unpack_scene(*glb, {}, "", kAgain, &unpacked);
    REQUIRE(plain);
    REQUIRE(unpacked.primitives == packed.primitives);
    REQUIRE(unpacked.triangles == packed.triangles);
    check_unpacked(*plain);
    return true;
}

bool run_scene(std::span<const std::byte> bytes) {
    const bool unpacked = try_unpack(bytes);
    const bool packed = try_pack(bytes);
    return unpacked || packed;
}

}  // namespace

extern const Target scene_target{"scene", run_scene, mutate_scene};

}  // namespace lacedring::fuzz
