#pragma once
// Watches a folder of shaders on a thread of its own. Recompiles shaders when they or their includes change, and gives
// their SPIR-V once all of them compile. Does not use the device.

#include <filesystem>
#include <memory>
#include <string>

#include "app/view/session/threads.h"
#include "renderer/shaders/shader_set.h"

namespace lacedring::view {

class ShaderWatch {
  public:
    /// `built_from`: the folder that the program was built from, or empty. If `folder` is the same, only shaders that
    /// changed after the build are compiled, else all. Errors: kDeviceFailure (no thread).
    static Result<std::unique_ptr<ShaderWatch>> create(Threads& threads, std::filesystem::path folder,
                                                       std::filesystem::path built_from);
    /// Ends the watch, without waiting for the thread.
    ~ShaderWatch();
    ShaderWatch(const ShaderWatch&) = delete;
    ShaderWatch& operator=(const ShaderWatch&) = delete;

    const std::filesystem::path& folder() const;
    /// Compiles all shaders, changed or not, and reports them even if the result is the same as before.
    void force();

    struct Update {
        /// Something changed since the last call; if false, only `checks` is current.
        bool fresh = false;
        /// Lines of "shaders/draw/surface.frag:42: why". With an error, `replaced` is as before.
        std::string error;
        bool changed = false;  ///< use `replaced`
        /// All shaders that differ from the built-in ones.
        gpu::ShaderSet::Replaced replaced;
        std::uint32_t compiled = 0;  ///< shaders compiled so far
        std::uint64_t checks = 0;    ///< number of completed checks of the files
    };
    Update take();
    bool has_update() const;
    /// Number of the first check that will see all files written before this call.
    std::uint64_t next_check() const;

  private:
    struct Shared;
    explicit ShaderWatch(std::shared_ptr<Shared> shared) : shared_(std::move(shared)) {}

    std::shared_ptr<Shared> shared_;  // shared with the thread
};

}  // namespace lacedring::view
