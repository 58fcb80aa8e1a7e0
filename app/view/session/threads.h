#pragma once
// Threads that the program need not wait for: one may be reading a file from a dead network disk when it ends.

#include <atomic>
#include <chrono>
#include <functional>
#include <memory>
#include <thread>
#include <vector>

#include "lacedring/base.hpp"

namespace lacedring::view {

/// A thread, for a caller that joins it. Errors: kDeviceFailure (the system gives no more threads).
Result<std::thread> start_thread(std::function<void()> work);

/// Starts threads and counts those that run. `work` must own or share all that it uses: a thread may still run when
/// the object that started it, and this one, are gone. Not thread-safe: one thread starts and finishes them.
class Threads {
  public:
    Threads() = default;
    ~Threads();  ///< Leaves behind the threads that still run.
    Threads(const Threads&) = delete;
    Threads& operator=(const Threads&) = delete;

    /// Errors: kDeviceFailure (the system gives no more threads).
    Result<void> start(std::function<void()> work);

    /// Waits until all threads have ended, but no longer than `patience`. False: some still run. The program must then
    /// end by std::_Exit, since returning from main destroys statics that they use.
    bool finish(std::chrono::milliseconds patience);

  private:
    struct Running {
        std::thread thread;
        std::shared_ptr<std::atomic<bool>> ended;
    };
    void join_ended();

    std::vector<Running> running_;
};

}  // namespace lacedring::view
