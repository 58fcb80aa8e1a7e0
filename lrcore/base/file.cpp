#include "lrcore/base/file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <string>
#include <utility>

namespace lr {
namespace {

struct CloseFile {
    void operator()(std::FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, CloseFile>;

}  // namespace

Result<std::vector<std::byte>> read_file(const std::filesystem::path& path) {
    std::error_code status;
    if (std::filesystem::is_directory(path, status)) return Error{ErrorCode::cannot_open, "is a folder"};
    File file(std::fopen(path.c_str(), "rb"));
    if (!file) return Error{ErrorCode::cannot_open, std::strerror(errno)};
    std::vector<std::byte> bytes;
    if (const auto size = std::filesystem::file_size(path, status); !status)
        bytes.reserve(size + 1);  // one more, to see the end without growing
    std::size_t used = 0;
    while (true) {  // sizes of pipes and devices are not known beforehand
        if (used == bytes.capacity()) bytes.reserve(used == 0 ? 65536 : used * 2);
        bytes.resize(bytes.capacity());
        const std::size_t got = std::fread(bytes.data() + used, 1, bytes.size() - used, file.get());
        used += got;
        bytes.resize(used);
        if (got == 0) break;
    }
    if (std::ferror(file.get()) != 0) return Error{ErrorCode::cannot_open, "read error"};
    return bytes;
}

namespace {

/// Writes all parts. Empty, or why not.
std::string write_all(int fd, std::span<const std::span<const std::byte>> parts) {
    for (std::span<const std::byte> part : parts) {
        while (!part.empty()) {
            const ::ssize_t put = ::write(fd, part.data(), part.size());
            if (put < 0 && errno == EINTR) continue;
            if (put < 0) return std::strerror(errno);
            part = part.subspan(static_cast<std::size_t>(put));
        }
    }
    return {};
}

Error cannot_write(std::string why) {
    return {ErrorCode::cannot_write, std::move(why)};
}

}  // namespace

Result<void> write_file(const std::filesystem::path& path, std::span<const std::span<const std::byte>> parts) {
    std::error_code status;
    std::filesystem::path target = path;
    // A link stays; what it leads to is written, even if that does not exist yet. Sixteen links deep is a loop.
    for (int depth = 0; depth < 16 && std::filesystem::is_symlink(target, status); ++depth) {
        const std::filesystem::path to = std::filesystem::read_symlink(target, status);
        if (status) return cannot_write(status.message());
        target = to.is_absolute() ? to : target.parent_path() / to;
    }
    if (std::filesystem::is_directory(target, status)) return cannot_write("is a folder");
    const auto existing = std::filesystem::status(target, status);
    // A device, a pipe or a file under a descriptor's name is written in place: renaming over it would replace it.
    const std::string name = path.string();
    if ((std::filesystem::exists(existing) && !std::filesystem::is_regular_file(existing)) ||
        name.starts_with("/dev/") || name.starts_with("/proc/")) {
        const int fd = ::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
        if (fd < 0) return cannot_write(std::strerror(errno));
        const std::string why = write_all(fd, parts);
        if (::close(fd) != 0 || !why.empty()) return cannot_write(why.empty() ? std::strerror(errno) : why);
        return {};
    }
    std::filesystem::path folder = target.parent_path();
    if (folder.empty()) folder = ".";
    std::filesystem::path temporary = target;
    temporary += ".part" + std::to_string(::getpid());
    // Without a name while it is written, so that a killed process leaves nothing behind; where the file system cannot
    // do that, under the temporary name.
    int fd = ::open(folder.c_str(), O_TMPFILE | O_WRONLY | O_CLOEXEC, 0666);
    const bool nameless = fd >= 0;
    if (!nameless) fd = ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    if (fd < 0) return cannot_write(std::strerror(errno));
    std::string why = write_all(fd, parts);
    if (why.empty() && std::filesystem::exists(existing)) {
        (void)::fchmod(fd,
                       static_cast<::mode_t>(existing.permissions()));  // best effort: who may read it stays as it was
    }
    if (why.empty() && nameless) {
        ::unlink(temporary.c_str());
        const std::string link = "/proc/self/fd/" + std::to_string(fd);
        if (::linkat(AT_FDCWD, link.c_str(), AT_FDCWD, temporary.c_str(), AT_SYMLINK_FOLLOW) != 0)
            why = std::strerror(errno);
    }
    if (::close(fd) != 0 && why.empty()) why = std::strerror(errno);
    if (why.empty()) {
        std::filesystem::rename(temporary, target, status);
        if (!status) return {};
        why = status.message();
    }
    std::filesystem::remove(temporary, status);
    return cannot_write(why);
}

}  // namespace lr
