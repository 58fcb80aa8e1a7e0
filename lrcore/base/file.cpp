#include "lrcore/base/file.h"

#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>

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
    if (const auto size = std::filesystem::file_size(path, status); !status) bytes.reserve(size);
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

Result<void> write_file(const std::filesystem::path& path, std::span<const std::span<const std::byte>> parts) {
    std::error_code status;
    if (std::filesystem::is_directory(path, status)) return Error{ErrorCode::cannot_write, "is a folder"};
    // A device or pipe is written in place: renaming over it would replace it by a file.
    const bool in_place = std::filesystem::exists(path, status) && !std::filesystem::is_regular_file(path, status);
    std::filesystem::path temporary = path;
    if (!in_place) temporary += ".part" + std::to_string(::getpid());
    bool good = false;
    std::string why;
    {
        std::FILE* file = std::fopen(temporary.c_str(), "wb");
        if (file == nullptr) return Error{ErrorCode::cannot_write, std::strerror(errno)};
        good = true;
        for (const auto& part : parts) {
            good = good && (part.empty() || std::fwrite(part.data(), 1, part.size(), file) == part.size());
        }
        if (!good) why = std::strerror(errno);
        if (std::fclose(file) != 0 && good) {
            good = false;
            why = std::strerror(errno);
        }
    }
    if (good && in_place) return {};
    if (good) {
        std::filesystem::rename(temporary, path, status);
        if (!status) return {};
        why = status.message();
    }
    if (!in_place) std::filesystem::remove(temporary, status);
    return Error{ErrorCode::cannot_write, why};
}

}  // namespace lr
