#include "window/glfw_window.hpp"

#include <vulkan/vulkan.h>
// After Vulkan, whose types GLFW then knows.
#include <GLFW/glfw3.h>

#include <pfvox/gpu_native.hpp>
#include <utility>

namespace pfvox::viewer {

namespace {

std::string glfwMessage(const std::string& what) {
    const char* description = nullptr;
    glfwGetError(&description);
    return description != nullptr ? what + ": " + description : what;
}

Key keyOf(int key) {
    switch (key) {
        case GLFW_KEY_TAB:
            return kKeyTab;
        case GLFW_KEY_ESCAPE:
            return kKeyEscape;
        case GLFW_KEY_PAGE_UP:
            return kKeyPageUp;
        case GLFW_KEY_PAGE_DOWN:
            return kKeyPageDown;
        case GLFW_KEY_LEFT_SHIFT:
        case GLFW_KEY_RIGHT_SHIFT:
            return kKeyShift;
        case GLFW_KEY_LEFT:
            return kKeyLeft;
        case GLFW_KEY_RIGHT:
            return kKeyRight;
        case GLFW_KEY_UP:
            return kKeyUp;
        case GLFW_KEY_DOWN:
            return kKeyDown;
        case GLFW_KEY_INSERT:
            return kKeyInsert;
        case GLFW_KEY_DELETE:
            return kKeyDelete;
        default:
            break;
    }
    if (key >= GLFW_KEY_KP_0 && key <= GLFW_KEY_KP_9) return '0' + key - GLFW_KEY_KP_0;
    return key > 0 && key < 128 ? key : kKeyOther;  // GLFW's printable keys are upper-case ASCII
}

/// Letters by what is written on the key, whatever the layout.
Key keyOf(int key, int scancode) {
    const char* const name = glfwGetKeyName(key, scancode);
    if (name != nullptr && name[1] == '\0' && name[0] >= 'a' && name[0] <= 'z') return name[0] - 'a' + 'A';
    return keyOf(key);
}

}  // namespace

Result<std::unique_ptr<GlfwLibrary>> GlfwLibrary::start() {
    if (glfwInit() != GLFW_TRUE) {
        return fail(ErrorCode::GpuUnavailable,
                    glfwMessage("cannot open a window") + "; --screenshot needs none");
    }
    std::unique_ptr<GlfwLibrary> library(new GlfwLibrary);
    if (glfwVulkanSupported() != GLFW_TRUE)
        return fail(ErrorCode::GpuUnavailable, glfwMessage("Vulkan cannot show pictures in windows here"));
    return library;
}

GlfwLibrary::~GlfwLibrary() {
    glfwTerminate();
}

void GlfwLibrary::require(gpu::DeviceOptions& options) const {
    std::uint32_t count = 0;
    const char** const names = glfwGetRequiredInstanceExtensions(&count);
    for (std::uint32_t i = 0; i < count; ++i) options.instanceExtensions.emplace_back(names[i]);
    options.deviceExtensions.emplace_back(VK_KHR_SWAPCHAIN_EXTENSION_NAME);
    options.queueFits = [](const gpu::NativeQueueFamily& family) {
        return glfwGetPhysicalDevicePresentationSupport(family.instance, family.physicalDevice,
                                                        family.index) == GLFW_TRUE;
    };
}

GlfwWindow::GlfwWindow(GLFWwindow* window, Interaction& interaction)
    : window_(window), interaction_(&interaction) {
    glfwSetWindowUserPointer(window_, this);
    installCallbacks();
}

Result<std::unique_ptr<GlfwWindow>> GlfwWindow::create(glm::uvec2 size, const std::string& title,
                                                       Interaction& interaction) {
    glfwWindowHint(GLFW_CLIENT_API, GLFW_NO_API);
    GLFWwindow* const window =
        glfwCreateWindow(static_cast<int>(size.x), static_cast<int>(size.y), title.c_str(), nullptr, nullptr);
    if (window == nullptr) return fail(ErrorCode::GpuUnavailable, glfwMessage("cannot open a window"));
    return std::unique_ptr<GlfwWindow>(new GlfwWindow(window, interaction));
}

GlfwWindow::~GlfwWindow() {
    glfwDestroyWindow(window_);
}

GlfwWindow& GlfwWindow::of(GLFWwindow* window) {
    return *static_cast<GlfwWindow*>(glfwGetWindowUserPointer(window));
}

void GlfwWindow::installCallbacks() {
    glfwSetKeyCallback(window_, [](GLFWwindow* w, int key, int scancode, int action, int mods) {
        GlfwWindow& self = of(w);
        if (action == GLFW_PRESS && key >= 0) {
            self.pressed_.keys.push_back(key);
            self.pressed_.modifiers |= mods;
        }
        const Key which = keyOf(key, scancode);
        if (action == GLFW_REPEAT && !repeats(which)) return;
        const Capture taken = self.capture();
        if (action != GLFW_RELEASE && (taken.keys || (taken.arrows && repeats(which)))) return;
        self.interaction_->key(which, action != GLFW_RELEASE, (mods & GLFW_MOD_CONTROL) != 0,
                               (mods & GLFW_MOD_SHIFT) != 0);
    });
    glfwSetCursorPosCallback(window_, [](GLFWwindow* w, double x, double y) {
        of(w).interaction_->cursor({x, y});
    });
    glfwSetMouseButtonCallback(window_, [](GLFWwindow* w, int button, int action, int mods) {
        GlfwWindow& self = of(w);
        if (action == GLFW_PRESS) self.pressed_.modifiers |= mods;
        if (button > GLFW_MOUSE_BUTTON_MIDDLE || (action == GLFW_PRESS && self.capture().mouse)) return;
        const MouseButton which = button == GLFW_MOUSE_BUTTON_LEFT    ? MouseButton::Left
                                  : button == GLFW_MOUSE_BUTTON_RIGHT ? MouseButton::Right
                                                                      : MouseButton::Middle;
        self.interaction_->button(which, action == GLFW_PRESS);
    });
    glfwSetScrollCallback(window_, [](GLFWwindow* w, double, double y) {
        GlfwWindow& self = of(w);
        if (!self.capture().mouse) self.interaction_->wheel(y);
    });
    glfwSetWindowFocusCallback(window_, [](GLFWwindow* w, int focused) {
        if (focused == GLFW_FALSE) of(w).interaction_->release();
    });
    glfwSetDropCallback(window_, [](GLFWwindow* w, int count, const char** paths) {
        for (int i = 0; i < count; ++i) of(w).dropped_.emplace_back(paths[i]);
    });
}

Result<VkSurfaceKHR_T*> GlfwWindow::createSurface(const gpu::Device& device) const {
    VkSurfaceKHR surface = VK_NULL_HANDLE;
    if (glfwCreateWindowSurface(gpu::nativeOf(device).instance, window_, nullptr, &surface) != VK_SUCCESS)
        return fail(ErrorCode::GpuUnavailable, glfwMessage("the window takes no pictures from Vulkan"));
    return surface;
}

glm::uvec2 GlfwWindow::size() const {
    int width = 0;
    int height = 0;
    glfwGetWindowSize(window_, &width, &height);
    return {static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height)};
}

glm::uvec2 GlfwWindow::pixels() const {
    if (glfwGetWindowAttrib(window_, GLFW_ICONIFIED) == GLFW_TRUE) return glm::uvec2(0);
    int width = 0;
    int height = 0;
    glfwGetFramebufferSize(window_, &width, &height);
    return {static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height)};
}

bool GlfwWindow::takeCloseRequest() {
    const bool asked = glfwWindowShouldClose(window_) == GLFW_TRUE;
    if (asked) glfwSetWindowShouldClose(window_, GLFW_FALSE);
    return asked;
}

void GlfwWindow::setTitle(const std::string& title) {
    if (title == title_) return;
    title_ = title;
    glfwSetWindowTitle(window_, title.c_str());
}

void GlfwWindow::pollEvents(double seconds) {
    seconds > 0.0 ? glfwWaitEventsTimeout(seconds) : glfwPollEvents();
    interaction_->setSize(glm::dvec2(size()));
}

std::vector<std::filesystem::path> GlfwWindow::takeDropped() {
    return std::exchange(dropped_, {});
}

GlfwWindow::Pressed GlfwWindow::takePressed() {
    return std::exchange(pressed_, {});
}

}  // namespace pfvox::viewer
