#include "session.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <system_error>

#include "png.hpp"

namespace pfvox::viewer {

namespace fs = std::filesystem;

namespace {

constexpr double kPollSeconds = 0.25;
constexpr std::uint32_t kSmoothFrames = 128;  // then a picture that stands still is done
constexpr std::size_t kKeptFrameTimes = 180;

std::string cameraKey(const fs::path& file) {
    std::error_code error;
    const fs::path absolute = fs::weakly_canonical(file, error);
    return (error ? file : absolute).string();
}

/// "hall-001.png", the first number that is free.
fs::path freeScreenshotName(const fs::path& folder, const fs::path& file) {
    const std::string stem = file.empty() ? "scene" : file.stem().string();
    for (int i = 1;; ++i) {
        fs::path name = folder / fmt::format("{}-{:03}.png", stem, i);
        std::error_code error;
        if (!fs::exists(name, error)) return name;
    }
}

}  // namespace

Result<std::unique_ptr<Session>> Session::create(gpu::Device& device, const SessionStart& start,
                                                 Memory memory, MessageLog& log) {
    PFVOX_TRY(FrameSequence, frames, FrameSequence::create(device));
    PFVOX_TRY(gpu::RayQuery, query, gpu::RayQuery::create(device));
    std::unique_ptr<Session> session(new Session(device, std::move(frames), std::move(query), log));
    session->settings = memory.settings;
    session->cameras_ = std::move(memory.cameras);
    session->camera.mode = session->settings.cameraMode;
    session->mode = start.mode;
    session->start_ = start;
    session->atlas = start.atlas;
    if (!start.path.empty()) session->open(start.path);
    return session;
}

void Session::open(const fs::path& path) {
    composer.leave([this, path] { openNow(path); });
}

void Session::openNow(const fs::path& path) {
    Result<OpenPath> opened = openPath(path);
    if (!opened) {
        log_->addError(describe(opened.error()));
        return;
    }
    probeRequest_ = std::exchange(start_.probes, {});
    if (!opened->probes.empty()) probeRequest_ = {.file = opened->probes};
    load(*std::move(opened), false);
}

void Session::reload() {
    if (!wanted_.file.empty()) load(wanted_, shown_ && shown_->path.file == wanted_.file);
}

void Session::load(OpenPath path, bool keepCamera) {
    wanted_ = path;
    // Watched from before they are read: what changes meanwhile is not missed.
    DiagnosticList ignored;
    const bool isScene = path.file.extension() == ".toml";
    const Result<Scene> scene = isScene ? readScene(path.file, Limits{}, ignored) : Result<Scene>(Scene{});
    watchFiles(scene ? *scene : Scene{});
    const fs::path file = path.file;
    MessageLog* const log = log_;
    forgetLoading();
    loading_ = Loading{.path = std::move(path),
                       .keepCamera = keepCamera,
                       .scene = std::async(std::launch::async, [file, log, read = start_.read] {
                           return read(file, Limits{}, *log);
                       })};
}

/// Without waiting for it, as the end of a future of std::async would.
void Session::forgetLoading() {
    if (loading_) outdated_.push_back(std::move(loading_->scene));
    loading_.reset();
}

void Session::watchFiles(const Scene& scene) {
    std::vector<fs::path> files = filesOf(wanted_.file, scene);
    if (wanted_.file.empty()) {  // a new scene
        files.clear();
        for (const SceneModel& model : scene.models) files.push_back(composer.editor.fileOf(model));
    }
    const fs::path probes = probeRequest_.file.empty() ? probesBeside(wanted_.file) : probeRequest_.file;
    if (!probeRequest_.none && !probes.empty()) files.push_back(probes);
    watch_.watch(files);
}

Result<void> Session::placeCamera(const fs::path& file, const Scene& scene) {
    const CameraRequest request = std::exchange(start_.camera, {});  // of the first scene only
    const auto remembered = cameras_.find(cameraKey(file));
    const bool asked = request.camera || !request.name.empty();
    if (!asked && remembered != cameras_.end()) {
        camera.set(remembered->second);
        return {};
    }
    PFVOX_TRY(const std::optional<ViewCamera>, chosen, chosenCamera(request, file, scene));
    chosen ? camera.set(*chosen) : frameAll();
    return {};
}

Result<void> Session::show(OpenPath path, LoadedScene loaded, bool keepCamera) {
    PFVOX_TRY(gpu::Scene, scene, gpu::Scene::build(*device_, gpu::partsOf(loaded), *log_));
    if (shown_ && !keepCamera) rememberCamera();
    const bool sameLight =
        keepCamera && shown_ && lightingOf(shown_->loaded.scene) == lightingOf(loaded.scene);
    if (!sameLight) lighting = lightingOf(loaded.scene);
    if (!keepCamera) probes_.reset();
    emitters_.reset();
    std::vector<WorldBounds> boxes = assetBoxesOf(loaded);
    shown_.emplace(ShownScene{std::move(path), std::move(loaded), std::move(scene), std::move(boxes)});
    composer.begin(shown_->path.file, shown_->loaded);
    selectedProbe.reset();
    findProbesOf(*shown_);
    frames_.restart();
    drawn_.reset();
    pick_.reset();
    camera.suit(shown_->scene.bounds());
    return keepCamera ? Result<void>{} : placeCamera(shown_->path.file, shown_->loaded.scene);
}

void Session::update(double secondsSinceStart) {
    const auto isDone = [](const auto& scene) {
        return scene.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
    };
    std::erase_if(outdated_, isDone);
    if (loading_ && isDone(loading_->scene)) {
        Loading done = *std::exchange(loading_, std::nullopt);
        Result<LoadedScene> loaded = done.scene.get();
        const std::string name = done.path.file.string();
        if (loaded) log_->dismissStrip();  // before: what is wrong with the probes is to stay
        const Result<void> shown = loaded ? show(std::move(done.path), *std::move(loaded), done.keepCamera)
                                          : Result<void>(tl::make_unexpected(loaded.error()));
        if (shown) {
            log_->add(MessageKind::Note, "shows " + name);
        } else {
            log_->addError(describe(shown.error()));
        }
    }
    applyEdits();
    if (secondsSinceStart < nextPoll_) return;
    nextPoll_ = secondsSinceStart + kPollSeconds;
    if (!loading_ && watch_.poll()) filesChanged();
}

double Session::aspect() const {
    const glm::uvec2 size = frames_.size();
    return size.y == 0 ? 16.0 / 9.0 : static_cast<double>(size.x) / size.y;
}

void Session::frameAll() {
    if (shown_) camera.frame(shown_->scene.bounds(), aspect());
}

void Session::nextCamera() {
    if (!shown_ || shown_->loaded.scene.cameras.empty()) {
        log_->add(MessageKind::Note, shown_ ? "the scene has no cameras" : "nothing is open");
        return;
    }
    const std::vector<Camera>& cameras = shown_->loaded.scene.cameras;
    const Camera& next = cameras[sceneCamera_++ % cameras.size()];
    camera.set(viewCameraOf(next));
    log_->add(MessageKind::Note, "camera " + (next.name.empty() ? "without a name" : "'" + next.name + "'"));
}

void Session::setMode(ViewMode wanted) {
    mode = wanted;
    if (!shown_) return;
    const Result<void> fits = checkView(wanted, probes(), shown_->path.file);
    if (!fits) log_->addError(describe(fits.error()));
}

void Session::execute(const KeyBinding& binding) {
    switch (binding.command) {
        case Command::FrameAll:
            return frameAll();
        case Command::ToggleHelp:
            showHelp = !showHelp;
            return;
        case Command::ToggleWindows:
            settings.showWindows = !settings.showWindows;
            return;
        case Command::ToggleCameraMode:
            camera.mode = camera.mode == CameraMode::Orbit ? CameraMode::Fly : CameraMode::Orbit;
            return;
        case Command::NextCamera:
            return nextCamera();
        case Command::ShowView:
            return setMode(static_cast<ViewMode>(binding.argument));
        case Command::Screenshot:
            return writeScreenshot();
        case Command::Reload:
            return composer.leave([this] { reload(); });
        case Command::NextFile:
            return openNeighbor(1);
        case Command::PreviousFile:
            return openNeighbor(-1);
        case Command::DismissMessage:
            if (!log_->strip()) composer.editor.select(std::nullopt);
            return log_->dismissStrip();
        case Command::Quit:
            return quit();
        default:
            return executeEdit(binding);
    }
}

void Session::pickAt(glm::dvec2 parts) {
    pick_.reset();
    if (!shown_) return;
    const gpu::GpuRay ray = rayThrough(camera.camera(), parts, aspect());
    const Result<gpu::RayBatch> batch =
        query_.cast(*device_, shown_->scene, {&ray, 1}, gpu::RayMode::ClosestHit);
    if (!batch) return log_->addError(describe(batch.error()));
    pick_ = describePick(shown_->loaded, ray, batch->hits.front());
    composer.editor.select(pick_ ? std::optional(pick_->modelIndex) : std::nullopt);
    if (pick_) {
        log_->add(MessageKind::Note, fmt::format("voxel {}, {}, {} of '{}', instance {}, material {}",
                                                 pick_->voxel.x, pick_->voxel.y, pick_->voxel.z, pick_->model,
                                                 pick_->instance, pick_->material));
    }
}

void Session::writeScreenshot() {
    if (!shown_ || frames_.pixels() == nullptr) return;
    const fs::path file = freeScreenshotName(start_.screenshotFolder, shown_->path.file);
    Result<Picture> picture = frames_.picture(*device_);
    const Result<void> written =
        picture ? writePng(file, *picture) : Result<void>(tl::make_unexpected(picture.error()));
    written ? log_->add(MessageKind::Note, "wrote " + file.string())
            : log_->addError(describe(written.error()));
}

bool Session::showsSingleModel() const {
    return shown_ && isSingleModel(shown_->path.file, shown_->loaded.scene);
}

PictureSettings Session::pictureSettings(glm::uvec2 windowPixels) const {
    const auto scaled = [&](std::uint32_t edge) {
        return std::max(1u, static_cast<std::uint32_t>(std::lround(edge * settings.renderScale)));
    };
    PictureSettings picture{.width = scaled(windowPixels.x),
                            .height = scaled(windowPixels.y),
                            .samplesPerPixel = 1,
                            .mode = mode,
                            .lodPixels = static_cast<float>(settings.lodPixels),
                            .toneMap = settings.toneMap,
                            .ambientRays = kFrameAmbientRays,
                            .ground = showsSingleModel() ? settings.modelGround : settings.sceneGround,
                            .atlas = atlas,
                            .lighting = lighting};
    picture.lighting.exposure = static_cast<float>(std::exp2(settings.exposureStops));
    return picture;
}

bool Session::needsFrame(glm::uvec2 windowPixels) const {
    if (!shown_ || windowPixels.x == 0 || windowPixels.y == 0) return false;
    if (!drawn_ || !(drawn_->first == camera.camera()) || !(drawn_->second == pictureSettings(windowPixels)))
        return true;
    return settings.antiAliasing && frames_.frames() < kSmoothFrames;
}

Result<void> Session::draw(glm::uvec2 windowPixels) {
    if (!needsFrame(windowPixels)) return {};
    const PictureSettings picture = pictureSettings(windowPixels);
    if (!settings.antiAliasing) frames_.restart();
    PFVOX_TRY(const GpuEmitters* const, emitters, emittersFor(picture));
    PFVOX_TRY(const PictureStatistics, statistics,
              frames_.draw(*device_, {shown_->scene, probes(), emitters}, camera.camera(), picture));
    statistics_ = statistics;
    drawn_ = {camera.camera(), picture};
    frameTimesMs_.push_back(static_cast<float>(statistics_.gpuMs));
    if (frameTimesMs_.size() > kKeptFrameTimes) frameTimesMs_.pop_front();
    return {};
}

void Session::rememberCamera() {
    if (shown_ && !shown_->path.file.empty()) cameras_[cameraKey(shown_->path.file)] = camera.camera();
}

Memory Session::memory() const {
    Memory memory{.settings = settings, .cameras = cameras_};
    memory.settings.cameraMode = camera.mode;
    if (shown_ && !shown_->path.file.empty()) memory.cameras[cameraKey(shown_->path.file)] = camera.camera();
    return memory;
}

}  // namespace pfvox::viewer
