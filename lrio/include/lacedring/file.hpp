#pragma once
// Reads, maps and writes whole files.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <utility>
#include <vector>

#include "lacedring/base.hpp"

namespace lacedring {

/// Reads a whole regular file. Refuses pipes, devices and the files of /proc and /sys: reading them may block forever,
/// never end, or have side effects.
/// Errors: cannot_open (missing, a folder, no permission, not a regular file), too_large (more than `most` bytes).
Result<std::vector<std::byte>> read_file(const std::filesystem::path& path, std::uint64_t most = UINT64_MAX);

/// Reads the first `count` bytes of a regular file, or all if it is shorter. Errors: cannot_open, as read_file.
Result<std::vector<std::byte>> read_file_start(const std::filesystem::path& path, std::uint64_t count);

/// A regular file mapped into memory for reading; the mapping is page-aligned. If another process truncates the file,
/// reading beyond its new end raises SIGBUS: map only files that nobody else changes.
class MappedFile {
  public:
    /// Errors: cannot_open, as read_file.
    static Result<MappedFile> open(const std::filesystem::path& path);

    MappedFile(MappedFile&& other) noexcept : bytes_(std::exchange(other.bytes_, {})) {}
    MappedFile& operator=(MappedFile&& other) noexcept {
        std::swap(bytes_, other.bytes_);
        return *this;
    }
    ~MappedFile();

    std::span<const std::byte> bytes() const { return bytes_; }

  private:
    explicit MappedFile(std::span<const std::byte> bytes) : bytes_(bytes) {}
    std::span<const std::byte> bytes_;
};

/// Reads an open descriptor, which may be a pipe, to its end. Errors: cannot_open (a read error), too_large.
Result<std::vector<std::byte>> read_descriptor(int descriptor, std::uint64_t most = UINT64_MAX);

/// Writes `parts` one after the other to an unnamed file, then names it `path`. So `path` is complete or untouched even
/// if the process is killed; an existing file's permissions are kept. Several threads or processes may write one path
/// at once; the last writer wins. Follows symbolic links; writes devices, pipes and descriptors (/dev/stdout) in place.
/// Errors: cannot_write (also for a loop of links).
Result<void> write_file(const std::filesystem::path& path, std::span<const std::span<const std::byte>> parts);

/// Writes `parts` to an open descriptor. Errors: cannot_write.
Result<void> write_descriptor(int descriptor, std::span<const std::span<const std::byte>> parts);

}  // namespace lacedring
