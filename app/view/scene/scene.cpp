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
constexpr Access kColorWrite{VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT,
                             VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT | VK_ACCESS_2_COLOR_ATTACHMENT_READ_BIT};
constexpr Access kComposeRead{VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_STORAGE_READ_BIT};
constexpr Access kComposeWrite{VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT};
constexpr Access kTransferRead{VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_READ_BIT};
constexpr Access kTransferWrite{VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT};

/// Makes the drawn images readable for compose.comp and triangle_at.
void leave(VkCommandBuffer commands, const gpu::Target& target) {
    for (const gpu::Image* image : {&target.color(), &target.triangles()}) {
        gpu::image_barrier(commands, image->handle(), image->aspect(), kColorWrite, kComposeRead,
                           VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, kGeneral);
    }
}

constexpr std::uint32_t kTimestamps = 3;
constexpr std::uint32_t kGroup = 8;  // side of a workgroup of compose.comp
// The ring's line is drawn if the mean edge is longer than this, in pixels.
constexpr double kLeastEdge = 1.5;

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

Result<void> Scene::resize(VkExtent2D extent, std::uint32_t samples, int sides) {
    const bool other = extent.width != extent_.width || extent.height != extent_.height;
    std::erase_if(sides_, [&](const auto& entry) { return other || (entry.first != 1 && entry.first != samples); });
    for (auto& [key, entry] : entries_) {
        std::erase_if(entry.plans, [&](const auto& plan) { return !sides_.contains(std::get<1>(plan.first)); });
    }
    blank_ = blank_ || !sides_.contains(drawn_.samples);
    if (other) {
        extent_ = {};  // until all images are made
        LR_ASSIGN(composed_, gpu::Image::create(*context_, "composed", extent, gpu::Target::kColor,
                                                VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT));
    }
    for (const std::uint32_t n : {1U, samples}) {
        for (int side = 0; side < sides; ++side) {
            std::optional<gpu::Target>& target = sides_[n].targets[side];
            if (target) continue;
            LR_ASSIGN(target, gpu::Target::create(*context_, {extent.width * n, extent.height * n},
                                                  VK_IMAGE_USAGE_STORAGE_BIT));
        }
    }
    extent_ = extent;
    return write_sets();
}

Result<void> Scene::write_sets() {
    descriptors_ = gpu::Descriptors(*context_);
    for (auto& [samples, sides] : sides_) {
        for (const int last : {0, 1}) {
            if (!sides.targets[last]) continue;
            VkDescriptorSet& set = sides.sets[last];
            LR_ASSIGN(set, descriptors_.allocate(layout_));
            descriptors_.write_image(set, 0, sides.targets[0]->color().view());
            descriptors_.write_image(set, 1, sides.targets[0]->triangles().view());
            descriptors_.write_image(set, 2, sides.targets[last]->color().view());
            descriptors_.write_image(set, 3, sides.targets[last]->triangles().view());
            descriptors_.write_image(set, 4, composed_.view());
            descriptors_.write(set, 5, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, {&paint_});
            descriptors_.write(set, 6, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, {&growth_});
        }
    }
    return {};
}

