// libFuzzer's entry points. The name of the program selects the target: bin/fuzz_lean is a link to bin/fuzz.
// --cpu_seconds=N ends a run after N seconds of processor time.

#include <algorithm>
#include <csignal>
#include <cstring>
#include <ctime>
#include <string>
#include <string_view>

#include "tests/fuzz/targets.h"

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t max_size);

namespace {

const lacedring::fuzz::Target* target = nullptr;

double used_seconds() {
    return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

/// Counts accepted and refused inputs, printed at the end: a target that accepts few inputs tests little.
struct Counts {
    unsigned long accepted = 0, all = 0;
    void print() const {
        std::fprintf(stderr, "stat::accepted_units: %lu of %lu\n", accepted, all);
        std::fprintf(stderr, "stat::cpu_seconds: %.1f\n", used_seconds());
    }
    ~Counts() { print(); }
} counts;

double most_seconds = 0;  // no limit

}  // namespace

void lacedring::fuzz::mutate_bytes(Bytes& bytes, std::size_t max_size) {
    if (max_size == 0) return bytes.clear();  // LLVMFuzzerMutate needs room
    const std::size_t size = std::min(bytes.size(), max_size);
    bytes.resize(max_size);
    bytes.resize(LLVMFuzzerMutate(reinterpret_cast<std::uint8_t*>(bytes.data()), size, max_size));
}

extern "C" int LLVMFuzzerInitialize(int* argc, char*** argv) {
    constexpr std::string_view limit = "--cpu_seconds=";
    for (const char* argument : std::span(*argv, static_cast<std::size_t>(*argc))) {
        if (std::string_view(argument).starts_with(limit)) most_seconds = std::atof(argument + limit.size());
    }
    std::string_view name = (*argv)[0];
    name.remove_prefix(name.rfind('/') + 1);
    for (const lacedring::fuzz::Target& t : lacedring::fuzz::targets()) {
        if (name == std::string("fuzz_") + t.name) target = &t;
    }
    if (target != nullptr) return 0;
    std::fprintf(stderr, "%s: run one of the links to this program, fuzz_lean, fuzz_obj, ...\n", (*argv)[0]);
    std::exit(2);
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {  // data has exactly its size
    ++counts.all;
    if (target->run(std::as_bytes(std::span(data, size)))) ++counts.accepted;
    constexpr unsigned long often = 16;
    if (most_seconds > 0 && counts.all % often == 0 && used_seconds() > most_seconds) {
        counts.print();
        most_seconds = 0;
        std::raise(SIGUSR1);  // makes libFuzzer exit, without destructors
    }
    return 0;
}

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t max_size,
                                               unsigned seed) {
    if (target->mutate == nullptr) return LLVMFuzzerMutate(data, size, max_size);
    const auto* from = reinterpret_cast<const std::byte*>(data);
    lacedring::fuzz::Bytes bytes(from, from + size);
    lacedring::fuzz::Random random(seed);
    target->mutate(bytes, max_size, random);
    bytes.resize(std::min(bytes.size(), max_size));
    if (!bytes.empty()) std::memcpy(data, bytes.data(), bytes.size());
    return bytes.size();
}
