#include "renderer/shaders/shader_set.h"

#include <utility>

namespace lacedring::gpu {

std::shared_ptr<const ShaderSet::Words> ShaderSet::find(std::string_view name) const {
    const std::scoped_lock lock(mutex_);
    const auto at = replaced_.find(name);
    return at == replaced_.end() ? nullptr : at->second;
}

ShaderSet::Replaced ShaderSet::exchange(Replaced replaced) {
    const std::scoped_lock lock(mutex_);
    return std::exchange(replaced_, std::move(replaced));
}

}  // namespace lacedring::gpu
