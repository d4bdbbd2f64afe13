// Panels: the windows upon the picture. They show a Session and change what is public in it.
#pragma once

#include <map>
#include <string>

#include "probe_detail.hpp"
#include "session.hpp"
#include "window/file_dialog.hpp"

namespace pfvox::viewer {

class Panels {
  public:
    /// Between Overlay::build's beginning and end.
    void draw(Session& session);

  private:
    void drawMenuBar(Session& session);
    void drawScene(Session& session);
    void drawRendering(Session& session);
    void drawStatistics(const Session& session);
    void drawProbes(Session& session);
    void drawProbeDetail(Session& session);
    void drawLog(const Session& session);
    void drawDialogs(Session& session);

    bool sceneOpen_ = true;
    bool renderingOpen_ = true;
    bool statisticsOpen_ = true;
    bool probesOpen_ = true;
    bool logOpen_ = true;
    FileDialog fileDialog_;
    std::optional<Dialog> dialogShown_;
    std::optional<ProbeDetail> detail_;
    std::optional<std::pair<std::filesystem::path, std::uint32_t>> detailOf_;
};

/// "court.toml", with a star when there are unsaved changes; empty when nothing is open.
std::string nameOf(const Session& session);

// The parts that have files of their own.

/// The models of the scene, and the selected one's fields.
void drawModelList(Session& session);
void drawSelectedModel(Session& session);
/// Sun and sky of the scene.
void drawSunAndSky(Session& session);
/// Where the probes stand.
void drawProbeGrid(Session& session);
/// Boxes, probes and handles upon the picture, below all windows. `cursor` is in the window's unit.
void drawSceneOverlay(const Session& session, const glm::dvec2& cursor);
/// Save the changes?
void drawLeaveQuestion(Session& session);

}  // namespace pfvox::viewer
