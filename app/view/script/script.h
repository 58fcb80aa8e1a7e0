#pragma once
// Drives the viewer by a script, whose lines stand for a user's actions. docs/viewer.md describes them.

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
    /// Reads a script. Errors: cannot_open. A wrong line is an error only when it is executed.
    static Result<Script> read(const std::filesystem::path& path);
    /// A script that waits until the mesh is ready, saves one picture, and ends the viewer.
    static Script screenshot(const std::string& path);

    /// Call before each frame. Executes lines up to the first that has to wait. Errors: invalid_argument,
    /// "FILE:LINE: why".
    Result<void> advance(Viewer& viewer, Window& window, std::deque<Event>& events);
    /// Returns whether a line is waiting.
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
    /// A kind of line. `run` returns false if it has to wait: it is called again before the next frame.
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
    Result<bool> minimize(const Words& words, const Stage& stage);
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
    /// Returns whether earlier changes are drawn and settled, as needed before a picture is saved. Errors:
    /// invalid_argument after 600 frames.
    Result<bool> settle(const Viewer& viewer) const;

    std::string name_;
    std::vector<Line> lines_;
    std::size_t at_ = 0;
    int frames_ = 0;  ///< to draw before the next line
    int waited_ = 0;  ///< frames that the current line has waited
    /// Frames since the awaited error has appeared.
    int seen_ = 0;
    /// Pictures of a turntable are being written.
    bool turning_ = false;
    std::uint64_t check_ = 0;  ///< the awaited check of the shaders' files
    std::chrono::steady_clock::time_point waiting_since_{};
};

/// The state as one line of JSON.
std::string state_text(Viewer& viewer);

}  // namespace lacedring::view
