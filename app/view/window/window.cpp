#include "app/view/window/window.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <dlfcn.h>
#include <unistd.h>

#include <algorithm>
#include <string_view>
#include <utility>

#include "app/cli/command.h"
#include "renderer/vk/device_error.h"

struct _XDisplay;  // Xlib's Display

namespace lacedring::view {
namespace {

Error failed(const char* what) {
    const char* text = nullptr;
    glfwGetError(&text);
    return {gpu::kNoDevice, std::string(what) + (text != nullptr ? std::string(": ") + text : "")};
}

/// Called by Xlib when the connection to the X server is lost, on the thread that notices it. It must not return, or
/// Xlib ends the process with its own message and exit code. Destroys nothing: the state of other objects is unknown.
int display_lost(_XDisplay*) {
    constexpr std::string_view kLine = "lacedring: display: the connection to the X server is lost\n";
    // Ignore a failure: standard error may be lost, too.
    (void)!::write(STDERR_FILENO, kLine.data(), kLine.size());
    ::_exit(app::no_device);
}

/// Registers display_lost with Xlib if GLFW has loaded Xlib. The program does not link to it.
void watch_connection() {
    void* const xlib = ::dlopen("libX11.so.6", RTLD_LAZY | RTLD_NOLOAD);
    if (xlib == nullptr) return;
    using Handler = int (*)(_XDisplay*);
    using SetHandler = Handler (*)(Handler);
    const auto set = reinterpret_cast<SetHandler>(::dlsym(xlib, "XSetIOErrorHandler"));
    if (set != nullptr) set(display_lost);
    ::dlclose(xlib);  // GLFW keeps it loaded
}

unsigned modifiers(int mods) {
    unsigned out = 0;
    if ((mods & GLFW_MOD_SHIFT) != 0) out |= mod_shift;
    if ((mods & GLFW_MOD_CONTROL) != 0) out |= mod_control;
    if ((mods & GLFW_MOD_ALT) != 0) out |= mod_alt;
    return out;
}

}  // namespace

Result<std::unique_ptr<Window>> Window::create(std::uint32_t width, std::uint32_t height) {
    std::unique_ptr<Window> out(new Window);
    watch_connection();
    if (glfwInit() != GLFW_TRUE) return failed("no usable display");
    watch_connection();  // GLFW 3.4 loads Xlib in glfwInit
    if (glfwVulkanSupported() != GLFW_TRUE) return failed("no Vulkan for windows");
    glfwWindowHint(GLFW_CLIENT_API, GLFW_NO_API);
    out->window_ = glfwCreateWindow(static_cast<int>(width), static_cast<int>(height), "LacedRing", nullptr, nullptr);
    if (out->window_ == nullptr) return failed("no window");
    out->listen();
    return out;
}

Window::~Window() {
    if (window_ != nullptr) glfwDestroyWindow(window_);
    glfwTerminate();
}

std::vector<const char*> Window::extensions() const {
    std::uint32_t count = 0;
    const char** names = glfwGetRequiredInstanceExtensions(&count);
    return {names, names + count};
}

Result<VkSurfaceKHR> Window::surface(VkInstance instance) const {
    VkSurfaceKHR surface = VK_NULL_HANDLE;
    if (glfwCreateWindowSurface(instance, window_, nullptr, &surface) != VK_SUCCESS) {
        return failed("no Vulkan surface for the window");
    }
    return surface;
}

void Window::listen() {
    glfwSetWindowUserPointer(window_, this);
    const auto of = [](GLFWwindow* w) -> Window& { return *static_cast<Window*>(glfwGetWindowUserPointer(w)); };
    static constexpr auto self = of;
    glfwSetKeyCallback(window_, [](GLFWwindow* w, int key, int, int action, int mods) {
        // A release may have other modifiers than its press: shift may be released first.
        self(w).events_.push_back(
            {.kind = Event::key, .code = key, .down = action != GLFW_RELEASE, .modifiers = modifiers(mods)});
    });
    glfwSetCharCallback(window_, [](GLFWwindow* w, unsigned code) {
        self(w).events_.push_back({.kind = Event::text, .code = static_cast<int>(code)});
    });
    glfwSetCursorPosCallback(window_, [](GLFWwindow* w, double x, double y) {
        const double scale = self(w).pixels();
        self(w).events_.push_back({.kind = Event::move, .x = x * scale, .y = y * scale});
    });
    glfwSetMouseButtonCallback(window_, [](GLFWwindow* w, int button, int action, int mods) {
        double x = 0, y = 0;
        glfwGetCursorPos(w, &x, &y);
        const double scale = self(w).pixels();
        self(w).events_.push_back({.kind = Event::button,
                                   .code = button,
                                   .down = action == GLFW_PRESS,
                                   .modifiers = modifiers(mods),
                                   .x = x * scale,
                                   .y = y * scale});
    });
    glfwSetScrollCallback(window_, [](GLFWwindow* w, double x, double y) {
        self(w).events_.push_back({.kind = Event::scroll, .x = x, .y = y});
    });
    glfwSetDropCallback(window_, [](GLFWwindow* w, int count, const char** paths) {
        self(w).events_.push_back({.kind = Event::drop, .paths = {paths, paths + count}});
    });
    glfwSetFramebufferSizeCallback(window_, [](GLFWwindow* w, int x, int y) {
        self(w).shrink(x, y);
        self(w).events_.push_back({.kind = Event::resize, .x = double(x), .y = double(y)});
    });
    glfwSetWindowCloseCallback(window_, [](GLFWwindow* w) { self(w).events_.push_back({.kind = Event::close}); });
    glfwSetWindowRefreshCallback(window_, [](GLFWwindow* w) { self(w).events_.push_back({.kind = Event::refresh}); });
}

double Window::pixels() const {
    int window = 0, frame = 0, height = 0;
    glfwGetWindowSize(window_, &window, &height);
    glfwGetFramebufferSize(window_, &frame, &height);
    return window > 0 ? static_cast<double>(frame) / window : 1.0;
}

std::vector<Event> Window::poll(double seconds) {
    if (seconds > 0) {
        glfwWaitEventsTimeout(seconds);
    } else {
        glfwPollEvents();
    }
    return std::exchange(events_, {});
}

void Window::wake() {
    glfwPostEmptyEvent();
}

VkExtent2D Window::extent() const {
    int width = 0, height = 0;
    glfwGetFramebufferSize(window_, &width, &height);
    if (glfwGetWindowAttrib(window_, GLFW_ICONIFIED) != 0) return {0, 0};
    return {static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height)};
}

