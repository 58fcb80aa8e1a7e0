// Compares the library's part codes with a reader written from docs/gltf/LACEDRING_mesh_compression.

#include <doctest/doctest.h>

#include <algorithm>
#include <list>
#include <optional>
#include <random>
#include <set>

#include "lrio/scene/deflate.h"
#include "lrio/scene/part_codes.h"
#include "tests/support/capture.h"
#include "tests/support/damage.h"

using namespace lacedring;

namespace {

using PartList = std::vector<std::uint32_t>;

/// The part of each triangle as the document's section "Part codes" defines it; nothing if the runs are not valid.
std::optional<PartList> parts_by_document(std::span<const std::byte> runs, std::size_t triangles, std::size_t parts) {
    std::vector<std::uint64_t> numbers;
    std::uint64_t value = 0;
    unsigned bytes = 0;
    for (const std::byte byte : runs) {
        value |= std::to_integer<std::uint64_t>(byte & std::byte{127}) << (7 * bytes);
        if (++bytes > 5 || value > UINT32_MAX) return {};
        if ((byte & std::byte{128}) != std::byte{0}) continue;
        numbers.push_back(value);
        value = bytes = 0;
    }
    if (bytes != 0) return {};
    std::list<std::uint32_t> lately;
    std::set<std::uint32_t> had;
    std::uint32_t expected = 0;
    PartList out;
    for (std::size_t i = 0; i < numbers.size();) {
        const std::uint64_t code = numbers[i++];
        std::uint32_t part = 0;
        if (code == 0) {
            if (i == numbers.size()) return {};
            const auto d = static_cast<std::uint32_t>(numbers[i++]);
            part = expected + ((d >> 1) ^ (0 - (d & 1)));
            if (!had.insert(part).second) return {};
            expected = part + 1;
        } else if (code <= 64) {
            if (code > lately.size()) return {};
            const auto at = std::next(lately.begin(), static_cast<std::ptrdiff_t>(code) - 1);
            part = *at;
            lately.erase(at);
        } else {
            part = static_cast<std::uint32_t>(code - 65);
            if (!had.contains(part) || std::ranges::count(lately, part) != 0) return {};
        }
        lately.push_front(part);
        if (lately.size() > 64) lately.pop_back();
        if (part >= parts || i == numbers.size()) return {};
        const std::uint64_t run = numbers[i++] + 1;
        if (run > triangles - out.size()) return {};
        out.insert(out.end(), static_cast<std::size_t>(run), part);
    }
    if (out.size() != triangles || had.size() != parts) return {};
    return out;
}

std::vector<std::byte> encoded_parts(const PartList& parts) {
    const auto codes = detail::encode_part_codes(parts);
    REQUIRE(codes);
    return *codes;
}

/// Checks that the library reads the same parts of the runs as parts_by_document, or refuses them as well.
void check_runs(std::span<const std::byte> runs, std::size_t triangles, std::size_t parts) {
    const auto expected = parts_by_document(runs, triangles, parts);
    const auto codes = detail::deflate_bytes(runs);
    REQUIRE(codes);
    const auto read = detail::decode_part_codes(*codes, triangles, parts);
    REQUIRE(read.has_value() == expected.has_value());
    if (read) REQUIRE(*read == *expected);
}

void check_round_trip(const PartList& parts) {
    const std::size_t count = parts.empty() ? 0 : *std::ranges::max_element(parts) + std::size_t{1};
    const std::vector<std::byte> codes = encoded_parts(parts);
    const auto runs = detail::inflate_bytes(codes, 15 * parts.size());
    REQUIRE(runs);
    REQUIRE(parts_by_document(*runs, parts.size(), count) == parts);
    const auto read = detail::decode_part_codes(codes, parts.size(), count);
    REQUIRE(read);
    REQUIRE(*read == parts);
    CHECK_FALSE(detail::decode_part_codes(codes, parts.size() + 1, count));
    CHECK_FALSE(detail::decode_part_codes(codes, parts.size(), count + 1));
    if (!parts.empty()) CHECK_FALSE(detail::decode_part_codes(codes, parts.size() - 1, count));
    if (count > 0) CHECK_FALSE(detail::decode_part_codes(codes, parts.size(), count - 1));
}

/// Random runs that use every part below `count`, mostly one of the recent parts.
PartList random_runs(std::uint32_t count, std::size_t runs, std::uint32_t seed) {
    std::mt19937 random(seed);
    const auto below = [&](std::size_t n) { return static_cast<std::uint32_t>(random() % n); };
    PartList fresh(count), used, out;
    for (std::uint32_t i = 0; i < count; ++i) fresh[i] = i;
    if (seed % 3 == 0) std::shuffle(fresh.begin(), fresh.end(), random);
    for (std::size_t i = 0; i < runs || !fresh.empty(); ++i) {
        std::uint32_t part = 0;
        if (used.empty() || (!fresh.empty() && below(3) == 0) || i >= runs) {
            part = fresh.back();
            fresh.pop_back();
            used.push_back(part);
        } else {
            const std::size_t back = below(4) == 0 ? used.size() : std::min<std::size_t>(used.size(), 3);
            part = used[used.size() - 1 - below(back)];
        }
        const std::uint32_t length = below(20) == 0 ? 1 + below(20000) : 1 + below(4);
        out.insert(out.end(), length, part);
    }
    return out;
}

/// The parts 0 to count - 1, `rounds` times.
PartList cycled(std::uint32_t count, std::uint32_t rounds) {
    PartList out;
    for (std::uint32_t i = 0; i < count * rounds; ++i) out.push_back(i % count);
    return out;
}

}  // namespace

