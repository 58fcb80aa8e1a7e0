#pragma once
// Header words of LR tables (docs/lr-tables.md). Internal to codec/tables.

#include <cstdint>
#include <span>
#include <string>
#include <utility>

#include "lacedring/base.hpp"
#include "lacedring/streams.hpp"
#include "lrcore/base/crc32.h"

namespace lacedring {

constexpr std::uint32_t kLrVersion = 1;
enum LrHeaderWord {
    kW_magic,
    kW_version,
    kW_vertices,
    kW_ring,
    kW_t0,
    kW_star,
    kW_isolated,
    kW_copies,
    kW_unit,
    kW_crc
};

/// CRC-32 of the stream without its checksum word. `words` is at least the header.
inline std::uint32_t lr_checksum(std::span<const std::uint32_t> words) {
    return crc32(std::as_bytes(words.subspan(kLrHeaderWords)), crc32(std::as_bytes(words.first(kW_crc))));
}

inline Error malformed_lr(std::string message) {
    return {ErrorCode::malformed, "LR tables: " + std::move(message)};
}

}  // namespace lacedring
