// The part of Session that is about probes: which light the scene, and which one is looked at.
#include "session.hpp"
#include "view_passes.hpp"

namespace pfvox::viewer {

namespace fs = std::filesystem;

namespace {

constexpr double kProbeReach = 8.0;  // of a click, in the window's unit
constexpr std::size_t kMostClickableProbes = 1 << 17;

}  // namespace

void Session::findProbesOf(const ShownScene& shown) {
    Result<std::optional<ShownProbes>> found =
        findProbes(*device_, probeRequest_, shown.loaded, shown.path.file, *log_);
    if (!found) return log_->addError(describe(found.error()));
    probes_ = *std::move(found);
    log_->add(MessageKind::Note,
              probes_ ? "probes from " + probes_->file.string() : guessNote(shown.path.file));
    frames_.restart();
    drawn_.reset();
}

void Session::loadProbes(const fs::path& file) {
    probeRequest_ = {.file = file};
    if (!shown_) return;
    findProbesOf(*shown_);
    watchFiles(shown_->loaded.scene);
}

void Session::dropProbes() {
    probeRequest_ = {.none = true};
    probes_.reset();
    frames_.restart();
    drawn_.reset();
}

Result<const GpuEmitters*> Session::emittersFor(const PictureSettings& picture) {
    if (!isGuessed({shown_->scene, probes()}, picture)) return nullptr;
    if (!emitters_) {
        PFVOX_TRY(GpuEmitters, made, GpuEmitters::upload(*device_, shown_->loaded, *log_));
        emitters_.emplace(std::move(made));
    }
    return &*emitters_;
}

std::optional<AtlasLayout> Session::shownAtlas() const {
    if (!shown_ || !probes_ || !drawn_) return std::nullopt;
    const PictureSettings& picture = drawn_->second;
    if (!isAtlas(drawnMode({shown_->scene, probes()}, picture))) return std::nullopt;
    return atlasLayout(picture, static_cast<std::uint32_t>(probes_->probes.size()));
}

bool Session::selectProbeAt(glm::dvec2 parts) {
    if (const std::optional<AtlasLayout> maps = shownAtlas()) {
        const std::optional<std::uint32_t> probe = maps->probeAt(parts * glm::dvec2(frames_.size()));
        if (probe && probes_->info.grid == shown_->loaded.probes) selectedProbe = probe;
        return true;
    }
    if (!shown_ || !settings.showProbeGrid) return false;
    const ProbeGrid& grid = shown_->loaded.probes;
    if (grid.probeCount() > kMostClickableProbes) return false;
    const Projection view = projection();
    double nearest = kProbeReach;
    std::optional<std::uint32_t> best;
    for (std::uint32_t i = 0; i < grid.probeCount(); ++i) {
        const auto at = view.pointOf(placeOfProbe(i));
        const double distance = at ? glm::length(*at - parts * windowSize) : nearest;
        if (distance < nearest) {
            nearest = distance;
            best = i;
        }
    }
    if (best) selectedProbe = best;
    return best.has_value();
}

glm::dvec3 Session::placeOfProbe(std::uint32_t index) const {
    const bool sameGrid =
        probes_ && probes_->info.grid == shown_->loaded.probes && index < probes_->probes.size();
    return sameGrid ? glm::dvec3(probes_->probes[index].position)
                    : glm::dvec3(shown_->loaded.probes.pointOf(index));
}

}  // namespace pfvox::viewer
