#pragma once
// Prints text on standard output and standard error. A failing stream (closed, disk full) does not end a command: main
// checks standard output after the command, and failures of standard error are ignored.

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
    (void)std::fwrite(text.data(), 1, text.size(), stream);  // the stream remembers a failure
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

/// Replaces line ends and other control characters, which a terminal would obey, in text or names from files.
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
