#pragma once
// A memory-mapped file with a limit of resident bytes. It serves to measure structures with less memory than they need,
// without privileges or a smaller machine.
//
// The addresses are reserved without access. Touching a page raises SIGSEGV; the handler reads the page from the file,
// and the program continues. At the limit, the page that was read first is evicted first (FIFO). If the file system
// supports O_DIRECT, reads bypass the system's cache, so that an evicted page is really read again.

#include <cstddef>
#include <filesystem>
#include <memory>
#include <span>

#include "lacedring/base.hpp"

namespace lacedring {

class PagedFile {
  public:
    static constexpr std::size_t kPageBytes = std::size_t{32} << 10;
    static constexpr std::size_t kMinPages = 8;  ///< an instruction may touch two pages, memcpy a few more

    /// Alternating protections split the mapping; Linux allows 65,530 mappings per process.
    static constexpr std::size_t kMaxPages = 60000;

    /// Writes `parts`, one after the other, to an unnamed file in `folder` and maps it. At first, no page is resident
    /// and there is no limit. `page_bytes` is a power of two; the system's page size is the minimum. The file is
    /// deleted with the object or the process. Errors: cannot_write (no such folder, no space), too_large (more than
    /// kMaxPages, or no address space).
    static Result<PagedFile> make(const std::filesystem::path& folder,
                                  std::span<const std::span<const std::byte>> parts,
                                  std::size_t page_bytes = kPageBytes);
    PagedFile(PagedFile&&) noexcept;
    PagedFile& operator=(PagedFile&&) noexcept;
    ~PagedFile();

    /// The file, at a fixed address. Only one thread may read it at a time, and system calls must not: they fail
    /// instead of raising SIGSEGV. As with mmap, a read error ends the process with SIGBUS.
    std::span<const std::byte> bytes() const;

    /// Limits residency to max(kMinPages, bytes / page_bytes()) pages; evicts the excess now.
    void limit(std::size_t bytes);
    std::size_t limit() const;

    /// Resident bytes of the mapping according to the system (mincore). O(pages).
    std::size_t resident() const;
    /// Number of pages read from the file so far.
    std::size_t pages_read() const;
    std::size_t page_bytes() const;
    /// Are pages read from the disk, not from the system's cache?
    bool direct() const;

    struct State;  ///< defined in paged_file.cpp

  private:
    explicit PagedFile(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

}  // namespace lacedring