Result<bool> Scene::adopt(const std::shared_ptr<const OwningModel>& model, const Shown& shown) {
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

Result<void> Scene::set_outlines(const EncodedLr* tables, double crease) {
    adjacency_.reset();
    crease_ = crease;
    // With outlines, painters push surfaces back in depth: recreate them.
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
    uploader_->finish();  // it uses the expander
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
    decltype(painters_) painters;
    for (const auto& [key, painter] : painters_) {
        LR_ASSIGN(gpu::Painter again, painter.again());
        painters.emplace(key, std::move(again));
    }
    // The last picture may still use the old pipelines.
    context_->wait_idle();
    *expander_ = std::move(expander);
    compose_ = std::move(compose);
    silhouettes_ = std::move(silhouettes);
    painters_ = std::move(painters);
    // Index buffers were written by the old shaders. Expand streams again, and upload index lists again, because they
    // were rotated in place. Plans for expanding stay valid: the layouts are the same.
    std::erase_if(entries_, [](const auto& entry) { return entry.first.source == gpu::Source::plain; });
    for (auto& [key, entry] : entries_) {
        entry.plans.clear();
        entry.mesh.expanded.mesh.decoded = false;
    }
    return {};
}

UploadKey Scene::key_of(const Shown& shown, int side) {
    using With = UploadKey::With;
    const With with = shown.view == gpu::View::offsets    ? With::offsets
                      : shown.view == gpu::View::wire     ? With::edges
                      : shown.view == gpu::View::seams    ? With::seams
                      : shown.view == gpu::View::material ? With::materials
                                                          : With::ring;
    if (shown.source == gpu::Source::plain || (shown.mode != Mode::single && side == 0)) {
        return {gpu::Source::plain, gpu::Path::compute, with};
    }
    return {shown.source, shown.path, with};
}

/// Starts uploading what `shown` needs of the model; returns whether all of it is in `entries`.
Result<bool> Scene::upload(const std::shared_ptr<const OwningModel>& model, const Shown& shown, Entries& entries) {
    if (std::optional<Uploader::Done> done = uploader_->take()) {
        if (done->job.model == model) {
            if (done->error) return *done->error;
            for (std::size_t i = 0; i < done->meshes.size(); ++i) {
                entries.emplace(done->job.keys[i], Entry{std::move(done->meshes[i]), {}});
            }
        }
    }
    Uploader::Job missing{model, {}};
    for (int side = 0; side < shown.sides(); ++side) {
        const UploadKey key = key_of(shown, side);
        if (!entries.contains(key)) missing.keys.push_back(key);
    }
    if (missing.keys.empty()) return true;
    if (!uploader_->asked(missing)) uploader_->ask(std::move(missing), *expander_);
    return false;
}

Result<gpu::Painter*> Scene::painter(gpu::View view, std::uint32_t samples) {
    const std::pair key(view, samples);
    const auto found = painters_.find(key);
    if (found != painters_.end()) return &found->second;
    LR_ASSIGN(gpu::Painter made, gpu::Painter::create(*context_, view, samples, adjacency_.has_value()));
    return &painters_.emplace(key, std::move(made)).first->second;
}

Result<bool> Scene::prepare(const Shown& shown) {
    if (!model_) return true;
    // While another model is being uploaded, upload nothing of this one.
    if (adopting_) {
        for (int side = 0; side < shown.sides(); ++side) {
            if (!entries_.contains(key_of(shown, side))) return false;
        }
    } else {
        LR_ASSIGN(const bool there, upload(model_, shown, entries_));
        if (!there) return false;
    }
    LR_ASSIGN(gpu::Painter * by, painter(shown.view, shown.samples));
    for (int side = 0; side < shown.sides(); ++side) {
        Entry& entry = entries_.at(key_of(shown, side));
        const std::tuple key(shown.view, shown.samples, side);
        if (entry.plans.contains(key)) continue;
        Plan plan{gpu::Descriptors(*context_), {}};
        const gpu::Target& target = *sides_.at(shown.samples).targets[side];
        LR_ASSIGN(plan.draw, by->plan(plan.descriptors, entry.mesh.expanded.mesh, target));
        entry.plans.emplace(key, std::move(plan));
    }
    return true;
}

void Scene::record_clear(VkCommandBuffer commands) {
    const gpu::Target& target = *sides_.at(1).targets[0];
    target.prepare(commands);
    target.begin(commands, {.color = true, .triangles = true, .clear_color = true, .clear_depth = true});
    gpu::Target::end(commands);
    leave(commands, target);
    drawn_ = {.samples = 1};
    blank_ = false;
}

Result<void> Scene::record_draw(VkCommandBuffer commands, const Shown& shown, const gpu::CameraOptions& options) {
    const auto stamp = [&](std::uint32_t i) {
        if (queries_) vkCmdWriteTimestamp2(commands, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, queries_.get(), i);
    };
    drawn_ = shown;
    blank_ = false;
    const int sides = shown.sides();
    const auto& targets = sides_.at(shown.samples).targets;
    const VkExtent2D drawn = targets[0]->extent();
    LR_ASSIGN(const gpu::Camera camera, gpu::make_camera(*model_, options, drawn.width, drawn.height));
    edge_pixels_ = model_->mean_edge * camera.pixels_per_unit / shown.samples;
    gpu::Painter& by = painters_.at({shown.view, shown.samples});
    by.set_frame(*model_, camera, *targets[0]);
    if (adjacency_) {
        gpu::SilhouetteStyle style;
        style.crease = crease_;
        style.width *= static_cast<float>(shown.samples);
        silhouettes_->set_frame(camera, *targets[0], style);
    }
    if (queries_) vkCmdResetQueryPool(commands, queries_.get(), 0, kTimestamps);
    stamp(0);
    for (int side = 0; side < sides; ++side) {
        gpu::ExpandedMesh& expanded = entries_.at(key_of(shown, side)).mesh.expanded;
        if (shown.decode_again && expanded.mesh.source != gpu::Source::plain) expanded.mesh.decoded = false;
        expander_->decode(commands, expanded);
    }
    stamp(1);
    for (int side = 0; side < sides; ++side) {
        Entry& entry = entries_.at(key_of(shown, side));
        if (shown.exact) expander_->rotate(commands, entry.mesh.expanded);
        by.record(commands, entry.mesh.expanded.mesh, entry.plans.at({shown.view, shown.samples, side}).draw,
                  *targets[side], shown.exact ? gpu::Painter::Ties::by_number : gpu::Painter::Ties::first_drawn);
        if (adjacency_) silhouettes_->record(commands, *adjacency_, *targets[side]);
    }
    stamp(2);
    timed_ = static_cast<bool>(queries_);
    for (int side = 0; side < sides; ++side) leave(commands, *targets[side]);
    return {};
}

const gpu::GpuMaterials* Scene::materials() const {
    const auto found = entries_.find(key_of(drawn_, drawn_.sides() - 1));
    const UploadedMaterials* const of = found != entries_.end() ? found->second.mesh.materials.get() : nullptr;
    return of != nullptr ? &of->device : nullptr;
}

bool Scene::has_ring_line() const {
    return parted_ && edge_pixels_ > kLeastEdge;
}

Result<VkPipeline> Scene::compose_pipeline() {
    const auto [mode, view] = std::pair(drawn_.mode, drawn_.view);
    const std::uint32_t how = mode == Mode::single  ? LR_COMPOSE_LEFT
                              : mode == Mode::split ? LR_COMPOSE_SPLIT
                                                    : LR_COMPOSE_DIFFERENCE;
    std::uint32_t paint = painted_ ? LR_PAINT_TRIANGLES : LR_PAINT_NONE;
    if (grows_) paint |= LR_PAINT_GROWTH;
    if (has_ring_line()) paint |= LR_PAINT_RING;
    const bool gray = view == gpu::View::smooth || view == gpu::View::flat || view == gpu::View::wire ||
                      view == gpu::View::seams || view == gpu::View::silhouette;
    if (paint != LR_PAINT_NONE && !gray) paint |= LR_PAINT_FLAT;
    const std::array<std::uint32_t, 3> constants{how, drawn_.samples, paint};
    gpu::PipelineHandle& made = compose_[constants];
    if (!made) {
        LR_ASSIGN(made, gpu::create_compute(*context_, "compose", layout_, spirv_compose_comp, constants));
    }
    return made.get();
}

Result<void> Scene::record_compose(VkCommandBuffer commands, std::uint32_t divider) {
    LR_ASSIGN(const VkPipeline pipeline, compose_pipeline());
    gpu::image_barrier(commands, composed_.handle(), composed_.aspect(), kTransferRead, kComposeWrite,
                       VK_IMAGE_LAYOUT_UNDEFINED, kGeneral);
    gpu::ComposeConstants push{};
    push.divider = divider;
    push.triangles = (painted_ || parted_) && model_ ? model_->triangle_count() : 0;
    push.invaded = invaded_;
    push.fresh = fresh_;
    // The ring's line fades and thins with short edges, as in View::ring (renderer/draw/painter.cpp).
    const double strength = std::clamp((edge_pixels_ - 1) / 9, 0.0, 1.0);
    const double closer = std::clamp((edge_pixels_ - 10) / 40, 0.0, 1.0);
    const auto width = static_cast<std::uint32_t>(std::lround((0.7 + 1.5 * strength + 1.3 * closer) * drawn_.samples));
    push.inner = (width + 1) / 2;
    push.outer = width / 2;
    push.line_opacity = static_cast<float>(0.15 + 0.80 * strength);
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline);
    vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, layout_.pipeline(), 0, 1,
                            &sides_.at(drawn_.samples).sets[drawn_.sides() - 1], 0, nullptr);
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
    const gpu::Image& image = sides_.at(drawn_.samples).targets[right ? 1 : 0]->triangles();
    const std::uint32_t n = drawn_.samples;
    LR_ASSIGN(const VkCommandBuffer commands, commands_->begin());
    VkBufferImageCopy region{};
    region.imageSubresource = {image.aspect(), 0, 0, 1};
    region.imageOffset = {static_cast<std::int32_t>(x * n + n / 2), static_cast<std::int32_t>(y * n + n / 2), 0};
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
    const auto& targets = sides_.at(drawn_.samples).targets;
    for (const auto& target : targets) {
        for (const gpu::Image* image : {&target->color(), &target->triangles()}) {
            gpu::image_barrier(commands, image->handle(), image->aspect(), kComposeRead, kColorWrite, kGeneral,
                               VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL);
        }
        target->record_read(commands);
        for (const gpu::Image* image : {&target->color(), &target->triangles()}) {
            gpu::image_barrier(commands, image->handle(), image->aspect(), kTransferRead, kComposeRead,
                               VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, kGeneral);
        }
    }
    LR_TRY(commands_->run());
    return gpu::difference(targets[0]->picture(), targets[1]->picture());
}

