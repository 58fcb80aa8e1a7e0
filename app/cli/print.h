#pragma once
// Text on standard output and standard error. A stream that is closed, or whose disk is full, ends no command: main
// looks at standard output once the command is done, and what standard error cannot say is lost.

#include <fmt/format.h>

#include <cstdint>
#include <cstdio>
#include <iterator>
#include <string>
#include <utility>

namespace lacedring::app {

inline void write_text(std::FILE* stream, fmt::string_view format, fmt::format_args args) {
    fmt::memory_buffer text;
    fmt::vformat_to(std::back_inserter(text), format, args);
    (void)std::fwrite(text.data(), 1, text.size(), stream);  // a failure stays with the stream
}

/// Writes results on standard output.
template <class... Args>
void print(fmt::format_string<Args...> format, Args&&... args) {
    write_text(stdout, format, fmt::make_format_args(args...));
}

/// Writes errors, notes and progress on standard error.
template <class... Args>
void say(fmt::format_string<Args...> format, Args&&... args) {
    write_text(stderr, format, fmt::make_format_args(args...));
}

/// Text out of a file, or a file's name, without line ends and other control characters that a terminal would obey.
inline std::string printable(std::string text, char instead = '?') {
    for (char& c : text) {
        if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = instead;
    }
    return text;
}

/// "1 triangle", "12 triangles"
inline std::string count_text(std::uint64_t count, const std::string& thing) {
    return fmt::format("{} {}{}", count, thing, count == 1 ? "" : "s");
}

/// "12 vertices", or with seams "12 vertices, 15 copies".
inline std::string vertices_text(std::size_t vertices, std::size_t copies) {
    return copies == vertices ? fmt::format("{} vertices", vertices)
                              : fmt::format("{} vertices, {} copies", vertices, copies);
}

}  // namespace lacedring::app
