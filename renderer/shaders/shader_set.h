#pragma once
// SPIR-V overrides of built-in shaders, for a program that compiles shaders while it runs (hot reload).

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

namespace lacedring::gpu {

/// The overrides, by shader name; empty unless a program sets some. Thread-safe.
class ShaderSet {
  public:
    using Words = std::vector<std::uint32_t>;
    /// Overrides by Shader::name.
    using Replaced = std::map<std::string, std::shared_ptr<const Words>, std::less<>>;

    /// Returns the override of a shader; null if it has none.
    std::shared_ptr<const Words> find(std::string_view name) const;
    /// Sets the overrides that pipelines created from now on use; returns the previous ones. Each must be valid SPIR-V
    /// with the interface of the shader it replaces (shader_interface.h).
    Replaced exchange(Replaced replaced);

  private:
    mutable std::mutex mutex_;
    Replaced replaced_;
};

}  // namespace lacedring::gpu
