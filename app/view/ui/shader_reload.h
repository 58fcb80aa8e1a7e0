#pragma once
// Reloads shaders that are edited while the viewer runs.

#include <filesystem>
#include <memory>

#include "app/view/session/shader_watch.h"
#include "app/view/ui/state.h"
#include "renderer/vk/context.h"

namespace lacedring::view {

class ShaderReload {
  public:
    /// Watches `folder`; if that is empty, the sources that the program was built from, if they still exist.
    void start(Threads& threads, const std::filesystem::path& folder, Facts& facts);
    /// Compiles all shaders again, changed or not.
    void force(Facts& facts);
    /// Uses newly compiled shaders. Returns whether the watch had an update. facts.shaders.reloads grows if the
    /// scene's pipelines were recreated.
    bool update(gpu::Context& context, Scene& scene, Facts& facts);
    bool has_update() const { return watch_ && watch_->has_update(); }
    /// Null: no folder is watched.
    const ShaderWatch* watch() const { return watch_.get(); }

  private:
    std::unique_ptr<ShaderWatch> watch_;
};

}  // namespace lacedring::view
