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

#include "app/cli/progress.h"
#include "lacedring/lacedring.hpp"
#include "renderer/vk/device_error.h"

namespace lacedring::app {

std::string refuse_negative(const std::string& number) {
    return number.starts_with('-') ? number + " is negative" : std::string();
}

void add_ring_options(CLI::App& command, RingChoice& choice) {
    command
        .add_option("--ring", choice.ring, "ring construction for every format, not for each the one it is best with")
        ->check(CLI::IsMember({"expander", "hybrid"}));
    command.add_option("--k", choice.k, "period of the hybrid, or auto: several are tried and the smallest kept")
        ->check([](const std::string& text) {
            std::uint32_t k = 0;
            const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), k);
            const bool number = error == std::errc() && end == text.data() + text.size() && k > 0;
            return number || text == "auto" ? std::string() : "k is a number above 0, or auto";
        })
        ->capture_default_str();
    command.add_option("--seeds", choice.seeds, "seed corners tried per component; 0: by the mesh's size")
        ->check(CLI::Range(0, 100000))
        ->capture_default_str();
    command.add_option("--random-seed", choice.random_seed, "for the choice of seed corners")
        ->check(refuse_negative)
        ->capture_default_str();
    command.add_option("--optimize", choice.optimize, "passes of the ring optimiser: a number, 0 for none, or auto")
        ->check([](const std::string& text) {
            std::uint32_t passes = 0;
            const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), passes);
            const bool number = error == std::errc() && end == text.data() + text.size() && passes <= 100000;
            return number || text == "auto" ? std::string() : "passes are a number up to 100000, or auto";
        })
        ->capture_default_str();
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
    options.progress = progress_bar("optimising the ring", options.passes);
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
        optimize.progress = progress_bar("optimising the ring", passes_at(choice.effort, format));
    }
    options.progress = optimize.progress;
    if (compact && given) options.periods = ring_periods(choice, triangles);
    if (!compact) options.periods = {ring_options(choice, triangles).k};
    return options;
}

void add_bits(CLI::App& command, const char* name, std::uint32_t& bits, std::uint32_t least, std::uint32_t most,
              const char* what) {
    command.add_option(name, bits, what)->check(CLI::Range(least, most))->type_name("BITS")->default_str("");
}

void add_position_bits(CLI::App& command, std::uint32_t& bits) {
    add_bits(command, "--positions", bits, 1, 22, "quantize positions: bits along the largest extent");
}

void add_threads(CLI::App& command, const std::vector<std::uint32_t*>& asked) {
    command
        .add_option_function<std::uint32_t>(
            "--threads",
            [asked](std::uint32_t threads) {
                for (std::uint32_t* one : asked) *one = threads;
            },
            "run on at most so many threads; unless told on all of the machine. The result is the same for any")
        ->check(CLI::Range(1, 1024))
        ->type_name("N");
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
