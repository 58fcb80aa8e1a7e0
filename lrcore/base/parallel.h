#pragma once
// Work in parts on several threads.

#include <cstdint>

namespace lacedring::detail {

/// in_parallel for a work of any type.
void run_parts(unsigned threads, std::uint32_t parts, void (*call)(void* work, std::uint32_t part), void* work);

/// Calls work(i) for each i below `parts` on at most `threads` threads, the calling one included; returns when all is
/// done. Threads take part after part, so that one which starts late leaves its parts to the others. If the system
/// creates no more threads, the existing ones do the work. Allocates nothing with one thread. Passes on what `work`
/// throws; some parts are left out then.
template <class Work>
void in_parallel(unsigned threads, std::uint32_t parts, Work work) {
    run_parts(
        threads, parts, [](void* w, std::uint32_t part) { (*static_cast<Work*>(w))(part); }, &work);
}

}  // namespace lacedring::detail
