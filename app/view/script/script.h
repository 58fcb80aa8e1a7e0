#pragma once
// A viewer driven by lines of text: what a person would do, in the order written. docs/viewer.md has the lines.

#include <chrono>
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

    /// Before each frame: performs what the lines say, up to the first that has to wait.
    /// Errors: invalid_argument, "FILE:LINE: why".
    Result<void> advance(Viewer& viewer, Window& window, std::deque<Event>& events);
    /// A line waits for something.
    bool waiting() const { return waited_ > 0; }

  private:
    using Words = std::vector<std::string>;
    struct Line {
        std::size_t number;
        Words words;
    };
    /// The objects that a line acts on.
    struct Stage {
        Viewer& viewer;
        Window& window;
        std::deque<Event>& events;
    };
    /// A kind of line. `run` gives false for not yet: it is called again after the next frame.
    struct Command {
        const char* name;
        const char* usage;
        std::size_t least, most;  ///< words after the name
        Result<bool> (Script::*run)(const Words& words, const Stage& stage);
    };
    static const std::vector<Command>& commands();

    Result<bool> run(const Words& words, const Stage& stage);
    Result<bool> open(const Words& words, const Stage& stage);
    Result<bool> move(const Words& words, const Stage& stage);
    Result<bool> click(const Words& words, const Stage& stage);
    Result<bool> drag(const Words& words, const Stage& stage);
    Result<bool> scroll(const Words& words, const Stage& stage);
    Result<bool> key(const Words& words, const Stage& stage);
    Result<bool> resize(const Words& words, const Stage& stage);
    Result<bool> minimise(const Words& words, const Stage& stage);
    Result<bool> close(const Words& words, const Stage& stage);
    Result<bool> set(const Words& words, const Stage& stage);
    Result<bool> camera(const Words& words, const Stage& stage);
    Result<bool> frames(const Words& words, const Stage& stage);
    Result<bool> wait(const Words& words, const Stage& stage);
    Result<bool> copy(const Words& words, const Stage& stage);
    Result<bool> save(const Words& words, const Stage& stage);
    Result<bool> save_turn(const Words& words, const Stage& stage);
    Result<bool> print(const Words& words, const Stage& stage);
    Result<bool> ray(const Words& words, const Stage& stage);
    /// Before a picture: what was changed must be drawn, and settle. A wait of that many frames is an error.
    Result<bool> settle(const Viewer& viewer) const;

    std::string name_;
    std::vector<Line> lines_;
    std::size_t at_ = 0;
    int frames_ = 0;          ///< to be drawn before the next line
    int waited_ = 0;          ///< frames
    int seen_ = 0;            ///< of these, since what is waited for is there
    bool turning_ = false;    ///< pictures of a turntable are being written
    std::uint64_t look_ = 0;  ///< of the watch over shaders, that is waited for
    std::chrono::steady_clock::time_point waiting_since_{};
};

/// The state as one line of JSON.
std::string state_text(Viewer& viewer);

}  // namespace lacedring::view
