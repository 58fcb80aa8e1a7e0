#pragma once
// Groups equal items; used by weld, find_surface, and the STL and OBJ readers. Internal to lrio.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <numeric>
#include <vector>

namespace lacedring::detail {

/// Spreads each bit of `word` over the hash, since floats differ in few bits and the table uses the lowest bits.
inline std::uint64_t mix(std::uint64_t hash, std::uint64_t word) {
    hash = (hash ^ word) * 0x9E3779B97F4A7C15U;
    hash ^= hash >> 32U;
    hash *= 0xD6E8FEB86659FD93U;
    return hash ^ (hash >> 29U);
}

inline std::uint64_t hash_bytes(const std::byte* bytes, std::size_t count, std::uint64_t hash) {
    for (; count >= 8; bytes += 8, count -= 8) {
        std::uint64_t word = 0;
        std::memcpy(&word, bytes, 8);
        hash = mix(hash, word);
    }
    if (count > 0) {
        std::uint64_t word = 0;
        std::memcpy(&word, bytes, count);
        hash = mix(hash, word);
    }
    return hash;
}

/// Groups of equal items: of[i] is the group of item i. Groups are numbered in the order of their first items.
struct Groups {
    std::vector<std::uint32_t> of;
    std::uint32_t count = 0;

    /// The first item of each group.
    std::vector<std::uint32_t> first_items() const {
        std::vector<std::uint32_t> items;
        items.reserve(count);
        for (std::uint32_t i = 0; i < of.size(); ++i) {
            if (of[i] == items.size()) items.push_back(i);
        }
        return items;
    }
};

/// Groups by sorting: the fallback for files made so that hashes collide. Cost: O(count log count).
template <class Compare>
Groups group_sorted(std::uint32_t count, const Compare& compare) {
    std::vector<std::uint32_t> items(count);
    std::iota(items.begin(), items.end(), 0U);
    std::sort(items.begin(), items.end(), [&](std::uint32_t i, std::uint32_t j) {
        const int order = compare(i, j);
        return order != 0 ? order < 0 : i < j;
    });
    Groups groups;
    groups.of.resize(count);
    // First sets groups.of[i] to the first item of i's group; then replaces first items by group numbers.
    for (std::uint32_t k = 0, first = 0; k < count; ++k) {
        if (k == 0 || compare(items[k - 1], items[k]) != 0) first = items[k];
        groups.of[items[k]] = first;
    }
    for (std::uint32_t i = 0; i < count; ++i)
        groups.of[i] = groups.of[i] == i ? groups.count++ : groups.of[groups.of[i]];
    return groups;
}

/// Groups the items 0..count-1 by hash(i) and compare(i, j), which is negative, 0 or positive; count < UINT32_MAX. Uses
/// an open-addressing table of first items, at most 5/8 full. After far more probes than usual, as with hostile hashes,
/// group_sorted gives the same result. Cost: O(count) expected, O(count log count) at most; 4 bytes an item and 6 to 13
/// bytes a group.
template <class Hash, class Compare>
Groups group_equal(std::uint32_t count, const Hash& hash, const Compare& compare) {
    constexpr std::uint32_t none = UINT32_MAX;
    constexpr std::uint64_t kProbesAnItem = 16, kFreeProbes = 65536;  // a 5/8 full table needs 2 to 4 on average
    Groups groups;
    groups.of.resize(count);
    std::vector<std::uint32_t> slots(1024, none);
    std::size_t mask = slots.size() - 1;
    std::uint64_t probes = 0;
    for (std::uint32_t i = 0; i < count; ++i) {
        if (probes > kFreeProbes + kProbesAnItem * i) return group_sorted(count, compare);
        if (std::uint64_t{groups.count} * 8 >= std::uint64_t{slots.size()} * 5) {
            std::vector<std::uint32_t> larger(slots.size() * 2, none);
            mask = larger.size() - 1;
            for (const std::uint32_t item : slots) {
                if (item == none) continue;
                std::size_t slot = static_cast<std::size_t>(hash(item)) & mask;
                for (; larger[slot] != none; ++probes) slot = (slot + 1) & mask;
                larger[slot] = item;
                if (probes > kFreeProbes + kProbesAnItem * count) return group_sorted(count, compare);
            }
            slots = std::move(larger);
        }
        std::size_t slot = static_cast<std::size_t>(hash(i)) & mask;
        for (; slots[slot] != none && compare(slots[slot], i) != 0; ++probes) slot = (slot + 1) & mask;
        if (slots[slot] == none) {
            slots[slot] = i;
            groups.of[i] = groups.count++;
        } else {
            groups.of[i] = groups.of[slots[slot]];
        }
    }
    return groups;
}

/// Groups equal items of an array; an item has `size` bytes.
inline Groups group_equal_bytes(const std::byte* data, std::size_t size, std::uint32_t count) {
    return group_equal(
        count, [=](std::uint32_t i) { return hash_bytes(data + i * size, size, size); },
        [=](std::uint32_t i, std::uint32_t j) { return std::memcmp(data + i * size, data + j * size, size); });
}

}  // namespace lacedring::detail
