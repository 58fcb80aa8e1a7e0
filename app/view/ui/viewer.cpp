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
#include "app/view/ui/settings.h"
#include "app/view/window/theme.h"
#include "renderer/vk/device_error.h"
#include "renderer/vk/try.h"

namespace lacedring::view {
namespace {

constexpr std::size_t kHistory = 120;            // frames of the plot
constexpr double kNoticed = 0.03;                // seconds of a picture that a person waits for
constexpr double kRest = 0.15, kLongRest = 0.4;  // seconds without a movement
// Samples of the picture at rest: 24 bytes each, of images and their copies.
constexpr std::uint64_t kMostSamples = 24000000;

double seconds_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

Result<std::unique_ptr<Viewer>> Viewer::create(gpu::Context& context, Threads& threads, const ViewerOptions& options) {
    LR_ASSIGN(Scene scene, Scene::create(context, options.wake));
    std::unique_ptr<Viewer> out(new Viewer(context, threads, options, std::move(scene)));
    LR_ASSIGN(out->overlay_, Overlay::create(context, options.scale));
    LR_ASSIGN(out->commands_, gpu::Commands::create(context));
    Choices& choices = out->state_.choices;
    Facts& facts = out->state_.facts;
    choices.panels = options.panels;
    choices.frame_cap = options.frame_cap;
    const std::string& weld = options.input.options.weld;
    choices.weld = weld == "none" ? Weld::none : weld == "attributes" ? Weld::attributes : Weld::position;
    facts.device = context.info().name;
    facts.mesh_shaders = context.info().max_mesh_groups != 0;
    facts.recent = read_recent();
    facts.sample_files = sample_meshes();
    out->largest_ = context.limits().maxImageDimension2D;
    const std::string& path = options.input.path;
    std::error_code error;
    out->loader_.list(path.empty() ? std::filesystem::current_path(error).string() : path);
    out->shaders_.start(threads, options.shaders, facts);
    out->asked_ = choices.ring;
    out->asked_weld_ = choices.weld;
    if (!path.empty()) LR_TRY(out->perform(action::Open{{path}}));
    return out;
}

std::string Viewer::title() const {
    const Facts& facts = state_.facts;
    if (facts.window_too_large) return "LacedRing: this window is larger than the device draws: make it smaller";
    if (!facts.document) return "LacedRing";
    return std::filesystem::path(facts.document->path).filename().string() + " - LacedRing";
}

bool Viewer::animated() const {
    const Choices& choices = state_.choices;
    return choices.turntable || choices.growing || choices.shown.decode_again || !state_.actions.empty() ||
           freshness_ == Freshness::redraw || turn_.running() || !paint_.laid(wanted_paint()) ||
           (visible() && scene_.model() != nullptr && scene_.drawn() != shown(Quality::fine));
}

bool Viewer::busy() const {
    const Loader::Progress& progress = state_.facts.progress;
    return (progress.busy && !progress.background) || animated() || difference_due();
}

bool Viewer::settled() const {
    const bool outlines = !state_.choices.has_outlines() || outlined_ == state_.facts.tables;
    return !busy() && outlines && still_seconds_ > 0 && !ring_due();
}

void Viewer::tell_error(const Result<void>& result) {
    if (!result) state_.facts.error = result.error().message;
}

void Viewer::camera_moved() {
    stale(Freshness::redraw);
    still_seconds_ = -1;
}

Shown Viewer::shown(Quality quality, const gpu::Model& model) const {
    Shown out = state_.choices.shown;
    out.exact = quality != Quality::rough || out.mode != Mode::single;
    out.samples = quality == Quality::fine ? std::min(out.samples, made_.samples) : 1;
    if (!gpu::has_source(model, out.source)) out.source = gpu::Source::lean;  // it is being made
    return out;
}

Shown Viewer::shown(Quality quality) const {
    return scene_.model() != nullptr ? shown(quality, *scene_.model()) : scene_.drawn();
}

PaintLayer::Wanted Viewer::wanted_paint() const {
    const Choices& choices = state_.choices;
    PaintLayer::Wanted out{state_.facts.document, choices.layers(), state_.facts.selection.corner, 0, 0};
    if (out.layers.sides != Paint::growth) return out;
    const double end = state_.facts.growth_end();
    out.invaded = static_cast<std::uint32_t>(std::min(choices.growth, end));
    // The last tenth of a second is told from what was invaded before, until all is done.
    if (choices.growth < end) out.newest = static_cast<std::uint32_t>(std::max(3.0, choices.growth_speed * 0.1));
    return out;
}

// Events and actions.

void Viewer::handle(const Event& in_window) {
    quiet_frames_ = 0;
    Event event = in_window;
    if ((event.kind == Event::move || event.kind == Event::button) && visible()) {
        event.x *= static_cast<double>(extent_.width) / window_.width;
        event.y *= static_cast<double>(extent_.height) / window_.height;
    }
    Overlay::feed(event);
    const auto act_on = [this](const Action& action) { tell_error(perform(action)); };
    if (event.kind == Event::resize) {
        largest_ = context_.limits().maxImageDimension2D;
        most_samples_ = 3;
        set_window(
            {static_cast<std::uint32_t>(std::max(0.0, event.x)), static_cast<std::uint32_t>(std::max(0.0, event.y))});
    } else if (event.kind == Event::close) {
        act_on(action::Do::close);
    } else if (event.kind == Event::drop) {
        if (!event.paths.empty()) act_on(action::Open{event.paths});
    } else {
        controls_.handle(event, state_, extent_, orbit_.options().up, act_on);
    }
}

Result<void> Viewer::perform(const Action& action) {
    quiet_frames_ = 0;
    return std::visit([this](const auto& one) { return on(one); }, action);
}

Result<void> Viewer::on(action::Do what) {
    switch (what) {
        case action::Do::cancel:
            cancel();
            break;
        case action::Do::escape:
            escape();
            break;
        case action::Do::frame_selection:
            frame_selection();
            break;
        case action::Do::begin_ring:
            begin_ring();
            break;
        case action::Do::copy_camera:
            clipboard_ = orbit_.text();
            state_.facts.tell("camera copied");
            break;
        case action::Do::reload_shaders:
            shaders_.force(state_.facts);
            break;
        case action::Do::close:
            closing_ = true;
            break;
    }
    return {};
}

Result<void> Viewer::on(const action::Open& open) {
    state_.facts.error.clear();
    queue_ = open.paths;
    open_next();
    return {};
}

void Viewer::open_next() {
    Input input = options_.input;
    const auto* weld = find_setting("weld");
    input.options.weld = weld->values[static_cast<std::size_t>(state_.choices.weld)].name;
    input.path = queue_.front();
    queue_.erase(queue_.begin());
    RingSettings settings = state_.choices.ring;
    settings.start = kNullCorner;  // was of another mesh
    asked_ = state_.choices.ring;
    asked_weld_ = state_.choices.weld;
    loader_.open(input, settings);
    state_.facts.progress = loader_.progress();
}

Result<void> Viewer::on(const action::Set& set) {
    const bool mesh_path = set.setting == find_setting("path") && set.value == static_cast<double>(gpu::Path::mesh);
    if (mesh_path && !state_.facts.mesh_shaders) {
        return Error{ErrorCode::invalid_argument, "the device has no mesh shaders: " + state_.facts.device};
    }
    set.setting->set(state_.choices, set.value);
    return {};
}

void Viewer::cancel() {
    if (turn_.running()) {
        end_turn();
    } else {
        loader_.cancel();
        queue_.clear();
    }
}

void Viewer::escape() {
    const Loader::Progress& progress = state_.facts.progress;
    if (state_.choices.help) {
        state_.choices.help = false;
    } else if (turn_.running() || (progress.busy && !progress.background)) {
        cancel();
    } else {
        state_.facts.selection = {};
        state_.facts.error.clear();
        state_.facts.shaders.error.clear();
    }
}

Result<void> Viewer::on(const action::FrameAll& all) {
    if (!state_.facts.document) return {};
    const double width = std::max(1U, extent_.width), height = std::max(1U, extent_.height);
    std::array<double, 2> fit{width, height};
    if (state_.choices.panels && !all.camera.position) fit = free_area(width, height);
    LR_TRY(orbit_.frame(*state_.facts.document->model, all.camera, {width, height}, fit));
    stale(Freshness::redraw);
    return {};
}

void Viewer::frame_selection() {
    if (!state_.facts.document || !state_.facts.selection.any()) return;
    const auto [centre, radius] = ball(*state_.facts.document, state_.facts.selection.corner);
    // In the middle of what panels leave of the window.
    const Area& free = state_.facts.free;
    const double width = extent_.width, height = extent_.height;
    const double seen = std::max(0.3 * height, std::min(free.right - free.left, free.bottom - free.top));
    orbit_.look_at(centre, radius * std::min(width, height) / seen);
    orbit_.pan((free.left + free.right - width) / 2, (free.top + free.bottom - height) / 2, height, width);
    stale(Freshness::redraw);
}

Result<void> Viewer::on(const action::LookFrom& from) {
    orbit_.look_from(from.direction);
    stale(Freshness::redraw);
    return {};
}

Result<void> Viewer::on(const action::Turn& turn) {
    orbit_.turn(turn.dx, turn.dy, extent_.height);
    camera_moved();
    return {};
}

Result<void> Viewer::on(const action::Pan& pan) {
    orbit_.pan(pan.dx, pan.dy, extent_.height, extent_.width);
    camera_moved();
    return {};
}

Result<void> Viewer::on(const action::Zoom& zoom) {
    const double width = extent_.width, height = extent_.height;
    orbit_.zoom(zoom.factor, zoom.x + 0.5 - width / 2, height / 2 - zoom.y - 0.5, height, width);
    camera_moved();
    return {};
}

Vector Viewer::ray(double x, double y) const {
    // Through the middle of the sample that triangle_at reads.
    const double n = scene_.drawn().samples;
    const double within = (std::floor(n / 2) + 0.5) / n;
    return orbit_.ray(std::floor(x) + within - extent_.width / 2.0, extent_.height / 2.0 - std::floor(y) - within,
                      extent_.height, extent_.width);
}

Result<void> Viewer::on(const action::Pick& pick) {
    const auto& document = state_.facts.document;
    const double x = pick.x, y = pick.y;
    if (!document || x < 0 || y < 0 || x >= extent_.width || y >= extent_.height) return {};
    const bool right = scene_.drawn().mode == Mode::split && x >= state_.choices.divider * extent_.width;
    LR_ASSIGN(const std::optional<std::uint32_t> hit,
              scene_.triangle_at(static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y), right));
    state_.facts.selection = {};
    if (!hit || *hit >= document->mesh->triangle_count()) return {};
    std::uint32_t t = *hit;
    const Vector along = ray(x, y);
    // A device rounds vertices to parts of a pixel: near an edge the ray through the sample may meet the neighbour.
    if (!ray_meets(*document, t, orbit_.eye(), along)) t = ray_hit(*document, orbit_.eye(), along).value_or(t);
    state_.facts.selection.corner = nearest_corner(*document, t, orbit_.eye(), along);
    recentre_frames_ = 4;
    return {};
}

Result<void> Viewer::on(const action::Step& by) {
    Selection& selection = state_.facts.selection;
    if (!state_.facts.document || !selection.any()) {
        state_.facts.tell("click a triangle first");
        return {};
    }
    const CornerId to = step(*state_.facts.document, selection.corner, by.operation);
    if (to.is_null()) {
        state_.facts.tell("a border: there is no such corner");
    } else {
        selection.corner = to;
        recentre_frames_ = 4;
    }
    return {};
}

void Viewer::begin_ring() {
    const Selection& selection = state_.facts.selection;
    CornerId& start = state_.choices.ring.start;
    state_.facts.tell(selection.any()   ? "the ring begins at the selected corner"
                      : start.is_null() ? "click a triangle first"
                                        : "the ring begins at the first triangle");
    start = selection.corner;
}

Result<void> Viewer::on(const action::SavePicture& save) {
    const std::string path = save.path.empty() ? free_name("lacedring", ".png") : save.path;
    LR_ASSIGN(const gpu::Picture taken, save.window ? window_picture() : picture());
    if (const Result<void> written = gpu::write_png(path, taken); !written) {
        return Error{written.error().code, path + ": " + written.error().message};
    }
    if (save.path.empty()) state_.facts.tell("saved " + path, 3);
    return {};
}

Result<void> Viewer::on(const action::SaveTurn& save) {
    if (turn_.running()) return {};
    if (!state_.facts.document) return Error{ErrorCode::invalid_argument, "no mesh"};
    return turn_.start(save.folder.empty() ? free_name("turntable", "") : save.folder, save.pictures, orbit_);
}

// News of threads.

void Viewer::take_news() {
    Facts& facts = state_.facts;
    Loader::News news = loader_.take();
    facts.progress = loader_.progress();
    if (news.document) news_.document = std::move(news.document);
    if (news.tables) news_.tables = std::move(news.tables);
    if (news.formats) news_.formats = std::move(news.formats);
    if (news.files) {
        facts.files = std::move(*news.files);
        quiet_frames_ = 0;
    }
    if (news_.document && visible()) take_document();
    if (news_.document) {
        // Tables and formats are of what is still to come.
        if (!facts.progress.busy || facts.progress.background) {
            facts.progress = {.busy = true, .background = false, .what = "to the device", .share = 1};
        }
    } else {
        if (news_.tables && facts.document && news_.tables->mesh == facts.document->mesh) {
            facts.tables = std::move(news_.tables);
        }
        if (news_.formats) facts.formats = std::move(news_.formats);
        news_ = {};
    }
    if (turn_.running()) facts.progress = {true, false, turn_.text(), turn_.share()};
    if (news.error) {
        facts.error = *news.error;
        if (!queue_.empty()) open_next();
        quiet_frames_ = 0;
    }
    const std::uint32_t reloads = facts.shaders.reloads;
    if (shaders_.update(context_, scene_, facts)) quiet_frames_ = 0;
    if (facts.shaders.reloads != reloads) stale(Freshness::redraw);
}

/// Shows the document that came, once its model is on the device; the one that was shown stays until then.
void Viewer::take_document() {
    Facts& facts = state_.facts;
    Choices& choices = state_.choices;
    const bool other = !facts.document || facts.document->mesh != news_.document->mesh;
    const std::shared_ptr<const OwningModel>& model = news_.document->model;
    Shown picture = shown(Quality::rough, *model);
    if (other && !choices.view_chosen) picture.view = model->has_materials ? gpu::View::material : gpu::View::smooth;
    const Result<bool> there = scene_.adopt(model, picture);
    if (there && !*there) return;
    const std::shared_ptr<const Document> document = std::exchange(news_.document, nullptr);
    if (!there) {
        facts.error = document->path + ": " + there.error().message;
        return;
    }
    choices.shown.view = picture.view;
    if (other) opened(*document);
    const bool other_way = facts.document && facts.document->expansion != document->expansion;
    const bool same_file = facts.document && facts.document->path == document->path;
    facts.document = document;
    // One that was stopped on its way goes on from there.
    if (other_way && (choices.growing || choices.growth >= facts.growth_end())) {
        choices.growth = 0;
        choices.growing = choices.paint == Paint::growth;
    }
    if (other && !same_file) {
        tell_error(perform(action::FrameAll{options_.camera}));
        const Vector up = options_.camera.up;
        options_.camera = {};  // was for the first mesh; its up stays
        options_.camera.up = up;
    }
    stale(Freshness::redraw);
}

/// Before another mesh is shown: another file, or the same one after its stand-in or welded otherwise.
void Viewer::opened(const Document& document) {
    Facts& facts = state_.facts;
    Choices& choices = state_.choices;
    facts.error.clear();
    facts.tables.reset();
    facts.formats.reset();
    facts.selection = {};
    facts.costs.clear();
    choices.growing = false;
    choices.growth = 0;
    choices.ring.start = asked_.start = kNullCorner;
    tell_error(paint_.clear(scene_));
    end_turn();
    if (facts.document && facts.document->path == document.path) return;
    queue_.clear();
    choices.paint = Paint::none;
    loader_.list(document.path);
    add_recent(facts.recent, document.path, options_.keep_recent);
}

// Frames.

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

/// Makes images of the picture's size. What the device does not hold has fewer samples, then it is made smaller, and
/// scaled up by the window.
Result<void> Viewer::resize() {
    constexpr std::uint32_t kSmallest = 64;
    for (;;) {
        Made wanted{extent_, std::min(state_.choices.shown.samples, most_samples_), state_.choices.shown.sides()};
        const std::uint64_t pixels = std::uint64_t{extent_.width} * extent_.height;
        while (wanted.samples > 1 && pixels * wanted.samples * wanted.samples > kMostSamples) --wanted.samples;
        wanted.samples = gpu::Target::fitting_samples(context_, extent_, wanted.samples);
        const bool other_size = made_.extent.width != extent_.width || made_.extent.height != extent_.height;
        if (!other_size && made_.samples == wanted.samples && made_.sides >= wanted.sides) return {};
        if (other_size) end_turn();  // its pictures are of one size
        context_.wait_idle();        // the window may still be taking the last picture
        Result<void> made = scene_.resize(extent_, wanted.samples, wanted.sides);
        if (made && other_size) made = overlay_->resize(extent_);
        if (made) {
            made_ = wanted;
            break;
        }
        if (made.error().code == gpu::kDeviceFailure) return made;
        if (wanted.samples > 1) {
            most_samples_ = wanted.samples - 1;  // until the window changes
            continue;
        }
        largest_ = std::max(extent_.width, extent_.height) / 2;  // likewise
        if (largest_ < kSmallest) return made;
        set_window(window_);
        most_samples_ = 3;
    }
    if (extent_.width != window_.width) {
        state_.facts.tell(
            fmt::format("drawn at {} x {}: the device draws no larger picture", extent_.width, extent_.height), 4);
    }
    stale(Freshness::redraw);
    return {};
}

/// What panels asked for, and what follows from choices.
void Viewer::act() {
    for (const Action& action : std::exchange(state_.actions, {})) tell_error(perform(action));
    const auto& document = state_.facts.document;
    if (!document || ImGui::IsMouseDown(0) || !ring_due()) return;
    if (state_.choices.weld != asked_weld_) {
        queue_ = {document->path};
        open_next();
    } else {
        asked_ = state_.choices.ring;
        loader_.encode(document, asked_);
    }
    state_.facts.progress = loader_.progress();
}

void Viewer::advance(double seconds) {
    Choices& choices = state_.choices;
    state_.facts.clock += seconds;
    if (choices.turntable && state_.facts.document) {
        orbit_.turn_degrees(choices.turntable_speed * seconds);
        camera_moved();
    }
    if (choices.paint != Paint::growth) choices.growing = false;
    if (choices.growing && state_.facts.document) {
        const double end = state_.facts.growth_end();
        choices.growth = std::min(choices.growth + choices.growth_speed * seconds, end);
        if (choices.growth >= end) choices.growing = false;
    }
    still_seconds_ = still_seconds_ < 0 ? 0 : still_seconds_ + seconds;
}

/// A selected corner that panels cover, or that is outside the window, goes to the middle of what they leave.
void Viewer::keep_selection_in_sight() {
    if (recentre_frames_ == 0) return;
    --recentre_frames_;  // the panel takes some frames to get its size
    const Facts& facts = state_.facts;
    if (!facts.document || !facts.selection.any()) return;
    const auto at = orbit_.project(place_of(*facts.document, facts.selection.corner), extent_.height, extent_.width);
    const Area& free = facts.free;
    if (!at || ((*at)[0] >= free.left && (*at)[0] < free.right && (*at)[1] >= free.top && (*at)[1] < free.bottom))
        return;
    orbit_.pan((free.left + free.right) / 2 - (*at)[0], (free.top + free.bottom) / 2 - (*at)[1], extent_.height,
               extent_.width);
    stale(Freshness::redraw);
}

void Viewer::update_outlines() {
    const std::shared_ptr<const Tables> wanted = state_.choices.has_outlines() ? state_.facts.tables : nullptr;
    if (wanted == outlined_) return;
    outlined_ = wanted;
    tell_error(scene_.set_outlines(wanted ? &wanted->lr : nullptr, wanted ? wanted->crease : 0));
    stale(Freshness::redraw);
}

void Viewer::update_paint() {
    if (!state_.facts.document) return;
    const Result<bool> changed = paint_.update(scene_, wanted_paint());
    if (!changed) {
        state_.facts.error = changed.error().message;
        // Not tried again every frame.
        if (state_.choices.paint == Paint::none) state_.choices.ring_line = false;
        state_.choices.paint = Paint::none;
    } else if (*changed) {
        stale(Freshness::compose);
    }
}

/// False: not yet. What cannot be is told, and not shown.
Result<bool> Viewer::prepare(const Shown& picture) {
    const Result<bool> there = scene_.prepare(picture);
    if (there || there.error().code == gpu::kDeviceFailure) return there;
    state_.facts.error = there.error().message;
    const Shown &drawn = scene_.drawn(), before = state_.choices.shown;
    Shown& chosen = state_.choices.shown;
    chosen.view = drawn.view;
    chosen.source = drawn.source;
    chosen.path = drawn.path;
    chosen.mode = drawn.mode;
    if (chosen == before) return there;  // nothing to go back to
    return false;
}

Result<void> Viewer::draw() {
    update_outlines();
    if (turn_.running()) {
        orbit_ = turn_.aim();
        stale(Freshness::redraw);
    }
    // A picture that takes long waits until a person rests; a new model is shown soon. Those of a turn are saved.
    const bool resting = still_seconds_ > (exact_seconds_ > kNoticed ? kRest : 0.0) && !state_.choices.growing &&
                         scene_.model() == drawn_model_;
    const bool fine = resting && still_seconds_ > (fine_seconds_ > kNoticed ? kLongRest : 0.0);
    const Shown picture = shown(fine || turn_.running() ? Quality::fine : resting ? Quality::exact : Quality::rough);
    const bool animated_decode = picture.decode_again && scene_.model() != nullptr;
    bool draw_scene = freshness_ == Freshness::redraw || picture != scene_.drawn() || animated_decode;
    if (draw_scene) {
        LR_ASSIGN(draw_scene, prepare(picture));
        if (!draw_scene) stale(Freshness::redraw);
    }
    update_paint();
    const auto begun = std::chrono::steady_clock::now();
    LR_ASSIGN(const VkCommandBuffer commands, commands_->begin());
    const bool draw_model = draw_scene && scene_.model() != nullptr;
    if (draw_model) {
        LR_TRY(scene_.record_draw(commands, picture, orbit_.options()));
    } else if (scene_.blank()) {
        scene_.record_clear(commands);
        stale(Freshness::compose);
    }
    const double divider = std::floor(state_.choices.divider * extent_.width + 0.5);
    const bool compose = draw_scene || freshness_ != Freshness::current || divider != divider_;
    if (compose) LR_TRY(scene_.record_compose(commands, static_cast<std::uint32_t>(divider)));
    divider_ = divider;
    overlay_->record(commands, scene_.composed());
    const double cpu = seconds_since(begun);
    LR_TRY(commands_->run());
    if (draw_scene || freshness_ == Freshness::compose) freshness_ = Freshness::current;
    if (!draw_scene) return {};
    state_.facts.difference.reset();
    if (draw_model) {
        drawn_model_ = scene_.model();
        state_.facts.frame_seconds = seconds_since(begun);
        if (picture.exact) (picture.samples > 1 ? fine_seconds_ : exact_seconds_) = state_.facts.frame_seconds;
        if (const auto times = scene_.times()) {
            std::deque<FrameCost>& costs = state_.facts.costs;
            costs.push_back({static_cast<float>(times->decode * 1e3), static_cast<float>(times->draw * 1e3),
                             static_cast<float>(cpu * 1e3)});
            if (costs.size() > kHistory) costs.pop_front();
        }
    }
    if (turn_.running()) save_turn_picture();
    return {};
}

/// The composed picture has no panels yet.
void Viewer::save_turn_picture() {
    const Result<gpu::Picture> taken = picture_of(scene_.composed());
    const Result<void> saved = taken ? turn_.save(*taken) : Result<void>(taken.error());
    tell_error(saved);
    if (!saved || turn_.done()) end_turn();
}

void Viewer::end_turn() {
    if (!turn_.running()) return;
    std::string how;
    orbit_ = turn_.end(how);
    state_.facts.tell(std::move(how), 4);
    stale(Freshness::redraw);
}

/// The two pictures that are drawn, once nothing moves.
Result<void> Viewer::compare() {
    if (!difference_due() || still_seconds_ <= 0 || freshness_ == Freshness::redraw || turn_.running() ||
        scene_.drawn() != shown(Quality::fine)) {
        return {};
    }
    LR_ASSIGN(state_.facts.difference, scene_.difference());
    quiet_frames_ = 0;
    return {};
}

Result<void> Viewer::frame(double seconds) {
    take_news();
    advance(seconds);
    if (visible()) {
        LR_TRY(resize());
        state_.facts.device_bytes = context_.arena().used();
        state_.facts.device_held = context_.arena().held();
        ImGuiIO& io = ImGui::GetIO();
        io.DisplaySize = {static_cast<float>(extent_.width), static_cast<float>(extent_.height)};
        io.DeltaTime = static_cast<float>(std::max(1e-4, seconds));
        ImGui::NewFrame();
        draw_panels(state_, scene_.has_ring_line());
        keep_selection_in_sight();
        draw_marks(state_, orbit_, extent_.width, extent_.height);
        ImGui::Render();
    }
    act();
    if (visible()) {
        LR_TRY(resize());  // choices may have changed
        LR_TRY(draw());
        LR_TRY(compare());
    }
    quiet_frames_ = still_seconds_ <= 0 ? 0 : quiet_frames_ + 1;
    return {};
}

void Viewer::presented(double seconds) {
    Facts& facts = state_.facts;
    facts.longest_frame = std::max(facts.longest_frame, seconds);
    const Document* document = facts.document.get();
    if (document == presented_ || drawn_model_ != document->model.get()) return;
    const bool first = document->asked != presented_asked_;
    presented_ = document;
    presented_asked_ = document->asked;
    facts.shown_seconds = seconds_since(presented_asked_);
    if (first) facts.first_seconds = facts.shown_seconds;
}

Result<gpu::Picture> Viewer::picture_of(const gpu::Image& image) {
    LR_ASSIGN(const gpu::Buffer bytes,
              gpu::Buffer::create(context_, "screenshot", VkDeviceSize{4} * made_.extent.width * made_.extent.height, 0,
                                  gpu::Memory::readback));
    LR_ASSIGN(const VkCommandBuffer commands, commands_->begin());
    VkBufferImageCopy region{};
    region.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    region.imageExtent = {made_.extent.width, made_.extent.height, 1};
    vkCmdCopyImageToBuffer(commands, image.handle(), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, bytes.handle(), 1, &region);
    gpu::memory_barrier(commands, {VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT},
                        {VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_READ_BIT});
    LR_TRY(commands_->run());
    gpu::Picture out;
    out.width = made_.extent.width;
    out.height = made_.extent.height;
    out.rgba.resize(4 * out.pixels());
    std::memcpy(out.rgba.data(), bytes.mapped(), out.rgba.size());
    return out;
}

}  // namespace lacedring::view
