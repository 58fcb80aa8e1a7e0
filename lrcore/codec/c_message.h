#pragma once
// Messages of the C interfaces.

#include <algorithm>
#include <cstring>
#include <string_view>

#include "lacedring/lacedring.h"

namespace lacedring {

/// Writes the text to the message, which may be null, and returns the code.
inline lacedring_code fail_with(lacedring_code code, std::string_view text, lacedring_message* message) {
    if (message != nullptr) {
        const std::size_t size = std::min(text.size(), sizeof message->text - 1);
        std::memcpy(message->text, text.data(), size);
        message->text[size] = 0;
    }
    return code;
}

/// Returns work()'s code, or OUT_OF_MEMORY if it throws: no exception reaches C callers.
template <class Work>
lacedring_code guarded(lacedring_message* message, Work work) {
    try {
        return work();
        // std::bad_alloc, or std::length_error if size_t has 32 bits.
    } catch (...) {
        return fail_with(LACEDRING_CODE_OUT_OF_MEMORY, lacedring_code_string(LACEDRING_CODE_OUT_OF_MEMORY), message);
    }
}

}  // namespace lacedring
