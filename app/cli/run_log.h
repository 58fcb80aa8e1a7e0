#pragma once
// Collects notes for standard error, and the files that a command has read.

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "app/cli/print.h"

namespace lacedring::app {

class RunLog {
  public:
    /// Adds a line about a file for standard error. It is printed only if the work succeeds: a failure prints one line.
    void note(const std::string& file, const std::string& text) { notes_.push_back(file + ": " + text); }
    void read(std::filesystem::path file) { files_.push_back(std::move(file)); }

    /// All files read so far, including those that a mesh file refers to.
    const std::vector<std::filesystem::path>& files() const { return files_; }

    /// Prints the notes and removes them.
    void flush() {
        for (std::string& line : std::exchange(notes_, {})) say("lacedring: {}\n", printable(std::move(line), ' '));
    }
    /// Removes the notes, after a failure.
    void discard() { notes_.clear(); }

  private:
    std::vector<std::string> notes_;
    std::vector<std::filesystem::path> files_;
};

}  // namespace lacedring::app
