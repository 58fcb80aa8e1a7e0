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

/// The work of a command. The chosen command sets it while the command line is parsed; main runs it. Returns an Exit.
using Action = std::function<int(RunLog&)>;

/// Options for making rings.
struct RingChoice {
    std::string ring;         ///< "expander" or "hybrid"; "": the best for each format
    std::string k = "auto";   ///< period k of the hybrid ring-expander; "auto": the best of recommended_periods
    std::uint32_t seeds = 0;  ///< 0: recommended_seeds
    std::uint64_t random_seed = 1;
    /// EncodeOptions::effort; decides the options that are not given.
    std::uint32_t effort = EncodeOptions{}.effort;
    std::uint32_t threads = 0;      ///< most threads; 0: all of the machine
    std::string optimize = "auto";  ///< passes of the ring optimizer, or "auto"
};
void add_ring_options(CLI::App& command, RingChoice& choice);
/// Options for formats that are smallest with the ring-expander. With --ring hybrid, --k auto means the paper's median,
/// 100.
RingOptions ring_options(const RingChoice& choice, std::size_t triangles);
/// Options for lr_compact, which is smallest with the hybrid, and the periods to try.
RingOptions compact_ring_options(const RingChoice& choice);
std::vector<std::uint32_t> ring_periods(const RingChoice& choice, std::size_t triangles);

/// All options of encode for one format and a mesh of `triangles` triangles.
EncodeOptions encode_options(const RingChoice& choice, Format format, std::size_t triangles);

/// Options for optimizing rings, with `cost` as the format's cost function. No passes if --ring or --k chooses a ring
/// and --optimize is not given.
OptimizeOptions optimize_options(const RingChoice& choice, const RingCost& cost);

/// Adds an option for the bits to which an attribute is quantized. Its help says that the default, 0, is lossless.
CLI::Option* add_bits(CLI::App& command, const char* name, std::uint32_t& bits, std::uint32_t least, std::uint32_t most,
                      const char* what);
void add_position_bits(CLI::App& command, std::uint32_t& bits);
/// Options for encoding positions; 0 bits: lossless. `threads`: 0 for all of the machine.
VertexOptions position_options(std::uint32_t bits, std::uint32_t threads = 0);

/// Adds --json.
void add_json(CLI::App& command, bool& json);

/// Adds --threads, which sets all of `asked`.
void add_threads(CLI::App& command, const std::vector<std::uint32_t*>& asked);
/// Number of threads to run on: `asked`, or all of the machine for 0.
unsigned thread_count(std::uint32_t asked);

/// Calls work(i), which returns an Exit, for each input, and prints the input's notes after it. Goes on after a bad
/// input. Returns the first exit code that is not done.
int for_each_input(const std::vector<std::string>& inputs, RunLog& log, const std::function<int(std::size_t)>& work);

/// Prints a JSON document on standard output. Replaces bytes that are not UTF-8 (in names of files or attributes).
void print_json(const nlohmann::ordered_json& document);

/// Prints "lacedring: FILE: MESSAGE" on standard error, in one line, and returns the exit code for the error.
int fail(const std::string& file, const Error& error);

}  // namespace lacedring::app
