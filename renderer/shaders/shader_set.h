#pragma once
// Shaders in other words than those built in, for a program that compiles them while it runs.

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

namespace lacedring::gpu {

/// Empty in a program that replaces none. May be used by several threads.
class ShaderSet {
  public:
    using Words = std::vector<std::uint32_t>;
    /// By Shader::name.
    using Replaced = std::map<std::string, std::shared_ptr<const Words>, std::less<>>;

    /// Null: the shader's own.
    std::shared_ptr<const Words> find(std::string_view name) const;
    /// Pipelines made from now on are of these, and of built-in ones where there is none. Gives what was there before.
    /// The words must be valid SPIR-V with the interface of those that they stand for (shader_interface.h).
    Replaced exchange(Replaced replaced);

  private:
    mutable std::mutex mutex_;
    Replaced replaced_;
};

}  // namespace lacedring::gpu
