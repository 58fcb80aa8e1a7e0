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

/// The code of a width, by how many ones it begins with.
enum WidthCode : std::uint8_t { kUnchanged, kAllZero, kOneMore, kOneLess, kGiven };

/// A plane as a block gives it.
struct PlaneChoice {
    enum Kind : std::uint8_t { none, last, given };

    Kind kind = none;
    std::uint8_t axis = 0;
    std::array<std::int8_t, 2> slope{};
};

/// All that a block says but its integers.
struct BlockChoices {
    struct Predictor {
        bool own = false;  // given in the block
        std::uint8_t value = 0;
    };
    struct Width {
        std::uint8_t code = kUnchanged, value = 0;  // of kGiven alone
    };

    std::array<Predictor, kMostComponents> predictors{};
    std::uint8_t size = 0;  // runs of 4 << size vertices
    std::array<PlaneChoice, kVertexBlock / kPlaneRun> planes{};
    std::array<std::array<Width, kVertexBlock / 4>, kMostComponents> widths{};  // of each run
};

/// The choices that an encoder made for a whole stream: words of its header, and the parameters of its components.
struct StreamChoices {
    std::uint32_t layout = 0, lattice = 0, error = 0;  // words 2, 4 and 5
    std::vector<VertexComponent> components;
};

/// The choices of a valid stream's blocks, in their order. Cost: O(V).
std::vector<BlockChoices> read_choices(const lacedring_vertices& stream);

}  // namespace lacedring::storage
