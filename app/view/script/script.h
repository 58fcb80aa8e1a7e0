#pragma once
// A viewer driven by lines of text: what a person would do, in the order written. docs/viewer.md has the lines.

#include <deque>
#include <filesystem>
#include <string>
#include <vector>

#include "app/view/ui/viewer.h"
#include "app/view/window/window.h"

namespace lacedring::view {

class Script {
  public:
    /// Errors: cannot_open; a wrong line is found when it is its turn.
    static Result<Script> read(const std::filesystem::path& path);
    /// Opens nothing, waits for the mesh to be as it will stay, takes one picture.
    static Script screenshot(const std::string& path);

    /// Before each frame: puts events in the queue and changes what the lines say, up to the first that has to wait.
    /// Errors: invalid_argument, "FILE:LINE: why".
    Result<void> advance(Viewer& viewer, Window& window, std::deque<Event>& events);
    /// A line waits for something.
    bool waiting() const { return waited_ > 0; }

  private:
    struct Line {
        std::size_t number;
        std::vector<std::string> words;
    };
    /// False: not yet, ask again after the next frame.
    Result<bool> run(const Line& line, Viewer& viewer, Window& window, std::deque<Event>& events);
    Result<bool> set(const Line& line, Viewer& viewer);
    Result<bool> wait(const Line& line, Viewer& viewer);
    static std::string state_text(Viewer& viewer);

    std::string name_;
    std::vector<Line> lines_;
    std::size_t at_ = 0;
    int frames_ = 0;  ///< to be drawn before the next line
    int waited_ = 0;
    bool turning_ = false;    ///< pictures of a turntable are being written
    std::uint64_t look_ = 0;  ///< of the watch over shaders, that is waited for
    std::chrono::steady_clock::time_point waiting_since_{};
};

}  // namespace lacedring::view
