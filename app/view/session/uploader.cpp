#include "app/view/session/uploader.h"

#include <new>
#include <utility>

#include "app/view/session/threads.h"
#include "renderer/vk/try.h"

namespace lacedring::view {
namespace {

gpu::UploadOptions options_of(const UploadKey& key) {
    gpu::UploadOptions out;
    out.path = key.path;
    using Lines = gpu::UploadOptions::Lines;
    out.ring = key.with == UploadKey::With::ring || key.with == UploadKey::With::offsets;
    out.offsets = key.with == UploadKey::With::offsets;
    out.lines = out.ring                             ? Lines::ring
                : key.with == UploadKey::With::edges ? Lines::edges
                : key.with == UploadKey::With::seams ? Lines::seams
                                                     : Lines::none;
    return out;
}

}  // namespace

Result<std::unique_ptr<Uploader>> Uploader::create(gpu::Context& context, std::function<void()> wake) {
    LR_ASSIGN(gpu::Transfer transfer, gpu::Transfer::create(context));
    std::unique_ptr<Uploader> out(new Uploader(context, std::move(transfer), std::move(wake)));
    out->transfer_.stop_when(&out->stop_);
    LR_ASSIGN(out->thread_, start_thread([uploader = out.get()] { uploader->run(); }));
    return out;
}

Uploader::~Uploader() {
    stop(std::chrono::milliseconds(0));
    if (thread_.joinable()) thread_.join();
}

bool Uploader::stop(std::chrono::milliseconds patience) {
    std::unique_lock lock(mutex_);
    next_.reset();
    quit_ = stop_ = true;
    changed_.notify_all();
    return changed_.wait_for(lock, patience, [this] { return !working_; });
}

void Uploader::ask(Job job, gpu::Expander& expander) {
    {
        const std::lock_guard lock(mutex_);
        expander_ = &expander;
        last_ = job;
        next_ = std::move(job);
        done_.reset();
        stop_ = working_;
    }
    changed_.notify_all();
}

bool Uploader::asked(const Job& job) const {
    const std::lock_guard lock(mutex_);
    return last_ == job;
}

std::optional<Uploader::Done> Uploader::take() {
    const std::lock_guard lock(mutex_);
    if (!done_) return std::nullopt;
    last_.reset();
    return std::exchange(done_, std::nullopt);
}

void Uploader::finish() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return !working_ && !next_; });
}

/// Uploads the model's materials, or returns those uploaded last if they are the same: models of other rings share
/// them.
Result<std::shared_ptr<const UploadedMaterials>> Uploader::materials_of(const OwningModel& model) {
    std::shared_ptr<const UploadedMaterials> out = materials_.lock();
    const std::uint32_t triangles = model.triangle_count();
    if (out && out->of == model.owned_materials && out->triangles == triangles) return out;
    LR_ASSIGN(gpu::GpuMaterials device, gpu::upload_materials(context_, transfer_, model.materials, triangles));
    out = std::make_shared<const UploadedMaterials>(
        UploadedMaterials{model.owned_materials, triangles, std::move(device)});
    materials_ = out;
    return out;
}

Result<void> Uploader::upload(Done& done, gpu::Expander& expander) {
    try {
        for (const UploadKey& key : done.job.keys) {
            gpu::UploadOptions options = options_of(key);
            UploadedMesh mesh;
            if (key.with == UploadKey::With::materials) {
                LR_ASSIGN(mesh.materials, materials_of(*done.job.model));
                options.materials = mesh.materials->device.table.address_words();
            }
            LR_ASSIGN(mesh.expanded, expander.upload(transfer_, *done.job.model, key.source, options));
            done.meshes.push_back(std::move(mesh));
        }
    } catch (const std::bad_alloc&) {
        return Error{ErrorCode::too_large, "not enough memory"};
    }
    return {};
}

void Uploader::run() {
    std::unique_lock lock(mutex_);
    for (;;) {
        changed_.wait(lock, [&] { return quit_ || next_.has_value(); });
        if (quit_) return;
        Done done{*std::exchange(next_, std::nullopt), {}, std::nullopt};
        gpu::Expander& expander = *expander_;
        working_ = true;
        stop_ = false;
        lock.unlock();
        if (const Result<void> made = upload(done, expander); !made) {
            done.error = made.error();
            done.meshes.clear();
        }
        lock.lock();
        working_ = false;
        // Drop the result if another job was asked for, or the same one again after it was stopped.
        if (last_ == done.job && !next_ && !quit_) done_ = std::move(done);
        changed_.notify_all();
        wake_();
    }
}

}  // namespace lacedring::view
