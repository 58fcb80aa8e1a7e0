#pragma once
// Turns events of keys and mouse into actions.

#include <functional>
#include <optional>

#include "app/view/ui/state.h"
#include "app/view/window/event.h"

namespace lacedring::view {

class Controls {
  public:
    /// Passes the actions of an event to `perform`. The event's position is in pixels of the picture. `up`: the
    /// camera's up direction.
    void handle(const Event& event, const State& state, VkExtent2D extent, const Vector& up,
                const std::function<void(Action)>& perform);

  private:
    enum class Drag { none, turn, zoom, pan, divider };
    Drag drag_ = Drag::none;
    double x_ = 0, y_ = 0, press_x_ = 0, press_y_ = 0;
};

}  // namespace lacedring::view
