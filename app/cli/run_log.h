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
    /// `quiet`: no line is printed.
    explicit RunLog(bool quiet = false) : quiet_(quiet) {}

    /// A line about a file for standard error. It waits until the work has succeeded: an error is one line alone.
    void note(const std::string& file, const std::string& text) {
        lines_.push_back("lacedring: " + file + ": " + text);
    }
    /// The line that says what was written: the file, counts, bytes. It waits likewise.
    void wrote(const std::string& file, const std::string& text) { lines_.push_back(file + ": " + text); }
    void read(std::filesystem::path file) { files_.push_back(std::move(file)); }

    /// Every file that was read so far, those beside a mesh too.
    const std::vector<std::filesystem::path>& files() const { return files_; }

    /// Prints the lines, notes and others in the order in which they came.
    void flush() {
        for (std::string& line : std::exchange(lines_, {})) {
            if (!quiet_) say("{}\n", printable(std::move(line), ' '));
        }
    }
    /// Forgets the lines of what failed.
    void discard() { lines_.clear(); }

  private:
    bool quiet_;
    std::vector<std::string> lines_;
    std::vector<std::filesystem::path> files_;
};

}  // namespace lacedring::app
