#include "lacedring/file.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>
#ifdef __linux__
#include <sys/vfs.h>
#endif

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <optional>
#include <string>
#include <utility>

#include "lrcore/base/try.h"

namespace lacedring {
namespace {

namespace fs = std::filesystem;

/// A file descriptor that is closed at the end of its scope.
class Descriptor {
  public:
    explicit Descriptor(int number) : number_(number) {}
    Descriptor(Descriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
    Descriptor& operator=(Descriptor&& other) noexcept {
        std::swap(number_, other.number_);
        return *this;
    }
    ~Descriptor() {
        if (number_ >= 0) ::close(number_);
    }

    int number() const { return number_; }
    bool good() const { return number_ >= 0; }
    /// False, with errno, if written data could not be saved.
    bool close() { return ::close(std::exchange(number_, -1)) == 0; }

  private:
    int number_;
};

Error cannot_open(std::string why) {
    return {ErrorCode::cannot_open, std::move(why)};
}
Error cannot_write(std::string why) {
    return {ErrorCode::cannot_write, std::move(why)};
}

/// Is the descriptor a file of /proc or /sys, which stat calls regular?
bool is_system_table([[maybe_unused]] int descriptor) {
#ifdef __linux__
    constexpr long kProc = 0x9fa0, kSys = 0x62656572;
    struct ::statfs where {};
    return ::fstatfs(descriptor, &where) == 0 && (where.f_type == kProc || where.f_type == kSys);
#else
    return false;
#endif
}

struct OpenFile {
    Descriptor descriptor;
    std::uint64_t size;
};

Result<OpenFile> open_regular(const fs::path& path) {
    struct ::stat what {};
    if (::stat(path.c_str(), &what) != 0) return cannot_open(std::strerror(errno));
    if (S_ISDIR(what.st_mode)) return cannot_open("is a folder");
    constexpr const char* kNotRegular = "is not a regular file";
    if (!S_ISREG(what.st_mode)) return cannot_open(kNotRegular);
    // O_NONBLOCK: a pipe may have replaced the file since it was examined.
    Descriptor file(::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC));
    if (!file.good()) return cannot_open(std::strerror(errno));
    if (::fstat(file.number(), &what) != 0 || !S_ISREG(what.st_mode) || is_system_table(file.number())) {
        return cannot_open(kNotRegular);
    }
    return OpenFile{std::move(file), static_cast<std::uint64_t>(what.st_size)};
}

/// Reads up to `most` bytes; `expected` is the probable size.
Result<std::vector<std::byte>> read_up_to(int descriptor, std::uint64_t most, std::uint64_t expected) {
    constexpr std::size_t kLeast = 65536;
    std::vector<std::byte> bytes;
    // One byte more than expected, so that the read that finds the end needs no larger buffer.
    bytes.resize(static_cast<std::size_t>(std::min(most, expected + 1)));
    std::size_t used = 0;
    while (used < most) {
        if (used == bytes.size()) {
            bytes.resize(static_cast<std::size_t>(std::min<std::uint64_t>(most, std::max(kLeast, 2 * used))));
        }
        const ::ssize_t got = ::read(descriptor, bytes.data() + used, bytes.size() - used);
        if (got < 0 && errno == EINTR) continue;
        if (got < 0) return cannot_open(std::string("read error: ") + std::strerror(errno));
        if (got == 0) break;
        used += static_cast<std::size_t>(got);
    }
    bytes.resize(used);
    return bytes;
}

Error too_large(std::uint64_t most) {
    return {ErrorCode::too_large, "has more than " + std::to_string(most) + " bytes"};
}

}  // namespace

Result<std::vector<std::byte>> read_file(const fs::path& path, std::uint64_t most) {
    LR_ASSIGN(const OpenFile file, open_regular(path));
    if (file.size > most) return too_large(most);
    Result<std::vector<std::byte>> bytes =
        read_up_to(file.descriptor.number(), most == UINT64_MAX ? most : most + 1, file.size);
    if (bytes && bytes->size() > most) return too_large(most);  // the file grew meanwhile
    return bytes;
}

Result<std::vector<std::byte>> read_file_start(const fs::path& path, std::uint64_t count) {
    LR_ASSIGN(const OpenFile file, open_regular(path));
    return read_up_to(file.descriptor.number(), count, std::min(file.size, count));
}

Result<MappedFile> MappedFile::open(const fs::path& path) {
    LR_ASSIGN(const OpenFile file, open_regular(path));
    if (file.size == 0) return MappedFile({});
    if (file.size > SIZE_MAX) return too_large(SIZE_MAX);
    const auto size = static_cast<std::size_t>(file.size);
    void* at = ::mmap(nullptr, size, PROT_READ, MAP_PRIVATE, file.descriptor.number(), 0);
    if (at == MAP_FAILED) return cannot_open(std::strerror(errno));
    return MappedFile({static_cast<const std::byte*>(at), size});
}

MappedFile::~MappedFile() {
    if (!bytes_.empty()) ::munmap(const_cast<std::byte*>(bytes_.data()), bytes_.size());
}

Result<std::vector<std::byte>> read_descriptor(int descriptor, std::uint64_t most) {
    Result<std::vector<std::byte>> bytes = read_up_to(descriptor, most == UINT64_MAX ? most : most + 1, 0);
    if (bytes && bytes->size() > most) return too_large(most);
    return bytes;
}

Result<void> write_descriptor(int descriptor, std::span<const std::span<const std::byte>> parts) {
    for (std::span<const std::byte> part : parts) {
        while (!part.empty()) {
            const ::ssize_t put = ::write(descriptor, part.data(), part.size());
            if (put < 0 && errno == EINTR) continue;
            if (put < 0) return cannot_write(std::strerror(errno));
            part = part.subspan(static_cast<std::size_t>(put));
        }
    }
    return {};
}

namespace {

/// The target of a path after symbolic links: a path to create or replace, or an object to write in place.
struct Destination {
    fs::path path;
    bool in_place = false;
    std::optional<::mode_t> mode;  ///< permissions of the existing file, if any
};

/// Does the path name an open descriptor of this process? Another program may hold its file open, and would not see a
/// file that replaces it.
bool names_descriptor(const fs::path& path) {
    const std::string name = path.string();
    return name.starts_with("/proc/") || name.starts_with("/dev/fd/");
}

Result<Destination> find_destination(const fs::path& path) {
    constexpr int kMostLinks = 40;  // Linux's limit
    Destination out{path, names_descriptor(path), {}};
    std::error_code status;
    for (int links = 0; !out.in_place && fs::is_symlink(out.path, status); ++links) {
        if (links == kMostLinks) return cannot_write(std::strerror(ELOOP));
        const fs::path to = fs::read_symlink(out.path, status);
        if (status) return cannot_write(status.message());
        out.path = to.is_absolute() ? to : out.path.parent_path() / to;
        out.in_place = names_descriptor(out.path);
    }
    struct ::stat what {};
    if (::stat(out.path.c_str(), &what) != 0) return out;
    if (S_ISDIR(what.st_mode)) return cannot_write("is a folder");
    if (!S_ISREG(what.st_mode)) out.in_place = true;
    out.mode = static_cast<::mode_t>(what.st_mode & 07777);
    return out;
}

Result<void> write_in_place(const fs::path& path, std::span<const std::span<const std::byte>> parts) {
    Descriptor file(::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_NOCTTY | O_CLOEXEC, 0666));
    if (!file.good()) return cannot_write(std::strerror(errno));
    if (Result<void> written = write_descriptor(file.number(), parts); !written) return written;
    if (!file.close()) return cannot_write(std::strerror(errno));
    return {};
}

/// Calls `take` with new names in `folder` until it succeeds, and returns that name. Null, with errno, if `take` fails
/// for another reason than EEXIST.
template <class Take>
std::optional<fs::path> take_free_name(const fs::path& folder, Take take) {
    static std::atomic<std::uint64_t> counter = 0;
    const auto now = static_cast<std::uint64_t>(std::chrono::steady_clock::now().time_since_epoch().count());
    while (true) {
        char name[64];
        std::snprintf(name, sizeof name, ".lacedring-%lx-%llx-%llx", static_cast<unsigned long>(::getpid()),
                      static_cast<unsigned long long>(now), static_cast<unsigned long long>(++counter));
        fs::path path = folder / name;
        if (take(path)) return path;
        if (errno != EEXIST) return std::nullopt;
    }
}

}  // namespace

