#pragma once
// A short description of each format.

#include <string_view>

namespace lacedring::app {

/// Who designed a format.
enum class Origin { ours, paper, baseline };
struct FormatNote {
    Origin origin;
    const char* what;  ///< the description
};
FormatNote note_on(std::string_view format);

}  // namespace lacedring::app
