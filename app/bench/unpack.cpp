#include "app/bench/unpack.h"

#include <algorithm>
#include <cstring>
#include <memory>
#include <thread>
#include <utility>

#include "app/formats/formats.h"
#include "lacedring/lacedring_storage.h"
#include "lacedring/lr_file.hpp"
#include "lacedring/mesh_files.hpp"
#include "lacedring/scene.hpp"
#include "lrlab/rivals/whole_mesh.h"

namespace lacedring::app {
namespace {

constexpr ReadOptions kNoLimit{.max_bytes = UINT64_MAX};
constexpr int kSmallestDraco = 10;  // level

using Bytes = std::vector<std::byte>;

Result<Bytes> packed_glb(const Mesh& mesh) {
    const auto plain = mesh_file_bytes(mesh, MeshFormat::gltf);
    if (!plain) return plain.error();
    PackOptions options;
    options.bits.threads = std::max(1U, std::thread::hardware_concurrency());
    options.form = LrForm::resident;  // restore_candidates times storage form
    const Result<SceneFile> packed = pack_scene(*plain, {}, options, kNoLimit);
    if (!packed) return packed.error();
    return make_glb_file(*packed);
}

/// Adds a candidate that decodes the bytes in `made`; if making or decoding them fails, adds it to out.absent.
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

/// The words of the connectivity and of the positions in storage form.
struct StoredParts {
    std::uint32_t vertices = 0, triangles = 0;
    std::vector<std::uint32_t> packed, positions;
};

Result<StoredParts> stored_parts(std::span<const std::byte> file) {
    const Result<LrContents> contents = list_lr(file);
    if (!contents) return contents.error();
    StoredParts out{contents->vertices, contents->input_triangles, {}, {}};
    // docs/lr-file.md: sections begin at multiples of 8.
    constexpr std::size_t kHead = 32, kEntry = 32, kName = 8;
    std::size_t at = kHead + kEntry * contents->sections.size();
    for (const LrSection& section : contents->sections) {
        const auto bytes = file.subspan(at, section.bytes).subspan(section.name.empty() ? 0 : kName);
        at += (section.bytes + 7) / 8 * 8;
        if (!section.stored) continue;
        std::vector<std::uint32_t>& words = section.kind == "packed" ? out.packed : out.positions;
        words.resize(bytes.size() / 4);
        std::memcpy(words.data(), bytes.data(), 4 * words.size());
    }
    if (out.packed.empty() || out.positions.empty())
        return Error{ErrorCode::unsupported, "a stream is not in storage form"};
    return out;
}

/// Decodes triangles and positions with lacedring_storage.h, without making resident streams. False: malformed.
bool decode_arrays(const StoredParts& parts) {
    const auto memory = [](std::size_t bytes) { return std::make_unique_for_overwrite<std::byte[]>(bytes); };
    const auto numbers = [](std::size_t count) { return std::make_unique_for_overwrite<std::uint32_t[]>(count); };
    lacedring_stored_packed mesh;
    if (lacedring_stored_packed_open(parts.packed.data(), parts.packed.size(), parts.vertices, parts.triangles, &mesh,
                                     nullptr) != LACEDRING_STATUS_OK)
        return false;
    const auto triangles = numbers(std::size_t{3} * mesh.triangles);
    if (lacedring_stored_packed_decode(&mesh, memory(lacedring_stored_packed_scratch(&mesh)).get(), triangles.get(),
                                       nullptr) != LACEDRING_STATUS_OK)
        return false;
    lacedring_stored_vertices stored;
    if (lacedring_stored_vertices_open(parts.positions.data(), parts.positions.size(), mesh.vertices, &stored,
                                       nullptr) != LACEDRING_STATUS_OK)
        return false;
    const auto scratch = memory(lacedring_stored_vertices_scratch(&stored, mesh.triangles, nullptr));
    const auto integers = numbers(std::size_t{mesh.vertices} * stored.attribute.components);
    if (lacedring_stored_vertices_decode(&stored, triangles.get(), mesh.triangles, nullptr, scratch.get(),
                                         integers.get(), nullptr) != LACEDRING_STATUS_OK)
        return false;
    const auto positions = std::make_unique_for_overwrite<float[]>(std::size_t{3} * mesh.vertices);
    lacedring_stored_vertices_values(&stored, integers.get(), positions.get());
    return true;
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
    if (const auto parts = stored_parts(stored)) {
        add(out, "lacedring_arrays", stored, [parts = *parts](std::span<const std::byte>) -> Result<void> {
            if (decode_arrays(parts)) return {};
            return Error{ErrorCode::malformed, "lacedring_storage.h refuses it"};
        });
    } else {
        out.absent.emplace_back("lacedring_arrays", parts.error().message);
    }
    alone.indices = without_degenerate(mesh.indices);
    add(out, "draco", draco_bytes(alone, bits, kSmallestDraco), decode_draco);
    return out;
}

}  // namespace lacedring::app