double Window::scale() const {
    float x = 1, y = 1;
    glfwGetWindowContentScale(window_, &x, &y);
    return std::clamp(static_cast<double>(std::max(x, y)), 1.0, 4.0);
}

void Window::set_size(std::uint32_t width, std::uint32_t height) {
    const double scale = pixels();
    glfwSetWindowSize(window_, static_cast<int>(width / scale), static_cast<int>(height / scale));
}

void Window::limit_size(std::uint32_t side) {
    limit_ = side;
    const int most = static_cast<int>(std::min(side / pixels(), 65535.0));  // more than any window system allows
    glfwSetWindowSizeLimits(window_, GLFW_DONT_CARE, GLFW_DONT_CARE, most, most);
    const VkExtent2D now = extent();
    shrink(now.width, now.height);
}

void Window::shrink(double width, double height) {
    if (std::max(width, height) <= limit_ || (width == shrunk_width_ && height == shrunk_height_)) return;
    shrunk_width_ = width;
    shrunk_height_ = height;
    const double most = limit_;
    set_size(static_cast<std::uint32_t>(std::min(width, most)), static_cast<std::uint32_t>(std::min(height, most)));
}

void Window::minimize(bool minimized) {
    if (minimized) {
        glfwIconifyWindow(window_);
    } else {
        glfwRestoreWindow(window_);
    }
}

void Window::hide() {
    glfwHideWindow(window_);
    glfwPollEvents();  // sends the request
    events_.clear();
}

void Window::set_title(const std::string& title) {
    glfwSetWindowTitle(window_, title.c_str());
}

void Window::set_clipboard(const std::string& text) {
    glfwSetClipboardString(window_, text.c_str());
}

}  // namespace lacedring::view
