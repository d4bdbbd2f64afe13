// View: how a document is seen: camera, settings and view, the frames that are drawn, and what is under the
// cursor.
//
//     document, camera, settings -> [View] -> pixels on the device
#pragma once

#include <deque>
#include <optional>
#include <pfvox/ray_query.hpp>

#include "atlas_layout.hpp"
#include "camera_choice.hpp"
#include "camera_controller.hpp"
#include "compose/gizmo.hpp"
#include "document.hpp"
#include "frame_sequence.hpp"
#include "pick.hpp"
#include "settings.hpp"

namespace pfvox::viewer {

class View {
  public:
    /// `first`: of the scene that is opened first.
    View(Document& document, FrameSequence frames, gpu::RayQuery query, CameraRequest first,
         const Memory& memory);

    /// Takes up what has changed in the document: another scene gets its camera, frames of what is gone are
    /// forgotten. The other functions that look at the document do so first.
    void follow();
    /// Draws one frame for a window of this many pixels, if it would differ from what pixels() holds. Errors:
    /// GpuLost, GpuOutOfMemory.
    Result<void> draw(glm::uvec2 windowPixels);
    /// Whether another draw() would change something.
    bool needsFrame(glm::uvec2 windowPixels) const;

    void frameAll();
    /// The selected model; everything without one.
    void frameSelected();
    void nextCamera();
    /// A view that the document has nothing for is told; its picture is the final one.
    void setMode(ViewMode wanted);
    /// Tells what is at a point of the picture: parts of its edges from the upper left. Its model becomes
    /// selected.
    void pickAt(glm::dvec2 parts);
    /// A probe of the grid that is drawn, or the one whose map is there. False = there is none.
    bool selectProbeAt(glm::dvec2 parts);
    /// The picture so far as "<scene>-001.png" in this folder, the first number that is free; tells what it
    /// wrote.
    void writeScreenshot(const std::filesystem::path& folder) const;

    const FrameSequence& frames() const { return frames_; }
    const PictureStatistics& statistics() const { return statistics_; }
    const std::deque<float>& frameTimesMs() const { return frameTimesMs_; }  ///< the latest last
    const std::optional<Pick>& pick() const { return pick_; }
    /// Settings and cameras as they are to be remembered.
    Memory memory() const;
    /// Camera and window as they are: what is drawn upon the picture goes through it.
    Projection projection() const { return {camera.camera(), windowSize}; }
    /// At the selected model; nothing when none that is seen is selected.
    std::optional<Gizmo> gizmo() const;
    /// Where the maps lie when the picture is a page of them, in pixels of frames(); then no scene is under
    /// the cursor.
    std::optional<AtlasLayout> shownAtlas() const;

    // What windows and commands change.
    CameraController camera;
    Settings settings;
    ViewMode mode = ViewMode::Final;  ///< one that checkView refuses shows the final picture instead
    AtlasChoice atlas;                ///< which probes the atlas views show
    bool showHelp = false;
    std::optional<std::uint32_t> selectedProbe;  ///< index in the grid of the shown scene
    glm::dvec2 windowSize{1280.0, 720.0};        ///< in the unit of cursor positions

  private:
    const ShownScene* shown() const { return document_->shown(); }
    void placeCamera();
    PictureSettings pictureSettings(glm::uvec2 windowPixels) const;
    double aspect() const;

    Document* document_;
    FrameSequence frames_;
    gpu::RayQuery query_;
    CameraRequest first_;
    CameraMemory cameras_;
    Revisions followed_;
    std::string cameraKey_;        ///< of the file that is looked at; empty = it has none
    bool wasEmpty_ = false;        ///< nothing to look at so far
    glm::uvec3 gridCounts_{0u};    ///< of the grid that selectedProbe counts in
    std::size_t sceneCamera_ = 0;  ///< that nextCamera() goes to
    std::optional<std::pair<ViewCamera, PictureSettings>> drawn_;
    PictureStatistics statistics_;
    std::deque<float> frameTimesMs_;
    std::optional<Pick> pick_;
};

}  // namespace pfvox::viewer
