// Shaders that are edited while they are drawn with.
#include <utility>

#include "app/view/session/shader_compiler.h"
#include "app/view/ui/viewer.h"

namespace lacedring::view {

void Viewer::watch_shaders() {
    const std::filesystem::path built_from = built_shaders();
    std::error_code error;
    std::filesystem::path folder =
        options_.shaders.empty() ? built_from : std::filesystem::canonical(options_.shaders, error);
    if (error || folder.empty()) return;
    std::string name = folder.string();
    Result<std::unique_ptr<ShaderWatch>> watch = ShaderWatch::create(threads_, std::move(folder), built_from);
    if (!watch) {
        state_.error = name + ": not watched: " + watch.error().message;
        return;
    }
    state_.shaders.folder = std::move(name);
    watch_ = std::move(*watch);
}

void Viewer::take_shaders() {
    const bool asked = std::exchange(state_.reload_shaders, false);
    if (!watch_) {
        if (!asked) return;
        state_.tell("no sources of shaders here: lacedring view --shaders DIR", 4);
        return;
    }
    if (asked) watch_->force();
    const ShaderWatch::News news = watch_->take();
    State::Shaders& shaders = state_.shaders;
    shaders.looks = news.looks;
    if (!news.fresh) return;
    quiet_frames_ = 0;
    shaders.compiled = news.compiled;
    shaders.error = news.error;
    if (!news.changed) return;
    gpu::ShaderSet::Replaced before = context_.shaders().exchange(news.replaced);
    if (const Result<void> made = scene_.reload(); !made) {
        context_.shaders().exchange(std::move(before));
        shaders.error = "the device refuses the shaders: " + made.error().message;
        return;
    }
    ++shaders.reloads;
    shaders.replaced = static_cast<std::uint32_t>(news.replaced.size());
    dirty_ = true;
    state_.tell("shaders reloaded");
}

}  // namespace lacedring::view
