// Prints a line per mesh and format: size and CRC-32 of the stream, of its orders and of the mesh.

#include <cstdio>

#include "lacedring/lacedring.hpp"
#include "lrcore/base/crc32.h"
#include "lrlab/generate/generate.h"
#include "tests/support/meshes.h"

using namespace lacedring;

namespace {

std::uint32_t crc_of(const std::vector<std::uint32_t>& words) {
    return crc32(std::as_bytes(std::span(words)));
}

void print(const char* name, const Mesh& mesh) {
    std::uint32_t attributes = 0;
    for (const Attribute& attribute : mesh.attributes) attributes = crc32(attribute.data, attributes);
    std::printf("%s: mesh %08x %08x\n", name, crc_of(mesh.indices), attributes);
    for (const Format format : {Format::lean, Format::packed, Format::lr, Format::lr_compact}) {
        for (const PackedProfile profile : {PackedProfile::small, PackedProfile::cache}) {
            if (profile == PackedProfile::cache && format != Format::packed) continue;
            const Result<Encoded> e = encode(mesh.indices, mesh.vertex_count, {.format = format, .profile = profile});
            if (!e) {
                std::printf("%s: %s: %s\n", name, name_of(format), e.error().message.c_str());
                continue;
            }
            std::printf("%s: %s%s: %lu words %08x %08x %08x\n", name, name_of(format),
                        profile == PackedProfile::cache ? " cache" : "", static_cast<unsigned long>(e->words.size()),
                        crc_of(e->words), crc_of(e->vertex_order), crc_of(e->triangle_order));
        }
    }
}

}  // namespace

int main() {
    for (const test::NamedMesh& named : test::named_meshes()) print(named.name.c_str(), named.mesh);
    for (const GeneratorInfo& kind : generators()) {
        const Result<Mesh> mesh = generate(kind.name, 50000, 3);
        if (mesh) print(std::string(kind.name).append(" of 50,000").c_str(), *mesh);
    }
}
