#pragma once
// Saves a whole turn as a folder of pictures, one per frame, so that the window keeps responding.

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
    /// The camera of the next picture. Each is turned from the first one, so that errors do not accumulate.
    Orbit aim() const;
    /// Writes the picture drawn with aim(). Errors: cannot_write, with the file's name.
    Result<void> save(const gpu::Picture& picture);
    bool done() const { return done_ == pictures_; }
    /// Ends the turn; returns the camera from before it. `message` gets the outcome.
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
