#pragma once
// Measures seconds and peak memory of a piece of work.

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace lacedring::app {

/// Wall seconds of one call.
double seconds(const std::function<void()>& work);

/// Resident memory of the process in bytes; 0 if the system does not report it.
std::size_t resident_bytes();

/// Peak growth in bytes of the process's resident memory during one call; 0 if the system does not report it (needs
/// /proc/self/clear_refs).
std::size_t peak_bytes(const std::function<void()>& work);

/// A piece of work to time in turn with others, and its times.
struct Candidate {
    std::string name;
    std::function<void()> work;
    std::vector<double> seconds;      ///< wall, one entry per round
    std::vector<double> gpu_seconds;  ///< from the device's timestamps, if any
    bool vertices = false;            ///< also report vertices per second
    double median() const;
};

double median(std::vector<double> values);

/// Runs every candidate once per round, so that a slow phase of the machine affects all of them. Calls `ran` after each
/// run, outside the timed part.
void run_interleaved(std::vector<Candidate>& candidates, int rounds, const std::function<void()>& ran);

}  // namespace lacedring::app
