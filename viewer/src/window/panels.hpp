// Panels: the windows upon the picture. They show a session and change what is public in it.
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
    void drawStatistics(const Document& document, const View& view);
    void drawProbes(Session& session);
    void drawProbeDetail(Session& session);
    void drawLog(const MessageLog& log);
    void drawDialogs(Document& document);

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
std::string nameOf(const Document& document);

// The parts that have files of their own.

/// The models of the scene, and the selected one's fields.
void drawModelList(Document& document, Input& input);
void drawSelectedModel(Document& document);
/// Sun and sky of the scene.
void drawSunAndSky(Composer& composer);
/// Where the probes stand.
void drawProbeGrid(Document& document, View& view);
/// Boxes, probes and handles upon the picture, below all windows. `cursor` is in the window's unit.
void drawSceneOverlay(const Document& document, const View& view, const glm::dvec2& cursor);
/// Save the changes?
void drawLeaveQuestion(Composer& composer);

}  // namespace pfvox::viewer
