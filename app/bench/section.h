#pragma once
// The parts of what bench measures, and their JSON.

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
    std::map<std::string, std::uint64_t> bytes = {};  ///< of what a candidate decodes, where that is told

    /// Median seconds of the named candidate; 0 if it is missing.
    double median(std::string_view candidate) const;
    /// {"a_over_b": seconds of a over seconds of b}; null where either is missing.
    nlohmann::ordered_json ratio(const std::string& a, const std::string& b) const;
};

/// The sizes of a mesh, for rates per second.
struct Counts {
    double triangles = 0, vertices = 0;
};

nlohmann::ordered_json to_json(const Section& section, const Counts& counts);

/// Measures the candidates, with a progress bar.
void measure(Section& section, int rounds);

/// Measures the candidates; `absent` gets the others' reasons, their names with `suffix`.
Section measure_unpacking(const char* name, UnpackBench made, int rounds, nlohmann::ordered_json& absent,
                          const std::string& suffix);

}  // namespace lacedring::app
