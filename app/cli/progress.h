#pragma once
// Progress bars on standard error, if that is a terminal.

#include <chrono>
#include <cstdint>
#include <functional>
#include <string>

namespace lacedring::app {

/// Turns all bars off (--quiet). Call it before the work begins.
void hide_progress();

/// A bar that appears after 0.5 s of work and is erased by the destructor. Prints nothing if standard error is not a
/// terminal. Not thread-safe.
class ProgressBar {
  public:
    /// `what` names the work, which takes `total` steps.
    ProgressBar(std::string what, std::uint64_t total);
    ~ProgressBar();
    ProgressBar(const ProgressBar&) = delete;
    ProgressBar& operator=(const ProgressBar&) = delete;

    void show(std::uint64_t done);
    void step() { show(done_ + 1); }

  private:
    std::string what_;
    std::uint64_t total_, done_ = 0;
    std::chrono::steady_clock::time_point begun_ = std::chrono::steady_clock::now();
    bool terminal_ = false, shown_ = false;
};

/// A bar as a callback: call it with the number of steps done; it returns true. Empty if standard error is not a
/// terminal. `what` must outlive the callback.
std::function<bool(std::uint32_t)> progress_bar(const char* what, std::uint32_t total);

}  // namespace lacedring::app
