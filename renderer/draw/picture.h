#pragma once
// Pictures on the host.

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <vector>

#include "lacedring/base.hpp"

namespace lacedring::gpu {

/// 8 bits a channel, row by row from the top. Drawn pictures are premultiplied by their opacity.
struct Picture {
    std::uint32_t width = 0;
    std::uint32_t height = 0;
    std::vector<std::uint8_t> rgba;  ///< 4 a pixel
    /// Original triangle + 1, with LR_FRONT_FLAG where its front is seen (shaders/shared.h); 0: background. Empty where
    /// it was not drawn.
    std::vector<std::uint32_t> triangles;

    std::size_t pixels() const { return std::size_t{width} * height; }
};

/// Puts a drawn picture on a soft grey background and averages squares of factor x factor pixels, in linear light.
/// The picture's sides must be multiples of `factor`.
Picture finish(const Picture& drawn, std::uint32_t factor);

/// What is different between two pictures of the same size.
struct Difference {
    std::uint64_t pixels = 0;      ///< pixels whose colour differs
    std::uint32_t channel = 0;     ///< the largest difference of a channel, of 255
    std::uint64_t beyond_one = 0;  ///< pixels of which a channel differs by more than one
    std::uint64_t triangles = 0;   ///< pixels whose triangle, or its side, differs
    std::uint64_t covered = 0;     ///< pixels of the first picture that show a triangle
};
Difference difference(const Picture& a, const Picture& b);

/// PNG, opaque. Written whole or not at all. Errors: cannot_write.
Result<void> write_png(const std::filesystem::path& path, const Picture& picture);
/// Errors: cannot_open, malformed.
Result<Picture> read_png(const std::filesystem::path& path);

}  // namespace lacedring::gpu
