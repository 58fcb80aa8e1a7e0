#pragma once
// Compiles GLSL to SPIR-V while the program runs, to the same words as the build does (shaders/CMakeLists.txt). Only
// shader_compiler.cpp uses glslang.

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "lacedring/base.hpp"

namespace lacedring::view {

/// Time and size of a file, which tell whether it has changed. All zero: no such file.
struct Stamp {
    std::filesystem::file_time_type time{};
    std::uintmax_t size = 0;
    bool operator==(const Stamp&) const = default;
};
Stamp stamp_of(const std::filesystem::path& file);

class ShaderCompiler {
  public:
    /// `folder` holds the sources, and the files that they include as "shaders/NAME". Other includes are searched in
    /// the folder's parent, then in the parent of `built_from` if that is not empty.
    explicit ShaderCompiler(std::filesystem::path folder, std::filesystem::path built_from = {});
    ~ShaderCompiler();
    ShaderCompiler(const ShaderCompiler&) = delete;
    ShaderCompiler& operator=(const ShaderCompiler&) = delete;

    /// `name`: "draw/surface.frag". `files` gets the stamps, taken before reading, of all files that were read or are
    /// missing. Cost: a few milliseconds; 0.1 s the first time. Call from one thread at a time. Errors: malformed,
    /// unsupported (unknown stage); the message has lines of "shaders/draw/surface.frag:42: why".
    Result<std::vector<std::uint32_t>> compile(const std::string& name, std::map<std::string, Stamp>& files);

  private:
    std::filesystem::path folder_, built_from_;
};

/// The folder of shaders that this program was built from, or empty if it is gone. The build puts a link to it beside
/// the program; an installed program has none.
std::filesystem::path built_shaders();

}  // namespace lacedring::view
