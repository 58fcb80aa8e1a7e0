#include "app/view/scene/scene.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <utility>

#include "lacedring/lacedring.hpp"
#include "renderer/vk/try.h"
#include "spirv/compose_comp.h"

namespace lacedring::view {
namespace {

using gpu::Access;

constexpr VkImageLayout kGeneral = VK_IMAGE_LAYOUT_GENERAL;
constexpr Access kColourWrite{VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT,
                              VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT | VK_ACCESS_2_COLOR_ATTACHMENT_READ_BIT};
constexpr Access kComposeRead{VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_STORAGE_READ_BIT};
constexpr Access kComposeWrite{VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT};
constexpr Access kTransferRead{VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_READ_BIT};
constexpr Access kTransferWrite{VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT};
/// How many pictures are drawn.
int sides_of(const Shown& shown) {
    return shown.mode == Mode::single ? 1 : 2;
}

/// What was drawn, to be read by compose.comp and by triangle_at.
void leave(VkCommandBuffer commands, const gpu::Target& target) {
    for (const gpu::Image* image : {&target.colour(), &target.triangles()}) {
        gpu::image_barrier(commands, image->handle(), image->aspect(), kColourWrite, kComposeRead,
                           VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, kGeneral);
    }
}

constexpr std::uint32_t kTimestamps = 3;
constexpr std::uint32_t kGroup = 8;  // compose.comp
constexpr double kLeastEdge = 1.5;   // pixels of a mean edge from which the growing ring has a line

}  // namespace

Result<Scene> Scene::create(gpu::Context& context, std::function<void()> wake) {
    Scene out;
    out.context_ = &context;
    LR_ASSIGN(out.commands_, gpu::Commands::create(context));
    LR_ASSIGN(out.transfer_, gpu::Transfer::create(context));
    LR_ASSIGN(gpu::Expander expander, gpu::Expander::create(context));
    out.expander_ = std::make_unique<gpu::Expander>(std::move(expander));
    LR_ASSIGN(out.uploader_, Uploader::create(context, std::move(wake)));
    std::vector<gpu::Binding> bindings;
    for (std::uint32_t i = 0; i < 5; ++i) bindings.push_back({i, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE});
    for (std::uint32_t i = 5; i < 7; ++i) bindings.push_back({i, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER});
    LR_ASSIGN(out.layout_, gpu::Layout::create(context, "compose", bindings, VK_SHADER_STAGE_COMPUTE_BIT,
                                               sizeof(gpu::ComposeConstants)));
    LR_ASSIGN(out.paint_, gpu::Buffer::create(context, "paint", 16, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT));
    LR_ASSIGN(out.growth_, gpu::Buffer::create(context, "growth", 16, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT));
    LR_ASSIGN(out.pixel_, gpu::Buffer::create(context, "pixel", 16, 0, gpu::Memory::readback));
    if (context.info().timestamps) {
        VkQueryPoolCreateInfo info{};
        info.sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO;
        info.queryType = VK_QUERY_TYPE_TIMESTAMP;
        info.queryCount = kTimestamps;
        VkQueryPool queries = VK_NULL_HANDLE;
        LR_TRY_VK(vkCreateQueryPool(context.device(), &info, nullptr, &queries));
        out.queries_ = {context.device(), queries};
    }
    return out;
}

Result<void> Scene::resize(VkExtent2D extent, std::uint32_t samples) {
    // Lines and supersampling go together, so painters do, too.
    if (samples != samples_) painters_.clear();
    for (auto& [key, entry] : entries_) entry.plans.clear();
    extent_ = extent;
    samples_ = samples;
    const VkExtent2D drawn{extent.width * samples, extent.height * samples};
    for (auto& target : targets_) {
        target.reset();
        LR_ASSIGN(target, gpu::Target::create(*context_, drawn, VK_IMAGE_USAGE_STORAGE_BIT));
    }
    LR_ASSIGN(composed_, gpu::Image::create(*context_, "composed", extent, gpu::Target::kColour,
                                            VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT));
    blank_ = true;
    return write_sets();
}

Result<void> Scene::write_sets() {
    if (!targets_[0]) return {};
    descriptors_ = gpu::Descriptors(*context_);
    for (const int both : {0, 1}) {
        LR_ASSIGN(sets_[both], descriptors_.allocate(layout_));
        const gpu::Target& right = *targets_[both];
        descriptors_.write_image(sets_[both], 0, targets_[0]->colour().view());
        descriptors_.write_image(sets_[both], 1, targets_[0]->triangles().view());
        descriptors_.write_image(sets_[both], 2, right.colour().view());
        descriptors_.write_image(sets_[both], 3, right.triangles().view());
        descriptors_.write_image(sets_[both], 4, composed_.view());
        descriptors_.write(sets_[both], 5, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, {&paint_});
        descriptors_.write(sets_[both], 6, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, {&growth_});
    }
    return {};
}

Result<bool> Scene::adopt(const std::shared_ptr<const gpu::Model>& model, const Shown& shown) {
    if (model == model_) return true;
    if (model != adopting_) {
        adopted_.clear();
        adopting_ = model;
    }
    const Result<bool> there = upload(model, shown, adopted_);
    if (there && !*there) return false;
    adopting_.reset();
    Entries entries = std::exchange(adopted_, {});
    if (!there) return there.error();
    entries_ = std::move(entries);
    model_ = model;
    return true;
}

Result<void> Scene::set_outlines(const EncodedLr* tables) {
    adjacency_.reset();
    // Surfaces are pushed back, or no longer.
    painters_.clear();
    for (auto& [key, entry] : entries_) entry.plans.clear();
    if (tables == nullptr || !model_) return {};
    if (!silhouettes_) {
        LR_ASSIGN(silhouettes_, gpu::Silhouettes::create(*context_));
    }
    LR_ASSIGN(adjacency_, gpu::upload_adjacency(*context_, *transfer_, *tables, gpu::surface_positions(*model_)));
    return {};
}

Result<void> Scene::reload() {
    uploader_->finish();  // it knows the expander
    LR_ASSIGN(gpu::Expander expander, expander_->again());
    decltype(compose_) compose;
    for (const auto& [constants, pipeline] : compose_) {
        LR_ASSIGN(compose[constants],
                  gpu::create_compute(*context_, "compose", layout_, spirv_compose_comp, constants));
    }
    std::optional<gpu::Silhouettes> silhouettes;
    if (silhouettes_) {
        LR_ASSIGN(silhouettes, gpu::Silhouettes::create(*context_));
    }
    std::map<gpu::View, gpu::Painter> painters;
    for (const auto& [view, painter] : painters_) {
        LR_ASSIGN(gpu::Painter again, painter.again());
        painters.emplace(view, std::move(again));
    }
    context_->wait_idle();  // the last picture may still be drawn with those that go
    *expander_ = std::move(expander);
    compose_ = std::move(compose);
    silhouettes_ = std::move(silhouettes);
    painters_ = std::move(painters);
    // Index buffers are of the old shaders: streams are expanded anew, index lists uploaded anew, for they were turned
    // in place. What was planned for expanding holds: the layouts are the same.
    std::erase_if(entries_, [](const auto& entry) { return entry.first.source == gpu::Source::plain; });
    for (auto& [key, entry] : entries_) {
        entry.plans.clear();
        entry.expanded.mesh.decoded = false;
    }
    return {};
}

UploadKey Scene::key_of(const Shown& shown, int side) {
    using With = UploadKey::With;
    const With with = shown.view == gpu::View::offsets ? With::offsets
                      : shown.view == gpu::View::wire  ? With::edges
                      : shown.view == gpu::View::seams ? With::seams
                                                       : With::ring;
    if (shown.source == gpu::Source::plain || (shown.mode != Mode::single && side == 0)) {
        return {gpu::Source::plain, gpu::Path::compute, with};
    }
    return {shown.source, shown.path, with};
}

/// True once all that `shown` needs of the model is in `entries`.
Result<bool> Scene::upload(const std::shared_ptr<const gpu::Model>& model, const Shown& shown, Entries& entries) {
    if (std::optional<Uploader::Done> done = uploader_->take()) {
        if (done->job.model == model) {
            if (done->error) return *done->error;
            for (std::size_t i = 0; i < done->meshes.size(); ++i) {
                entries.emplace(done->job.keys[i], Entry{std::move(done->meshes[i]), {}});
            }
        }
    }
    Uploader::Job missing{model, {}};
    for (int side = 0; side < sides_of(shown); ++side) {
        const UploadKey key = key_of(shown, side);
        if (!entries.contains(key)) missing.keys.push_back(key);
    }
    if (missing.keys.empty()) return true;
    if (!uploader_->asked(missing)) uploader_->ask(std::move(missing), *expander_);
    return false;
}

Result<gpu::Painter*> Scene::painter(gpu::View view) {
    const auto found = painters_.find(view);
    if (found != painters_.end()) return &found->second;
    LR_ASSIGN(gpu::Painter made, gpu::Painter::create(*context_, view, samples_, adjacency_.has_value()));
    return &painters_.emplace(view, std::move(made)).first->second;
}

Result<bool> Scene::prepare(const Shown& shown) {
    if (!model_) return true;
    // While another model is on its way, this one is drawn as far as it is there.
    if (adopting_) {
        for (int side = 0; side < sides_of(shown); ++side) {
            if (!entries_.contains(key_of(shown, side))) return false;
        }
    } else {
        LR_ASSIGN(const bool there, upload(model_, shown, entries_));
        if (!there) return false;
    }
    LR_ASSIGN(gpu::Painter * by, painter(shown.view));
    for (int side = 0; side < sides_of(shown); ++side) {
        Entry& entry = entries_.at(key_of(shown, side));
        if (entry.plans.contains({shown.view, side})) continue;
        Plan plan{gpu::Descriptors(*context_), {}};
        LR_ASSIGN(plan.draw, by->plan(plan.descriptors, entry.expanded.mesh, *targets_[side]));
        entry.plans.emplace(std::pair(shown.view, side), std::move(plan));
    }
    return true;
}

void Scene::record_clear(VkCommandBuffer commands, int first) {
    for (int side = first; side < 2; ++side) {
        const gpu::Target& target = *targets_[side];
        target.prepare(commands);
        target.begin(commands, {.colour = true, .triangles = true, .clear_colour = true, .clear_depth = true});
        gpu::Target::end(commands);
        leave(commands, target);
    }
    blank_ = false;
}

Result<void> Scene::record_draw(VkCommandBuffer commands, const Shown& shown, const gpu::CameraOptions& options) {
    const auto stamp = [&](std::uint32_t i) {
        if (queries_) vkCmdWriteTimestamp2(commands, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, queries_.get(), i);
    };
    view_ = shown.view;
    const int sides = sides_of(shown);
    if (blank_) record_clear(commands, sides);  // what is not drawn must be readable
    const VkExtent2D drawn = targets_[0]->extent();
    LR_ASSIGN(const gpu::Camera camera, gpu::make_camera(*model_, options, drawn.width, drawn.height));
    edge_pixels_ = model_->mean_edge * camera.pixels_per_unit / samples_;
    gpu::Painter& by = painters_.at(shown.view);
    by.set_frame(*model_, camera, *targets_[0]);
    if (adjacency_) {
        gpu::SilhouetteStyle style;
        style.width *= static_cast<float>(samples_);
        silhouettes_->set_frame(camera, *targets_[0], style);
    }
    if (queries_) vkCmdResetQueryPool(commands, queries_.get(), 0, kTimestamps);
    stamp(0);
    for (int side = 0; side < sides; ++side) {
        gpu::ExpandedMesh& expanded = entries_.at(key_of(shown, side)).expanded;
        if (shown.decode_again && expanded.mesh.source != gpu::Source::plain) expanded.mesh.decoded = false;
        expander_->decode(commands, expanded);
    }
    stamp(1);
    for (int side = 0; side < sides; ++side) {
        Entry& entry = entries_.at(key_of(shown, side));
        if (shown.exact) expander_->rotate(commands, entry.expanded);
        by.record(commands, entry.expanded.mesh, entry.plans.at({shown.view, side}).draw, *targets_[side],
                  shown.exact ? gpu::Painter::Ties::by_number : gpu::Painter::Ties::first_drawn);
        if (adjacency_) silhouettes_->record(commands, *adjacency_, *targets_[side]);
    }
    stamp(2);
    timed_ = static_cast<bool>(queries_);
    for (int side = 0; side < sides; ++side) leave(commands, *targets_[side]);
    return {};
}

Result<VkPipeline> Scene::compose_pipeline(Mode mode) {
    const std::uint32_t how = mode == Mode::single  ? LR_COMPOSE_LEFT
                              : mode == Mode::split ? LR_COMPOSE_SPLIT
                                                    : LR_COMPOSE_DIFFERENCE;
    std::uint32_t paint = painted_ ? LR_PAINT_TRIANGLES : LR_PAINT_NONE;
    if (grows_) paint |= LR_PAINT_GROWTH;
    if (grows_ && edge_pixels_ > kLeastEdge) paint |= LR_PAINT_RING;
    const bool grey =
        view_ == gpu::View::smooth || view_ == gpu::View::flat || view_ == gpu::View::wire || view_ == gpu::View::seams;
    if (paint != LR_PAINT_NONE && !grey) paint |= LR_PAINT_FLAT;
    const std::array<std::uint32_t, 3> constants{how, samples_, paint};
    gpu::PipelineHandle& made = compose_[constants];
    if (!made) {
        LR_ASSIGN(made, gpu::create_compute(*context_, "compose", layout_, spirv_compose_comp, constants));
    }
    return made.get();
}

Result<void> Scene::record_compose(VkCommandBuffer commands, Mode mode, std::uint32_t divider) {
    LR_ASSIGN(const VkPipeline pipeline, compose_pipeline(mode));
    gpu::image_barrier(commands, composed_.handle(), composed_.aspect(), kTransferRead, kComposeWrite,
                       VK_IMAGE_LAYOUT_UNDEFINED, kGeneral);
    gpu::ComposeConstants push{};
    push.divider = divider;
    push.triangles = (painted_ || grows_) && model_ ? model_->triangle_count() : 0;
    push.invaded = invaded_;
    push.fresh = fresh_;
    // The ring's line, faded and thinned like the one of the view of the ring (renderer/draw/painter.cpp).
    const double strength = std::clamp((edge_pixels_ - 1) / 9, 0.0, 1.0);
    const double closer = std::clamp((edge_pixels_ - 10) / 40, 0.0, 1.0);
    const auto width = static_cast<std::uint32_t>(std::lround((0.7 + 1.5 * strength + 1.3 * closer) * samples_));
    push.inner = (width + 1) / 2;
    push.outer = width / 2;
    push.line_opacity = static_cast<float>(0.15 + 0.80 * strength);
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline);
    vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, layout_.pipeline(), 0, 1,
                            &sets_[mode == Mode::single ? 0 : 1], 0, nullptr);
    vkCmdPushConstants(commands, layout_.pipeline(), VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof(push), &push);
    vkCmdDispatch(commands, (extent_.width + kGroup - 1) / kGroup, (extent_.height + kGroup - 1) / kGroup, 1);
    gpu::image_barrier(commands, composed_.handle(), composed_.aspect(), kComposeWrite, kTransferRead, kGeneral,
                       VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
    return {};
}

