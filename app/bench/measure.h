#pragma once
// Seconds and peak memory of a piece of work.

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace lacedring::app {

/// Wall seconds of one call.
double seconds(const std::function<void()>& work);

/// Bytes of memory that the process holds now. 0 where the system does not tell.
std::size_t resident_bytes();

/// Bytes by which the process's resident memory rose above where it was, at most, during one call. 0 where the system
/// does not tell (it needs /proc/self/clear_refs).
std::size_t peak_bytes(const std::function<void()>& work);

/// Something to time, run in turn with others.
struct Candidate {
    std::string name;
    std::function<void()> work;
    std::vector<double> seconds;      ///< wall, one entry a round
    std::vector<double> gpu_seconds;  ///< by the device's timestamps, where there are any
    bool vertices = false;            ///< works on vertices: rates are of these, too
    double median() const;
};

double median(std::vector<double> values);

/// Runs every candidate once per round, so that a slow spell of the machine meets all of them. `ran` is told after each
/// run, outside the times.
void run_interleaved(std::vector<Candidate>& candidates, int rounds, const std::function<void()>& ran);

}  // namespace lacedring::app
