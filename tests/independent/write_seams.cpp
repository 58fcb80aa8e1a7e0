// Writes seam sections, some of them mutated, for test_seams.py. Each is words: the numbers of vertices, triangles and
// section words, the triangles, the section, whether it is accepted, and if so the copies of the corners.

#include <cstdio>
#include <cstdlib>
#include <map>

#include "lacedring/seams.hpp"
#include "lrcore/base/crc32.h"
#include "tests/support/meshes.h"
#include "tests/support/shapes.h"

using namespace lacedring;

namespace {

using Words = std::vector<std::uint32_t>;

void put(const Words& words) {
    if (std::fwrite(words.data(), 4, words.size(), stdout) != words.size()) std::exit(1);
}

void write(const Words& section, const Words& triangles, std::uint32_t vertices) {
    const Result<SeamView> view = validate_seams(section, triangles, vertices);
    put({vertices, static_cast<std::uint32_t>(triangles.size() / 3), static_cast<std::uint32_t>(section.size())});
    put(triangles);
    put(section);
    put({view ? 1U : 0U});
    if (!view) return;
    Words copies(triangles.size());
    decode_seams(*view, triangles, copies);
    put(copies);
}

}  // namespace

int main() {
    test::SplitMix64 random(1);
    for (const test::NamedMesh& named : test::named_meshes()) {
        const Mesh& mesh = named.mesh;
        if (mesh.triangle_count() > 2000) continue;
        Words triangles, copies;
        for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
            const std::uint32_t* t = &mesh.indices[i];
            if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) triangles.insert(triangles.end(), t, t + 3);
            if (random.below(20) == 0) triangles.insert(triangles.end(), 3, UINT32_MAX);
        }
        std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> numbers;
        std::uint32_t chart = 0;
        for (std::size_t c = 0; c < triangles.size(); ++c) {
            if (random.below(30) == 0) chart = random.below(5);
            const auto number = static_cast<std::uint32_t>(numbers.size());
            copies.push_back(numbers.emplace(std::pair(triangles[c], chart), number).first->second);
        }
        const Result<EncodedSeams> seams = encode_seams(triangles, mesh.vertex_count, copies);
        if (!seams) return 1;
        write(seams->words, triangles, mesh.vertex_count);
        for (std::uint32_t n = 0; n < 3; ++n) {
            Words changed = seams->words;
            changed[random.below(static_cast<std::uint32_t>(changed.size()))] ^= 1U << random.below(32);
            changed[1] = crc32(std::as_bytes(std::span(changed).subspan(2)));
            write(changed, triangles, mesh.vertex_count);
        }
    }
    return 0;
}
