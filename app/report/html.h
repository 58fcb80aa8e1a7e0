#pragma once
// Pieces of HTML text: escaping, numbers, data URIs.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace lacedring::app {

/// Escapes `text` for an element or a quoted attribute. Characters that HTML cannot hold (control characters, invalid
/// UTF-8) are replaced by visible ones.
std::string escape_html(std::string_view text);

/// A file name: escaped, and isolated so that right-to-left letters do not reorder the text around it.
std::string name_html(std::string_view name);

/// "28,944"
std::string grouped(std::uint64_t number);
/// "1.332"; a dash if there is none (NaN, infinity).
std::string fixed(double number, int decimals);
/// "1 vertex", "2,000 vertices"
std::string counted(std::uint64_t number, std::string_view one, std::string_view many);

/// "data:image/png;base64,..."
std::string png_uri(std::span<const std::byte> png);

/// Quotes an argument, if needed, for a POSIX shell.
std::string shell_word(std::string_view argument);

}  // namespace lacedring::app
