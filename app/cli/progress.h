#pragma once
// Progress bars on standard error, if that is a terminal.

#include <chrono>
#include <cstdint>
#include <functional>
#include <string>

namespace lacedring::app {

/// No bar appears from now on (--quiet). To be called before the work begins.
void hide_progress();

/// A bar that appears when the work takes longer than a moment, and is gone when this is. Nothing where standard error
/// is no terminal. Not thread-safe.
class ProgressBar {
  public:
    /// `what` is being done, in `total` steps.
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

/// A bar as a callback that is told how many steps are done, and returns true. Empty where standard error is no
/// terminal. `what` must stay.
std::function<bool(std::uint32_t)> progress_bar(const char* what, std::uint32_t total);

}  // namespace lacedring::app
