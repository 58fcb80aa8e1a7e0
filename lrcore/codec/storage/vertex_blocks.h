#pragma once
// The choices that an encoder made for each block of a vertex stream: predictors, planes, widths. Internal to lrcore.

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "lacedring/lacedring_vertices.h"
#include "lacedring/vertices.hpp"
#include "lrcore/codec/vertices/vertex_layout.h"

namespace lacedring::storage {

constexpr std::uint32_t kMostComponents = LACEDRING_VERTICES_MAX_COMPONENTS;
constexpr std::uint32_t kPlaneRun = kVertexPlaneRun;
constexpr std::uint32_t kMostZeros = kVertexMostZeros;

/// Codes of widths; the value is the number of leading ones in the stream.
enum WidthCode : std::uint8_t { kUnchanged, kAllZero, kOneMore, kOneLess, kGiven };

/// A plane as stored in a block.
struct PlaneChoice {
    enum Kind : std::uint8_t { none, last, given };

    Kind kind = none;
    std::uint8_t axis = 0;
    std::array<std::int8_t, 2> slope{};
};

/// Everything in a block except its integers.
struct BlockChoices {
    struct Predictor {
        bool own = false;  // stored in the block
        std::uint8_t value = 0;
    };
    struct Width {
        std::uint8_t code = kUnchanged, value = 0;  // value for kGiven only
    };

    std::array<Predictor, kMostComponents> predictors{};
    std::uint8_t size = 0;  // runs of 4 << size vertices
    std::array<PlaneChoice, kVertexBlock / kPlaneRun> planes{};
    std::array<std::array<Width, kVertexBlock / 4>, kMostComponents> widths{};  // per run
};

/// The choices that an encoder made for a whole stream: header words and the parameters of components.
struct StreamChoices {
    std::uint32_t layout = 0, lattice = 0, error = 0;  // words 2, 4 and 5
    std::vector<VertexComponent> components;
};

/// The choices of a valid stream's blocks, in order. Cost: O(V).
std::vector<BlockChoices> read_choices(const lacedring_vertices& stream);

}  // namespace lacedring::storage
