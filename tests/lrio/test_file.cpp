#include <doctest/doctest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <fstream>
#include <thread>

#include "lacedring/file.hpp"

using namespace lacedring;

namespace {

/// A temporary folder, removed by the destructor.
struct Folder {
    std::filesystem::path path;
    Folder() {
        std::string name = (std::filesystem::temp_directory_path() / "lacedring-file-XXXXXX").string();
        REQUIRE(::mkdtemp(name.data()) != nullptr);
        path = name;
    }
    ~Folder() { std::filesystem::remove_all(path); }
    std::size_t files() const {
        const std::filesystem::directory_iterator begin(path);
        return static_cast<std::size_t>(std::distance(begin, std::filesystem::directory_iterator()));
    }
};

Result<void> write(const std::filesystem::path& path, std::size_t size, char value) {
    const std::vector<std::byte> bytes(size, static_cast<std::byte>(value));
    const std::span<const std::byte> parts[] = {bytes};
    return write_file(path, parts);
}

}  // namespace

TEST_CASE("a file that several threads write at once is always one thread's whole file") {
    const Folder folder;
    const std::filesystem::path path = folder.path / "out.bin";
    constexpr std::size_t kSize = 20000;
    std::atomic<int> failed = 0, torn = 0;
    {
        std::vector<std::jthread> threads;
        for (char i = 0; i < 4; ++i) {
            threads.emplace_back([&, i] {
                for (int k = 0; k < 250; ++k) {
                    if (!write(path, kSize, i)) ++failed;
                    const Result<std::vector<std::byte>> read = read_file(path);
                    if (!read || read->size() != kSize || read->front() != read->back()) ++torn;
                }
            });
        }
    }
    CHECK(failed == 0);
    CHECK(torn == 0);
    CHECK(folder.files() == 1);
}

TEST_CASE("temporary files of a killed writer do not disturb the next") {
    const Folder folder;
    const std::filesystem::path path = folder.path / "out.bin";
    // Temporary names of earlier versions, some taken by folders.
    for (int i = 0; i < 64; ++i) {
        std::filesystem::create_directory(folder.path / ("out.bin.part" + std::to_string(::getpid() + i)));
    }
    CHECK(write(path, 10, 'a'));
    CHECK(write(path, 20, 'b'));
    CHECK(read_file(path).value().size() == 20);
}

TEST_CASE("writing follows symbolic links, and a loop of links is an error") {
    const Folder folder;
    const std::filesystem::path file = folder.path / "file", link = folder.path / "link";
    CHECK(write(file, 10, 'a'));
    std::filesystem::create_symlink(file, link);
    CHECK(write(link, 20, 'b'));
    CHECK(std::filesystem::is_symlink(link));
    CHECK(read_file(file).value().size() == 20);

    const std::filesystem::path one = folder.path / "one", two = folder.path / "two";
    std::filesystem::create_symlink(one, two);
    std::filesystem::create_symlink(two, one);
    const Result<void> loop = write(one, 10, 'a');
    REQUIRE_FALSE(loop);
    CHECK(loop.error().code == ErrorCode::cannot_write);
    CHECK(std::filesystem::is_symlink(one));
    CHECK_FALSE(read_file(one));
}

TEST_CASE("a mapped file has the bytes of the file") {
    const Folder folder;
    for (const std::size_t size : {std::size_t{0}, std::size_t{1}, std::size_t{10000}}) {
        REQUIRE(write(folder.path / "file", size, 'm'));
        Result<MappedFile> mapped = MappedFile::open(folder.path / "file");
        REQUIRE(mapped);
        const MappedFile moved = std::move(*mapped);
        CHECK(std::ranges::equal(moved.bytes(), read_file(folder.path / "file").value()));
        CHECK(moved.bytes().size() == size);
    }
    CHECK(MappedFile::open(folder.path).error().message == "is a folder");
    CHECK_FALSE(MappedFile::open(folder.path / "none"));
}

TEST_CASE("only regular files are read") {
    const Folder folder;
    const std::filesystem::path pipe = folder.path / "pipe";
    REQUIRE(::mkfifo(pipe.c_str(), 0600) == 0);
    for (const std::filesystem::path& path :
         {pipe, folder.path, std::filesystem::path("/dev/zero"), std::filesystem::path("/proc/self/maps")}) {
        CAPTURE(path.string());
        const Result<std::vector<std::byte>> read = read_file(path);
        REQUIRE_FALSE(read);
        CHECK(read.error().code == ErrorCode::cannot_open);
    }
    CHECK(write(folder.path / "file", 100, 'a'));
    CHECK(read_file(folder.path / "file", 100));
    CHECK(read_file(folder.path / "file", 99).error().code == ErrorCode::too_large);
    CHECK(read_file_start(folder.path / "file", 7).value().size() == 7);
}
