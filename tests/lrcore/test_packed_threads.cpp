// decode_packed and encode with threads, and where creating threads fails: this file replaces pthread_create.

#include <dlfcn.h>
#include <doctest/doctest.h>
#include <pthread.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <climits>
#include <cstdlib>

#include "lacedring/lacedring.hpp"
#include "lacedring/streams.hpp"
#include "lrlab/generate/generate.h"
#include "tests/support/meshes.h"

namespace {
// The threads that pthread_create may create, and those that it created.
std::atomic<int> allowed = INT_MAX, made = 0;
}  // namespace

extern "C" int pthread_create(pthread_t* thread, const pthread_attr_t* attributes, void* (*start)(void*),
                              void* argument) {
    static const auto real = reinterpret_cast<decltype(&pthread_create)>(dlsym(RTLD_NEXT, "pthread_create"));
    if (made >= allowed) return EAGAIN;
    ++made;
    return real(thread, attributes, start, argument);
}

using namespace lacedring;

namespace {

struct Sample {
    std::vector<std::uint32_t> words, indices;
    PackedView view;
};

EncodedPacked encode_packed_of(const Mesh& mesh) {
    const CornerTable table = build_corner_table(mesh.indices, mesh.vertex_count).value();
    return encode_packed(table, expand_rings(table)).value();
}

const Sample& sample() {
    static const Sample only = [] {
        Sample out;
        out.words = encode_packed_of(generate("sphere", 600000, 1).value()).words;
        out.view = validate_packed(out.words).value();
        out.indices.resize(std::size_t{3} * out.view.triangles);
        decode_packed(out.view, out.indices);
        return out;
    }();
    return only;
}

bool decodes(unsigned threads) {
    std::vector<std::uint32_t> out(sample().indices.size());
    decode_packed(sample().view, out, threads);
    return out == sample().indices;
}

}  // namespace

TEST_CASE("decode_packed gives the same indices with any number of threads") {
    for (const unsigned threads : {0U, 1U, 2U, 3U, 7U, 64U, 1000U, UINT_MAX}) {
        CAPTURE(threads);
        made = 0;
        CHECK(decodes(threads));
        CHECK(static_cast<unsigned>(made) <= (threads == 0 ? 0 : threads - 1));
        if (threads == 2) CHECK(made == 1);
    }
}

TEST_CASE("decode_packed gives the same indices where threads cannot be created") {
    for (const int most : {0, 1, 2}) {
        for (const unsigned threads : {2U, 4U, 1000U, UINT_MAX}) {
            CAPTURE(most);
            CAPTURE(threads);
            made = 0;
            allowed = most;
            CHECK(decodes(threads));
            allowed = INT_MAX;
            CHECK(made <= most);
        }
    }
}

TEST_CASE("encode creates only requested threads, and gives the same words where they cannot be created") {
    const Mesh mesh = generate("blob", 40000, 1).value();
    EncodeOptions options{.effort = 1};
    made = 0;
    const std::vector<std::uint32_t> words = encode(mesh.indices, mesh.vertex_count, options).value().words;
    CHECK(made == 0);
    options.threads = 2;
    CHECK(encode(mesh.indices, mesh.vertex_count, options).value().words == words);
    CHECK(made > 0);
    for (const int most : {0, 1, 2}) {
        CAPTURE(most);
        made = 0;
        allowed = most;
        options.threads = 8;
        CHECK(encode(mesh.indices, mesh.vertex_count, options).value().words == words);
        allowed = INT_MAX;
        CHECK(made <= most);
    }
}

TEST_CASE("decode_packed on two threads starts none for a small stream") {
    const Mesh mesh = generate("sphere", 100000, 1).value();
    const EncodedPacked small = encode_packed_of(mesh);
    const PackedView view = validate_packed(small.words).value();
    std::vector<std::uint32_t> out(std::size_t{3} * view.triangles);
    made = 0;
    decode_packed(view, out, 2);
    CHECK(made == 0);
}

// Skipped with sanitizers: their shadow memory needs the address space.
TEST_CASE("decode_packed gives the same indices where the address space has no room for a thread's stack" *
          doctest::skip(test::kSanitized)) {
    REQUIRE(decodes(1));
    const pid_t child = fork();
    REQUIRE(child >= 0);
    if (child == 0) {
        std::vector<std::uint32_t> out(sample().indices.size());
        const rlimit limit{64U << 20, 64U << 20};  // no room for a stack
        if (setrlimit(RLIMIT_AS, &limit) != 0) _exit(2);
        decode_packed(sample().view, out, 1000);
        _exit(out == sample().indices ? 0 : 1);
    }
    int status = 0;
    REQUIRE(waitpid(child, &status, 0) == child);
    CHECK(WIFEXITED(status));
    CHECK(WEXITSTATUS(status) == 0);
}
