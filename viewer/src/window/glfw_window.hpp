// GlfwWindow: the window itself: size, events, dropped files. What they mean is Interaction's and Session's
// affair.
#pragma once

#include <filesystem>
#include <functional>
#include <glm/glm.hpp>
#include <memory>
#include <pfvox/gpu.hpp>
#include <string>
#include <vector>

#include "interaction.hpp"

struct GLFWwindow;
struct VkSurfaceKHR_T;

namespace pfvox::viewer {

/// GLFW itself; once in a program.
class GlfwLibrary {
  public:
    /// Errors: GpuUnavailable (no display, no Vulkan loader).
    static Result<std::unique_ptr<GlfwLibrary>> start();
    ~GlfwLibrary();
    GlfwLibrary(const GlfwLibrary&) = delete;
    GlfwLibrary& operator=(const GlfwLibrary&) = delete;

    /// Adds what a device needs to show pictures in windows.
    void require(gpu::DeviceOptions& options) const;

  private:
    GlfwLibrary() = default;
};

class GlfwWindow {
  public:
    /// Whether the overlay takes mouse or keys for itself.
    struct Capture {
        bool mouse = false;
        bool keys = false;
        bool arrows = false;  ///< the keys that move about in the overlay
    };

    /// What went down, even when it is up again by now; keys and modifiers as GLFW numbers them.
    struct Pressed {
        std::vector<int> keys;
        int modifiers = 0;  ///< that were held with any of them, or with a mouse button
    };

    /// Errors: GpuUnavailable.
    static Result<std::unique_ptr<GlfwWindow>> create(glm::uvec2 size, const std::string& title,
                                                      Interaction& interaction);
    ~GlfwWindow();
    GlfwWindow(const GlfwWindow&) = delete;
    GlfwWindow& operator=(const GlfwWindow&) = delete;

    /// Errors: GpuUnavailable.
    Result<VkSurfaceKHR_T*> createSurface(const gpu::Device& device) const;
    GLFWwindow* handle() const { return window_; }
    glm::uvec2 size() const;    ///< in the unit of cursor positions
    glm::uvec2 pixels() const;  ///< 0 while minimised
    /// Whether the user has asked to close it since the last call.
    bool takeCloseRequest();
    void setTitle(const std::string& title);
    /// Handles what has happened; waits for something for at most `seconds` when nothing has.
    void pollEvents(double seconds);
    std::vector<std::filesystem::path> takeDropped();
    /// Since the last call.
    Pressed takePressed();

    std::function<Capture()> capture = [] { return Capture{}; };

  private:
    GlfwWindow(GLFWwindow* window, Interaction& interaction);
    static GlfwWindow& of(GLFWwindow* window);
    void installCallbacks();

    GLFWwindow* window_;
    Interaction* interaction_;
    std::vector<std::filesystem::path> dropped_;
    Pressed pressed_;
    std::string title_;
};

}  // namespace pfvox::viewer
