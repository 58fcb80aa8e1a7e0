#pragma once
// A memory-mapped file of which no more than so many bytes are resident: what lets a structure be measured in less
// memory than it takes, without a privilege or a smaller machine.
//
// The addresses are reserved without access. Touching one raises SIGSEGV; the handler reads that page of the file into
// its place and lets the program go on. Once `limit` bytes are resident, the page that was read longest ago gives its
// memory back first (first in, first out). The file is read past the system's own cache where the file system can
// (O_DIRECT), so that a page that left really is read again.

#include <cstddef>
#include <filesystem>
#include <memory>
#include <span>

#include "lacedring/base.hpp"

namespace lacedring {

class PagedFile {
  public:
    static constexpr std::size_t kPageBytes = std::size_t{32} << 10;
    static constexpr std::size_t kMinPages = 8;  ///< an instruction may touch two; a copy by the library some more

    /// Pages with and without access in turn are so many mappings; Linux has 65,530 a process.
    static constexpr std::size_t kMaxPages = 60000;

    /// Writes `parts`, one after the other, to a file without a name in `folder`, and maps it; nothing is resident, and
    /// nothing limited. `page_bytes` is a power of two, raised to the system's. The file is gone with the object or the
    /// process. Errors: cannot_write (no such folder, no space), too_large (more than kMaxPages, or no such addresses).
    static Result<PagedFile> make(const std::filesystem::path& folder,
                                  std::span<const std::span<const std::byte>> parts,
                                  std::size_t page_bytes = kPageBytes);
    PagedFile(PagedFile&&) noexcept;
    PagedFile& operator=(PagedFile&&) noexcept;
    ~PagedFile();

    /// The file, at an address that does not change. To be read by one thread at a time, not by system calls (which do
    /// not raise SIGSEGV). As with mmap, a read error ends the process with SIGBUS.
    std::span<const std::byte> bytes() const;

    /// From here on at most `bytes` are resident, rounded down to pages, but kMinPages. Gives up what is more.
    void limit(std::size_t bytes);
    std::size_t limit() const;

    /// Bytes of the mapping that are in memory, as the system says (mincore). O(pages).
    std::size_t resident() const;
    /// Pages read from the file so far.
    std::size_t pages_read() const;
    std::size_t page_bytes() const;
    /// Is the file read from its disk, and not from memory of the system's?
    bool direct() const;

    struct State;  ///< the implementation's

  private:
    explicit PagedFile(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

}  // namespace lacedring
