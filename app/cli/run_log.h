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
    /// `quiet`: prints no lines.
    explicit RunLog(bool quiet = false) : quiet_(quiet) {}

    /// Adds a line about a file for standard error. It is printed only if the work succeeds: a failure prints one line.
    void note(const std::string& file, const std::string& text) {
        lines_.push_back("lacedring: " + file + ": " + text);
    }
    /// Adds the line about a file that was written: counts and bytes. It is printed like a note.
    void wrote(const std::string& file, const std::string& text) { lines_.push_back(file + ": " + text); }
    void read(std::filesystem::path file) { files_.push_back(std::move(file)); }

    /// All files read so far, including those that a mesh file refers to.
    const std::vector<std::filesystem::path>& files() const { return files_; }

    /// Prints the notes and removes them.
    void flush() {
        for (std::string& line : std::exchange(lines_, {})) {
            if (!quiet_) say("{}\n", printable(std::move(line), ' '));
        }
    }
    /// Removes the lines, after a failure.
    void discard() { lines_.clear(); }

  private:
    bool quiet_;
    std::vector<std::string> lines_;
    std::vector<std::filesystem::path> files_;
};

}  // namespace lacedring::app
