#include "app/view/ui/viewer.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <filesystem>

#include "app/view/session/files.h"
#include "app/view/ui/overlays.h"
#include "app/view/ui/panels.h"
#include "app/view/window/theme.h"
#include "renderer/vk/device_error.h"
#include "renderer/vk/try.h"

namespace lacedring::view {
namespace {

constexpr std::size_t kHistory = 120;  // frames of the plot
constexpr double kNoticed = 0.03;      // seconds of a picture that a person waits for
constexpr double kRest = 0.15;         // seconds without a movement

double seconds_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

Result<std::unique_ptr<Viewer>> Viewer::create(gpu::Context& context, Threads& threads, const ViewerOptions& options) {
    LR_ASSIGN(Scene scene, Scene::create(context, options.wake));
    std::unique_ptr<Viewer> out(new Viewer(context, threads, options, std::move(scene)));
    LR_ASSIGN(out->overlay_, Overlay::create(context, options.scale));
    LR_ASSIGN(out->commands_, gpu::Commands::create(context));
    State& state = out->state_;
    state.panels = options.panels;
    state.frame_cap = options.frame_cap;
    state.device = context.info().name;
    out->largest_ = context.limits().maxImageDimension2D;
    state.mesh_shaders = context.info().max_mesh_groups != 0;
    state.samples = context.info().software ? 1 : 2;
    state.recent = read_recent();
    state.sample_files = sample_meshes();
    std::error_code error;
    out->loader_.list(options.input.path.empty() ? std::filesystem::current_path(error).string() : options.input.path);
    out->asked_ = state.ring;
    out->watch_shaders();
    if (!options.input.path.empty()) state.open = options.input.path;
    return out;
}

std::string Viewer::title() const {
    if (state_.window_too_large) return "LacedRing: this window is larger than the device draws: make it smaller";
    if (!state_.document) return "LacedRing";
    return std::filesystem::path(state_.document->path).filename().string() + " - LacedRing";
}

Shown Viewer::shown(bool moving, const gpu::Model* model) const {
    Shown out = state_.shown;
    out.exact = !moving || out.mode != Mode::single;
    if (model != nullptr && !gpu::has_source(*model, out.source)) {
        out.source = gpu::Source::lean;  // it is being made
    }
    return out;
}

void Viewer::set_window(VkExtent2D window) {
    window_ = window;
    extent_ = window;
    const std::uint32_t side = std::max(window.width, window.height);
    if (side <= largest_) return;
    const auto fitting = [&](std::uint32_t n) {
        return static_cast<std::uint32_t>(std::max<std::uint64_t>(1, std::uint64_t{n} * largest_ / side));
    };
    if (visible()) extent_ = {fitting(window.width), fitting(window.height)};
}

Result<void> Viewer::make_images(std::uint32_t samples) {
    LR_TRY(scene_.resize(extent_, samples));
    return overlay_->resize(extent_);
}

/// Makes images of the picture's size. What the device does not hold is made smaller, and scaled up by the window.
Result<void> Viewer::resize() {
    std::uint32_t samples = gpu::Target::fitting_samples(context_, extent_, state_.samples);
    if (made_.width == extent_.width && made_.height == extent_.height && made_samples_ == samples) return {};
    end_turntable();       // its pictures are of one size
    context_.wait_idle();  // the window may still be taking the last picture
    constexpr std::uint32_t kSmallest = 64;
    for (;;) {
        const Result<void> made = make_images(samples);
        if (made) break;
        if (made.error().code == gpu::kDeviceFailure) return made;
        if (samples > 1) {
            state_.samples = --samples;
            continue;
        }
        largest_ = std::max(extent_.width, extent_.height) / 2;  // until the window changes
        if (largest_ < kSmallest) return made;
        set_window(window_);
        samples = gpu::Target::fitting_samples(context_, extent_, state_.samples);
    }
    if (extent_.width != window_.width) {
        state_.tell(fmt::format("drawn at {} x {}: the device draws no larger picture", extent_.width, extent_.height),
                    4);
    }
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
    state_.growth = 0;
    state_.ring.start = asked_.start = kNullCorner;
    end_turntable();
    state_.costs.clear();
    loader_.list(path);
    add_recent(state_.recent, path, options_.keep_recent);
}

void Viewer::take_news() {
    Loader::News news = loader_.take();
    state_.progress = loader_.progress();
    if (news.document) news_.document = std::move(news.document);
    if (news.tables) news_.tables = std::move(news.tables);
    if (news.formats) news_.formats = std::move(news.formats);
    if (news.files) {
        state_.files = std::move(*news.files);
        quiet_frames_ = 0;
    }
    if (news_.document && visible()) take_document();
    if (news_.document) {
        // Tables and formats are of what is still to come.
        if (!state_.progress.busy || state_.progress.background) {
            state_.progress = {.busy = true, .background = false, .what = "to the device", .share = 1};
        }
    } else {
        if (news_.tables && state_.document && news_.tables->mesh == state_.document->mesh) {
            state_.tables = std::move(news_.tables);
        }
        if (news_.formats) state_.formats = std::move(news_.formats);
        news_ = {};
    }
    if (const auto& job = state_.turntable_job) {
        state_.progress = {true, false, fmt::format("picture {} of {}", job->done + 1, job->pictures),
                           static_cast<double>(job->done) / job->pictures};
    }
    if (news.error) {
        state_.error = *news.error;
        if (!queue_.empty()) {
            state_.open = queue_.front();
            queue_.erase(queue_.begin());
        }
        quiet_frames_ = 0;
    }
}

/// Shows the document that came, once its model is on the device; the one that was shown stays until then.
void Viewer::take_document() {
    const std::shared_ptr<const gpu::Model>& model = news_.document->model;
    const Result<bool> there = scene_.adopt(model, shown(false, model.get()));
    if (there && !*there) return;
    const std::shared_ptr<const Document> document = std::exchange(news_.document, nullptr);
    if (!there) {
        state_.error = document->path + ": " + there.error().message;
        return;
    }
    const bool other = !state_.document || state_.document->mesh != document->mesh;
    if (other) {
        opened(document->path);
        if (const Result<void> taken = take_paint_away(); !taken) state_.error = taken.error().message;
    }
    const bool other_way = state_.document && state_.document->expansion != document->expansion;
    state_.document = document;
    // One that was stopped on its way goes on from there.
    if (other_way && (state_.growing || state_.growth >= state_.growth_end())) {
        state_.growth = 0;
        state_.growing = state_.paint == Paint::growth;
    }
    if (other) {
        const Result<void> framed = frame_all(options_.camera);
        if (!framed) state_.error = framed.error().message;
        const Vector up = options_.camera.up;
        options_.camera = {};  // was for the first mesh; its up stays
        options_.camera.up = up;
    }
    dirty_ = fresh_ = true;
}

/// What panels and keys asked for.
void Viewer::act() {
    if (state_.open) {
        Input input = options_.input;
        input.path = *std::exchange(state_.open, std::nullopt);
        RingSettings settings = state_.ring;
        settings.start = kNullCorner;  // was of another mesh
        if (queue_.empty()) state_.error.clear();
        loader_.open(input, settings);
        asked_ = state_.ring;
    } else if (state_.ring != asked_ && state_.document && !ImGui::IsMouseDown(0)) {
        asked_ = state_.ring;
        loader_.encode(state_.document, state_.ring);
    }
    if (std::exchange(state_.cancel, false)) {
        if (state_.turntable_job) {
            end_turntable();
        } else {
            loader_.cancel();
            queue_.clear();
        }
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
        state_.tell("camera copied");
    }
    if (std::exchange(state_.screenshot, false)) save(free_name("lacedring", ".png"));
    if (std::exchange(state_.turntable_pictures, false) && state_.document && !state_.turntable_job) {
        const std::string folder = free_name("turntable", "");
        constexpr std::uint32_t kPictures = 90;
        if (const Result<void> started = start_turntable(folder, kPictures); !started) {
            state_.error = folder + ": " + started.error().message;
        }
    }
    if (state_.step && state_.document && state_.selection.any()) {
        const CornerId to = step(*state_.document, state_.selection.corner, *state_.step);
        if (to.is_null()) {
            state_.tell("a border: there is no such corner");
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
        dirty_ = moved_ = true;
    }
    if (state_.paint != Paint::growth) state_.growing = false;
    if (state_.growing && state_.document) {
        state_.growth = std::min(state_.growth + state_.growth_speed * seconds, state_.growth_end());
        if (state_.growth >= state_.growth_end()) state_.growing = false;
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

/// False: not yet. What cannot be is told, and not shown.
Result<bool> Viewer::prepare(const Shown& picture) {
    const Result<bool> there = scene_.prepare(picture);
    if (there || there.error().code == gpu::kDeviceFailure) return there;
    state_.error = there.error().message;
    const bool other = state_.shown.view != drawn_.view || state_.shown.source != drawn_.source ||
                       state_.shown.path != drawn_.path || state_.shown.mode != drawn_.mode;
    if (!other) return there;  // nothing to go back to
    state_.shown = drawn_;
    return false;
}

Result<void> Viewer::draw() {
    update_outlines();
    aim_turntable();
    // An exact picture that takes long waits until a person rests.
    const bool resting = still_seconds_ > (exact_seconds_ > kNoticed ? kRest : 0.0);
    bool draw_scene = dirty_ || (!drawn_.exact && resting) || state_.shown.decode_again;
    const Shown picture = shown(fresh_ || !resting, scene_.model());
    if (draw_scene) {
        LR_ASSIGN(draw_scene, prepare(picture));
        if (!draw_scene) dirty_ = true;
    }
    LR_TRY(update_paint());
    const auto begun = std::chrono::steady_clock::now();
    LR_ASSIGN(const VkCommandBuffer commands, commands_->begin());
    if (draw_scene && scene_.model() != nullptr) {
        LR_TRY(scene_.record_draw(commands, picture, orbit_.options()));
        drawn_ = picture;
    } else if (scene_.blank()) {
        scene_.record_clear(commands);
        compose_ = true;
    }
    if (draw_scene || compose_) {
        const auto divider = static_cast<std::uint32_t>(state_.divider * extent_.width + 0.5);
        LR_TRY(scene_.record_compose(commands, drawn_.mode, divider));
        compose_ = false;
    }
    overlay_->record(commands, scene_.composed());
    const double cpu = seconds_since(begun);
    LR_TRY(commands_->run());
    if (!draw_scene) return {};
    dirty_ = fresh_ = false;
    if (scene_.model() != nullptr) {
        state_.frame_seconds = seconds_since(begun);
        if (picture.exact) exact_seconds_ = state_.frame_seconds;
        if (const auto times = scene_.times()) {
            state_.costs.push_back({static_cast<float>(times->decode * 1e3), static_cast<float>(times->draw * 1e3),
                                    static_cast<float>(cpu * 1e3)});
            if (state_.costs.size() > kHistory) state_.costs.pop_front();
        }
        difference_due_ = picture.mode != Mode::single;
    }
    if (picture.mode == Mode::single) state_.difference.reset();
    if (state_.turntable_job) save_turntable_picture();
    return {};
}

/// Of the two pictures that are drawn, once nothing moves.
Result<void> Viewer::compare() {
    if (!difference_due_ || still_seconds_ == 0 || dirty_ || state_.turntable_job) return {};
    LR_ASSIGN(state_.difference, scene_.difference());
    difference_due_ = false;
    quiet_frames_ = 0;
    return {};
}

Result<void> Viewer::frame(double seconds) {
    take_news();
    take_shaders();
    advance(seconds);
    still_seconds_ = std::exchange(moved_, false) ? 0 : still_seconds_ + seconds;
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
        LR_TRY(compare());
    }
    animated_ = state_.turntable || state_.growing || state_.shown.decode_again || state_.open.has_value() || dirty_ ||
                state_.turntable_job.has_value() || !laid() || (visible() && !drawn_.exact);
    busy_ = (state_.progress.busy && !state_.progress.background) || animated_ || difference_due_;
    settled_ = !busy_ && (!state_.outlines || !state_.tables || outlined_ == state_.tables.get()) &&
               still_seconds_ > 0 && state_.ring == asked_;
    quiet_frames_ = still_seconds_ == 0 ? 0 : quiet_frames_ + 1;
    return {};
}

void Viewer::presented(double seconds) {
    state_.longest_frame = std::max(state_.longest_frame, seconds);
    if (state_.document.get() == shown_ || scene_.model() != state_.document->model.get()) return;
    const bool first = state_.document->asked != shown_asked_;
    shown_ = state_.document.get();
    shown_asked_ = state_.document->asked;
    state_.shown_seconds = seconds_since(shown_asked_);
    if (first) state_.first_seconds = state_.shown_seconds;
}

Result<gpu::Picture> Viewer::picture_of(const gpu::Image& image) {
    LR_ASSIGN(const gpu::Buffer bytes,
              gpu::Buffer::create(context_, "screenshot", VkDeviceSize{4} * made_.width * made_.height, 0,
                                  gpu::Memory::readback));
    LR_ASSIGN(const VkCommandBuffer commands, commands_->begin());
    VkBufferImageCopy region{};
    region.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    region.imageExtent = {made_.width, made_.height, 1};
    vkCmdCopyImageToBuffer(commands, image.handle(), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, bytes.handle(), 1, &region);
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
    state_.tell("saved " + path, 3);
    quiet_frames_ = 0;
}

}  // namespace lacedring::view