Result<void> write_file(const fs::path& path, std::span<const std::span<const std::byte>> parts) {
    LR_ASSIGN(const Destination found, find_destination(path));
    if (found.in_place) return write_in_place(found.path, parts);
    const fs::path& target = found.path;
    const fs::path folder = target.has_parent_path() ? target.parent_path() : fs::path(".");

    // The file has no name while it is written, so that a killed process leaves nothing behind. If the file system does
    // not support unnamed files, it has a temporary name.
    Descriptor file(-1);
    std::optional<fs::path> temporary;
    if (::access("/proc/self/fd", X_OK) == 0) {
        file = Descriptor(::open(folder.c_str(), O_TMPFILE | O_WRONLY | O_CLOEXEC, 0666));
    }
    const bool nameless = file.good();
    if (!nameless) {
        temporary = take_free_name(folder, [&](const fs::path& name) {
            file = Descriptor(::open(name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666));
            return file.good();
        });
        if (!temporary) return cannot_write(std::strerror(errno));
    }
    const auto give_up = [&](Error why) {
        if (temporary) ::unlink(temporary->c_str());
        return why;
    };
    if (const Result<void> written = write_descriptor(file.number(), parts); !written) return give_up(written.error());
    if (found.mode) (void)::fchmod(file.number(), *found.mode);  // keeps the permissions; best effort
    if (nameless) {
        const std::string self = "/proc/self/fd/" + std::to_string(file.number());
        const auto link_as = [&](const fs::path& name) {
            return ::linkat(AT_FDCWD, self.c_str(), AT_FDCWD, name.c_str(), AT_SYMLINK_FOLLOW) == 0;
        };
        // Links a new file to its name directly. linkat cannot replace an existing file: that takes a temporary name
        // and rename.
        if (!found.mode && link_as(target)) return {};
        temporary = take_free_name(folder, link_as);
        if (!temporary) return cannot_write(std::strerror(errno));
    }
    if (!file.close()) return give_up(cannot_write(std::strerror(errno)));
    if (::rename(temporary->c_str(), target.c_str()) != 0) return give_up(cannot_write(std::strerror(errno)));
    return {};
}

}  // namespace lacedring
