#include "app/view/session/loader.h"

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <mutex>
#include <new>
#include <thread>
#include <utility>

#include "app/cli/input.h"
#include "app/formats/formats.h"
#include "app/view/session/coarse.h"
#include "app/view/session/files.h"
#include "lacedring/lacedring.hpp"
#include "lacedring/streams.hpp"
#include "lrlab/rivals/strips.h"
#include "renderer/vk/device_error.h"
#include "renderer/vk/try.h"

namespace lacedring::view {
namespace {

using Clock = std::chrono::steady_clock;

// Seconds after which a requested ring is shown, even if the optimizer has not finished.
constexpr double kSoon = 0.25;
// A job waits this long for the older, stopped job to end; after that both compute at once.
constexpr std::chrono::seconds kTurn{1};
// Meshes of at least this many triangles get a stand-in.
constexpr std::size_t kLarge = 2000000;
// Files and folders being read at once, including those of stopped requests.
constexpr std::size_t kMostReaders = 8;

void measure(Document& document) {
    const auto figures = [&](std::size_t bytes, std::size_t references, const std::vector<std::uint32_t>& indices) {
        StreamFigures out;
        out.bytes = bytes;
        out.bits = document.bits_per_triangle(bytes);
        out.references = document.bits_per_triangle(references) / 8;
        out.acmr = analyze_fifo32(indices, document.mesh->vertex_count).acmr;
        return out;
    };
    const std::vector<std::uint32_t>& listed = document.mesh->indices;
    document.plain = figures(4 * listed.size(), listed.size(), listed);
    const LeanView& lean = document.views.lean;
    std::vector<std::uint32_t> indices(std::size_t{3} * lean.slots());
    decode_lean(lean, indices);
    document.lean = figures(lean.bytes(), lean.references(), indices);
    if (document.model->packed.words.empty()) return;
    const PackedView& packed = document.views.packed;
    indices.resize(std::size_t{3} * packed.triangles);
    decode_packed(packed, indices);
    document.packed = figures(packed.bytes(), 0, indices);
}

/// Sets the document's model, the views of its streams, and their figures.
Result<void> set_model(Document& document, std::shared_ptr<const OwningModel> model) {
    const gpu::Source source = model->packed.words.empty() ? gpu::Source::lean : gpu::Source::packed;
    LR_ASSIGN(document.views, gpu::view_streams(*model, source));
    document.model = std::move(model);
    measure(document);
    return {};
}

RingOptions ring_options(const RingSettings& settings, bool quick) {
    RingOptions options;
    options.seeds = quick ? 1 : std::max(1U, settings.seeds);
    options.random_seed = settings.random_seed;
    options.start = settings.start;
    options.k = settings.hybrid ? std::max(1U, settings.k) : 0;
    return options;
}

}  // namespace

/// State shared by the loader and its threads, which may outlive it.
struct Loader::Shared {
    std::mutex mutex;
    std::condition_variable changed;
    std::function<void()> wake;  // empty after the loader's destructor
    // The current request; null: none, or canceled.
    std::shared_ptr<Job> newest;
    Update update;
    Progress progress;
    std::size_t readers = 0, computing = 0;  // numbers of threads
    std::uint64_t listing = 0;               // number of the newest call of list()
    std::weak_ptr<const Mesh> measured;      // the mesh whose formats were measured

    void say_news() {
        if (wake) wake();
    }
};

/// One request, on a thread of its own.
class Loader::Job {
  public:
    Job(std::shared_ptr<Shared> shared, Request request)
        : shared_(std::move(shared)), request_(std::move(request)), asked_(Clock::now()) {}

    /// Call with the mutex held. The job publishes nothing after that.
    void stop() { stop_ = true; }
    const std::string& path() const { return request_.input ? request_.input->path : request_.document->path; }
    bool reads() const { return request_.input.has_value(); }

    void run();

  private:
    void work();
    Result<app::LoadedMesh> read();
    Result<void> make(Document& document, const std::shared_ptr<const Materials>& materials, bool has_materials);
    Result<void> finish(Document& document, bool quick);
    void show_stand_in(const app::LoadedMesh& loaded);
    void measure_formats(const Document& document);
    bool begin_computing();
    bool stopped() const { return stop_.load(); }
    double since_asked() const { return std::chrono::duration<double>(Clock::now() - asked_).count(); }
    void say(const std::string& what, double share, bool background = false);
    void publish(const Document& document);
    void fail(const std::string& why);

