#pragma once
// Shaders that are edited while they are drawn with.

#include <filesystem>
#include <memory>

#include "app/view/session/shader_watch.h"
#include "app/view/ui/state.h"
#include "renderer/vk/context.h"

namespace lacedring::view {

class ShaderReload {
  public:
    /// Watches `folder`, or if that is empty the sources that the program was built from; where there are none,
    /// nothing.
    void start(Threads& threads, const std::filesystem::path& folder, Facts& facts);
    /// Compiles all again, changed or not.
    void force(Facts& facts);
    /// Takes what has been compiled. True: something came of it. The scene's pipelines are new if facts.shaders.reloads
    /// has grown.
    bool update(gpu::Context& context, Scene& scene, Facts& facts);
    bool has_news() const { return watch_ && watch_->has_news(); }
    /// Null: nothing is watched.
    const ShaderWatch* watch() const { return watch_.get(); }

  private:
    std::unique_ptr<ShaderWatch> watch_;
};

}  // namespace lacedring::view
