#pragma once
// Builds error messages from words and numbers. Internal to lrcore.

#include <concepts>
#include <cstdint>
#include <string>
#include <string_view>

namespace lacedring::detail {

inline void append(std::string& out, std::string_view part) {
    out += part;
}
inline void append(std::string& out, std::integral auto number) {
    out += std::to_string(number);
}

/// Concatenates the parts; numbers in decimal.
template <class... Parts>
std::string message(const Parts&... parts) {
    std::string out;
    (append(out, parts), ...);
    return out;
}

/// "0x" and eight digits.
inline std::string hexadecimal(std::uint32_t word) {
    std::string out = "0x00000000";
    for (std::size_t i = out.size(); word != 0; word >>= 4) out[--i] = "0123456789abcdef"[word & 15];
    return out;
}

}  // namespace lacedring::detail
