#include "app/view/session/threads.h"

#include <algorithm>
#include <system_error>
#include <utility>

#include "renderer/vk/device_error.h"

namespace lacedring::view {

Result<std::thread> start_thread(std::function<void()> work) {
    try {
        return std::thread(std::move(work));
    } catch (const std::system_error& error) {
        return Error{gpu::kDeviceFailure, "no thread can be started: " + error.code().message()};
    }
}

Threads::~Threads() {
    join_ended();
    for (Running& running : running_) running.thread.detach();
}

Result<void> Threads::start(std::function<void()> work) {
    join_ended();
    auto ended = std::make_shared<std::atomic<bool>>(false);
    Result<std::thread> thread = start_thread([work = std::move(work), ended]() mutable {
        work();
        // Release shared objects before the thread counts as ended.
        work = {};
        *ended = true;
    });
    if (!thread) return thread.error();
    running_.push_back({std::move(*thread), std::move(ended)});
    return {};
}

bool Threads::finish(std::chrono::milliseconds patience) {
    const auto until = std::chrono::steady_clock::now() + patience;
    for (;;) {
        join_ended();
        if (running_.empty()) return true;
        if (std::chrono::steady_clock::now() >= until) return false;
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
}

void Threads::join_ended() {
    std::erase_if(running_, [](Running& running) {
        if (!*running.ended) return false;
        running.thread.join();  // returns at once: its work has ended
        return true;
    });
}

}  // namespace lacedring::view
