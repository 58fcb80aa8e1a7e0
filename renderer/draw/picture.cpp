#include "renderer/draw/picture.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace lacedring::gpu {
namespace {

float to_linear(std::uint32_t value) {
    const float x = static_cast<float>(value) / 255.0F;
    return x <= 0.04045F ? x / 12.92F : std::pow((x + 0.055F) / 1.055F, 2.4F);
}

std::uint8_t to_srgb(float x) {
    const float y = x <= 0.0031308F ? 12.92F * x : 1.055F * std::pow(x, 1.0F / 2.4F) - 0.055F;
    return static_cast<std::uint8_t>(std::clamp(y * 255.0F + 0.5F, 0.0F, 255.0F));
}

/// Light in the middle, a little darker at the rim; sRGB, 0 to 255.
std::array<float, 3> background(float x, float y) {
    const float dx = x - 0.5F, dy = y - 0.42F;
    const float t = std::min(1.0F, std::sqrt(dx * dx + dy * dy) * 1.25F);
    const float s = t * t * (3.0F - 2.0F * t);
    return {246.0F - 34.0F * s, 247.0F - 32.0F * s, 249.0F - 28.0F * s};
}

}  // namespace

Picture finish(const Picture& drawn, std::uint32_t factor) {
    std::array<float, 256> linear{};
    for (std::uint32_t i = 0; i < 256; ++i) linear[i] = to_linear(i);
    Picture out;
    out.width = drawn.width / factor;
    out.height = drawn.height / factor;
    out.rgba.resize(4 * out.pixels());
    const float scale = 1.0F / static_cast<float>(factor * factor);
    for (std::uint32_t y = 0; y < out.height; ++y) {
        for (std::uint32_t x = 0; x < out.width; ++x) {
            const std::array<float, 3> behind =
                background((static_cast<float>(x) + 0.5F) / static_cast<float>(out.width),
                           (static_cast<float>(y) + 0.5F) / static_cast<float>(out.height));
            std::array<float, 3> sum{};
            for (std::uint32_t j = 0; j < factor; ++j) {
                const std::size_t row = std::size_t{y * factor + j} * drawn.width + std::size_t{x} * factor;
                for (std::uint32_t i = 0; i < factor; ++i) {
                    const std::uint8_t* p = &drawn.rgba[4 * (row + i)];
                    const float through = 1.0F - static_cast<float>(p[3]) / 255.0F;
                    for (std::size_t c = 0; c < 3; ++c) {
                        const float value = static_cast<float>(p[c]) + through * behind[c];
                        sum[c] += linear[std::min<std::uint32_t>(255, static_cast<std::uint32_t>(value + 0.5F))];
                    }
                }
            }
            std::uint8_t* to = &out.rgba[4 * (std::size_t{y} * out.width + x)];
            for (std::size_t c = 0; c < 3; ++c) to[c] = to_srgb(sum[c] * scale);
            to[3] = 255;
        }
    }
    return out;
}

Difference difference(const Picture& a, const Picture& b) {
    Difference out;
    for (std::size_t i = 0; i < a.pixels(); ++i) {
        std::uint32_t largest = 0;
        for (std::size_t c = 0; c < 4; ++c) {
            const int d = std::abs(int{a.rgba[4 * i + c]} - int{b.rgba[4 * i + c]});
            largest = std::max(largest, static_cast<std::uint32_t>(d));
        }
        if (largest != 0) ++out.pixels;
        if (largest > 1) ++out.beyond_one;
        out.channel = std::max(out.channel, largest);
        if (!a.triangles.empty()) {
            if (a.triangles[i] != b.triangles[i]) ++out.triangles;
            if (a.triangles[i] != 0) ++out.covered;
        }
    }
    return out;
}

}  // namespace lacedring::gpu
