#include "window/app.hpp"

#include <chrono>
#include <cstdlib>

#include "session.hpp"
#include "window/glfw_window.hpp"
#include "window/overlay.hpp"
#include "window/panels.hpp"
#include "window/presenter.hpp"

namespace pfvox::viewer {

namespace {

using Clock = std::chrono::steady_clock;

constexpr double kIdleSeconds = 0.1;         // between looks at the files when nothing happens
constexpr double kLongestStepSeconds = 0.1;  // of the camera, after a stall

/// What lives while the window is open, in the order in which it is made.
struct App {
    std::unique_ptr<GlfwWindow> window;
    std::unique_ptr<Presenter> presenter;
    std::unique_ptr<Overlay> overlay;
};

Result<App> openWindow(const gpu::Device& device, Interaction& interaction, glm::uvec2 size,
                       const UserFolders& folders) {
    App app;
    PFVOX_TRY(std::unique_ptr<GlfwWindow>, window, GlfwWindow::create(size, "pfview", interaction));
    app.window = std::move(window);
    PFVOX_TRY(VkSurfaceKHR_T* const, surface, app.window->createSurface(device));
    PFVOX_TRY(std::unique_ptr<Presenter>, presenter,
              Presenter::create(device, surface, app.window->pixels()));
    app.presenter = std::move(presenter);
    const std::filesystem::path layout =
        folders.state.empty() ? std::filesystem::path{} : folders.state / "pfvox/pfview-windows.ini";
    PFVOX_TRY(std::unique_ptr<Overlay>, overlay, Overlay::create(*app.window, *app.presenter, layout));
    app.overlay = std::move(overlay);
    return app;
}

std::string titleOf(const Session& session) {
    const std::string name = nameOf(session.document);
    return name.empty() ? "pfview" : name + " - pfview";
}

void handleInput(App& app, Interaction& interaction, Session& session, double seconds) {
    session.view.windowSize = glm::dvec2(app.window->size());
    session.document.drop(app.window->takeDropped());
    for (const KeyBinding& binding : interaction.takeCommands()) session.input.execute(binding);
    if (session.document.composer.waits()) interaction.release();
    if (const std::optional<glm::dvec2> click = interaction.takeClick()) session.input.clickAt(*click);
    if (const std::optional<Drag> drag = interaction.takeDrag()) session.input.drag(*drag);
    interaction.advance(std::min(seconds, kLongestStepSeconds));
}

Result<void> runLoop(App& app, Interaction& interaction, Session& session) {
    const Clock::time_point started = Clock::now();
    double last = 0.0;
    Panels panels;
    int busyFrames = 0;  // that are still to be shown without waiting: the overlay settles after an event
    interaction.grabs = [&](glm::dvec2 parts) { return session.input.grabAt(parts); };
    while (!session.input.wantsToQuit()) {
        if (app.window->takeCloseRequest()) session.input.quit();
        const bool busy =
            busyFrames > 0 || interaction.isMoving() || session.view.needsFrame(app.window->pixels());
        const Clock::time_point polled = Clock::now();
        const bool shown = app.window->pixels().x != 0;
        app.window->pollEvents(busy && shown ? 0.0 : kIdleSeconds);
        const std::chrono::duration<double> waited = Clock::now() - polled;
        const bool event = waited.count() < 0.9 * kIdleSeconds;
        busyFrames = !busy && event ? 3 : std::max(busyFrames - 1, 0);

        const std::chrono::duration<double> now = Clock::now() - started;
        handleInput(app, interaction, session, now.count() - last);
        last = now.count();
        PFVOX_CHECK(app.presenter->finish());
        session.update(now.count());
        PFVOX_CHECK(session.view.draw(app.window->pixels()));
        app.window->setTitle(titleOf(session));
        app.overlay->build([&] { panels.draw(session); });
        const ShownPixels pixels{.buffer = session.view.frames().pixels(),
                                 .size = session.view.frames().size()};
        PFVOX_CHECK(app.presenter->show(app.window->pixels(), pixels,
                                        [&](VkCommandBuffer commands) { app.overlay->draw(commands); }));
    }
    return {};
}

Result<void> saidNothing(const gpu::Device& device, Diagnostics& diagnostics) {
    const std::vector<std::string> messages = device.validationMessages();
    for (const std::string& message : messages) diagnostics.warn("vulkan-validation", message);
    if (messages.empty()) return {};
    return fail(ErrorCode::Internal, "the Vulkan validation layer has complaints");
}

}  // namespace

Result<void> runWindow(const Options& options, Diagnostics& diagnostics) {
    const UserFolders folders =
        userFolders(std::getenv("XDG_CONFIG_HOME"), std::getenv("XDG_STATE_HOME"), std::getenv("HOME"));
    Memory memory = loadMemory(folders, diagnostics);
    memory.settings.exposureStops = options.exposureStops.value_or(memory.settings.exposureStops);
    memory.settings.toneMap = options.toneMap.value_or(memory.settings.toneMap);
    memory.settings.modelGround = options.ground.value_or(memory.settings.modelGround);
    memory.settings.sceneGround = options.ground.value_or(memory.settings.sceneGround);
    PFVOX_TRY(const std::unique_ptr<GlfwLibrary>, glfw, GlfwLibrary::start());
    gpu::DeviceOptions deviceOptions{.selector = options.device, .validation = options.validation};
    glfw->require(deviceOptions);
    PFVOX_TRY(gpu::Device, device, gpu::Device::open(deviceOptions));

    MessageLog log;
    const SessionStart start{.path = options.file,
                             .camera = options.camera,
                             .mode = options.picture.mode,
                             .probes = options.probes,
                             .atlas = options.picture.atlas};
    PFVOX_TRY(const std::unique_ptr<Session>, session, Session::create(device, start, memory, log));
    Interaction interaction(session->view.camera);
    const glm::uvec2 size = options.sizeGiven
                                ? glm::uvec2(options.picture.width, options.picture.height)
                                : glm::uvec2(memory.settings.windowWidth, memory.settings.windowHeight);
    {
        PFVOX_TRY(App, app, openWindow(device, interaction, size, folders));
        PFVOX_CHECK(runLoop(app, interaction, *session));
        Memory kept = session->view.memory();
        const glm::uvec2 last = app.window->size();
        if (last.x >= 64 && last.y >= 64) {
            kept.settings.windowWidth = last.x;
            kept.settings.windowHeight = last.y;
        }
        PFVOX_CHECK(saveMemory(folders, kept));
    }
    return saidNothing(device, diagnostics);
}

}  // namespace pfvox::viewer
