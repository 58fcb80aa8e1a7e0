#include "app/bench/measure.h"

#include <malloc.h>

#include <algorithm>
#include <cstdio>
#include <cstring>

namespace lacedring::app {
namespace {

/// The value of a line of /proc/self/status in bytes; 0 if there is no such line.
std::size_t status_bytes(const char* key) {
    std::FILE* file = std::fopen("/proc/self/status", "r");
    if (file == nullptr) return 0;
    char line[256];
    unsigned long long kib = 0;
    while (std::fgets(line, sizeof line, file) != nullptr) {
        if (std::strncmp(line, key, std::strlen(key)) == 0) std::sscanf(line + std::strlen(key), ": %llu", &kib);
    }
    std::fclose(file);
    return static_cast<std::size_t>(kib) * 1024;
}

bool reset_peak() {
    std::FILE* file = std::fopen("/proc/self/clear_refs", "w");
    if (file == nullptr) return false;
    const bool written = std::fputs("5", file) >= 0;
    return std::fclose(file) == 0 && written;
}

}  // namespace

double seconds(const std::function<void()>& work) {
    const auto begin = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

std::size_t resident_bytes() {
    return status_bytes("VmRSS");
}

std::size_t peak_bytes(const std::function<void()>& work) {
    malloc_trim(0);
    if (!reset_peak()) return 0;
    const std::size_t before = resident_bytes();
    work();
    const std::size_t peak = status_bytes("VmHWM");
    return peak > before ? peak - before : 0;
}

double median(std::vector<double> values) {
    if (values.empty()) return 0;
    std::sort(values.begin(), values.end());
    return values[values.size() / 2];
}

double Candidate::median() const {
    return app::median(seconds);
}

void run_interleaved(std::vector<Candidate>& candidates, int rounds, const std::function<void()>& ran) {
    for (int round = 0; round < rounds; ++round) {
        for (Candidate& candidate : candidates) {
            candidate.seconds.push_back(seconds(candidate.work));
            ran();
        }
    }
}

}  // namespace lacedring::app
