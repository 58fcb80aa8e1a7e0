// A whole turn as a folder of pictures, one a frame, so that the window stays alive.
#include <fmt/format.h>

#include <filesystem>

#include "app/view/ui/viewer.h"
#include "renderer/draw/picture.h"

namespace lacedring::view {

Result<void> Viewer::start_turntable(const std::string& folder, std::uint32_t pictures) {
    if (pictures == 0) return Error{ErrorCode::invalid_argument, "no pictures"};
    if (!state_.document) return Error{ErrorCode::invalid_argument, "no mesh"};
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error) return Error{ErrorCode::cannot_write, error.message()};
    end_turntable();
    before_turntable_ = orbit_;
    state_.turntable_job = {folder, pictures, 0};
    quiet_frames_ = 0;
    return {};
}

/// Before a frame is drawn: as the next picture has it. Each is turned from where it began, so that no error adds up.
void Viewer::aim_turntable() {
    if (!state_.turntable_job) return;
    const State::TurntableJob& job = *state_.turntable_job;
    orbit_ = before_turntable_;
    orbit_.turn_degrees(360.0 * job.done / job.pictures);
    dirty_ = true;
    fresh_ = false;
    still_seconds_ = 1e6;  // nobody moves it: every picture is an exact one
}

/// After it is drawn. The composed picture has no panels yet.
void Viewer::save_turntable_picture() {
    State::TurntableJob& job = *state_.turntable_job;
    const Result<gpu::Picture> taken = picture_of(scene_.composed());
    const std::string path = fmt::format("{}/{:03}.png", job.folder, job.done);
    const Result<void> written = taken ? gpu::write_png(path, *taken) : Result<void>(taken.error());
    if (!written) {
        state_.error = path + ": " + written.error().message;
        end_turntable();
        return;
    }
    if (++job.done == job.pictures) end_turntable();
}

void Viewer::end_turntable() {
    if (!state_.turntable_job) return;
    const State::TurntableJob& job = *state_.turntable_job;
    state_.tell(job.done == job.pictures
                    ? fmt::format("saved {} pictures in {}", job.pictures, job.folder)
                    : fmt::format("stopped: {} of {} pictures in {}", job.done, job.pictures, job.folder),
                4);
    state_.turntable_job.reset();
    orbit_ = before_turntable_;
    dirty_ = true;
}

}  // namespace lacedring::view