Result<void> Scene::hold(gpu::Buffer& buffer, const char* name, std::size_t bytes) {
    if (buffer.size() >= bytes && buffer.mapped() != nullptr) return {};
    LR_ASSIGN(buffer,
              gpu::Buffer::create(*context_, name, bytes, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, gpu::Memory::upload));
    return write_sets();
}

Result<void> Scene::set_paint(std::span<const std::uint32_t> colors) {
    under_marks_.clear();
    painted_ = colored_ = !colors.empty();
    if (!painted_) return {};
    LR_TRY(hold(paint_, "paint", colors.size_bytes()));
    std::memcpy(paint_.mapped(), colors.data(), colors.size_bytes());
    return {};
}

Result<void> Scene::set_marks(std::span<const Mark> marks) {
    const auto exchange = [&](const Mark& mark) {
        std::byte* at = paint_.mapped() + sizeof(std::uint32_t) * mark.triangle;
        Mark under = mark;
        std::memcpy(&under.color, at, sizeof(under.color));
        std::memcpy(at, &mark.color, sizeof(mark.color));
        return under;
    };
    while (!under_marks_.empty()) {  // in reverse order: a triangle may have been marked twice
        exchange(under_marks_.back());
        under_marks_.pop_back();
    }
    painted_ = colored_ || !marks.empty();
    if (marks.empty() || !model_) return {};
    if (!colored_) {
        const std::size_t bytes = sizeof(std::uint32_t) * std::size_t{model_->triangle_count()};
        LR_TRY(hold(paint_, "paint", bytes));
        std::memset(paint_.mapped(), 0, bytes);
    }
    for (const Mark& mark : marks) under_marks_.push_back(exchange(mark));
    return {};
}

Result<void> Scene::set_sides(std::span<const gpu::GrowthTriangle> triangles, bool colors) {
    parted_ = !triangles.empty();
    grows_ = parted_ && colors;
    if (!parted_) return {};
    LR_TRY(hold(growth_, "growth", triangles.size_bytes()));
    std::memcpy(growth_.mapped(), triangles.data(), triangles.size_bytes());
    return {};
}

void Scene::grow(std::uint32_t invaded, std::uint32_t fresh) {
    invaded_ = invaded;
    fresh_ = fresh;
}

}  // namespace lacedring::view
