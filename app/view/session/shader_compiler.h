#pragma once
// GLSL to SPIR-V while the program runs: the words that the build would make (shaders/CMakeLists.txt). The only file
// that knows of glslang.

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "lacedring/base.hpp"

namespace lacedring::view {

/// What tells whether a file has changed. All zero: it is not there.
struct Stamp {
    std::filesystem::file_time_type time{};
    std::uintmax_t size = 0;
    bool operator==(const Stamp&) const = default;
};
Stamp stamp_of(const std::filesystem::path& file);

class ShaderCompiler {
  public:
    /// `folder` holds the sources and what they include as "shaders/NAME". Includes of other folders are looked for
    /// beside it, then in the repository that this program was built in, if `built_from` is that one's shaders.
    explicit ShaderCompiler(std::filesystem::path folder, std::filesystem::path built_from = {});
    ~ShaderCompiler();
    ShaderCompiler(const ShaderCompiler&) = delete;
    ShaderCompiler& operator=(const ShaderCompiler&) = delete;

    /// `name`: "draw/surface.frag". `files`: gets every file that was read, or should have been, as it was just before.
    /// Cost: some milliseconds; a tenth of a second the first time. One thread at a time.
    /// Errors: malformed, unsupported (a stage that is not ours); lines of "shaders/draw/surface.frag:42: why".
    Result<std::vector<std::uint32_t>> compile(const std::string& name, std::map<std::string, Stamp>& files);

  private:
    std::filesystem::path folder_, built_from_;
};

/// The folder of shaders that this program was built from, while it is still there; else empty. The build puts a link
/// to it beside the program; no installed program has one.
std::filesystem::path built_shaders();

}  // namespace lacedring::view
