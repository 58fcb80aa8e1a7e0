#pragma once
// What each format is, in a few words.

#include <string_view>

namespace lacedring::app {

/// Whose idea a format is.
enum class Origin { ours, paper, baseline };
struct FormatNote {
    Origin origin;
    const char* what;  ///< in a few words
};
FormatNote note_on(std::string_view format);

}  // namespace lacedring::app
