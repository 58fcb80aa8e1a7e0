#pragma once
// Whole files in and out.

#include <cstddef>
#include <filesystem>
#include <span>
#include <vector>

#include "lrcore/base/result.h"

namespace lr {

/// The whole file. Errors: cannot_open (missing, a folder, no permission), too_large.
Result<std::vector<std::byte>> read_file(const std::filesystem::path& path);

/// Writes `parts` one after the other to a temporary file beside `path`, then renames it: `path` is whole or untouched, and
/// keeps its permissions. A link is followed; devices and pipes are written in place.
/// Errors: cannot_write.
Result<void> write_file(const std::filesystem::path& path, std::span<const std::span<const std::byte>> parts);

}  // namespace lr
