#pragma once
// Looks after a folder of shaders on a thread of its own: compiles what changes, and what includes what changes, and
// gives the words once all of it compiles. Knows of no device.

#include <filesystem>
#include <memory>
#include <string>

#include "app/view/session/threads.h"
#include "renderer/shaders/shader_set.h"

namespace lacedring::view {

class ShaderWatch {
  public:
    /// `built_from`: the folder that the program was built from, or empty. If `folder` is that one, only what changed
    /// after the program was built is compiled; of another one everything is. Errors: kDeviceFailure (no thread).
    static Result<std::unique_ptr<ShaderWatch>> create(Threads& threads, std::filesystem::path folder,
                                                       std::filesystem::path built_from);
    ~ShaderWatch();  ///< Ends the watch, without waiting for what is being compiled.
    ShaderWatch(const ShaderWatch&) = delete;
    ShaderWatch& operator=(const ShaderWatch&) = delete;

    const std::filesystem::path& folder() const;
    /// Compiles everything, changed or not, and gives it even if it is what was given before.
    void force();

    struct News {
        bool fresh = false;    ///< something came since the last call: what follows is of now
        std::string error;     ///< lines of "shaders/draw/surface.frag:42: why"; then `replaced` is as before
        bool changed = false;  ///< `replaced` is to be taken
        gpu::ShaderSet::Replaced replaced;  ///< every shader that is not as it was built in
        std::uint32_t compiled = 0;         ///< shaders, since the beginning
        std::uint64_t looks = 0;            ///< how often it has looked at the files, always of now
    };
    News take();
    bool has_news() const;
    /// The first look that sees what has been written by now.
    std::uint64_t next_look() const;

  private:
    struct Shared;
    explicit ShaderWatch(std::shared_ptr<Shared> shared) : shared_(std::move(shared)) {}

    std::shared_ptr<Shared> shared_;  // with the thread
};

}  // namespace lacedring::view
