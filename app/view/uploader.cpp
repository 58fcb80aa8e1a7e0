#include "app/view/uploader.h"

#include <utility>

#include "renderer/try.h"

namespace lr::view {
namespace {

gpu::UploadOptions options_of(const UploadKey& key) {
    gpu::UploadOptions out;
    out.path = key.path;
    out.ring = key.with != UploadKey::With::edges;
    out.offsets = key.with == UploadKey::With::offsets;
    out.lines = key.with == UploadKey::With::edges ? gpu::UploadOptions::Lines::edges : gpu::UploadOptions::Lines::ring;
    return out;
}

}  // namespace

Result<std::unique_ptr<Uploader>> Uploader::create(gpu::Context& context, std::function<void()> wake) {
    LR_ASSIGN(gpu::Transfer transfer, gpu::Transfer::create(context));
    std::unique_ptr<Uploader> out(new Uploader(std::move(transfer), std::move(wake)));
    out->thread_ = std::thread([uploader = out.get()] { uploader->run(); });
    return out;
}

Uploader::~Uploader() {
    {
        const std::lock_guard lock(mutex_);
        next_.reset();
        quit_ = true;
    }
    changed_.notify_all();
    thread_.join();
}

void Uploader::ask(Job job, const gpu::Expander& expander) {
    {
        const std::lock_guard lock(mutex_);
        expander_ = &expander;
        last_ = job;
        next_ = std::move(job);
        done_.reset();
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

void Uploader::run() {
    std::unique_lock lock(mutex_);
    for (;;) {
        changed_.wait(lock, [&] { return quit_ || next_.has_value(); });
        if (quit_) return;
        Done done{*std::exchange(next_, std::nullopt), {}, std::nullopt};
        const gpu::Expander& expander = *expander_;
        working_ = true;
        lock.unlock();
        for (const UploadKey& key : done.job.keys) {
            Result<gpu::Drawable> made = expander.upload(transfer_, *done.job.model, key.source, options_of(key));
            if (!made) {
                done.error = made.error();
                done.drawables.clear();
                break;
            }
            done.drawables.push_back(std::move(*made));
        }
        lock.lock();
        working_ = false;
        if (last_ == done.job) done_ = std::move(done);  // else something else is wanted by now
        changed_.notify_all();
        wake_();
    }
}

}  // namespace lr::view
