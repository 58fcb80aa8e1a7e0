#pragma once
// Shared by all commands: registration, ring options, exit codes.

#include <cstdint>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "app/cli/input.h"
#include "app/cli/print.h"
#include "app/cli/run_log.h"
#include "lacedring/base.hpp"
#include "lacedring/lacedring.hpp"
#include "lacedring/ring.hpp"
#include "lacedring/vertices.hpp"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace lacedring::app {

/// Exit codes: a contract (docs/command-line.md).
enum Exit : int { done = 0, check_failed = 1, wrong_usage = 2, bad_input = 3, no_device = 4 };

/// What main runs once the command line is parsed; the command that was chosen sets it. Returns an Exit.
using Action = std::function<int(RunLog&)>;

/// How the rings are to be made.
struct RingChoice {
    std::string ring;         ///< "", for what each format is best with; "expander" or "hybrid", for all
    std::string k = "auto";   ///< of the hybrid: a number, or the best of recommended_periods
    std::uint32_t seeds = 0;  ///< 0: recommended_seeds
    std::uint64_t random_seed = 1;
    std::uint32_t effort = EncodeOptions{}.effort;  ///< what is not said below is decided by it (encode)
    std::uint32_t threads = 0;                      ///< at most; 0: all of the machine
    std::string optimize = "auto";  ///< passes of the optimizer: a number, or as many as optimize_rings recommends
};
void add_ring_options(CLI::App& command, RingChoice& choice);
/// For a format that is best with the ring-expander. With --ring hybrid, --k auto means the paper's median, 100.
RingOptions ring_options(const RingChoice& choice, std::size_t triangles);
/// For one that is best with the hybrid: the options beside the period, and the periods to try.
RingOptions compact_ring_options(const RingChoice& choice);
std::vector<std::uint32_t> ring_periods(const RingChoice& choice, std::size_t triangles);

/// All of it for one format and a mesh of that size.
EncodeOptions encode_options(const RingChoice& choice, Format format, std::size_t triangles);

/// How rings are to be optimized for a format whose ring costs what `cost` says. Not at all where --ring or --k says
/// which ring it is to be, unless --optimize does.
OptimizeOptions optimize_options(const RingChoice& choice, const RingCost& cost);

/// An option of bits to which an attribute is quantized. Its help says that the default is lossless, which is 0.
CLI::Option* add_bits(CLI::App& command, const char* name, std::uint32_t& bits, std::uint32_t least, std::uint32_t most,
                      const char* what);
void add_position_bits(CLI::App& command, std::uint32_t& bits);
/// Lossless for 0 bits. `threads`: as asked for.
VertexOptions position_options(std::uint32_t bits, std::uint32_t threads = 0);

void add_json(CLI::App& command, bool& json);

/// --threads, for all of these: threads at most, 0 for all of the machine.
void add_threads(CLI::App& command, const std::vector<std::uint32_t*>& asked);
/// The threads to run on where so many were asked for.
unsigned thread_count(std::uint32_t asked);

/// Calls work(i), which returns an Exit, for each input, and says each one's notes behind it. One bad input does not
/// keep the others from their results. Returns the first exit code that is not done.
int for_each_input(const std::vector<std::string>& inputs, RunLog& log, const std::function<int(std::size_t)>& work);

/// Prints a JSON document on standard output. Bytes that are no UTF-8 (of file or attribute names) are replaced.
void print_json(const nlohmann::ordered_json& document);

/// Prints "lacedring: FILE: what" on standard error, one line, and returns the exit code for the error.
int fail(const std::string& file, const Error& error);

}  // namespace lacedring::app
