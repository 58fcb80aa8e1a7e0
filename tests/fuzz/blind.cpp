// Runs a target on the files of a folder and on random mutations of them: without a guide, but with any compiler.
//
//   fuzz_blind TARGET FOLDER MUTATIONS [SEED]

#include <algorithm>
#include <array>
#include <filesystem>
#include <memory>
#include <string_view>

#include "lrcore/base/file.h"
#include "tests/fuzz/targets.h"

namespace lr::fuzz {

void mutate_bytes(Bytes& bytes, std::size_t max_size, Random& random) {
    if (bytes.empty()) bytes.push_back({});
    const auto any = [&] { return static_cast<std::byte>(random_below(random, 256)); };
    const std::size_t at = random_below(random, bytes.size());
    const auto place = bytes.begin() + static_cast<std::ptrdiff_t>(at);
    switch (random_below(random, 8)) {
        case 0:
            bytes[at] ^= std::byte{1} << random_below(random, 8);
            break;
        case 1:
            bytes[at] = any();
            break;
        case 2:  // a little more or less
            bytes[at] = static_cast<std::byte>(static_cast<unsigned>(bytes[at]) + random_below(random, 5) - 2);
            break;
        case 3:
            bytes[at] = bytes[random_below(random, bytes.size())];
            break;
        case 4: {  // one digit for another, where there is text
            constexpr std::string_view common = "0123456789-+.eE/ \n\",:[]{}";
            bytes[at] = static_cast<std::byte>(common[random_below(random, common.size())]);
            break;
        }
        case 5:
            bytes.insert(place, any());
            break;
        case 6:
            bytes.erase(place, bytes.begin() + static_cast<std::ptrdiff_t>(
                                                   std::min(at + 1 + random_below(random, 8), bytes.size())));
            break;
        default: {  // a piece again, elsewhere
            const std::size_t from = random_below(random, bytes.size());
            const Bytes piece(bytes.begin() + static_cast<std::ptrdiff_t>(from),
                              bytes.begin() + static_cast<std::ptrdiff_t>(
                                                  std::min(from + 1 + random_below(random, 32), bytes.size())));
            bytes.insert(place, piece.begin(), piece.end());
        }
    }
    bytes.resize(std::min(bytes.size(), max_size));
}

namespace {

bool run_exactly_sized(const Target& target, const Bytes& bytes) {
    const auto exact = std::make_unique<std::byte[]>(bytes.size());
    std::copy(bytes.begin(), bytes.end(), exact.get());
    return target.run({exact.get(), bytes.size()});
}

int run(const Target& target, const char* folder, long mutations, unsigned seed) {
    constexpr std::size_t max_size = 1 << 16;
    std::vector<std::filesystem::path> paths;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) paths.push_back(entry.path());
    std::sort(paths.begin(), paths.end());
    std::vector<Bytes> inputs;
    std::size_t good = 0;
    for (const auto& path : paths) {
        auto bytes = read_file(path);
        if (!bytes) continue;
        inputs.push_back(std::move(*bytes));
        good += run_exactly_sized(target, inputs.back()) ? 1 : 0;
    }
    std::printf("%s: %zu of %zu seeds accepted; seed %u\n", target.name, good, inputs.size(), seed);
    if (good == 0) return 1;
    Random random(seed);
    std::array<long, 2> counts{};
    for (long i = 0; i < mutations; ++i) {
        Bytes bytes = inputs[random_below(random, inputs.size())];
        for (std::uint32_t n = 1 + random_below(random, 3); n > 0; --n) {
            if (target.mutate != nullptr) {
                target.mutate(bytes, max_size, random);
            } else {
                mutate_bytes(bytes, max_size, random);
            }
        }
        ++counts[run_exactly_sized(target, bytes) ? 1 : 0];
    }
    std::printf("%s: %ld mutations accepted, %ld refused\n", target.name, counts[1], counts[0]);
    return counts[0] > 0 && counts[1] > 0 ? 0 : 1;  // mutations that are all refused, or none, test nothing
}

}  // namespace
}  // namespace lr::fuzz

int main(int argc, char** argv) {
    for (const lr::fuzz::Target& target : lr::fuzz::targets()) {
        if (argc < 4 || std::string_view(target.name) != argv[1]) continue;
        const unsigned seed = argc > 4 ? static_cast<unsigned>(std::strtoul(argv[4], nullptr, 10)) : 1;
        return lr::fuzz::run(target, argv[2], std::strtol(argv[3], nullptr, 10), seed);
    }
    std::fprintf(stderr, "fuzz_blind TARGET FOLDER MUTATIONS [SEED]\n");
    return 2;
}
