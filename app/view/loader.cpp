#include "app/view/loader.h"

#include <algorithm>
#include <utility>

#include "app/formats.h"
#include "lrcore/baseline/strips.h"
#include "renderer/try.h"

namespace lr::view {
namespace {

constexpr double kSoon = 0.25;  // seconds after which something must be seen of a ring that was asked for

StreamFigures figures(std::size_t triangles, std::size_t bytes, std::size_t references, std::size_t vertices,
                      const std::vector<std::uint32_t>& indices) {
    StreamFigures out;
    const auto count = static_cast<double>(std::max<std::size_t>(1, triangles));
    out.bytes = bytes;
    out.references = static_cast<double>(references) / count;
    out.bits = 8.0 * static_cast<double>(bytes) / count;
    out.acmr = analyze_fifo32(indices, vertices).acmr;
    return out;
}

void measure(Document& document) {
    const std::size_t triangles = document.mesh->triangle_count() - document.table->topology.degenerate;
    const std::size_t vertices = document.mesh->vertex_count;
    document.plain = figures(triangles, 4 * document.mesh->indices.size(), document.mesh->indices.size(), vertices,
                             document.mesh->indices);
    const gpu::Model& model = *document.model;
    if (const Result<LeanView> view = view_lean(model.lean.words)) {
        std::vector<std::uint32_t> indices(std::size_t{3} * view->slots());
        decode_lean(*view, indices);
        document.lean = figures(triangles, view->bytes(), view->references(), vertices, indices);
    }
    if (model.packed.words.empty()) return;
    if (const Result<PackedView> view = view_packed(model.packed.words)) {
        std::vector<std::uint32_t> indices(std::size_t{3} * view->triangles);
        decode_packed(*view, indices);
        document.packed = figures(triangles, view->bytes(), 0, vertices, indices);
    }
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

Loader::Loader(std::function<void()> wake) : wake_window_(std::move(wake)), thread_([this] { run(); }) {}

Loader::~Loader() {
    {
        const std::lock_guard lock(mutex_);
        quit_ = true;
        stop_ = true;
    }
    wake_.notify_all();
    thread_.join();
}

void Loader::request(Request request) {
    {
        const std::lock_guard lock(mutex_);
        next_ = std::move(request);
        stop_ = true;  // until run() takes the request
        asked_ = std::chrono::steady_clock::now();
        progress_ = {.busy = true, .background = false, .what = "starting", .share = 0};
    }
    wake_.notify_all();
}

void Loader::open(const Input& input, const RingSettings& settings) {
    request({input, nullptr, settings});
}

void Loader::encode(std::shared_ptr<const Document> document, const RingSettings& settings) {
    request({std::nullopt, std::move(document), settings});
}

void Loader::cancel() {
    const std::lock_guard lock(mutex_);
    if (next_) progress_ = {};  // it was not begun
    next_.reset();
    stop_ = true;
}

Loader::Progress Loader::progress() const {
    const std::lock_guard lock(mutex_);
    return progress_;
}

bool Loader::has_news() const {
    const std::lock_guard lock(mutex_);
    return news_.document || news_.tables || news_.formats || news_.error;
}

Loader::News Loader::take() {
    const std::lock_guard lock(mutex_);
    return std::exchange(news_, {});
}

void Loader::say(const std::string& what, double share, bool background) {
    const std::lock_guard lock(mutex_);
    progress_ = {true, background, what, share};
}

void Loader::publish(const Document& document) {
    auto copy = std::make_shared<Document>(document);
    const std::lock_guard lock(mutex_);
    copy->asked = asked_;
    copy->seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - asked_).count();
    if (stop_) return;
    news_.document = std::move(copy);
    wake_window_();
}

double Loader::since_asked() const {
    const std::lock_guard lock(mutex_);
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - asked_).count();
}

void Loader::run() {
    for (;;) {
        Request request;
        {
            std::unique_lock lock(mutex_);
            progress_ = {};
            wake_.wait(lock, [&] { return quit_ || next_.has_value(); });
            if (quit_) return;
            request = std::move(*next_);
            next_.reset();
            stop_ = false;
            progress_.busy = true;
        }
        work(request);
    }
}

/// Rings and streams. `quick`: one seed, nothing optimised, lean alone.
Result<void> Loader::finish(Document& document, const Request& request, bool quick) {
    const RingSettings& settings = request.settings;
    const CornerTable& table = *document.table;
    // In steps of the bar: ring, lean's passes, packed's passes.
    const double share = quick ? 0.55 : document.optimised ? 0.0 : 0.6;
    say("making the ring", share);
    auto expansion = std::make_shared<Expansion>();
    const Rings rings = expand_rings(table, ring_options(settings, quick), expansion.get());
    if (stopped()) return {};
    bool shown = quick || request.input.has_value();
    // An optimiser that takes its time lets the ring be seen as it was made.
    const auto show = [&] {
        if (shown || since_asked() < kSoon) return;
        shown = true;
        Result<LeanStream> lean = encode_lean(table, rings, {.wart_skipping = settings.warts});
        if (!lean) return;  // reported when the optimized rings are encoded
        Document early = document;
        auto model = std::make_shared<gpu::Model>(*document.model);
        model->lean = std::move(*lean);
        model->packed = {};
        early.rings = std::make_shared<const Rings>(rings);
        early.model = std::move(model);
        early.settings = settings;
        early.optimised = false;
        measure(early);
        publish(early);
    };
    const auto optimised = [&](const RingCost& cost, double from, double to, const char* what) {
        if (quick || settings.passes == 0) return rings;
        OptimizeOptions options;
        options.cost = cost;
        options.passes = settings.passes;
        options.random_seed = settings.random_seed;
        options.progress = [&, from, to, what](std::uint32_t done) {
            say(what, from + (to - from) * done / settings.passes);
            show();
            return !stopped();
        };
        say(what, from);
        return optimize_rings(table, rings, options);
    };
    auto lean_rings = std::make_shared<Rings>(optimised(lean_ring_cost, share, 0.8, "optimising the ring"));
    if (stopped()) return {};
    auto model = std::make_shared<gpu::Model>(*document.model);
    LR_ASSIGN(model->lean, encode_lean(table, *lean_rings, {.wart_skipping = settings.warts}));
    if (!quick) {
        const Rings packed_rings = optimised(packed_ring_cost, 0.8, 1.0, "optimising for the packed stream");
        if (stopped()) return {};
        LR_ASSIGN(model->packed, encode_packed(table, packed_rings));
    }
    if (stopped()) return {};
    document.rings = std::move(lean_rings);
    // Where it went the same way it stays the same one, so that what is made of it does.
    if (!document.expansion || *document.expansion != *expansion) document.expansion = std::move(expansion);
    document.model = std::move(model);
    document.settings = settings;
    document.optimised = !quick;
    measure(document);
    publish(document);
    return {};
}

void Loader::work(const Request& request) {
    const std::string path = request.input ? request.input->path : request.document->path;
    const auto failed = [&](const Error& error) {
        const std::lock_guard lock(mutex_);
        if (stop_) return;
        news_.error = path + ": " + error.message;
        wake_window_();
    };
    Document document;
    if (request.input) {
        say("reading the file", 0.05);
        app::RunLog log;
        Result<Mesh> mesh = app::load({request.input->path, request.input->options}, log);
        if (!mesh) return failed(mesh.error());
        if (stopped()) return;
        document.path = path;
        document.mesh = std::make_shared<const Mesh>(std::move(*mesh));
        say("building the corner table", 0.3);
        Result<CornerTable> table = build_corner_table(document.mesh->indices, document.mesh->vertex_count);
        if (!table) return failed(table.error());
        if (stopped()) return;
        document.table = std::make_shared<const CornerTable>(std::move(*table));
        Result<gpu::Model> model = gpu::make_surface(*document.mesh);
        if (!model) return failed(model.error());
        document.model = std::make_shared<const gpu::Model>(std::move(*model));
        if (stopped()) return;
        if (const Result<void> done = finish(document, request, true); !done) return failed(done.error());
    } else {
        document = *request.document;
        document.optimised = true;  // shown already: the bar begins with the ring
    }
    if (stopped()) return;
    if (const Result<void> done = finish(document, request, false); !done) return failed(done.error());
    if (stopped()) return;

    say("making LR tables", 0, true);
    if (Result<EncodedLr> lr = encode_lr(*document.table, ring_options(request.settings, true))) {
        if (Result<Tables> tables = make_tables(document.mesh, std::move(*lr))) {
            const std::lock_guard lock(mutex_);
            if (!stop_) news_.tables = std::make_shared<const Tables>(std::move(*tables));
            wake_window_();
        }
    }
    // Formats have the rings recommended for each: once for a mesh, unless another ring was asked for before they came.
    if (stopped() || measured_.lock() == document.mesh) return;
    app::RingChoice choice;
    Result<app::FormatSet> formats =
        app::make_formats(*document.mesh, choice, false, [&](double share, const std::string& what) {
            say("measuring " + what, share, true);
            return !stopped();
        });
    if (!formats || stopped()) return;
    for (app::Format& format : formats->formats) {
        format.indices = {};  // only the figures are shown
        format.order = {};
    }
    const std::lock_guard lock(mutex_);
    measured_ = document.mesh;
    news_.formats = std::make_shared<const app::FormatSet>(std::move(*formats));
    wake_window_();
}

}  // namespace lr::view
