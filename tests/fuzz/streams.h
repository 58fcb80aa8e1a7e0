#pragma once
// Validates and uses streams, and mutates streams so that they may stay valid.

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "lacedring/lr_file.hpp"
#include "tests/fuzz/targets.h"

namespace lacedring::fuzz {

using Words = std::vector<std::uint32_t>;

/// Validates and uses a stream (use.h). Returns its triangles, or nothing if it is refused.
std::optional<Words> use_stream(Format kind, std::span<const std::uint32_t> words);

/// Validates and uses a vertex stream. False if it is refused.
bool use_vertex_stream(std::span<const std::uint32_t> words);

/// Validates and uses a seam section. `words`: the numbers of vertices and triangles, the triangles, the section. False
/// if it is refused.
bool use_seam_section(std::span<const std::uint32_t> words);

/// Mutates bytes or whole words, then mostly sets the sizes and the checksum of the header to valid ones.
void mutate_stream(Format kind, Words& words, std::size_t max_words, Random& random);
void mutate_vertex_stream(Words& words, std::size_t max_words, Random& random);
void mutate_seam_section(Words& words, std::size_t max_words, Random& random);

/// Mutates the blocks of a seam section that fits the triangles, so that it mostly stays valid. Does not change large
/// sections.
void mutate_seams(Words& section, std::span<const std::uint32_t> triangles, std::uint32_t vertices, Random& random);

/// The whole words of `bytes`.
Words words_of(std::span<const std::byte> bytes);

}  // namespace lacedring::fuzz
