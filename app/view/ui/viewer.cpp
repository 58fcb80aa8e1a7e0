#include "app/view/ui/viewer.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>

#include "app/view/scene/read_picture.h"
#include "app/view/session/files.h"
#include "app/view/ui/overlays.h"
#include "app/view/ui/panels.h"
#include "app/view/ui/settings.h"
#include "app/view/window/theme.h"
#include "renderer/vk/device_error.h"
#include "renderer/vk/try.h"

namespace lacedring::view {
namespace {

constexpr std::size_t kHistory = 120;  // frames in the plot
// Pictures that take longer than kNoticed seconds wait until the camera rests: exact ones for kRest seconds, those with
// several samples for kLongRest.
constexpr double kNoticed = 0.03;
constexpr double kRest = 0.15, kLongRest = 0.4;

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
    const std::string& path = options.input.path;
    std::error_code error;
    out->loader_.list(path.empty() ? std::filesystem::current_path(error).string() : path);
    out->shaders_.start(threads, options.shaders, facts);
    out->asked_ = choices.ring;
    out->asked_weld_ = choices.weld;
    if (!path.empty()) LR_TRY(out->perform(action::Open{{path}}));
    return out;
}

Result<gpu::Picture> Viewer::picture() {
    const bool panels = state_.choices.panels || state_.choices.help;
    return panels ? window_picture() : read_picture(context_, *commands_, scene_.composed(), size_.made());
}

Result<gpu::Picture> Viewer::window_picture() {
    return read_picture(context_, *commands_, overlay_->image(), size_.made());
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
    out.samples = quality == Quality::fine ? size_.samples(out.samples) : 1;
    while (out.samples > 1 && exact_seconds_ * out.samples * out.samples > options_.patience) --out.samples;
    if (!gpu::has_source(model, out.source)) out.source = gpu::Source::lean;  // the stream is still being made
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
    // Until the end, highlight the triangles invaded in the last tenth of a second.
    if (choices.growth < end) out.newest = static_cast<std::uint32_t>(std::max(3.0, choices.growth_speed * 0.1));
    return out;
}

// Events and actions.

void Viewer::handle(const Event& in_window) {
    quiet_frames_ = 0;
    Event event = in_window;
    if ((event.kind == Event::move || event.kind == Event::button) && visible()) {
        event.x *= static_cast<double>(extent().width) / window().width;
        event.y *= static_cast<double>(extent().height) / window().height;
    }
    Overlay::feed(event);
    const auto act_on = [this](const Action& action) { tell_error(perform(action)); };
    if (event.kind == Event::resize) {
        size_.set_window(
            {static_cast<std::uint32_t>(std::max(0.0, event.x)), static_cast<std::uint32_t>(std::max(0.0, event.y))},
            context_.limits().maxImageDimension2D);
    } else if (event.kind == Event::close) {
        act_on(action::Do::close);
    } else if (event.kind == Event::drop) {
        if (!event.paths.empty()) act_on(action::Open{event.paths});
    } else {
        controls_.handle(event, state_, extent(), orbit_.options().up, act_on);
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
            if (frame_selection(state_.facts, orbit_, area())) stale(Freshness::redraw);
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
    settings.start = kNullCorner;  // it was a corner of another mesh
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
    const double width = std::max(1U, extent().width), height = std::max(1U, extent().height);
    std::array<double, 2> fit{width, height};
    if (state_.choices.panels && !all.camera.position) fit = free_area(width, height);
    LR_TRY(orbit_.frame(*state_.facts.document->model, all.camera, {width, height}, fit));
    stale(Freshness::redraw);
    return {};
}

Result<void> Viewer::on(const action::LookFrom& from) {
    orbit_.look_from(from.direction);
    stale(Freshness::redraw);
    return {};
}

Result<void> Viewer::on(const action::Turn& turn) {
    orbit_.turn(turn.dx, turn.dy, extent().height);
    camera_moved();
    return {};
}

Result<void> Viewer::on(const action::Pan& pan) {
    orbit_.pan(pan.dx, pan.dy, extent().height, extent().width);
    camera_moved();
    return {};
}

Result<void> Viewer::on(const action::Zoom& zoom) {
    const double width = extent().width, height = extent().height;
    orbit_.zoom(zoom.factor, zoom.x + 0.5 - width / 2, height / 2 - zoom.y - 0.5, height, width);
    camera_moved();
    return {};
}

Result<void> Viewer::on(const action::Pick& pick) {
    return selecting_.pick(state_, scene_, orbit_, area(), pick.x, pick.y);
}

Result<void> Viewer::on(const action::Step& by) {
    selecting_.step(state_.facts, by.operation);
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

// Updates from threads.

void Viewer::take_news() {
    Facts& facts = state_.facts;
    Loader::Update update = loader_.take();
    facts.progress = loader_.progress();
    if (update.document) update_.document = std::move(update.document);
    if (update.tables) update_.tables = std::move(update.tables);
    if (update.formats) update_.formats = std::move(update.formats);
    if (update.files) {
        facts.files = std::move(*update.files);
        quiet_frames_ = 0;
    }
    if (update_.document && visible()) take_document();
    if (update_.document) {
        // Hold tables and formats back: they belong to the document that is not shown yet.
        if (!facts.progress.busy || facts.progress.background) {
            facts.progress = {.busy = true, .background = false, .what = "uploading", .share = 1};
        }
    } else {
        if (update_.tables && facts.document && update_.tables->mesh == facts.document->mesh) {
            facts.tables = std::move(update_.tables);
        }
        if (update_.formats) facts.formats = std::move(update_.formats);
        update_ = {};
    }
    if (turn_.running()) facts.progress = {true, false, turn_.text(), turn_.share()};
    if (update.error) {
        facts.error = *update.error;
        if (!queue_.empty()) open_next();
        quiet_frames_ = 0;
    }
    const std::uint32_t reloads = facts.shaders.reloads;
    if (shaders_.update(context_, scene_, facts)) quiet_frames_ = 0;
    if (facts.shaders.reloads != reloads) stale(Freshness::redraw);
}

/// Shows the new document once its model is on the device; the old one stays until then.
void Viewer::take_document() {
    Facts& facts = state_.facts;
    Choices& choices = state_.choices;
    const bool other = !facts.document || facts.document->mesh != update_.document->mesh;
    const std::shared_ptr<const OwningModel>& model = update_.document->model;
    Shown picture = shown(Quality::rough, *model);
    if (other && !choices.view_chosen) picture.view = model->has_materials ? gpu::View::material : gpu::View::smooth;
    const Result<bool> there = scene_.adopt(model, picture);
    if (there && !*there) return;
    const std::shared_ptr<const Document> document = std::exchange(update_.document, nullptr);
    if (!there) {
        facts.error = document->path + ": " + there.error().message;
        return;
    }
    choices.shown.view = picture.view;
    if (other) opened(*document);
    const bool other_way = facts.document && facts.document->expansion != document->expansion;
    const bool same_file = facts.document && facts.document->path == document->path;
    facts.document = document;
    // Restart the growth if it was running or finished; a stopped one stays where it is.
    if (other_way && (choices.growing || choices.growth >= facts.growth_end())) {
        choices.growth = 0;
        choices.growing = choices.paint == Paint::growth;
    }
    if (other && !same_file) {
        tell_error(perform(action::FrameAll{options_.camera}));
        const Vector up = options_.camera.up;
        // The camera of the options is for the first mesh; later meshes keep only its up direction.
        options_.camera = {};
        options_.camera.up = up;
    }
    stale(Freshness::redraw);
}

/// Prepares for showing another mesh: another file, or the same one after its stand-in or with another weld.
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

Result<void> Viewer::resize() {
    const Shown& chosen = state_.choices.shown;
    LR_ASSIGN(const PictureSize::Change change,
              size_.make(context_, scene_, *overlay_, chosen.samples, chosen.sides()));
    if (change == PictureSize::Change::none) return {};
    // All pictures of a turn have the same size.
    if (change == PictureSize::Change::size) end_turn();
    if (size_.smaller_than_window()) {
        state_.facts.tell(
            fmt::format("drawn at {} x {}: the device draws no larger picture", extent().width, extent().height), 4);
    }
    stale(Freshness::redraw);
    return {};
}

/// Performs the actions that panels asked for, and requests another ring or weld if it was chosen.
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
        // Do not try again in every frame.
        if (state_.choices.paint == Paint::none) state_.choices.ring_line = false;
        state_.choices.paint = Paint::none;
    } else if (*changed) {
        stale(Freshness::compose);
    }
}

/// Prepares the picture; returns false if it is not ready. If it is impossible, shows the error and goes back to the
/// choices of the last picture.
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
    if (chosen == before) return there;  // these choices were drawn before: there is nothing to go back to
    return false;
}

