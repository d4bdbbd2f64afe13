#include "window/overlay.hpp"

#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_vulkan.h>
#include <imgui.h>

#include <algorithm>
#include <system_error>
#include <utility>
#include <vector>

namespace pfvox::viewer {

namespace {

/// Dear ImGui before 1.87 sees which keys are down when a frame begins: one that went down and up while a
/// slow frame was computed would be lost. Such keys are down for the frame that follows.
class BriefKeys {
  public:
    explicit BriefKeys(const GlfwWindow::Pressed& pressed) {
#if IMGUI_VERSION_NUM < 18700
        for (const int key : pressed.keys) press(io_.KeysDown[key]);
        if ((pressed.modifiers & GLFW_MOD_CONTROL) != 0) press(io_.KeyCtrl);
        if ((pressed.modifiers & GLFW_MOD_SHIFT) != 0) press(io_.KeyShift);
        if ((pressed.modifiers & GLFW_MOD_ALT) != 0) press(io_.KeyAlt);
#else
        static_cast<void>(pressed);  // its queue gives each its frame
#endif
    }
    ~BriefKeys() {
        for (bool* const key : added_) *key = false;
    }
    BriefKeys(const BriefKeys&) = delete;
    BriefKeys& operator=(const BriefKeys&) = delete;

  private:
    void press(bool& key) {
        if (!std::exchange(key, true)) added_.push_back(&key);
    }

    ImGuiIO& io_ = ImGui::GetIO();
    std::vector<bool*> added_;
};

}  // namespace

Result<std::unique_ptr<Overlay>> Overlay::create(GlfwWindow& window, Presenter& presenter,
                                                 const std::filesystem::path& layoutFile) {
    std::unique_ptr<Overlay> overlay(new Overlay(window));
    IMGUI_CHECKVERSION();
    ImGui::CreateContext();
    ImGui::StyleColorsDark();
    ImGui::GetStyle().WindowRounding = 4.0f;
    if (!layoutFile.empty()) {
        std::error_code ignored;  // without the folder the layout is not kept, that is all
        std::filesystem::create_directories(layoutFile.parent_path(), ignored);
    }
    ImGui::GetIO().ConfigFlags |= ImGuiConfigFlags_NavEnableKeyboard;  // all of it without a mouse
    overlay->layoutFile_ = layoutFile.string();
    ImGui::GetIO().IniFilename = layoutFile.empty() ? nullptr : overlay->layoutFile_.c_str();
    PFVOX_CHECK(overlay->start(presenter));
    window.capture = [] {
        const ImGuiIO& io = ImGui::GetIO();
        const bool asks = ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopup);
        return GlfwWindow::Capture{
            .mouse = io.WantCaptureMouse, .keys = io.WantTextInput || asks, .arrows = io.NavActive};
    };
    return overlay;
}

Result<void> Overlay::start(Presenter& presenter) {
    const gpu::NativeDevice& native = presenter.native();
    device_ = vk::Device(native.device);
    try {
        const vk::DescriptorPoolSize size{.type = vk::DescriptorType::eCombinedImageSampler,
                                          .descriptorCount = 1};
        descriptors_ = vk::Device(native.device)
                           .createDescriptorPoolUnique(vk::DescriptorPoolCreateInfo{
                               .flags = vk::DescriptorPoolCreateFlagBits::eFreeDescriptorSet, .maxSets = 1}
                                                           .setPoolSizes(size));
    } catch (const vk::Error& error) {
        return fail(ErrorCode::GpuUnavailable, std::string("overlay: ") + error.what());
    }
    platformStarted_ = ImGui_ImplGlfw_InitForVulkan(window_->handle(), true);
    ImGui_ImplVulkan_InitInfo info{};
    info.Instance = native.instance;
    info.PhysicalDevice = native.physicalDevice;
    info.Device = native.device;
    info.QueueFamily = native.queueFamily;
    info.Queue = native.queue;
    info.DescriptorPool = *descriptors_;
    info.MinImageCount = std::max(2u, presenter.imageCount());
    info.ImageCount = info.MinImageCount;
    info.MSAASamples = VK_SAMPLE_COUNT_1_BIT;
    rendererStarted_ = platformStarted_ && ImGui_ImplVulkan_Init(&info, presenter.renderPass());
    if (!rendererStarted_) return fail(ErrorCode::GpuUnavailable, "the overlay cannot be drawn");
    PFVOX_CHECK(
        presenter.runOnce([](VkCommandBuffer commands) { ImGui_ImplVulkan_CreateFontsTexture(commands); }));
    ImGui_ImplVulkan_DestroyFontUploadObjects();
    return {};
}

Overlay::~Overlay() {
    try {
        if (device_) device_.waitIdle();  // the last frame may still use what goes now
    } catch (const vk::Error&) {          // of a lost device: nothing is under way
    }
    if (rendererStarted_) ImGui_ImplVulkan_Shutdown();
    if (platformStarted_) ImGui_ImplGlfw_Shutdown();
    ImGui::DestroyContext();
}

void Overlay::build(const std::function<void()>& drawPanels) {
    ImGui_ImplVulkan_NewFrame();
    ImGui_ImplGlfw_NewFrame();
    const BriefKeys brief(window_->takePressed());
    ImGui::NewFrame();
    drawPanels();
    ImGui::Render();
}

void Overlay::draw(VkCommandBuffer commands) {
    ImGui_ImplVulkan_RenderDrawData(ImGui::GetDrawData(), commands);
}

}  // namespace pfvox::viewer
