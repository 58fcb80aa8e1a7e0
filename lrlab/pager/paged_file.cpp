#include "lrlab/pager/paged_file.h"

#include <fcntl.h>
#include <linux/magic.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/statfs.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

namespace lacedring {

struct PagedFile::State {
    int fd = -1;
    std::byte* base = nullptr;
    std::size_t bytes = 0, pages = 0, page_bytes = 0, max_pages = 0, reads = 0;
    bool direct = false;
    std::vector<bool> resident;        // is each page resident?
    std::vector<std::uint32_t> queue;  // the resident pages, a ring buffer of `pages` entries from `oldest` on
    std::size_t oldest = 0, queued = 0;
    State* next = nullptr;  // in the handler's list

    State() = default;
    State(const State&) = delete;
    State& operator=(const State&) = delete;
    ~State();

    bool holds(const void* address) const {
        const auto a = reinterpret_cast<std::uintptr_t>(address), b = reinterpret_cast<std::uintptr_t>(base);
        return a >= b && a - b < pages * page_bytes;
    }
    void evict() {
        const std::size_t page = queue[oldest];
        oldest = oldest + 1 == pages ? 0 : oldest + 1;
        --queued;
        resident[page] = false;
        ::madvise(base + page * page_bytes, page_bytes, MADV_DONTNEED);
        ::mprotect(base + page * page_bytes, page_bytes, PROT_NONE);
    }
    /// Reads a page. False: read error. Runs in a signal handler, so it may only make system calls.
    bool load(std::size_t page) {
        while (queued >= max_pages) evict();
        std::byte* at = base + page * page_bytes;
        if (::mprotect(at, page_bytes, PROT_READ | PROT_WRITE) != 0) return false;
        for (std::size_t got = 0; got < page_bytes;) {
            const ::ssize_t n = ::pread(fd, at + got, page_bytes - got, static_cast<::off_t>(page * page_bytes + got));
            if (n < 0 && errno == EINTR) continue;
            if (n <= 0) return false;
            got += static_cast<std::size_t>(n);
        }
        if (::mprotect(at, page_bytes, PROT_READ) != 0) return false;
        const std::size_t last = oldest + queued;
        queue[last < pages ? last : last - pages] = static_cast<std::uint32_t>(page);
        ++queued;
        ++reads;
        resident[page] = true;
        return true;
    }
};

namespace {

PagedFile::State* mapped = nullptr;  // list of all mapped files
struct sigaction before_ours;

void on_fault(int signal, siginfo_t* info, void*) {
    const int saved = errno;
    for (PagedFile::State* s = mapped; s != nullptr; s = s->next) {
        if (!s->holds(info->si_addr)) continue;
        const auto page = static_cast<std::size_t>(static_cast<std::byte*>(info->si_addr) - s->base) / s->page_bytes;
        if (s->resident[page]) break;  // a write to a resident page is the program's error
        if (!s->load(page)) {
            ::signal(SIGBUS, SIG_DFL);
            ::raise(SIGBUS);
        }
        errno = saved;
        return;
    }
    ::sigaction(signal, &before_ours, nullptr);  // the access is repeated, and the previous handler gets the signal
    errno = saved;
}

Error cannot_write(int why) {
    return {ErrorCode::cannot_write, std::strerror(why)};
}

/// Opens an unnamed file. -1: error, with errno.
int open_nameless(const std::filesystem::path& folder) {
    const int fd = ::open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600);
    if (fd >= 0 || (errno != EOPNOTSUPP && errno != EISDIR)) return fd;  // else: no O_TMPFILE on this file system
    std::string name = (folder / "lacedring-XXXXXX").string();
    const int named = ::mkostemp(name.data(), O_CLOEXEC);
    if (named >= 0) ::unlink(name.c_str());
    return named;
}

/// Writes `parts` and extends the file to `bytes`. Returns 0 or errno.
int write_padded(int fd, std::span<const std::span<const std::byte>> parts, std::size_t bytes) {
    for (std::span<const std::byte> part : parts) {
        while (!part.empty()) {
            const ::ssize_t put = ::write(fd, part.data(), part.size());
            if (put < 0 && errno == EINTR) continue;
            if (put < 0) return errno;
            part = part.subspan(static_cast<std::size_t>(put));
        }
    }
    if (::ftruncate(fd, static_cast<::off_t>(bytes)) != 0 || ::fsync(fd) != 0) return errno;
    return 0;
}

}  // namespace

