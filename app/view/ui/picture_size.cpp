#include "app/view/ui/picture_size.h"

#include "renderer/draw/target.h"
#include "renderer/vk/device_error.h"
#include "renderer/vk/try.h"

namespace lacedring::view {
namespace {

// Most samples of a picture at rest. Each takes 24 bytes of images and copies.
constexpr std::uint64_t kMostSamples = 24000000;
constexpr std::uint32_t kSmallest = 64;  // pixels of a side

}  // namespace

void PictureSize::set_window(VkExtent2D window, std::uint32_t device_limit) {
    window_ = window;
    largest_ = device_limit;
    most_samples_ = 3;
    fit();
}

void PictureSize::fit() {
    extent_ = window_;
    const std::uint32_t side = std::max(window_.width, window_.height);
    if (side <= largest_ || !visible()) return;
    const auto fitting = [&](std::uint32_t n) {
        return static_cast<std::uint32_t>(std::max<std::uint64_t>(1, std::uint64_t{n} * largest_ / side));
    };
    extent_ = {fitting(window_.width), fitting(window_.height)};
}

Result<PictureSize::Change> PictureSize::make(gpu::Context& context, Scene& scene, Overlay& overlay,
                                              std::uint32_t samples, int sides) {
    for (;;) {
        std::uint32_t wanted = std::min(samples, most_samples_);
        const std::uint64_t pixels = std::uint64_t{extent_.width} * extent_.height;
        while (wanted > 1 && pixels * wanted * wanted > kMostSamples) --wanted;
        wanted = gpu::Target::fitting_samples(context, extent_, wanted);
        const bool other_size = made_.width != extent_.width || made_.height != extent_.height;
        if (!other_size && samples_ == wanted && sides_ >= sides) return Change::none;
        // The window may still be copying the last picture.
        context.wait_idle();
        Result<void> made = scene.resize(extent_, wanted, sides);
        if (made && other_size) made = overlay.resize(extent_);
        if (made) {
            made_ = extent_;
            samples_ = wanted;
            sides_ = sides;
            return other_size ? Change::size : Change::samples;
        }
        if (made.error().code == gpu::kDeviceFailure) return made.error();
        if (wanted > 1) {
            most_samples_ = wanted - 1;  // until the window changes
            continue;
        }
        largest_ = std::max(extent_.width, extent_.height) / 2;  // also until the window changes
        if (largest_ < kSmallest) return made.error();
        fit();
        most_samples_ = 3;
    }
}

}  // namespace lacedring::view
