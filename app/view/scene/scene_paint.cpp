// What compose.comp lays over the triangles, kept on the device.
#include <cstring>

#include "app/view/scene/scene.h"
#include "renderer/vk/try.h"

namespace lacedring::view {

Result<void> Scene::hold(gpu::Buffer& buffer, const char* name, std::size_t bytes) {
    if (buffer.size() >= bytes && buffer.mapped() != nullptr) return {};
    LR_ASSIGN(buffer,
              gpu::Buffer::create(*context_, name, bytes, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, gpu::Memory::upload));
    return write_sets();
}

Result<void> Scene::set_paint(std::span<const std::uint32_t> colours) {
    under_marks_.clear();
    painted_ = coloured_ = !colours.empty();
    if (!painted_) return {};
    LR_TRY(hold(paint_, "paint", colours.size_bytes()));
    std::memcpy(paint_.mapped(), colours.data(), colours.size_bytes());
    return {};
}

Result<void> Scene::set_marks(std::span<const Mark> marks) {
    const auto exchange = [&](const Mark& mark) {
        std::byte* at = paint_.mapped() + sizeof(std::uint32_t) * mark.triangle;
        Mark under = mark;
        std::memcpy(&under.colour, at, sizeof(under.colour));
        std::memcpy(at, &mark.colour, sizeof(mark.colour));
        return under;
    };
    while (!under_marks_.empty()) {  // a triangle may have been marked twice
        exchange(under_marks_.back());
        under_marks_.pop_back();
    }
    painted_ = coloured_ || !marks.empty();
    if (marks.empty() || !model_) return {};
    if (!coloured_) {
        const std::size_t bytes = sizeof(std::uint32_t) * std::size_t{model_->triangle_count()};
        LR_TRY(hold(paint_, "paint", bytes));
        std::memset(paint_.mapped(), 0, bytes);
    }
    for (const Mark& mark : marks) under_marks_.push_back(exchange(mark));
    return {};
}

Result<void> Scene::set_growth(std::span<const gpu::GrowthTriangle> triangles) {
    grows_ = !triangles.empty();
    if (!grows_) return {};
    LR_TRY(hold(growth_, "growth", triangles.size_bytes()));
    std::memcpy(growth_.mapped(), triangles.data(), triangles.size_bytes());
    return {};
}

void Scene::grow(std::uint32_t invaded, std::uint32_t fresh) {
    invaded_ = invaded;
    fresh_ = fresh;
}

}  // namespace lacedring::view
