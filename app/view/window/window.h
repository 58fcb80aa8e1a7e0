#pragma once
// The window, by GLFW. The only file that knows of it.

#include <vulkan/vulkan.h>

#include <memory>
#include <string>
#include <vector>

#include "app/view/window/event.h"
#include "lacedring/base.hpp"

struct GLFWwindow;

namespace lacedring::view {

class Window {
  public:
    /// Errors: kNoDevice (no display, no window, or no Vulkan for it).
    static Result<std::unique_ptr<Window>> create(std::uint32_t width, std::uint32_t height);
    ~Window();
    Window(const Window&) = delete;
    Window& operator=(const Window&) = delete;

    /// Instance extensions that surface() needs.
    std::vector<const char*> extensions() const;
    Result<VkSurfaceKHR> surface(VkInstance instance) const;

    /// What happened since the last call; waits up to `seconds` for something.
    std::vector<Event> poll(double seconds);
    /// Ends a poll that waits. From any thread.
    static void wake();

    VkExtent2D extent() const;  ///< pixels; zero while minimised
    double scale() const;       ///< pixels of the display a nominal pixel
    void set_size(std::uint32_t width, std::uint32_t height);
    /// Keeps the window from getting larger than `side` pixels: the window system is asked to, and a window that is
    /// larger all the same is asked to shrink, once for each size.
    void limit_size(std::uint32_t side);
    void minimise(bool minimised);
    void hide();
    void set_title(const std::string& title);
    void set_clipboard(const std::string& text);

  private:
    Window() = default;
    /// Pixels a unit of the window's coordinates.
    double pixels() const;
    void listen();
    void shrink(double width, double height);

    GLFWwindow* window_ = nullptr;
    std::uint32_t limit_ = UINT32_MAX;
    double shrunk_width_ = 0, shrunk_height_ = 0;  // that was too large last
    std::vector<Event> events_;
};

}  // namespace lacedring::view
