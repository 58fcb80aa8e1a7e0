#pragma once
// Notes for standard error, and the files that a command has read.

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "app/cli/print.h"

namespace lacedring::app {

class RunLog {
  public:
    /// A line about a file for standard error. It waits until the work has succeeded: an error is one line alone.
    void note(const std::string& file, const std::string& text) { notes_.push_back(file + ": " + text); }
    void read(std::filesystem::path file) { files_.push_back(std::move(file)); }

    /// Every file that was read so far, those beside a mesh too.
    const std::vector<std::filesystem::path>& files() const { return files_; }

    /// Says the notes.
    void flush() {
        for (std::string& line : std::exchange(notes_, {})) say("lacedring: {}\n", printable(std::move(line), ' '));
    }
    /// Forgets the notes of what failed.
    void discard() { notes_.clear(); }

  private:
    std::vector<std::string> notes_;
    std::vector<std::filesystem::path> files_;
};

}  // namespace lacedring::app
