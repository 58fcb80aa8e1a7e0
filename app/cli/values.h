#pragma once
// Values that options take. All options refuse other values in one form:
// "--threads: '-5' is not a whole number from 1 to 1024".

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

namespace CLI {
class Option;
}  // namespace CLI

namespace lacedring::app {

constexpr std::uint64_t kMostMebibytes = std::uint64_t{1} << 30;
constexpr double kNoLimit = std::numeric_limits<double>::infinity();

/// Each of these restricts the values of an option, and returns the option. "{}" in its description becomes the list of
/// allowed values: "1 to 22", "lean, packed or lr".

/// Whole numbers; `word`, if not empty, is allowed as well. The option gets plain digits: 1e6 becomes 1000000.
CLI::Option* allow_whole_numbers(CLI::Option* option, std::uint64_t least, std::uint64_t most,
                                 const std::string& word = "");
/// Finite numbers from `least` to `most`.
CLI::Option* allow_numbers(CLI::Option* option, double least, double most);
/// Finite numbers above `lower` and below `upper`.
CLI::Option* allow_numbers_between(CLI::Option* option, double lower, double upper);
CLI::Option* allow_words(CLI::Option* option, const std::vector<std::string>& words);

/// "'TEXT' is not ALLOWED", for options that parse their values themselves. Long values are shortened.
std::string refusal(const std::string& text, const std::string& allowed);

/// "glb, ply or obj"
std::string or_list(const std::vector<std::string>& words);

}  // namespace lacedring::app