TEST_CASE("part codes decode to the part of each triangle") {
    for (std::uint32_t seed = 0; seed < 60; ++seed) {
        CAPTURE(seed);
        check_round_trip(random_runs(1 + seed * seed % 300, 10 + 10 * std::size_t{seed}, seed));
    }
    check_round_trip({});
    check_round_trip({0});
    for (const std::size_t run : {2U, 127U, 128U, 129U, 16384U, 16385U, 3000000U}) check_round_trip(PartList(run, 0));
    for (const std::uint32_t count : {2U, 63U, 64U, 65U, 66U, 127U, 128U, 129U, 200U}) {
        CAPTURE(count);
        check_round_trip(cycled(count, 4));
    }
    check_round_trip(cycled(40000, 2));  // the most bytes: each triangle has another part than the one before
    PartList backwards = cycled(20000, 1);
    std::ranges::reverse(backwards);
    check_round_trip(backwards);
}

TEST_CASE("cut and damaged runs of parts are refused or read as the document says") {
    std::size_t accepted = 0;
    for (std::uint32_t seed = 0; seed < 6; ++seed) {
        CAPTURE(seed);
        const PartList parts = seed == 5 ? cycled(80, 2) : random_runs(1 + 7 * seed, 40, seed);
        const std::size_t count = *std::ranges::max_element(parts) + std::size_t{1};
        const auto runs = detail::inflate_bytes(encoded_parts(parts), 15 * parts.size());
        REQUIRE(runs);
        test::for_each_cut(*runs, [&](auto cut) { check_runs(cut, parts.size(), count); });
        test::for_each_flip(*runs, [&](const std::vector<std::byte>& bad, std::size_t) {
            accepted += parts_by_document(bad, parts.size(), count).has_value() ? 1 : 0;
            check_runs(bad, parts.size(), count);
        });
    }
    CHECK_MESSAGE(accepted > 0, "some damaged runs are valid");
}

TEST_CASE("random runs of parts are read as the document says") {
    std::size_t accepted = 0;
    for (std::uint32_t seed = 0; seed < 20000; ++seed) {
        CAPTURE(seed);
        std::mt19937 random(seed);
        std::vector<std::byte> runs;
        std::size_t triangles = random() % 4 == 0 ? 1 : 0, parts = random() % 4 == 0 ? 1 : 0;
        for (std::size_t i = 0, n = 1 + random() % 6; i < n; ++i) {
            static constexpr std::uint8_t kCodes[] = {0, 0, 0, 1, 2, 3, 65, 66, 67}, kDistances[] = {0, 0, 0, 1, 2, 3};
            const std::uint8_t code = kCodes[random() % std::size(kCodes)],
                               more = static_cast<std::uint8_t>(random() % 3);
            runs.push_back(static_cast<std::byte>(code));
            if (code == 0) runs.push_back(static_cast<std::byte>(kDistances[random() % std::size(kDistances)]));
            // 0x80 makes the number one byte longer than needed.
            if (random() % 8 == 0) runs.push_back(std::byte{0x80});
            runs.push_back(static_cast<std::byte>(more));
            triangles += more + std::size_t{1};
            parts += code == 0 ? 1 : 0;
        }
        accepted += parts_by_document(runs, triangles, parts).has_value() ? 1 : 0;
        check_runs(runs, triangles, parts);
    }
    CHECK(accepted > 200);
}

TEST_CASE("a damaged zlib stream of part codes is refused") {
    const PartList parts = random_runs(9, 60, 1);
    const std::vector<std::byte> good = encoded_parts(parts);
    test::for_each_cut(good, [&](auto cut) { CHECK_FALSE(detail::decode_part_codes(cut, parts.size(), 9)); });
    test::for_each_flip(good, [&](const std::vector<std::byte>& bad, std::size_t) {
        const auto read = detail::decode_part_codes(bad, parts.size(), 9);
        // Bits after the last code of deflate have no effect.
        CHECK((!read || *read == parts));
    });
    std::vector<std::byte> longer = good;
    longer.push_back(std::byte{0});
    CHECK_FALSE(detail::decode_part_codes(longer, parts.size(), 9));
    const auto bomb = detail::deflate_bytes(std::vector<std::byte>(10 << 20));
    REQUIRE(bomb);
    CHECK_FALSE(detail::decode_part_codes(*bomb, parts.size(), 9));
}
