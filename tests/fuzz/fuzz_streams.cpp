// Mutated streams with right checksums: validate refuses them, or they decode within bounds. Meant for the sanitizers.
//
//   fuzz_streams TRIALS [SEED]

#include <array>
#include <cstdio>
#include <cstdlib>
#include <memory>

#include "lrcore/base/crc32.h"
#include "lrcore/generate/generate.h"
#include "lrcore/lean/lean_format.h"
#include "lrcore/lean/lean_stream.h"
#include "lrcore/lr/lr_encode.h"
#include "lrcore/packed/packed_format.h"
#include "lrcore/packed/packed_stream.h"
#include "tests/support/lr_consistency.h"
#include "tests/support/meshes.h"

using namespace lr;

namespace {

using Words = std::vector<std::uint32_t>;

enum Kind : std::uint32_t { lean, packed, packed_cache, lr_tables, lr_compact, kinds };
constexpr std::array<const char*, kinds> kNames{"lean", "packed", "packed_cache", "lr", "lr_compact"};

std::uint64_t state = 1;

std::uint32_t random(std::uint32_t below) {
    state = state * 6364136223846793005U + 1442695040888963407U;
    return static_cast<std::uint32_t>((state >> 33) % below);
}

Mesh some_mesh() {
    const std::uint64_t seed = random(1000000);
    switch (random(4)) {
        case 0:
            return test::random_soup(8 + random(40), 1 + random(300), seed);
        case 1:
            return test::random_gluing(20 + random(100), 50 + random(600), seed);
        case 2:
            return generate("blob", 100 + random(600), seed).value();
        default:
            return generate("parts", 100 + random(600), seed).value();
    }
}

std::array<Words, kinds> streams_of(const Mesh& mesh) {
    std::array<Words, kinds> out;
    const CornerTable table = build_corner_table(mesh.indices, mesh.vertex_count).value();
    const Rings rings = expand_rings(table, {.seeds = 1, .random_seed = state, .k = random(4)});
    out[lean] = encode_lean(table, rings)->words;
    out[packed] = encode_packed(table, rings).value().words;
    out[packed_cache] = encode_packed(table, rings, PackedProfile::cache).value().words;
    if (auto tables = encode_lr(table, {})) out[lr_tables] = std::move(tables->words);
    const std::array<std::uint32_t, 1> period{random(40)};
    if (auto tables = encode_compact_lr(table, {}, period)) out[lr_compact] = std::move(tables->words);
    return out;
}

void mutate(Words& words) {
    for (std::uint32_t n = 1 + random(3); n > 0; --n) {
        std::uint32_t& word = words[random(static_cast<std::uint32_t>(words.size()))];
        switch (random(4)) {
            case 0:
                word ^= 1U << random(32);
                break;
            case 1:
                word = random(64);
                break;
            case 2:
                word = static_cast<std::uint32_t>(state);
                break;
            default:
                word += random(5) - 2;
        }
    }
    if (random(40) == 0) words.resize(random(static_cast<std::uint32_t>(words.size())));
}

void correct_checksum(Kind kind, Words& words) {
    if (kind == lean && words.size() >= LR_LEAN_HEADER_WORDS) words[LR_LEAN_WORD_CHECKSUM] = lean_checksum(words);
    if ((kind == packed || kind == packed_cache) && words.size() >= LR_PACKED_HEADER_WORDS) {
        words[LR_PACKED_WORD_CHECKSUM] = packed_checksum(words);
    }
    if (kind >= lr_tables && words.size() >= kLrHeaderWords) {
        const auto bytes = std::as_bytes(std::span(words));
        words[9] = crc32(bytes.subspan(4 * kLrHeaderWords), crc32(bytes.first(36)));
    }
}

void check(std::span<const std::uint32_t> indices, std::uint32_t vertices) {
    for (const std::uint32_t v : indices) {
        if (v < vertices) continue;
        std::printf("vertex %u of %u\n", v, vertices);
        std::abort();
    }
}

template <class View>
void check_operators(const View& view) {
    const std::string why = test::inconsistency(view);
    if (why.empty()) return;
    std::printf("accepted tables disagree: %s\n", why.c_str());
    std::abort();
}

/// Returns whether the stream is valid. A valid one is decoded, and every operator checked.
bool accepted(Kind kind, std::span<const std::uint32_t> words) {
    if (kind == lean) {
        const auto view = validate_lean(words);
        if (!view) return false;
        Words out(std::size_t{3} * view->slots());
        decode_lean(*view, out);
        check(out, view->vertices);
    } else if (kind == packed || kind == packed_cache) {
        const auto view = validate_packed(words);
        if (!view) return false;
        const std::size_t size = std::size_t{3} * view->triangles;
        const auto out = std::make_unique<std::uint32_t[]>(size);  // exactly, for the sanitizer
        decode_packed(*view, {out.get(), size});
        check({out.get(), size}, view->vertices);
        if (view->triangles != 0) check(decode_packed_triangle(*view, random(view->triangles)).v, view->vertices);
    } else if (kind == lr_tables) {
        const auto stream = validate_lr(words);
        if (!stream) return false;
        check(decode_lr(*stream), stream->view.vertices);
        check_operators(stream->view);
    } else {
        const auto stream = validate_compact_lr(words);
        if (!stream) return false;
        check(decode_lr(*stream), stream->view.vertices);
        check_operators(stream->view);
    }
    return true;
}

}  // namespace

int main(int argc, char** argv) {
    const long trials = argc > 1 ? std::strtol(argv[1], nullptr, 10) : 10000;
    if (argc > 2) state = std::strtoull(argv[2], nullptr, 10);
    std::printf("seed %llu\n", static_cast<unsigned long long>(state));
    std::array<std::array<long, 2>, kinds> counts{};
    for (long done = 0; done < trials;) {
        const std::array<Words, kinds> good = streams_of(some_mesh());
        for (int trial = 0; trial < 400 && done < trials; ++trial) {
            const auto kind = static_cast<Kind>(random(kinds));
            if (good[kind].empty()) continue;
            Words bad = good[kind];
            mutate(bad);
            correct_checksum(kind, bad);
            const auto exact = std::make_unique<std::uint32_t[]>(bad.size());
            std::copy(bad.begin(), bad.end(), exact.get());
            ++counts[kind][accepted(kind, {exact.get(), bad.size()}) ? 0 : 1];
            ++done;
        }
    }
    bool both = true;
    for (std::uint32_t kind = 0; kind < kinds; ++kind) {
        std::printf("%s: %ld accepted, %ld refused\n", kNames[kind], counts[kind][0], counts[kind][1]);
        both = both && counts[kind][0] > 0 && counts[kind][1] > 0;
    }
    return both ? 0 : 1;  // mutations that are all refused, or none, test nothing
}
