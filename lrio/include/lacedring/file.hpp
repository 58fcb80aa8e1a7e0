#pragma once
// Whole files in and out.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <utility>
#include <vector>

#include "lacedring/base.hpp"

namespace lacedring {

/// Reads a whole regular file. Pipes, devices and what /proc and /sys hold are refused without being opened for long:
/// reading one may block for ever, never end, or have an effect.
/// Errors: cannot_open (missing, a folder, no permission, not a regular file), too_large (more than `most` bytes).
Result<std::vector<std::byte>> read_file(const std::filesystem::path& path, std::uint64_t most = UINT64_MAX);

/// Reads the first `count` bytes of a regular file, fewer where it is shorter. Errors: cannot_open, as read_file.
Result<std::vector<std::byte>> read_file_start(const std::filesystem::path& path, std::uint64_t count);

/// A regular file mapped into memory for reading, at the start of a page. Whoever truncates the file while it is mapped
/// makes reads behind its new end fatal (SIGBUS): for files of one's own.
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

/// Reads what is left of an open descriptor, of a pipe too. Errors: cannot_open (a read error), too_large.
Result<std::vector<std::byte>> read_descriptor(int descriptor, std::uint64_t most = UINT64_MAX);

/// Writes `parts` one after the other to a file without a name, then gives it the name `path`: `path` is whole or
/// untouched, whatever ends the process, and keeps its permissions. Threads and processes may write one path at once;
/// the last one stays. Links are followed; devices, pipes and descriptors (/dev/stdout) are written in place. Errors:
/// cannot_write (a loop of links, too).
Result<void> write_file(const std::filesystem::path& path, std::span<const std::span<const std::byte>> parts);

/// Writes `parts` to an open descriptor. Errors: cannot_write.
Result<void> write_descriptor(int descriptor, std::span<const std::span<const std::byte>> parts);

}  // namespace lacedring
