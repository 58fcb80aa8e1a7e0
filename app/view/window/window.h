#pragma once
// The window. Only window.cpp uses GLFW.

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

    /// Returns the events since the last call; waits up to `seconds` for one.
    std::vector<Event> poll(double seconds);
    /// Ends a waiting poll(). May be called from any thread.
    static void wake();

    VkExtent2D extent() const;  ///< pixels; zero while minimized
    double scale() const;       ///< pixels of the display per nominal pixel
    void set_size(std::uint32_t width, std::uint32_t height);
    /// Limits the sides of the window to `side` pixels: asks the window system for the limit, and shrinks a window that
    /// is larger nevertheless, once for each size.
    void limit_size(std::uint32_t side);
    void minimize(bool minimized);
    void hide();
    void set_title(const std::string& title);
    void set_clipboard(const std::string& text);

  private:
    Window() = default;
    /// Pixels per unit of the window's coordinates.
    double pixels() const;
    void listen();
    void shrink(double width, double height);

    GLFWwindow* window_ = nullptr;
    std::uint32_t limit_ = UINT32_MAX;
    double shrunk_width_ = 0, shrunk_height_ = 0;  // the last size that was too large
    std::vector<Event> events_;
};

}  // namespace lacedring::view
