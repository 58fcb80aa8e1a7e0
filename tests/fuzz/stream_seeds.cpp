// Writes small valid streams, .lr files and inputs of the chain: fuzz_stream_seeds FOLDER makes FOLDER/lean/NAME, ...

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <string>

#include "lacedring/file.hpp"
#include "lacedring/lacedring.hpp"
#include "lacedring/lr_file.hpp"
#include "lacedring/ring.hpp"
#include "lrlab/generate/generate.h"
#include "tests/support/meshes.h"

using namespace lacedring;

namespace {

std::filesystem::path folder;
bool all_written = true;

void write(const char* target, const std::string& name, std::span<const std::byte> bytes) {
    if (bytes.size() > 8192) return;  // scripts/fuzz would cut it off
    std::filesystem::create_directories(folder / target);
    const std::span<const std::byte> parts[] = {bytes};
    all_written = write_file(folder / target / name, parts).has_value() && all_written;
}

void write_stream(const char* target, const std::string& name, const Mesh& mesh, const Encoded& encoded) {
    write(target, name, encoded.bytes());
    if (mesh.triangle_count() > 60) return;
    write("lr_file", std::string(target) + "-" + name,
          serialize_lr(make_lr_file(mesh, encoded, mesh.triangle_count() % 2 == 0)));
}

void write_seeds(std::string name, const Mesh& mesh, std::uint32_t number) {
    std::replace(name.begin(), name.end(), ' ', '-');
    const CornerTable table = build_corner_table(mesh.indices, mesh.vertex_count).value();
    Rings rings = expand_rings(table, {.k = number % 4});
    if (number % 2 == 0) rings = optimize_rings(table, std::move(rings), {.passes = 2});
    write_stream("lean", name, mesh, as_encoded(*encode_lean(table, rings)));
    for (const PackedProfile profile : {PackedProfile::small, PackedProfile::cache}) {
        PackedChoice packed =
            encode_smallest_packed(table, {.k = number % 4}, {.passes = 2 - number % 2 * 2}, profile).value();
        write_stream("packed", name + (profile == PackedProfile::cache ? "-cache" : ""), mesh,
                     as_encoded(std::move(packed.stream)));
    }
    if (mesh.triangle_count() <= 200) {
        write_stream("lr", name, mesh, as_encoded(*encode_lr(table, {.k = number % 4})));
        const std::array<std::uint32_t, 1> periods{number % 4};
        write_stream("lr_compact", name, mesh, as_encoded(*encode_compact_lr(table, {}, periods)));
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
