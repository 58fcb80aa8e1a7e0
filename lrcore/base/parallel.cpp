#include "lrcore/base/parallel.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <new>
#include <system_error>
#include <thread>
#include <vector>

namespace lacedring::detail {

void run_parts(unsigned threads, std::uint32_t parts, void (*call)(void* work, std::uint32_t part), void* work) {
    const unsigned wanted = std::min(threads, parts);
    if (wanted <= 1) {
        for (std::uint32_t i = 0; i < parts; ++i) call(work, i);
        return;
    }
    std::atomic<std::uint32_t> next_part = 0;
    std::atomic<bool> failed = false;
    std::exception_ptr failure;
    const auto run = [&] {
        try {
            for (std::uint32_t i = next_part++; i < parts && !failed; i = next_part++) call(work, i);
        } catch (...) {
            if (!failed.exchange(true)) failure = std::current_exception();
        }
    };
    {
        std::vector<std::jthread> others;
        try {
            others.reserve(wanted - 1);
            for (unsigned i = 1; i < wanted && next_part < parts; ++i) others.emplace_back(run);
        } catch (const std::system_error&) {  // the existing threads take all parts
        } catch (const std::bad_alloc&) {
        }
        run();
    }
    if (failure) std::rethrow_exception(failure);
}

}  // namespace lacedring::detail
