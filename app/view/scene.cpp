#include "app/view/scene.h"

#include <algorithm>
#include <array>
#include <cstring>

#include "renderer/try.h"
#include "spirv/compose_comp.h"

namespace lr::view {
namespace {

using gpu::Access;

constexpr VkImageLayout kGeneral = VK_IMAGE_LAYOUT_GENERAL;
constexpr Access kColourWrite{VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT,
                              VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT | VK_ACCESS_2_COLOR_ATTACHMENT_READ_BIT};
constexpr Access kComposeRead{VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_STORAGE_READ_BIT};
constexpr Access kComposeWrite{VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT};
constexpr Access kTransferRead{VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_READ_BIT};
constexpr Access kTransferWrite{VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT};
constexpr std::uint32_t kTimestamps = 3;
constexpr std::uint32_t kGroup = 8;  // compose.comp

}  // namespace

Result<Scene> Scene::create(gpu::Context& context) {
    Scene out;
    out.context_ = &context;
    LR_ASSIGN(out.commands_, gpu::Commands::create(context));
    LR_ASSIGN(out.transfer_, gpu::Transfer::create(context));
    LR_ASSIGN(out.expander_, gpu::Expander::create(context));
    std::vector<gpu::Binding> bindings;
    for (std::uint32_t i = 0; i < 5; ++i) bindings.push_back({i, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE});
    bindings.push_back({5, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER});
    LR_ASSIGN(out.layout_, gpu::Layout::create(context, "compose", bindings, VK_SHADER_STAGE_COMPUTE_BIT,
                                               sizeof(gpu::ComposeConstants)));
    LR_ASSIGN(out.compose_, gpu::create_compute(context, "compose", out.layout_, spirv_compose_comp));
    LR_ASSIGN(out.paint_, gpu::Buffer::create(context, "paint", 16, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT));
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
    }
    return {};
}

Result<void> Scene::set_model(std::shared_ptr<const gpu::Model> model) {
    if (model == model_) return {};
    entries_.clear();
    model_ = std::move(model);
    return set_paint({});
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
    LR_ASSIGN(adjacency_, gpu::upload_adjacency(*context_, *transfer_, *tables, model_->positions));
    return {};
}

Result<void> Scene::set_paint(std::span<const std::uint32_t> colours) {
    painted_ = !colours.empty();
    if (!painted_) return {};
    if (paint_.size() < colours.size_bytes() || paint_.mapped() == nullptr) {
        LR_ASSIGN(paint_, gpu::Buffer::create(*context_, "paint", colours.size_bytes(),
                                              VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, gpu::Memory::upload));
        LR_TRY(write_sets());
    }
    std::memcpy(paint_.mapped(), colours.data(), colours.size_bytes());
    return {};
}

Scene::Kind Scene::kind_of(gpu::View view) {
    if (view == gpu::View::offsets) return Kind::offsets;
    return view == gpu::View::wire ? Kind::edges : Kind::ring;
}

Scene::Key Scene::key_of(const Shown& shown, int side) {
    if (shown.mode != Mode::single && side == 0) return {gpu::Source::plain, gpu::Path::compute, kind_of(shown.view)};
    const bool plain = shown.source == gpu::Source::plain;
    return {shown.source, plain ? gpu::Path::compute : shown.path, kind_of(shown.view)};
}

Result<Scene::Entry> Scene::upload(const Key& key) {
    const auto [source, path, kind] = key;
    gpu::UploadOptions options;
    options.path = path;
    options.ring = kind != Kind::edges;
    options.offsets = kind == Kind::offsets;
    options.lines = kind == Kind::edges ? gpu::UploadOptions::Lines::edges : gpu::UploadOptions::Lines::ring;
    LR_ASSIGN(gpu::Drawable drawable, expander_.upload(*transfer_, *model_, source, options));
    return Entry{std::move(drawable), {}};
}

Result<gpu::Painter*> Scene::painter(gpu::View view) {
    const auto found = painters_.find(view);
    if (found != painters_.end()) return &found->second;
    LR_ASSIGN(gpu::Painter made, gpu::Painter::create(*context_, view, samples_, adjacency_.has_value()));
    return &painters_.emplace(view, std::move(made)).first->second;
}