PagedFile::State::~State() {
    for (State** s = &mapped; *s != nullptr; s = &(*s)->next) {
        if (*s != this) continue;
        *s = next;
        if (mapped == nullptr) ::sigaction(SIGSEGV, &before_ours, nullptr);
        break;
    }
    if (base != nullptr) ::munmap(base, pages * page_bytes);
    if (fd >= 0) ::close(fd);
}

Result<PagedFile> PagedFile::make(const std::filesystem::path& folder,
                                  std::span<const std::span<const std::byte>> parts, std::size_t page_bytes) {
    auto s = std::make_unique<State>();
    for (const auto& part : parts) s->bytes += part.size();
    s->page_bytes = page_bytes = std::max(page_bytes, static_cast<std::size_t>(::sysconf(_SC_PAGESIZE)));
    s->pages = std::max<std::size_t>(1, (s->bytes + page_bytes - 1) / page_bytes);
    s->max_pages = std::max(s->pages, kMinPages);
    if (s->pages > kMaxPages) return Error{ErrorCode::too_large, "too many pages to map one by one"};
    s->fd = open_nameless(folder);
    if (s->fd < 0) return cannot_write(errno);
    if (const int why = write_padded(s->fd, parts, s->pages * page_bytes); why != 0) return cannot_write(why);
    ::posix_fadvise(s->fd, 0, 0, POSIX_FADV_DONTNEED);
    struct statfs system;
    const bool in_memory =
        ::fstatfs(s->fd, &system) == 0 && (system.f_type == TMPFS_MAGIC || system.f_type == RAMFS_MAGIC);
    s->direct = ::fcntl(s->fd, F_SETFL, O_DIRECT) == 0 && !in_memory;

    void* base = ::mmap(nullptr, s->pages * page_bytes, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    if (base == MAP_FAILED) return Error{ErrorCode::too_large, std::strerror(errno)};
    s->base = static_cast<std::byte*>(base);
    ::madvise(base, s->pages * page_bytes, MADV_NOHUGEPAGE);  // a 2 MB page would make unread pages resident
    s->resident.assign(s->pages, false);
    s->queue.resize(s->pages);

    if (mapped == nullptr) {
        struct sigaction ours = {};
        ours.sa_sigaction = on_fault;
        ours.sa_flags = SA_SIGINFO;
        ::sigemptyset(&ours.sa_mask);
        ::sigaction(SIGSEGV, &ours, &before_ours);
    }
    s->next = std::exchange(mapped, s.get());
    return PagedFile(std::move(s));
}

PagedFile::PagedFile(std::unique_ptr<State> state) : state_(std::move(state)) {}
PagedFile::PagedFile(PagedFile&&) noexcept = default;
PagedFile& PagedFile::operator=(PagedFile&&) noexcept = default;
PagedFile::~PagedFile() = default;

std::span<const std::byte> PagedFile::bytes() const {
    return {state_->base, state_->bytes};
}

void PagedFile::limit(std::size_t bytes) {
    state_->max_pages = std::max(bytes / state_->page_bytes, kMinPages);
    while (state_->queued > state_->max_pages) state_->evict();
}
std::size_t PagedFile::limit() const {
    return state_->max_pages * state_->page_bytes;
}

std::size_t PagedFile::resident() const {
    const auto system_page = static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
    const std::size_t all = state_->pages * state_->page_bytes;
    std::vector<unsigned char> in(all / system_page);
    if (::mincore(state_->base, all, in.data()) != 0) return 0;
    return static_cast<std::size_t>(std::count_if(in.begin(), in.end(), [](unsigned char p) { return p & 1; })) *
           system_page;
}

std::size_t PagedFile::pages_read() const {
    return state_->reads;
}
std::size_t PagedFile::page_bytes() const {
    return state_->page_bytes;
}
bool PagedFile::direct() const {
    return state_->direct;
}

}  // namespace lacedring
