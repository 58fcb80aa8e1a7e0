#pragma once
// A whole turn as a folder of pictures, one a frame, so that the window stays alive.

#include <optional>
#include <string>

#include "app/view/scene/orbit.h"
#include "renderer/draw/picture.h"

namespace lacedring::view {

class TurnSaver {
  public:
    bool running() const { return pictures_ != 0; }
    /// Errors: cannot_write, invalid_argument (no pictures).
    Result<void> start(const std::string& folder, std::uint32_t pictures, const Orbit& orbit);
    /// The camera of the next picture. Each is turned from the start, so that no error adds up.
    Orbit aim() const;
    /// Writes the picture that aim() was for. Errors: cannot_write, naming the file.
    Result<void> save(const gpu::Picture& picture);
    bool done() const { return done_ == pictures_; }
    /// Gives the camera as it was before. `message`: how it ended.
    Orbit end(std::string& message);
    /// "picture 3 of 90"
    std::string text() const;
    double share() const { return static_cast<double>(done_) / pictures_; }

  private:
    std::string folder_;
    std::uint32_t pictures_ = 0, done_ = 0;
    Orbit before_;
};

}  // namespace lacedring::view
