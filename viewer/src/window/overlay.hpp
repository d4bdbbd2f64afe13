// Overlay: Dear ImGui on top of the picture.
#pragma once

#include <filesystem>
#include <functional>

#include "window/glfw_window.hpp"
#include "window/presenter.hpp"

namespace pfvox::viewer {

class Overlay {
  public:
    /// The places of the windows are kept in `layoutFile`; empty = nowhere. Errors: GpuUnavailable.
    static Result<std::unique_ptr<Overlay>> create(GlfwWindow& window, Presenter& presenter,
                                                   const std::filesystem::path& layoutFile);
    ~Overlay();
    Overlay(const Overlay&) = delete;
    Overlay& operator=(const Overlay&) = delete;

    /// Lays the windows out anew; drawPanels calls ImGui.
    void build(const std::function<void()>& drawPanels);
    /// Into a render pass that has begun.
    void draw(VkCommandBuffer commands);

  private:
    explicit Overlay(GlfwWindow& window) : window_(&window) {}
    Result<void> start(Presenter& presenter);

    GlfwWindow* window_;
    vk::UniqueDescriptorPool descriptors_;
    std::string layoutFile_;
    vk::Device device_;
    bool platformStarted_ = false;
    bool rendererStarted_ = false;
};

}  // namespace pfvox::viewer
