#include "app/cli/command.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <system_error>
#include <thread>

#include "app/cli/help.h"
#include "app/cli/progress.h"
#include "app/cli/values.h"
#include "lacedring/lacedring.hpp"
#include "renderer/vk/device_error.h"

namespace lacedring::app {

void add_ring_options(CLI::App& command, RingChoice& choice) {
    const OptionGroup group(command, "Ring");
    const auto add = [&](const char* name, auto& value, const char* help) {
        return command.add_option(name, value, help)->capture_default_str();
    };
    allow_words(add("--ring", choice.ring, "construct all rings as {}; default: the best for each format"),
                {"expander", "hybrid"});
    allow_whole_numbers(add("--k", choice.k, "period of hybrid rings; auto tries several and keeps the best"), 1,
                        UINT32_MAX, "auto");
    allow_whole_numbers(add("--seeds", choice.seeds, "start corners to try per component; 0: by the mesh's size"), 0,
                        100000);
    allow_whole_numbers(add("--random-seed", choice.random_seed, "seed of the random choice of start corners"), 0,
                        UINT64_MAX);
    allow_whole_numbers(add("--optimize", choice.optimize, "passes of the ring optimizer; 0: none"), 0, 100000, "auto");
}

namespace {

/// The value of --k; 0 for auto. CLI11 has checked the text.
std::uint32_t period(const RingChoice& choice) {
    std::uint32_t k = 0;
    std::from_chars(choice.k.data(), choice.k.data() + choice.k.size(), k);
    return k;
}

}  // namespace

RingOptions ring_options(const RingChoice& choice, std::size_t triangles) {
    constexpr std::uint32_t kPaperMedian = 100;
    RingOptions options;
    options.random_seed = choice.random_seed;
    options.seeds = choice.seeds != 0 ? choice.seeds : recommended_seeds(triangles);
    if (choice.ring == "hybrid") options.k = period(choice) != 0 ? period(choice) : kPaperMedian;
    return options;
}

RingOptions compact_ring_options(const RingChoice& choice) {
    RingOptions options;
    options.random_seed = choice.random_seed;
    options.seeds = choice.seeds == 0 ? 1 : choice.seeds;  // each period is tried with every seed
    return options;
}

std::vector<std::uint32_t> ring_periods(const RingChoice& choice, std::size_t triangles) {
    if (choice.ring == "expander") return {0};
    if (const std::uint32_t k = period(choice); k != 0) return {k};
    std::vector<std::uint32_t> periods = recommended_periods(triangles);
    if (choice.ring == "hybrid") std::erase(periods, 0U);  // 0 is the expander
    return periods;
}

OptimizeOptions optimize_options(const RingChoice& choice, const RingCost& cost) {
    OptimizeOptions options;
    options.cost = cost;
    options.random_seed = choice.random_seed;
    if (choice.optimize != "auto") {
        std::from_chars(choice.optimize.data(), choice.optimize.data() + choice.optimize.size(), options.passes);
    } else if (!choice.ring.empty() || choice.k != "auto") {
        options.passes = 0;
    }
    options.threads = thread_count(choice.threads);
    options.progress = progress_bar("optimizing the ring", options.passes);
    return options;
}

EncodeOptions encode_options(const RingChoice& choice, Format format, std::size_t triangles) {
    OptimizeOptions optimize = optimize_options(choice, {});
    const bool compact = format == Format::lr_compact, given = !choice.ring.empty() || choice.k != "auto";
    EncodeOptions options;
    options.format = format;
    options.effort = choice.effort;
    options.random_seed = choice.random_seed;
    options.threads = optimize.threads;
    if (choice.seeds != 0) options.seeds = choice.seeds;
    if (choice.optimize != "auto" || given) {
        options.passes = optimize.passes;
    } else {
        optimize.progress = progress_bar("optimizing the ring", passes_at(choice.effort, format));
    }
    options.progress = optimize.progress;
    if (compact && given) options.periods = ring_periods(choice, triangles);
    if (!compact) options.periods = {ring_options(choice, triangles).k};
    return options;
}

CLI::Option* add_bits(CLI::App& command, const char* name, std::uint32_t& bits, std::uint32_t least, std::uint32_t most,
                      const char* what) {
    return allow_whole_numbers(command.add_option(name, bits, what), least, most)
        ->type_name("BITS")
        ->default_str("lossless");
}

void add_position_bits(CLI::App& command, std::uint32_t& bits) {
    add_bits(command, "--positions", bits, 1, 22, "round positions to {} bits along the largest extent");
}

void add_json(CLI::App& command, bool& json) {
    command.add_flag("--json", json, "print one JSON document on standard output");
}

void add_threads(CLI::App& command, const std::vector<std::uint32_t*>& asked) {
    const auto set = [asked](std::uint32_t threads) {
        for (std::uint32_t* one : asked) *one = threads;
    };
    allow_whole_numbers(command.add_option_function<std::uint32_t>(
                            "--threads", set, "use at most N threads, for the same result; default: all"),
                        1, 1024);
}

unsigned thread_count(std::uint32_t asked) {
    return asked != 0 ? asked : std::max(std::thread::hardware_concurrency(), 1U);
}

VertexOptions position_options(std::uint32_t bits, std::uint32_t threads) {
    VertexOptions options;
    options.threads = thread_count(threads);
    if (bits == 0) return options;
    options.mapping = VertexMapping::lattice;
    options.bits = bits;
    return options;
}

int for_each_input(const std::vector<std::string>& inputs, RunLog& log, const std::function<int(std::size_t)>& work) {
    int exit = done;
    for (std::size_t i = 0; i < inputs.size(); ++i) {
        const int code = work(i);
        if (code == done || code == check_failed) {
            log.flush();
        } else {
            log.discard();
        }
        if (exit == done) exit = code;
    }
    return exit;
}

void print_json(const nlohmann::ordered_json& document) {
    print("{}\n", document.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
}

int fail(const std::string& file, const Error& error) {
    std::string line = fmt::format("lacedring: {}: {}", input_name(file), error.message);
    if (error.code == ErrorCode::memory_limit) line += " (--max-memory)";
    say("{}\n", printable(std::move(line), ' '));
    if (error.code == gpu::kNoDevice || error.code == gpu::kDeviceFailure) return no_device;
    return error.code == ErrorCode::invalid_argument ? wrong_usage : bad_input;
}

}  // namespace lacedring::app
