// Tests PagedFile: its contents, its limit, the order of eviction, and errors.

#include <doctest/doctest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <random>
#include <vector>

#include "lrlab/pager/paged_file.h"

using namespace lacedring;

namespace {

constexpr std::size_t kPage = 4096;

std::filesystem::path folder() {
    return std::filesystem::temp_directory_path();
}

std::vector<std::uint32_t> numbers(std::size_t count) {
    std::vector<std::uint32_t> out(count);
    std::mt19937 random(1);
    for (std::uint32_t& x : out) x = static_cast<std::uint32_t>(random());
    return out;
}

PagedFile paged(const std::vector<std::uint32_t>& words, std::size_t page = kPage) {
    const auto bytes = std::as_bytes(std::span(words));
    const std::size_t cut = bytes.size() / 3;
    const std::span<const std::byte> parts[] = {bytes.first(cut), {}, bytes.subspan(cut)};
    Result<PagedFile> file = PagedFile::make(folder(), parts, page);
    REQUIRE(file);
    return std::move(*file);
}

const std::uint32_t* words_of(const PagedFile& file) {
    return reinterpret_cast<const std::uint32_t*>(file.bytes().data());
}

}  // namespace

TEST_CASE("a paged file has the parts' bytes and stays within its limit") {
    const std::size_t page = std::max<std::size_t>(kPage, static_cast<std::size_t>(::sysconf(_SC_PAGESIZE)));
    const std::vector<std::uint32_t> words = numbers(50 * page / 4 + 5);  // 51 pages
    const PagedFile other = paged(numbers(7));                            // a fault must find its file
    PagedFile file = paged(words, page);
    REQUIRE(file.bytes().size() == 4 * words.size());
    CHECK(file.resident() == 0);
    CHECK(file.pages_read() == 0);
    for (const std::size_t pages :
         {std::size_t{60}, std::size_t{51}, std::size_t{20}, std::size_t{9}, std::size_t{1}}) {
        CAPTURE(pages);
        file.limit(pages * page + page / 2);
        const std::size_t allowed = std::max(pages, PagedFile::kMinPages) * page;
        CHECK(file.limit() == allowed);
        CHECK(file.resident() <= allowed);
        std::size_t wrong = 0;
        std::mt19937 random(2);
        // Reads in order, and at random in between.
        for (std::size_t i = 0; i < words.size(); ++i) {
            wrong += words_of(file)[i] != words[i];
            if (i % 64 != 0) continue;
            const std::size_t at = random() % words.size();
            wrong += words_of(file)[at] != words[at];
            if (i % page == 0) CHECK(file.resident() <= allowed);
        }
        CHECK(wrong == 0);
        CHECK(file.resident() == std::min(allowed, 51 * page));
    }
    CHECK(words_of(other)[3] == numbers(7)[3]);
    CHECK(other.pages_read() == 1);
}

TEST_CASE("the page that was read first is evicted first") {
    const std::size_t page = std::max<std::size_t>(kPage, static_cast<std::size_t>(::sysconf(_SC_PAGESIZE)));
    const std::vector<std::uint32_t> words = numbers(20 * page / 4);
    PagedFile file = paged(words, page);
    file.limit(10 * page);
    const auto reads = [&](std::size_t p) {
        const std::size_t before = file.pages_read();
        CHECK(words_of(file)[p * page / 4 + 17] == words[p * page / 4 + 17]);
        return file.pages_read() - before;
    };
    {
        INFO("ten pages fit the limit");
        for (std::size_t p = 0; p < 10; ++p) CHECK(reads(p) == 1);
        for (std::size_t p = 0; p < 10; ++p) CHECK(reads(p) == 0);
    }
    {
        INFO("page 10 evicts page 0, and page 0 then evicts page 1");
        CHECK(reads(10) == 1);
        CHECK(reads(0) == 1);
        CHECK(reads(2) == 0);
        CHECK(reads(1) == 1);
        CHECK(reads(2) == 1);
        CHECK(file.resident() == 10 * page);
    }
    {
        INFO("a smaller limit evicts the two oldest pages, 4 and 5");
        file.limit(8 * page);
        CHECK(file.resident() == 8 * page);
        CHECK(reads(6) == 0);
        CHECK(reads(5) == 1);
    }
    INFO("a scan of more pages than the limit finds none of them resident, one of fewer pages all");
    for (std::size_t p = 0; p < 20; ++p) reads(p);
    for (std::size_t p = 0; p < 20; ++p) CHECK(reads(p) == 1);
    for (std::size_t p = 12; p < 20; ++p) CHECK(reads(p) == 0);
}

TEST_CASE("a paged file can be moved, and made again after all were destroyed") {
    const std::vector<std::uint32_t> words = numbers(30000);
    for (int i = 0; i < 3; ++i) {
        PagedFile a = paged(words);
        PagedFile b = std::move(a);
        a = paged(words);
        b = std::move(a);
        CHECK(words_of(b)[29999] == words[29999]);
    }
    CHECK(paged({}).bytes().empty());
}

TEST_CASE("writes to a paged file and faults elsewhere end the process") {
    const std::vector<std::uint32_t> words = numbers(3000);
    for (const bool write : {true, false}) {
        const ::pid_t child = ::fork();
        if (child == 0) {
            ::signal(SIGSEGV, SIG_DFL);  // not doctest's handler, which reports the signal
            ::alarm(20);                 // ends an endless loop of faults
            const PagedFile file = paged(words);
            auto* at = const_cast<volatile std::uint32_t*>(words_of(file));
            if (!write) at = reinterpret_cast<volatile std::uint32_t*>(std::uintptr_t{64});
            if (write) (void)*at;
            *at = 1;
            ::_exit(0);
        }
        int status = 0;
        REQUIRE(::waitpid(child, &status, 0) == child);
        CHECK(WIFSIGNALED(status));
        CHECK(WTERMSIG(status) == SIGSEGV);
    }
}

TEST_CASE("a paged file without a folder, or of too many pages, is an error") {
    const std::vector<std::uint32_t> words = numbers(10);
    const std::span<const std::byte> parts[] = {std::as_bytes(std::span(words))};
    const Result<PagedFile> missing = PagedFile::make("/no/such/folder", parts);
    REQUIRE_FALSE(missing);
    CHECK(missing.error().code == ErrorCode::cannot_write);
    const std::size_t page = std::max<std::size_t>(kPage, static_cast<std::size_t>(::sysconf(_SC_PAGESIZE)));
    const std::vector<std::byte> block(page);
    const std::vector<std::span<const std::byte>> many(PagedFile::kMaxPages + 1, std::span(block));
    const Result<PagedFile> pages = PagedFile::make(folder(), many, page);  // refused before writing
    REQUIRE_FALSE(pages);
    CHECK(pages.error().code == ErrorCode::too_large);
}
