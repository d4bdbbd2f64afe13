#include "view.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <system_error>
#include <utility>

#include "compose/model_edits.hpp"
#include "png.hpp"
#include "view_passes.hpp"

namespace pfvox::viewer {

namespace fs = std::filesystem;

namespace {

constexpr std::uint32_t kSmoothFrames = 128;  // then a picture that stands still is done
constexpr std::size_t kKeptFrameTimes = 180;
constexpr double kProbeReach = 8.0;  // of a click, in the window's unit
constexpr std::size_t kMostClickableProbes = 1 << 17;

/// Empty for a scene without a file.
std::string cameraKeyOf(const fs::path& file) {
    if (file.empty()) return {};
    std::error_code error;
    const fs::path absolute = fs::weakly_canonical(file, error);
    return (error ? file : absolute).string();
}

fs::path freeScreenshotName(const fs::path& folder, const fs::path& file) {
    const std::string stem = file.empty() ? "scene" : file.stem().string();
    for (int i = 1;; ++i) {
        fs::path name = folder / fmt::format("{}-{:03}.png", stem, i);
        std::error_code error;
        if (!fs::exists(name, error)) return name;
    }
}

}  // namespace

View::View(Document& document, FrameSequence frames, gpu::RayQuery query, CameraRequest first,
           const Memory& memory)
    : settings(memory.settings),
      document_(&document),
      frames_(std::move(frames)),
      query_(std::move(query)),
      first_(std::move(first)),
      cameras_(memory.cameras) {
    camera.mode = settings.cameraMode;
}

// ---- The document ----------------------------------------------------------------------------------------

void View::follow() {
    const Revisions now = document_->revisions();
    if (shown() == nullptr) return;
    const LoadedScene& loaded = shown()->loaded;
    if (now != followed_) {
        frames_.restart();
        drawn_.reset();
        pick_.reset();
    }
    if (now.shown != followed_.shown) camera.suit(shown()->scene.bounds());
    if (now.opened != followed_.opened) {
        if (!cameraKey_.empty()) cameras_[cameraKey_] = camera.camera();
        placeCamera();
        sceneCamera_ = 0;
    } else if (wasEmpty_ && !loaded.bounds.empty()) {
        frameAll();
    }
    if (now.shown != followed_.shown || loaded.probes.counts != gridCounts_) selectedProbe.reset();
    cameraKey_ = cameraKeyOf(shown()->path.file);
    wasEmpty_ = loaded.bounds.empty();
    gridCounts_ = loaded.probes.counts;
    followed_ = now;
}

void View::placeCamera() {
    const fs::path& file = shown()->path.file;
    if (file.empty()) return;  // a new scene is looked at from where one stands
    const CameraRequest request = std::exchange(first_, {});
    const auto remembered = cameras_.find(cameraKeyOf(file));
    const bool asked = request.camera || !request.name.empty();
    if (!asked && remembered != cameras_.end()) return camera.set(remembered->second);
    const auto chosen = chosenCamera(request, file, shown()->loaded.scene);
    if (!chosen) document_->log().addError(describe(chosen.error()));
    chosen&&* chosen ? camera.set(**chosen) : frameAll();
}

Memory View::memory() const {
    Memory memory{.settings = settings, .cameras = cameras_};
    memory.settings.cameraMode = camera.mode;
    if (!cameraKey_.empty()) memory.cameras[cameraKey_] = camera.camera();
    return memory;
}

// ---- The camera ------------------------------------------------------------------------------------------

double View::aspect() const {
    const glm::uvec2 size = frames_.size();
    return size.y == 0 ? 16.0 / 9.0 : static_cast<double>(size.x) / size.y;
}

void View::frameAll() {
    if (shown() != nullptr) camera.frame(shown()->scene.bounds(), aspect());
}

void View::frameSelected() {
    const auto selected = document_->composer.editor.selected();
    if (shown() == nullptr || !selected) return frameAll();
    const WorldBounds box = boundsOfModel(shown()->loaded, *selected);
    box.empty() ? frameAll() : camera.frame(gpu::WorldBox{.min = box.min, .max = box.max}, aspect());
}

void View::nextCamera() {
    MessageLog& log = document_->log();
    if (shown() == nullptr || shown()->loaded.scene.cameras.empty()) {
        log.add(MessageKind::Note, shown() != nullptr ? "the scene has no cameras" : "nothing is open");
        return;
    }
    const std::vector<Camera>& cameras = shown()->loaded.scene.cameras;
    const Camera& next = cameras[sceneCamera_++ % cameras.size()];
    camera.set(viewCameraOf(next));
    log.add(MessageKind::Note, "camera " + (next.name.empty() ? "without a name" : "'" + next.name + "'"));
}

// ---- The picture -----------------------------------------------------------------------------------------

void View::setMode(ViewMode wanted) {
    mode = wanted;
    if (shown() == nullptr) return;
    const Result<void> fits = checkView(wanted, document_->probes(), shown()->path.file);
    if (!fits) document_->log().addError(describe(fits.error()));
}

PictureSettings View::pictureSettings(glm::uvec2 windowPixels) const {
    const auto scaled = [&](std::uint32_t edge) {
        return std::max(1u, static_cast<std::uint32_t>(std::lround(edge * settings.renderScale)));
    };
    PictureSettings picture{
        .width = scaled(windowPixels.x),
        .height = scaled(windowPixels.y),
        .samplesPerPixel = 1,
        .mode = mode,
        .lodPixels = static_cast<float>(settings.lodPixels),
        .toneMap = settings.toneMap,
        .ambientRays = kFrameAmbientRays,
        .ground = document_->showsSingleModel() ? settings.modelGround : settings.sceneGround,
        .atlas = atlas,
        .lighting = lightingOf(shown()->loaded.scene)};
    picture.lighting.exposure = static_cast<float>(std::exp2(settings.exposureStops));
    return picture;
}

bool View::needsFrame(glm::uvec2 windowPixels) const {
    if (shown() == nullptr || windowPixels.x == 0 || windowPixels.y == 0) return false;
    if (followed_ != document_->revisions()) return true;
    if (!drawn_ || !(drawn_->first == camera.camera()) || !(drawn_->second == pictureSettings(windowPixels)))
        return true;
    return settings.antiAliasing && frames_.frames() < kSmoothFrames;
}

Result<void> View::draw(glm::uvec2 windowPixels) {
    follow();
    if (!needsFrame(windowPixels)) return {};
    const PictureSettings picture = pictureSettings(windowPixels);
    if (!settings.antiAliasing) frames_.restart();
    PFVOX_TRY(const PictureInput, input, document_->inputOf(picture));
    PFVOX_TRY(const PictureStatistics, statistics,
              frames_.draw(document_->device(), input, camera.camera(), picture));
    statistics_ = statistics;
    drawn_ = {camera.camera(), picture};
    frameTimesMs_.push_back(static_cast<float>(statistics_.gpuMs));
    if (frameTimesMs_.size() > kKeptFrameTimes) frameTimesMs_.pop_front();
    return {};
}

void View::writeScreenshot(const fs::path& folder) const {
    if (shown() == nullptr || frames_.pixels() == nullptr) return;
    const fs::path file = freeScreenshotName(folder, shown()->path.file);
    Result<Picture> picture = frames_.picture(document_->device());
    const Result<void> written =
        picture ? writePng(file, *picture) : Result<void>(tl::make_unexpected(picture.error()));
    written ? document_->log().add(MessageKind::Note, "wrote " + file.string())
            : document_->log().addError(describe(written.error()));
}

// ---- What is under the cursor ----------------------------------------------------------------------------

void View::pickAt(glm::dvec2 parts) {
    follow();
    pick_.reset();
    if (shown() == nullptr) return;
    const gpu::GpuRay ray = rayThrough(camera.camera(), parts, aspect());
    const Result<gpu::RayBatch> batch =
        query_.cast(document_->device(), shown()->scene, {&ray, 1}, gpu::RayMode::ClosestHit);
    if (!batch) return document_->log().addError(describe(batch.error()));
    pick_ = describePick(shown()->loaded, ray, batch->hits.front());
    document_->composer.editor.select(pick_ ? std::optional(pick_->modelIndex) : std::nullopt);
    if (!pick_) return;
    document_->log().add(MessageKind::Note, fmt::format("voxel {}, {}, {} of '{}', instance {}, material {}",
                                                        pick_->voxel.x, pick_->voxel.y, pick_->voxel.z,
                                                        pick_->model, pick_->instance, pick_->material));
}

std::optional<AtlasLayout> View::shownAtlas() const {
    const ShownProbes* const probes = document_->probes();
    if (shown() == nullptr || probes == nullptr || !drawn_) return std::nullopt;
    const PictureSettings& picture = drawn_->second;
    if (!isAtlas(drawnMode({shown()->scene, probes}, picture))) return std::nullopt;
    return atlasLayout(picture, static_cast<std::uint32_t>(probes->probes.size()));
}

bool View::selectProbeAt(glm::dvec2 parts) {
    follow();
    if (const std::optional<AtlasLayout> maps = shownAtlas()) {
        const std::optional<std::uint32_t> probe = maps->probeAt(parts * glm::dvec2(frames_.size()));
        if (probe && document_->probes()->info.grid == shown()->loaded.probes) selectedProbe = probe;
        return true;
    }
    if (shown() == nullptr || !settings.showProbeGrid) return false;
    const ProbeGrid& grid = shown()->loaded.probes;
    if (grid.probeCount() > kMostClickableProbes) return false;
    const Projection view = projection();
    double nearest = kProbeReach;
    std::optional<std::uint32_t> best;
    for (std::uint32_t i = 0; i < grid.probeCount(); ++i) {
        const auto at = view.pointOf(document_->placeOfProbe(i));
        const double distance = at ? glm::length(*at - parts * windowSize) : nearest;
        if (distance < nearest) {
            nearest = distance;
            best = i;
        }
    }
    if (best) selectedProbe = best;
    return best.has_value();
}

std::optional<Gizmo> View::gizmo() const {
    const auto selected = document_->composer.editor.selected();
    if (shown() == nullptr || !settings.showWindows || !selected || shownAtlas()) return std::nullopt;
    const WorldBounds box = boundsOfModel(shown()->loaded, *selected);
    if (box.empty()) return std::nullopt;
    const Gizmo gizmo(projection(), footOf(box));
    return gizmo.isSeen() ? std::optional(gizmo) : std::nullopt;
}

}  // namespace pfvox::viewer