    const std::shared_ptr<Shared> shared_;
    const Request request_;
    const Clock::time_point asked_;
    std::atomic<bool> stop_ = false;
    bool reading_ = false, computing_ = false;  // counted in Shared
};

Loader::Loader(Threads& threads, std::function<void()> wake) : threads_(threads), shared_(std::make_shared<Shared>()) {
    shared_->wake = std::move(wake);
}

Loader::~Loader() {
    cancel();
    const std::lock_guard lock(shared_->mutex);
    shared_->wake = {};
}

void Loader::request(Request request) {
    auto job = std::make_shared<Job>(shared_, std::move(request));
    cancel();
    bool room = true;
    {
        const std::lock_guard lock(shared_->mutex);
        if (job->reads()) room = shared_->readers < kMostReaders;
        if (room) {
            if (job->reads()) ++shared_->readers;
            shared_->newest = job;
            shared_->progress = {.busy = true, .background = false, .what = "starting", .share = 0};
        }
    }
    shared_->changed.notify_all();
    const Result<void> started =
        room ? threads_.start([job] { job->run(); })
             : Error{gpu::kDeviceFailure, std::to_string(kMostReaders) + " other files are still being read"};
    if (started) return;
    const std::lock_guard lock(shared_->mutex);
    if (room && job->reads()) --shared_->readers;
    shared_->newest.reset();
    shared_->progress = {};
    shared_->update.error = job->path() + ": " + started.error().message;
}

void Loader::open(const Input& input, const RingSettings& settings) {
    request({input, nullptr, settings});
}

void Loader::encode(std::shared_ptr<const Document> document, const RingSettings& settings) {
    request({std::nullopt, std::move(document), settings});
}

void Loader::cancel() {
    const std::lock_guard lock(shared_->mutex);
    if (shared_->newest) shared_->newest->stop();
    shared_->newest.reset();
    shared_->progress = {};
    shared_->changed.notify_all();
}

void Loader::list(const std::string& path) {
    std::uint64_t number = 0;
    {
        const std::lock_guard lock(shared_->mutex);
        number = ++shared_->listing;
        if (shared_->readers >= kMostReaders) return;
        ++shared_->readers;
    }
    const Result<void> started = threads_.start([shared = shared_, path, number] {
        std::optional<std::vector<std::string>> files;
        try {
            files = meshes_beside(path);
        } catch (const std::bad_alloc&) {
            files.reset();  // the list stays as it is
        }
        const std::lock_guard lock(shared->mutex);
        --shared->readers;
        if (number != shared->listing || !files) return;
        shared->update.files = std::move(files);
        shared->say_news();
    });
    if (started) return;
    const std::lock_guard lock(shared_->mutex);
    --shared_->readers;
    shared_->update.error = path + ": cannot list its folder: " + started.error().message;
}

Loader::Progress Loader::progress() const {
    const std::lock_guard lock(shared_->mutex);
    return shared_->progress;
}

bool Loader::has_update() const {
    const std::lock_guard lock(shared_->mutex);
    const Update& update = shared_->update;
    return update.document || update.tables || update.formats || update.files || update.error;
}

Loader::Update Loader::take() {
    const std::lock_guard lock(shared_->mutex);
    return std::exchange(shared_->update, {});
}

void Loader::Job::say(const std::string& what, double share, bool background) {
    const std::lock_guard lock(shared_->mutex);
    if (!stop_) shared_->progress = {true, background, what, share};
}

void Loader::Job::publish(const Document& document) {
    auto copy = std::make_shared<Document>(document);
    const std::lock_guard lock(shared_->mutex);
    copy->asked = asked_;
    copy->seconds = since_asked();
    if (stop_) return;
    shared_->update.document = std::move(copy);
    shared_->say_news();
}

void Loader::Job::fail(const std::string& why) {
    const std::lock_guard lock(shared_->mutex);
    if (stop_) return;
    shared_->update.error = path() + ": " + why;
    shared_->say_news();
}

void Loader::Job::run() {
    reading_ = reads();
    try {
        work();
    } catch (const std::bad_alloc&) {
        fail("not enough memory");
    }
    const std::lock_guard lock(shared_->mutex);
    if (reading_) --shared_->readers;
    if (computing_) --shared_->computing;
    if (shared_->newest.get() == this) {
        shared_->newest.reset();
        shared_->progress = {};
    }
    shared_->changed.notify_all();
}

/// Reads the file. On a dead network disk it may never return.
Result<app::LoadedMesh> Loader::Job::read() {
    say("reading the file", 0.05);
    app::RunLog log;
    Result<app::LoadedMesh> mesh = app::load_file(*request_.input, log);
    if (mesh) log.flush();
    const std::lock_guard lock(shared_->mutex);
    --shared_->readers;
    reading_ = false;
    return mesh;
}

/// Waits until the older job has stopped computing, for at most kTurn. Returns false if this job was stopped.
bool Loader::Job::begin_computing() {
    std::unique_lock lock(shared_->mutex);
    shared_->changed.wait_for(lock, kTurn, [this] { return stop_ || shared_->computing == 0; });
    if (stop_) return false;
    ++shared_->computing;
    computing_ = true;
    return true;
}

/// Makes rings and streams, and publishes the document. `quick`: one seed, no optimizer, only lean.
Result<void> Loader::Job::finish(Document& document, bool quick) {
    const RingSettings& settings = request_.settings;
    const CornerTable& table = *document.table;
    // Where the progress bar stands; then come lean's passes up to 0.8 and packed's up to 1.
    const double share = quick ? 0.55 : document.optimized ? 0.0 : 0.6;
    say("making the ring", share);
    auto expansion = std::make_shared<Expansion>();
    const Rings rings = expand_rings(table, ring_options(settings, quick), expansion.get());
    if (stopped()) return {};
    bool shown = quick || reads();
    // While the optimizer runs, show the ring as expand_rings made it, once kSoon has passed.
    const auto show = [&] {
        if (shown || since_asked() < kSoon) return;
        shown = true;
        Result<EncodedLean> lean = encode_lean(table, rings, {.wart_skipping = settings.warts});
        // Reported when the optimized rings are encoded.
        if (!lean) return;
        Document early = document;
        auto model = std::make_shared<OwningModel>(*document.model);
        model->lean = std::move(*lean);
        model->packed = {};
        if (!gpu::encode_seams(*model)) return;
        early.rings = std::make_shared<const Rings>(rings);
        if (!set_model(early, std::move(model))) return;
        early.settings = settings;
        early.optimized = false;
        publish(early);
    };
    const auto optimize_options = [&](const RingCost& cost, double from, double to, const char* what) {
        if (!quick) say(what, from);
        OptimizeOptions options;
        options.cost = cost;
        options.passes = quick ? 0 : settings.passes;
        options.random_seed = settings.random_seed;
        options.threads = std::max(std::thread::hardware_concurrency(), 2U) - 1;  // one is left for drawing
        options.progress = [&, from, to, what](std::uint32_t done) {
            say(what, from + (to - from) * done / settings.passes);
            show();
            return !stopped();
        };
        return options;
    };
    auto lean_rings = std::make_shared<Rings>(
        optimize_rings(table, rings, optimize_options(kLeanRingCost, share, 0.8, "optimizing the ring")));
    if (stopped()) return {};
    auto model = std::make_shared<OwningModel>(*document.model);
    LR_ASSIGN(model->lean, encode_lean(table, *lean_rings, {.wart_skipping = settings.warts}));
    if (!quick) {
        const OptimizeOptions optimize =
            optimize_options(kPackedRingCost, 0.8, 1.0, "optimizing for the packed stream");
        LR_ASSIGN(PackedChoice packed, encode_smallest_packed(table, ring_options(settings, quick), optimize));
        model->packed = std::move(packed.stream);
    }
    LR_TRY(gpu::encode_seams(*model));
    if (stopped()) return {};
    document.rings = std::move(lean_rings);
    // Keep the old object if the expansion is the same, so that paintings made of it stay valid.
    if (!document.expansion || *document.expansion != *expansion) document.expansion = std::move(expansion);
    LR_TRY(set_model(document, std::move(model)));
    document.settings = settings;
    document.optimized = !quick;
    publish(document);
    return {};
}

/// Makes the corner table and the drawn surface of a mesh, and publishes it with a quick ring.
Result<void> Loader::Job::make(Document& document, const std::shared_ptr<const Materials>& materials,
                               bool has_materials) {
    say("building the corner table", 0.3);
    const Surface& surface = *document.surface;
    const Mesh joined = surface_mesh(*document.mesh, surface);
    LR_ASSIGN(CornerTable table, build_corner_table(joined.indices, joined.vertex_count));
    if (stopped()) return {};
    document.table = std::make_shared<const CornerTable>(std::move(table));
    LR_ASSIGN(gpu::Model model, gpu::make_surface(*document.mesh, surface));
    gpu::add_materials(model, *document.mesh, *materials);
    document.model =
        std::make_shared<const OwningModel>(OwningModel{std::move(model), document.mesh, materials, has_materials});
    if (stopped()) return {};
    return finish(document, true);
}

/// Publishes a coarse mesh first, if making the ring of the mesh takes long.
void Loader::Job::show_stand_in(const app::LoadedMesh& loaded) {
    if (loaded.mesh.triangle_count() < kLarge) return;
    say("making a coarse stand-in", 0.2);
    Document document;
    document.path = path();
    document.stand_in = loaded.mesh.triangle_count();
    Mesh mesh = coarse(loaded.mesh);
    auto surface = std::make_shared<Surface>();
    surface->vertex_count = mesh.vertex_count;
    document.mesh = std::make_shared<const Mesh>(std::move(mesh));
    document.surface = std::move(surface);
    if (!make(document, std::make_shared<const Materials>(), false))
        // Loading the mesh itself will report this error.
        return;
}

/// Measures every format with the ring recommended for it; skips a mesh that was measured before.
void Loader::Job::measure_formats(const Document& document) {
    {
        const std::lock_guard lock(shared_->mutex);
        if (stop_ || shared_->measured.lock() == document.mesh) return;
    }
    app::RingChoice choice;
    Result<app::FormatSet> formats =
        app::make_formats(*document.mesh, *document.surface, choice, false, [&](double share, const std::string& what) {
            say("measuring " + what, share, true);
            return !stopped();
        });
    if (!formats) return;
    for (app::MeasuredFormat& format : formats->formats) {
        format.indices = {};  // only the figures are shown
        format.order = {};
    }
    const std::lock_guard lock(shared_->mutex);
    if (stop_) return;
    shared_->measured = document.mesh;
    shared_->update.formats = std::make_shared<const app::FormatSet>(std::move(*formats));
    shared_->say_news();
}

void Loader::Job::work() {
    Document document;
    if (stopped()) return;
    if (reads()) {
        Result<app::LoadedMesh> read_mesh = read();
        if (!read_mesh) return fail(read_mesh.error().message);
        if (!begin_computing()) return;
        document.path = path();
        show_stand_in(*read_mesh);
        if (stopped()) return;
        document.mesh = std::make_shared<const Mesh>(std::move(read_mesh->mesh));
        document.surface = std::make_shared<const Surface>(std::move(read_mesh->surface));
        const bool has_materials = read_mesh->has_materials();
        const auto materials = std::make_shared<const Materials>(std::move(read_mesh->materials));
        if (const Result<void> made = make(document, materials, has_materials); !made)
            return fail(made.error().message);
    } else {
        if (!begin_computing()) return;
        document = *request_.document;
        document.optimized = true;  // the progress bar begins with the ring
    }
    if (stopped()) return;
    if (reads()) document.report = report_topology(*document.table);
    if (const Result<void> done = finish(document, false); !done) return fail(done.error().message);
    if (stopped()) return;

    say("making LR tables", 0, true);
    if (Result<EncodedLr> lr = encode_lr(*document.table, ring_options(request_.settings, true))) {
        if (Result<Tables> tables = make_tables(document.mesh, std::move(*lr))) {
            tables->crease = crease_angle(document);
            const std::lock_guard lock(shared_->mutex);
            if (stop_) return;
            shared_->update.tables = std::make_shared<const Tables>(std::move(*tables));
            shared_->say_news();
        }
    }
    measure_formats(document);
}

}  // namespace lacedring::view
