#include "app/cli/progress.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <memory>
#include <optional>
#include <utility>

#include "app/cli/print.h"

namespace lacedring::app {
namespace {

constexpr std::uint64_t kWidth = 40;
constexpr std::chrono::milliseconds kMoment{500};  // before the bar appears

bool progress_hidden = false;

bool shows_progress() {
    return !progress_hidden && isatty(STDERR_FILENO) != 0;
}

}  // namespace

void hide_progress() {
    progress_hidden = true;
}

ProgressBar::ProgressBar(std::string what, std::uint64_t total)
    : what_(std::move(what)), total_(std::max<std::uint64_t>(1, total)), terminal_(shows_progress()) {}

ProgressBar::~ProgressBar() {
    if (!shown_) return;
    say("\r{:{}}\r", "", what_.size() + kWidth + 44);  // two numbers have up to 20 digits each
    std::fflush(stderr);
}

void ProgressBar::show(std::uint64_t done) {
    done_ = std::min(done, total_);
    if (!terminal_ || std::chrono::steady_clock::now() - begun_ < kMoment) return;
    const std::uint64_t full = kWidth * done_ / total_;
    say("\r{} [{:=<{}}{:{}}] {}/{}", what_, "", full, "", kWidth - full, done_, total_);
    std::fflush(stderr);
    shown_ = true;
}

std::function<bool(std::uint32_t)> progress_bar(const char* what, std::uint32_t total) {
    if (!shows_progress()) return {};
    const auto bar = std::make_shared<std::optional<ProgressBar>>(std::in_place, what, total);
    return [=](std::uint32_t done) {
        if (!*bar) bar->emplace(what, total);  // the work begins again
        (*bar)->show(done);
        if (done >= total) bar->reset();  // erased before the next output
        return true;
    };
}

}  // namespace lacedring::app
