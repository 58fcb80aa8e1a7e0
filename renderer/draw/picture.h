#pragma once
// Pictures on the host.

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <vector>

#include "lacedring/base.hpp"

namespace lacedring::gpu {

/// 8 bits per channel, row by row from the top. In pictures read from a Target, colors are premultiplied by opacity.
struct Picture {
    std::uint32_t width = 0;
    std::uint32_t height = 0;
    std::vector<std::uint8_t> rgba;  ///< 4 per pixel
    /// Per pixel: original triangle + 1, with LR_FRONT_FLAG if its front is seen (shaders/shared.h); 0: background.
    /// Empty in pictures without triangle numbers.
    std::vector<std::uint32_t> triangles;

    std::size_t pixels() const { return std::size_t{width} * height; }
};

/// Puts a drawn picture on a soft gray background and averages squares of factor x factor pixels, in linear light.
/// Width and height must be multiples of `factor`.
Picture finish(const Picture& drawn, std::uint32_t factor);

/// Differences between two pictures of the same size.
struct Difference {
    std::uint64_t pixels = 0;      ///< pixels whose color differs
    std::uint32_t channel = 0;     ///< the largest difference of a channel, 0 to 255
    std::uint64_t beyond_one = 0;  ///< pixels with a channel that differs by more than 1
    std::uint64_t triangles = 0;   ///< pixels that show another triangle or its other side
    std::uint64_t covered = 0;     ///< pixels of the first picture that show a triangle
};
Difference difference(const Picture& a, const Picture& b);

/// Writes an opaque PNG file, completely or not at all. Errors: cannot_write.
Result<void> write_png(const std::filesystem::path& path, const Picture& picture);
/// Errors: cannot_open, malformed.
Result<Picture> read_png(const std::filesystem::path& path);

}  // namespace lacedring::gpu
