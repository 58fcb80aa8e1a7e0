// Decoders and validators allocate no memory for counts in a header that exceed the stream. A binary of its own,
// because it replaces operator new.

#include <doctest/doctest.h>

#include <cstdlib>
#include <new>

#include "lacedring/lacedring.hpp"
#include "lacedring/lr_file.hpp"
#include "lacedring/streams.hpp"
#include "lrcore/base/crc32.h"
#include "lrcore/codec/lean/lean_format.h"
#include "lrcore/codec/packed/packed_format.h"
#include "tests/support/meshes.h"

namespace {
std::size_t allocated = 0;  // bytes requested since the last reset, freed or not
}

// Not inlined: the compiler would warn that free() is called on memory of the standard operator new.
[[gnu::noinline]] void* operator new(std::size_t size) {
    allocated += size;
    void* const out = std::malloc(size);
    if (out == nullptr) throw std::bad_alloc();
    return out;
}
[[gnu::noinline]] void operator delete(void* p) noexcept {
    std::free(p);
}
[[gnu::noinline]] void operator delete(void* p, std::size_t) noexcept {
    std::free(p);
}

using namespace lacedring;

namespace {

// Far above what the streams below need.
constexpr std::size_t kLittle = 64 * 1024;

/// The bytes that work() allocates.
template <class Work>
std::size_t bytes_of(const Work& work) {
    allocated = 0;
    work();
    return allocated;
}

CornerTable table_of(const Mesh& mesh) {
    return build_corner_table(mesh.indices, mesh.vertex_count).value();
}

/// Two tetrahedra that share vertex 0, of which LR tables have a copy.
Mesh pinched() {
    return test::make_mesh({0, 1, 2, 0, 2, 3, 0, 3, 1, 1, 3, 2, 0, 4, 5, 0, 5, 6, 0, 6, 4, 4, 6, 5}, 7);
}

std::vector<std::uint32_t> lr_words(bool compact, std::uint32_t vertices) {
    const std::uint32_t periods[] = {0};
    Result<EncodedLr> encoded =
        compact ? encode_compact_lr(table_of(pinched()), {}, periods) : encode_lr(table_of(pinched()), {});
    REQUIRE(encoded);
    REQUIRE(encoded->copies == 1);
    std::vector<std::uint32_t> words = std::move(encoded->words);
    words[2] = vertices;
    const std::span<const std::uint32_t> all(words);
    words[9] = crc32(std::as_bytes(all.subspan(kLrHeaderWords)), crc32(std::as_bytes(all.first(9))));
    return words;
}

template <class Stream>
void check_lr(const Stream& stream) {
    REQUIRE(stream);
    CHECK(stream->view.vertices == (1U << 28) - 2);
    std::size_t indices = 0;
    CHECK(bytes_of([&] { indices = decode_lr(*stream).size(); }) < kLittle);
    CHECK(indices == 24);
}

}  // namespace

TEST_CASE("LR tables of 2^28 unused vertices decode in little memory") {
    const std::vector<std::uint32_t> standard = lr_words(false, (1U << 28) - 2),
                                     compact = lr_words(true, (1U << 28) - 2);
    CHECK(bytes_of([&] { CHECK(validate_lr(standard)); }) < kLittle);
    CHECK(bytes_of([&] { CHECK(validate_compact_lr(compact)); }) < kLittle);
    check_lr(view_lr(standard));
    check_lr(view_compact_lr(compact));
}

TEST_CASE("a lean stream of 2^29 unused vertices, or of counts beyond its words, is validated in little memory") {
    std::vector<std::uint32_t> words = encode_lean(table_of(pinched()), expand_rings(table_of(pinched())))->words;
    words[LR_LEAN_WORD_VERTICES] = 1U << 29;
    words[LR_LEAN_WORD_CHECKSUM] = lean_checksum(words);
    CHECK(bytes_of([&] { CHECK(validate_lean(words)); }) < kLittle);
    for (const std::size_t count : {LR_LEAN_WORD_RINGS2, LR_LEAN_WORD_RINGS1, LR_LEAN_WORD_VERBATIM}) {
        std::vector<std::uint32_t> bad = words;
        bad[count] = 1U << 28;
        bad[LR_LEAN_WORD_CHECKSUM] = lean_checksum(bad);
        CHECK(bytes_of([&] { CHECK_FALSE(validate_lean(bad)); }) < kLittle);
    }
}

TEST_CASE("a packed stream of counts beyond its words is validated in little memory") {
    const std::vector<std::uint32_t> words =
        encode_packed(table_of(pinched()), expand_rings(table_of(pinched())))->words;
    CHECK(bytes_of([&] { CHECK(validate_packed(words)); }) < kLittle);
    for (const std::size_t count : {LR_PACKED_WORD_VERTICES, LR_PACKED_WORD_TRIANGLES}) {
        for (const std::uint32_t many : {1U << 28, 1U << 29, UINT32_MAX}) {
            std::vector<std::uint32_t> bad = words;
            bad[count] = many;
            bad[LR_PACKED_WORD_CHECKSUM] = packed_checksum(bad);
            // More vertices may make a valid stream of another mesh by chance; more triangles cannot.
            CHECK(bytes_of([&] { CHECK((count == LR_PACKED_WORD_VERTICES || !validate_packed(bad))); }) < kLittle);
            CHECK(bytes_of([&] { (void)validate_packed(bad); }) < kLittle);
        }
    }
}

TEST_CASE("an .lr file whose connectivity has more vertices than the file is refused in little memory") {
    for (const Format format : {Format::lr, Format::lr_compact}) {
        CAPTURE(static_cast<int>(format));
        const Mesh mesh = pinched();
        LrFile file;
        file.vertex_count = mesh.vertex_count;
        file.input_triangles = 8;
        file.format = format;
        file.words = lr_words(format == Format::lr_compact, (1U << 28) - 2);
        for (const Attribute& attribute : mesh.attributes) file.attributes.push_back({attribute, {}});
        const std::vector<std::byte> bytes = serialize_lr(file);
        CHECK(bytes_of([&] { CHECK_FALSE(parse_lr(bytes)); }) < kLittle);
    }
}