Result<void> Viewer::draw() {
    update_outlines();
    if (turn_.running()) {
        orbit_ = turn_.aim();
        stale(Freshness::redraw);
    }
    // Slow pictures wait until the camera rests. A new model is first shown in one pass. Pictures of a turn are fine.
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
    const double divider = std::floor(state_.choices.divider * extent().width + 0.5);
    const bool compose = draw_scene || freshness_ != Freshness::current || divider != divider_;
    if (compose) LR_TRY(scene_.record_compose(commands, static_cast<std::uint32_t>(divider)));
    divider_ = divider;
    overlay_->record(commands, scene_.composed());
    const double cpu = seconds_since(begun);
    LR_TRY(commands_->run());
    if (draw_scene || freshness_ == Freshness::compose) freshness_ = Freshness::current;
    state_.facts.samples = shown(Quality::fine).samples;
    if (!draw_scene) return {};
    state_.facts.difference.reset();
    if (draw_model) {
        drawn_model_ = scene_.model();
        state_.facts.frame_seconds = seconds_since(begun);
        tell_materials();
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

/// Shows a note, once, on parts of the file's materials that are not drawn.
void Viewer::tell_materials() {
    const gpu::GpuMaterials* materials = scene_.materials();
    if (materials == nullptr || materials == told_materials_) return;
    told_materials_ = materials;
    if (!materials->notes.empty()) state_.facts.tell(materials->notes.front(), 6);
}

/// Saves the composed picture, which has no panels, as the next one of the turn.
void Viewer::save_turn_picture() {
    const Result<gpu::Picture> taken = read_picture(context_, *commands_, scene_.composed(), size_.made());
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

/// Compares the two pictures once nothing moves.
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
        io.DisplaySize = {static_cast<float>(extent().width), static_cast<float>(extent().height)};
        io.DeltaTime = static_cast<float>(std::max(1e-4, seconds));
        ImGui::NewFrame();
        draw_panels(state_, scene_.has_ring_line());
        if (selecting_.keep_in_sight(state_.facts, orbit_, area())) stale(Freshness::redraw);
        draw_marks(state_, orbit_, extent().width, extent().height);
        ImGui::Render();
    }
    act();
    if (visible()) {
        LR_TRY(resize());  // act() may have changed choices
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

}  // namespace lacedring::view
