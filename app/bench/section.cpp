#include "app/bench/section.h"

#include <algorithm>
#include <utility>

#include "app/cli/progress.h"

namespace lacedring::app {

using Json = nlohmann::ordered_json;

double Section::median(std::string_view candidate) const {
    const auto found = std::ranges::find(candidates, candidate, &Candidate::name);
    return found == candidates.end() ? 0 : found->median();
}

Json Section::ratio(const std::string& a, const std::string& b) const {
    const double over = median(a), under = median(b);
    return {{a + "_over_" + b, over > 0 && under > 0 ? Json(over / under) : Json(nullptr)}};
}

Json to_json(const Section& section, const Counts& counts) {
    Json out = Json::object();
    for (const Candidate& c : section.candidates) {
        out[c.name] = {{"seconds", c.median()},
                       {"mtri_per_s", counts.triangles / c.median() / 1e6},
                       {"seconds_min", *std::min_element(c.seconds.begin(), c.seconds.end())},
                       {"seconds_max", *std::max_element(c.seconds.begin(), c.seconds.end())}};
        if (c.vertices) out[c.name]["mvert_per_s"] = counts.vertices / c.median() / 1e6;
        if (!c.gpu_seconds.empty()) out[c.name]["gpu_seconds"] = median(c.gpu_seconds);
        if (const auto found = section.bytes.find(c.name); found != section.bytes.end()) {
            out[c.name]["ns_per_triangle"] = 1e9 * c.median() / counts.triangles;
            out[c.name]["bytes"] = found->second;
        }
    }
    return out;
}

void measure(Section& section, int rounds) {
    ProgressBar bar(section.name, section.candidates.size() * static_cast<std::uint64_t>(rounds));
    run_interleaved(section.candidates, rounds, [&] { bar.step(); });
}

Section measure_unpacking(const char* name, UnpackBench made, int rounds, Json& absent, const std::string& suffix) {
    for (const auto& [what, reason] : made.absent) absent[what + suffix] = reason;
    Section out{name, std::move(made.candidates), std::move(made.bytes)};
    measure(out, rounds);
    return out;
}

}  // namespace lacedring::app
