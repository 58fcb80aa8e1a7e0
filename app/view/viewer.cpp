#include "app/view/viewer.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <filesystem>

#include "app/view/files.h"
#include "app/view/overlays.h"
#include "app/view/panels.h"
#include "app/view/theme.h"
#include "renderer/try.h"

namespace lr::view {
namespace {

constexpr std::size_t kHistory = 120;  // frames of the plot

double seconds_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

Result<std::unique_ptr<Viewer>> Viewer::create(gpu::Context& context, const ViewerOptions& options) {
    LR_ASSIGN(Scene scene, Scene::create(context));
    std::unique_ptr<Viewer> out(new Viewer(context, options, std::move(scene)));
    LR_ASSIGN(out->overlay_, Overlay::create(context, options.scale));
    LR_ASSIGN(out->commands_, gpu::Commands::create(context));
    State& state = out->state_;
    state.panels = options.panels;
    state.device = context.info().name;
    state.mesh_shaders = context.info().max_mesh_groups != 0;
    state.samples = context.info().software ? 1 : 2;
    state.recent = read_recent();
    std::error_code error;
    state.files =
        meshes_beside(options.input.path.empty() ? std::filesystem::current_path(error).string() : options.input.path);
    out->asked_ = state.ring;
    if (!options.input.path.empty()) state.open = options.input.path;
    return out;
}

std::string Viewer::title() const {
    if (!state_.document) return "LacedRing";
    return std::filesystem::path(state_.document->path).filename().string() + " - LacedRing";
}

Shown Viewer::shown(bool moving) const {
    Shown out = state_.shown;
    out.exact = !moving || state_.exact_while_moving || out.mode != Mode::single;
    if (scene_.model() != nullptr && out.source == gpu::Source::packed && scene_.model()->packed.words.empty()) {
        out.source = gpu::Source::lean;  // it is being made
    }
    return out;
}

Result<void> Viewer::resize() {
    const std::uint32_t samples = gpu::Target::fitting_samples(context_, extent_, state_.samples);
    if (made_.width == extent_.width && made_.height == extent_.height && made_samples_ == samples) return {};
    vkDeviceWaitIdle(context_.device());  // the window may still be taking the last picture
    LR_TRY(scene_.resize(extent_, samples));
    LR_TRY(overlay_->resize(extent_));
    made_ = extent_;
    made_samples_ = samples;
    dirty_ = true;
    return {};
}

Result<void> Viewer::frame_all(const gpu::CameraOptions& options) {
    if (!state_.document) return {};
    const double width = std::max(1U, extent_.width), height = std::max(1U, extent_.height);
    std::array<double, 2> fit{width, height};
    if (state_.panels && !options.position) fit = free_area(state_, width, height);
    LR_TRY(orbit_.frame(*state_.document->model, options, {width, height}, fit));
    dirty_ = true;
    return {};
}

void Viewer::opened(const std::string& path) {
    queue_.clear();
    state_.error.clear();
    state_.tables.reset();
    state_.formats.reset();
    state_.selection = {};
    state_.paint = Paint::none;
    state_.growing = false;
    state_.costs.clear();
    state_.files = meshes_beside(path);
    add_recent(state_.recent, path, options_.keep_recent);
}

void Viewer::take_news() {
    Loader::News news = loader_.take();
    state_.progress = loader_.progress();
    if (news.document) {
        const bool other = !state_.document || state_.document->mesh != news.document->mesh;
        if (other) opened(news.document->path);
        state_.document = std::move(news.document);
        if (const Result<void> set = scene_.set_model(state_.document->model); !set) state_.error = set.error().message;
        if (other) {
            const Result<void> framed = frame_all(options_.camera);
            if (!framed) state_.error = framed.error().message;
            const Vector up = options_.camera.up;
            options_.camera = {};  // was for the first mesh; its up stays
            options_.camera.up = up;
        }
        dirty_ = true;
    }
    if (news.tables && state_.document && news.tables->mesh == state_.document->mesh) state_.tables = news.tables;
    if (news.formats) state_.formats = news.formats;
    if (news.error) {
        state_.error = *news.error;
        if (!queue_.empty()) {
            state_.open = queue_.front();
            queue_.erase(queue_.begin());
        }
        quiet_frames_ = 0;
    }
}

/// What panels and keys asked for.
void Viewer::act() {
    if (state_.open) {
        Input input = options_.input;
        input.path = *std::exchange(state_.open, std::nullopt);
        if (queue_.empty()) state_.error.clear();
        loader_.open(input, state_.ring);
        asked_ = state_.ring;
    } else if (state_.ring != asked_ && state_.document && !ImGui::IsMouseDown(0)) {
        asked_ = state_.ring;
        loader_.encode(state_.document, state_.ring);
    }
    if (std::exchange(state_.cancel, false)) {
        loader_.cancel();
        queue_.clear();
    }
    if (std::exchange(state_.frame_all, false)) {
        gpu::CameraOptions options;
        options.up = options_.camera.up;
        if (const Result<void> framed = frame_all(options); !framed) state_.error = framed.error().message;
    }
    if (std::exchange(state_.frame_selection, false) && state_.document && state_.selection.any()) {
        const auto [centre, radius] = ball(*state_.document, state_.selection.corner);
        // In the middle of what its panel leaves of the window.
        const double height = extent_.height, seen = std::max(0.3 * height, height - state_.covered_below);
        orbit_.look_at(centre, radius * height / seen);
        orbit_.pan(0, (seen - height) / 2, height, extent_.width);
        dirty_ = true;
    }
    if (std::exchange(state_.copy_camera, false)) {
        clipboard_ = orbit_.text();
        state_.note = "camera copied";
        state_.note_until = state_.clock + 2;
    }
    if (std::exchange(state_.screenshot, false)) save(free_name("lacedring", ".png"));
    if (std::exchange(state_.turntable_frames, false)) save_turntable();
    if (state_.step && state_.document && state_.selection.any()) {
        const CornerId to = step(*state_.document, state_.selection.corner, *state_.step);
        if (to.is_null()) {
            state_.note = "a border: there is no such corner";
            state_.note_until = state_.clock + 2;
        } else {
            state_.selection.corner = to;
        }
    }
    state_.step.reset();
    if (std::exchange(state_.choices_changed, false)) dirty_ = true;
}

void Viewer::advance(double seconds) {
    state_.clock += seconds;
    if (state_.turntable && state_.document) {
        orbit_.turn_degrees(state_.turntable_speed * seconds);
        dirty_ = moving_ = true;
    }
    if (state_.paint != Paint::growth) state_.growing = false;
    if (state_.growing && state_.document) {
        state_.growth += state_.growth_speed * seconds;
        if (state_.growth >= static_cast<double>(state_.document->mesh->triangle_count())) state_.growing = false;
    }
}

void Viewer::update_outlines() {
    const Tables* wanted = state_.outlines ? state_.tables.get() : nullptr;
    if (wanted == outlined_) return;
    outlined_ = wanted;
    const Result<void> set = scene_.set_outlines(wanted != nullptr ? &wanted->lr : nullptr);
    if (!set) state_.error = set.error().message;
    dirty_ = true;
}

void Viewer::update_paint() {
    const Painted wanted{state_.selection.corner, state_.paint, std::floor(state_.growth), state_.document.get()};
    if (wanted == painted_ || !state_.document) return;
    painted_ = wanted;
    std::vector<std::uint32_t> colours;
    if (state_.paint != Paint::none || state_.selection.any()) {
        colours.resize(state_.document->mesh->triangle_count());
        lay_paint(state_, colours);
        if (state_.selection.any()) paint_selection(*state_.document, state_.selection.corner, colours);
    }
    if (const Result<void> set = scene_.set_paint(colours); !set) state_.error = set.error().message;
    compose_ = true;
}

Result<void> Viewer::draw() {
    update_outlines();
    const bool exact_due = !moving_ && !drawn_exact_;
    const bool draw_scene = dirty_ || exact_due || state_.shown.decode_again;
    const Shown picture = shown(moving_);
    if (draw_scene) LR_TRY(scene_.prepare(picture));
    update_paint();
    const auto begun = std::chrono::steady_clock::now();
    LR_ASSIGN(const VkCommandBuffer commands, commands_->begin());
    if (draw_scene) LR_TRY(scene_.record_draw(commands, picture, orbit_.options()));
    if (draw_scene || compose_) {
        const auto divider = static_cast<std::uint32_t>(state_.divider * extent_.width + 0.5);
        scene_.record_compose(commands, picture.mode, divider);
    }
    overlay_->record(commands, scene_.composed());
    const double cpu = seconds_since(begun);
    LR_TRY(commands_->run());
    if (draw_scene && scene_.model() != nullptr) {
        if (const auto times = scene_.times()) {
            state_.costs.push_back({static_cast<float>(times->decode * 1e3), static_cast<float>(times->draw * 1e3),
                                    static_cast<float>(cpu * 1e3)});
            if (state_.costs.size() > kHistory) state_.costs.pop_front();
            state_.frame_seconds = seconds_since(begun);
        }
        drawn_exact_ = picture.exact;
        if (picture.mode != Mode::single) difference_due_ = true;
    }
    if (difference_due_ && !moving_ && picture.mode != Mode::single && scene_.model() != nullptr) {
        LR_ASSIGN(state_.difference, scene_.difference(orbit_.options(), picture));
        difference_due_ = false;
        quiet_frames_ = 0;
    }
    if (picture.mode == Mode::single) state_.difference.reset();
    dirty_ = compose_ = false;
    return {};
}

Result<void> Viewer::frame(double seconds) {
    take_news();
    const bool was_moving = moving_;
    moving_ = dragging_ >= 0 && was_moving;
    advance(seconds);
    if (visible()) {
        LR_TRY(resize());
        state_.device_bytes = context_.arena().used();
        state_.device_held = context_.arena().held();
        ImGuiIO& io = ImGui::GetIO();
        io.DisplaySize = {static_cast<float>(extent_.width), static_cast<float>(extent_.height)};
        io.DeltaTime = static_cast<float>(std::max(1e-4, seconds));
        ImGui::NewFrame();
        draw_panels(state_, orbit_);
        draw_marks(state_, orbit_, extent_.width, extent_.height);
        ImGui::Render();
    }
    act();
    if (visible()) {
        if (state_.samples != made_samples_) LR_TRY(resize());
        LR_TRY(draw());
    }
    busy_ = (state_.progress.busy && !state_.progress.background) || state_.turntable || state_.growing ||
            state_.shown.decode_again || dirty_ || difference_due_ || state_.open.has_value();
    const bool laid =
        painted_ == Painted{state_.selection.corner, state_.paint, std::floor(state_.growth), state_.document.get()};
    settled_ = !busy_ && laid && (!state_.outlines || !state_.tables || outlined_ == state_.tables.get()) && !moving_ &&
               drawn_exact_ && state_.ring == asked_;
    if (moving_) quiet_frames_ = 0;
    ++quiet_frames_;
    if (!dragging_divider_ && dragging_ < 0) moving_ = false;
    return {};
}

Result<gpu::Picture> Viewer::picture() {
    LR_ASSIGN(const gpu::Buffer bytes,
              gpu::Buffer::create(context_, "screenshot", VkDeviceSize{4} * made_.width * made_.height, 0,
                                  gpu::Memory::readback));
    LR_ASSIGN(const VkCommandBuffer commands, commands_->begin());
    VkBufferImageCopy region{};
    region.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    region.imageExtent = {made_.width, made_.height, 1};
    vkCmdCopyImageToBuffer(commands, overlay_->image().handle(), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, bytes.handle(),
                           1, &region);
    gpu::memory_barrier(commands, {VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT},
                        {VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_READ_BIT});
    LR_TRY(commands_->run());
    gpu::Picture out;
    out.width = made_.width;
    out.height = made_.height;
    out.rgba.resize(4 * out.pixels());
    std::memcpy(out.rgba.data(), bytes.mapped(), out.rgba.size());
    return out;
}

void Viewer::save(const std::string& path) {
    const Result<gpu::Picture> taken = picture();
    const Result<void> written = taken ? gpu::write_png(path, *taken) : Result<void>(taken.error());
    if (!written) {
        state_.error = path + ": " + written.error().message;
        return;
    }
    state_.note = "saved " + path;
    state_.note_until = state_.clock + 3;
    quiet_frames_ = 0;
}

/// A whole turn in 90 pictures, without panels, in a folder of their own.
void Viewer::save_turntable() {
    constexpr int kFrames = 90;
    if (!state_.document || !visible()) return;
    const std::string folder = free_name("turntable", "");
    std::error_code error;
    std::filesystem::create_directory(folder, error);
    const auto one = [&](int i) -> Result<void> {
        LR_ASSIGN(const VkCommandBuffer commands, commands_->begin());
        LR_TRY(scene_.record_draw(commands, shown(false), orbit_.options()));
        scene_.record_compose(commands, state_.shown.mode,
                              static_cast<std::uint32_t>(state_.divider * extent_.width + 0.5));
        ImGui::GetDrawData()->CmdListsCount = 0;  // panels stay out
        overlay_->record(commands, scene_.composed());
        LR_TRY(commands_->run());
        LR_ASSIGN(const gpu::Picture taken, picture());
        return gpu::write_png(fmt::format("{}/{:03}.png", folder, i), taken);
    };
    const Orbit before = orbit_;
    for (int i = 0; i < kFrames; ++i) {
        if (const Result<void> done = scene_.prepare(shown(false)); !done) return;
        if (const Result<void> done = one(i); !done) {
            state_.error = folder + ": " + done.error().message;
            break;
        }
        orbit_.turn_degrees(360.0 / kFrames);
    }
    orbit_ = before;
    dirty_ = true;
    state_.note = fmt::format("saved {} pictures in {}", kFrames, folder);
    state_.note_until = state_.clock + 4;
}

}  // namespace lr::view
