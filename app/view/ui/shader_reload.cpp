#include "app/view/ui/shader_reload.h"

#include <utility>

#include "app/view/session/shader_compiler.h"

namespace lacedring::view {

void ShaderReload::start(Threads& threads, const std::filesystem::path& asked, Facts& facts) {
    const std::filesystem::path built_from = built_shaders();
    std::error_code error;
    std::filesystem::path folder = asked.empty() ? built_from : std::filesystem::canonical(asked, error);
    if (error || folder.empty()) return;
    std::string name = folder.string();
    Result<std::unique_ptr<ShaderWatch>> watch = ShaderWatch::create(threads, std::move(folder), built_from);
    if (!watch) {
        facts.error = name + ": cannot watch the shaders: " + watch.error().message;
        return;
    }
    facts.shaders.folder = std::move(name);
    watch_ = std::move(*watch);
}

void ShaderReload::force(Facts& facts) {
    if (watch_) {
        watch_->force();
    } else {
        facts.tell("no shader sources found: use lacedring view --shaders DIR", 4);
    }
}

bool ShaderReload::update(gpu::Context& context, Scene& scene, Facts& facts) {
    if (!watch_) return false;
    const ShaderWatch::Update update = watch_->take();
    ShaderFacts& shaders = facts.shaders;
    shaders.checks = update.checks;
    if (!update.fresh) return false;
    shaders.compiled = update.compiled;
    shaders.error = update.error;
    if (!update.changed) return true;
    gpu::ShaderSet::Replaced before = context.shaders().exchange(update.replaced);
    if (const Result<void> made = scene.reload(); !made) {
        context.shaders().exchange(std::move(before));
        shaders.error = "the device refuses the shaders: " + made.error().message;
        return true;
    }
    ++shaders.reloads;
    shaders.replaced = static_cast<std::uint32_t>(update.replaced.size());
    facts.tell("shaders reloaded");
    return true;
}

}  // namespace lacedring::view