std::optional<SceneTimes> Scene::times() const {
    if (!timed_) return std::nullopt;
    std::array<std::uint64_t, kTimestamps> ticks{};
    if (vkGetQueryPoolResults(context_->device(), queries_.get(), 0, kTimestamps, sizeof(ticks), ticks.data(),
                              sizeof(ticks[0]), VK_QUERY_RESULT_64_BIT) != VK_SUCCESS) {
        return std::nullopt;
    }
    const double period = static_cast<double>(context_->limits().timestampPeriod) * 1e-9;
    return SceneTimes{static_cast<double>(ticks[1] - ticks[0]) * period,
                      static_cast<double>(ticks[2] - ticks[1]) * period};
}

Result<std::optional<std::uint32_t>> Scene::triangle_at(std::uint32_t x, std::uint32_t y, bool right) {
    if (!model_ || x >= extent_.width || y >= extent_.height) return std::optional<std::uint32_t>{};
    const gpu::Image& image = targets_[right ? 1 : 0]->triangles();
    LR_ASSIGN(const VkCommandBuffer commands, commands_->begin());
    VkBufferImageCopy region{};
    region.imageSubresource = {image.aspect(), 0, 0, 1};
    region.imageOffset = {static_cast<std::int32_t>(x * samples_ + samples_ / 2),
                          static_cast<std::int32_t>(y * samples_ + samples_ / 2), 0};
    region.imageExtent = {1, 1, 1};
    constexpr VkImageLayout kSource = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL;
    gpu::image_barrier(commands, image.handle(), image.aspect(), kComposeRead, kTransferRead, kGeneral, kSource);
    vkCmdCopyImageToBuffer(commands, image.handle(), kSource, pixel_.handle(), 1, &region);
    gpu::image_barrier(commands, image.handle(), image.aspect(), kTransferRead, kComposeRead, kSource, kGeneral);
    gpu::memory_barrier(commands, kTransferWrite, {VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_READ_BIT});
    LR_TRY(commands_->run());
    std::uint32_t id = 0;
    std::memcpy(&id, pixel_.mapped(), sizeof(id));
    if (id == 0) return std::optional<std::uint32_t>{};
    return std::optional((id & ~LR_FRONT_FLAG) - 1);
}

Result<gpu::Difference> Scene::difference() {
    LR_ASSIGN(const VkCommandBuffer commands, commands_->begin());
    for (const auto& target : targets_) {
        for (const gpu::Image* image : {&target->colour(), &target->triangles()}) {
            gpu::image_barrier(commands, image->handle(), image->aspect(), kComposeRead, kColourWrite, kGeneral,
                               VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL);
        }
        target->record_read(commands);
        for (const gpu::Image* image : {&target->colour(), &target->triangles()}) {
            gpu::image_barrier(commands, image->handle(), image->aspect(), kTransferRead, kComposeRead,
                               VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, kGeneral);
        }
    }
    LR_TRY(commands_->run());
    return gpu::difference(targets_[0]->picture(), targets_[1]->picture());
}

}  // namespace lacedring::view
