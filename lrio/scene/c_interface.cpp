// The C interface scene.h, on top of scene.hpp.

#include <cstdlib>
#include <cstring>
#include <new>

#include "lacedring/scene.h"
#include "lacedring/scene.hpp"
#include "lrcore/base/try.h"
#include "lrcore/codec/c_message.h"

namespace lacedring {
namespace {

lacedring_code scene_code(ErrorCode code) {
    switch (code) {
        case ErrorCode::too_large:
            return LACEDRING_CODE_TOO_LARGE;
        case ErrorCode::memory_limit:
            return LACEDRING_CODE_OUT_OF_MEMORY;
        case ErrorCode::invalid_argument:
            return LACEDRING_CODE_INVALID_ARGUMENT;
        default:  // all other errors are about the bytes
            return LACEDRING_CODE_MALFORMED;
    }
}

Result<std::vector<std::byte>> plain_glb(std::span<const std::byte> bytes, std::uint64_t max_bytes) {
    LR_ASSIGN(const auto scene, unpack_scene(bytes, "", "", {.max_bytes = max_bytes}));
    return make_glb_file(scene);
}

}  // namespace
}  // namespace lacedring

using namespace lacedring;

int lacedring_is_packed_scene(const void* bytes, std::size_t size) {
    if (bytes == nullptr) return 0;
    try {
        return is_packed_scene({static_cast<const std::byte*>(bytes), size}) ? 1 : 0;
    } catch (...) {  // std::bad_alloc
        return 0;
    }
}

lacedring_code lacedring_unpack_scene(const void* bytes, std::size_t size, std::uint64_t max_bytes, unsigned char** glb,
                                      std::size_t* glb_size, lacedring_message* message) {
    if (glb != nullptr) *glb = nullptr;
    if (glb_size != nullptr) *glb_size = 0;
    if (bytes == nullptr || glb == nullptr || glb_size == nullptr) {
        return fail_with(LACEDRING_CODE_INVALID_ARGUMENT, "a null pointer", message);
    }
    return guarded(message, [&] {
        const auto plain = plain_glb({static_cast<const std::byte*>(bytes), size}, max_bytes);
        if (!plain) return fail_with(scene_code(plain.error().code), plain.error().message, message);
        void* out = std::malloc(plain->size());
        if (out == nullptr) throw std::bad_alloc();
        std::memcpy(out, plain->data(), plain->size());
        *glb = static_cast<unsigned char*>(out);
        *glb_size = plain->size();
        return LACEDRING_CODE_OK;
    });
}

void lacedring_free(void* memory) {
    std::free(memory);
}
