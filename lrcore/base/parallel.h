#pragma once
// Work in parts on several threads.

#include <cstdint>

namespace lacedring::detail {

/// in_parallel without its template parameter.
void run_parts(unsigned threads, std::uint32_t parts, void (*call)(void* work, std::uint32_t part), void* work);

/// Calls work(i) for each i below `parts` on at most `threads` threads, including the calling thread; returns when all
/// are done. Each thread takes the next free part, so a late thread delays nothing. If the system creates no more
/// threads, the existing ones do the work. Allocates nothing with one thread. Rethrows an exception of `work`; some
/// parts are then skipped.
template <class Work>
void in_parallel(unsigned threads, std::uint32_t parts, Work work) {
    run_parts(
        threads, parts, [](void* w, std::uint32_t part) { (*static_cast<Work*>(w))(part); }, &work);
}

}  // namespace lacedring::detail
