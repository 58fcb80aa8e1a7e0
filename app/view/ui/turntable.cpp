#include "app/view/ui/turntable.h"

#include <fmt/format.h>

#include <filesystem>

namespace lacedring::view {

Result<void> TurnSaver::start(const std::string& folder, std::uint32_t pictures, const Orbit& orbit) {
    if (pictures == 0) return Error{ErrorCode::invalid_argument, "no pictures"};
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error) return Error{ErrorCode::cannot_write, folder + ": " + error.message()};
    folder_ = folder;
    pictures_ = pictures;
    done_ = 0;
    before_ = orbit;
    return {};
}

Orbit TurnSaver::aim() const {
    Orbit out = before_;
    out.turn_degrees(360.0 * done_ / pictures_);
    return out;
}

Result<void> TurnSaver::save(const gpu::Picture& picture) {
    const std::string path = fmt::format("{}/{:03}.png", folder_, done_);
    if (const Result<void> written = gpu::write_png(path, picture); !written) {
        return Error{written.error().code, path + ": " + written.error().message};
    }
    ++done_;
    return {};
}

Orbit TurnSaver::end(std::string& message) {
    message = done() ? fmt::format("saved {} pictures in {}", pictures_, folder_)
                     : fmt::format("stopped: {} of {} pictures in {}", done_, pictures_, folder_);
    pictures_ = 0;
    return before_;
}

std::string TurnSaver::text() const {
    return fmt::format("picture {} of {}", done_ + 1, pictures_);
}

}  // namespace lacedring::view
