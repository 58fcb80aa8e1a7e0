// Writes small valid streams, .lr files and inputs of the chain: fuzz_stream_seeds FOLDER makes FOLDER/lean/NAME, ...

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <string>

#include "lrcore/codec/lean/lean_encode.h"
#include "lrcore/codec/packed/packed_encode.h"
#include "lrcore/codec/tables/lr_encode.h"
#include "lrcore/ring/optimize.h"
#include "lrio/file/file.h"
#include "lrio/file/lr_file.h"
#include "lrlab/generate/generate.h"
#include "tests/support/meshes.h"

using namespace lr;

namespace {

std::filesystem::path folder;
bool all_written = true;

void write(const char* target, const std::string& name, std::span<const std::byte> bytes) {
    if (bytes.size() > 8192) return;  // scripts/fuzz would cut it off
    std::filesystem::create_directories(folder / target);
    const std::span<const std::byte> parts[] = {bytes};
    all_written = write_file(folder / target / name, parts).has_value() && all_written;
}

void write_stream(const char* target, const std::string& name, const Mesh& mesh, Connectivity kind,
                  const std::vector<std::uint32_t>& words, const std::vector<std::uint32_t>& vertex_order,
                  const std::vector<std::uint32_t>& triangle_order) {
    write(target, name, std::as_bytes(std::span(words)));
    if (mesh.triangle_count() > 60) return;
    write("lr_file", std::string(target) + "-" + name,
          serialize_lr(make_lr_file(mesh, kind, words, vertex_order, triangle_order, mesh.triangle_count() % 2 == 0)));
}

void write_seeds(std::string name, const Mesh& mesh, std::uint32_t number) {
    std::replace(name.begin(), name.end(), ' ', '-');
    const CornerTable table = build_corner_table(mesh.indices, mesh.vertex_count).value();
    Rings rings = expand_rings(table, {.k = number % 4});
    if (number % 2 == 0) rings = optimize_rings(table, std::move(rings), {.passes = 2});
    const Result<LeanStream> lean = encode_lean(table, rings);
    write_stream("lean", name, mesh, Connectivity::lean, lean->words, lean->vertex_order, lean->slot_triangle);
    for (const PackedProfile profile : {PackedProfile::small, PackedProfile::cache}) {
        const Result<PackedStream> packed = encode_packed(table, rings, profile);
        write_stream("packed", name + (profile == PackedProfile::cache ? "-cache" : ""), mesh, Connectivity::packed,
                     packed->words, packed->vertex_order, packed->triangle_order);
    }
    if (mesh.triangle_count() <= 200) {
        const Result<EncodedLr> lr = encode_lr(table, {.k = number % 4});
        write_stream("lr", name, mesh, Connectivity::lr, lr->words, lr->vertex_order, lr->triangle_order);
        const std::array<std::uint32_t, 1> periods{number % 4};
        const Result<EncodedLr> compact = encode_compact_lr(table, {}, periods);
        write_stream("lr_compact", name, mesh, Connectivity::lr_compact, compact->words, compact->vertex_order,
                     compact->triangle_order);
    }
    if (mesh.vertex_count <= 256 && mesh.triangle_count() <= 100) {
        std::vector<std::byte> input;
        for (const std::uint32_t v : mesh.indices) input.push_back(static_cast<std::byte>(v));
        const std::uint32_t warts = number % 3 == 0 ? 0x80 : 0, copies = number % 5 == 0 ? 2 + number % 8 * 2 : 0;
        for (const std::uint32_t option : {0x40U | warts, number % 7, number % 3, number % 4, number, 255U, copies, 3U,
                                           number % 2 == 0 ? 0U : 1U << number % 6}) {
            input.push_back(static_cast<std::byte>(option));
        }
        write("chain_indices", name, input);
    }
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 2) return 2;
    folder = argv[1];
    std::uint32_t number = 0;
    for (const test::NamedMesh& named : test::named_meshes()) {
        if (named.mesh.triangle_count() <= 200) write_seeds(named.name, named.mesh, number);
        ++number;
    }
    for (const char* kind : {"blob", "terrain", "parts", "soup", "genus"}) {  // of several blocks, and groups of blocks
        write_seeds(std::string(kind) + "-600", generate(kind, 600).value(), number++);
        write_seeds(std::string(kind) + "-4600", generate(kind, 4600).value(), number++);
    }
    if (!all_written) std::fprintf(stderr, "%s: cannot be written\n", argv[1]);
    return all_written ? 0 : 1;
}