Result<void> Scene::prepare(const Shown& shown) {
    if (!model_) return {};
    LR_ASSIGN(gpu::Painter * by, painter(shown.view));
    for (int side = 0; side < (shown.mode == Mode::single ? 1 : 2); ++side) {
        const Key key = key_of(shown, side);
        if (!entries_.contains(key)) {
            LR_ASSIGN(Entry entry, upload(key));
            entries_.emplace(key, std::move(entry));
        }
        Entry& entry = entries_.at(key);
        if (entry.plans.contains({shown.view, side})) continue;
        Plan plan{gpu::Descriptors(*context_), {}};
        LR_ASSIGN(plan.draw, by->plan(plan.descriptors, entry.drawable.mesh, *targets_[side]));
        entry.plans.emplace(std::pair(shown.view, side), std::move(plan));
    }
    return {};
}

Result<void> Scene::record_draw(VkCommandBuffer commands, const Shown& shown, const gpu::CameraOptions& options) {
    const auto stamp = [&](std::uint32_t i) {
        if (queries_) vkCmdWriteTimestamp2(commands, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, queries_.get(), i);
    };
    view_ = shown.view;
    const int sides = shown.mode == Mode::single ? 1 : 2;
    timed_ = false;
    if (!model_) {
        for (int side = 0; side < sides; ++side) {
            targets_[side]->prepare(commands);
            targets_[side]->begin(commands,
                                  {.colour = true, .triangles = true, .clear_colour = true, .clear_depth = true});
            gpu::Target::end(commands);
        }
    } else {
        const VkExtent2D drawn = targets_[0]->extent();
        LR_ASSIGN(const gpu::Camera camera, gpu::make_camera(*model_, options, drawn.width, drawn.height));
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
            gpu::Drawable& drawable = entries_.at(key_of(shown, side)).drawable;
            if (shown.decode_again && drawable.mesh.source != gpu::Source::plain) drawable.mesh.decoded = false;
            expander_.decode(commands, drawable);
        }
        stamp(1);
        for (int side = 0; side < sides; ++side) {
            Entry& entry = entries_.at(key_of(shown, side));
            if (shown.exact) expander_.rotate(commands, entry.drawable);
            by.record(commands, entry.drawable.mesh, entry.plans.at({shown.view, side}).draw, *targets_[side],
                      shown.exact ? gpu::Painter::Ties::by_number : gpu::Painter::Ties::first_drawn);
            if (adjacency_) silhouettes_->record(commands, *adjacency_, *targets_[side]);
        }
        stamp(2);
        timed_ = static_cast<bool>(queries_);
    }
    for (int side = 0; side < sides; ++side) {
        for (const gpu::Image* image : {&targets_[side]->colour(), &targets_[side]->triangles()}) {
            gpu::image_barrier(commands, image->handle(), image->aspect(), kColourWrite, kComposeRead,
                               VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, kGeneral);
        }
    }
    return {};
}

void Scene::record_compose(VkCommandBuffer commands, Mode mode, std::uint32_t divider) const {
    gpu::image_barrier(commands, composed_.handle(), composed_.aspect(), kTransferRead, kComposeWrite,
                       VK_IMAGE_LAYOUT_UNDEFINED, kGeneral);
    gpu::ComposeConstants push{};
    push.mode = mode == Mode::single ? LR_COMPOSE_LEFT : mode == Mode::split ? LR_COMPOSE_SPLIT : LR_COMPOSE_DIFFERENCE;
    push.divider = divider;
    push.samples = samples_;
    const bool grey = view_ == gpu::View::smooth || view_ == gpu::View::flat || view_ == gpu::View::wire;
    push.paint = !painted_ ? LR_PAINT_NONE : grey ? LR_PAINT_LIT : LR_PAINT_FLAT;
    push.triangles = painted_ && model_ ? model_->triangle_count() : 0;
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, compose_.get());
    vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, layout_.pipeline(), 0, 1,
                            &sets_[mode == Mode::single ? 0 : 1], 0, nullptr);
    vkCmdPushConstants(commands, layout_.pipeline(), VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof(push), &push);
    vkCmdDispatch(commands, (extent_.width + kGroup - 1) / kGroup, (extent_.height + kGroup - 1) / kGroup, 1);
    gpu::image_barrier(commands, composed_.handle(), composed_.aspect(), kComposeWrite, kTransferRead, kGeneral,
                       VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
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

Result<gpu::Difference> Scene::difference(const gpu::CameraOptions& camera, const Shown& shown) {
    if (shown.mode == Mode::single) return Error{ErrorCode::invalid_argument, "there is one picture only"};
    LR_TRY(prepare(shown));
    // Drawn again: the pictures are read in the layout that drawing leaves them in.
    LR_ASSIGN(const VkCommandBuffer commands, commands_->begin());
    LR_TRY(record_draw(commands, shown, camera));
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

}  // namespace lr::view
