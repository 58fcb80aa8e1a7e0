#pragma once
// Threads that the program does not wait for when it ends: one may be reading from a dead network disk.

#include <atomic>
#include <chrono>
#include <functional>
#include <memory>
#include <thread>
#include <vector>

#include "lacedring/base.hpp"

namespace lacedring::view {

/// Starts a thread that the caller joins. Errors: kDeviceFailure (the system gives no more threads).
Result<std::thread> start_thread(std::function<void()> work);

/// Starts threads and keeps track of them. `work` must own or share everything it uses: a thread may still run after
/// the object that started it and this object are destroyed. Not thread-safe.
class Threads {
  public:
    Threads() = default;
    ~Threads();  ///< Detaches the threads that still run.
    Threads(const Threads&) = delete;
    Threads& operator=(const Threads&) = delete;

    /// Errors: kDeviceFailure (the system gives no more threads).
    Result<void> start(std::function<void()> work);

    /// Waits until all threads have ended, for at most `patience`. Returns false if some still run: the program must
    /// then end with std::_Exit, since returning from main destroys statics that they use.
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
