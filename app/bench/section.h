#pragma once
// The sections of bench's results, and their JSON.

#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "app/bench/measure.h"
#include "app/bench/unpack.h"

namespace lacedring::app {

/// Candidates that are measured in turn.
struct Section {
    std::string name;
    std::vector<Candidate> candidates;
    std::map<std::string, std::uint64_t> bytes = {};  ///< input size of a candidate, if known

    /// Median seconds of the named candidate; 0 if it is missing.
    double median(std::string_view candidate) const;
    /// {"a_over_b": seconds of a over seconds of b}; null if either is missing.
    nlohmann::ordered_json ratio(const std::string& a, const std::string& b) const;
};

/// The sizes of a mesh, for rates per second.
struct Counts {
    double triangles = 0, vertices = 0;
};

nlohmann::ordered_json to_json(const Section& section, const Counts& counts);

/// Measures the candidates, with a progress bar.
void measure(Section& section, int rounds);

/// Measures the candidates, and adds the reasons of the absent ones to `absent` under NAME + `suffix`.
Section measure_unpacking(const char* name, UnpackBench made, int rounds, nlohmann::ordered_json& absent,
                          const std::string& suffix);

}  // namespace lacedring::app
