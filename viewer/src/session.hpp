// Session: everything of the interactive viewer but the window.
//
//     Document <- View <- Input: each knows those before it
#pragma once

#include <memory>

#include "input.hpp"

namespace pfvox::viewer {

/// What the command line asks for.
struct SessionStart {
    std::filesystem::path path;
    CameraRequest camera = {};
    ViewMode mode = ViewMode::Final;
    ProbeRequest probes = {};
    AtlasChoice atlas = {};
    std::filesystem::path screenshotFolder = {};  ///< empty = where the program runs
    Document::Read read = loadScene;              ///< on a thread of its own
};

class Session {
  public:
    /// Begins to load. Errors: those of the programs on the device.
    static Result<std::unique_ptr<Session>> create(gpu::Device& device, const SessionStart& start,
                                                   const Memory& memory, MessageLog& log);
    /// As time passes.
    void update(double secondsSinceStart) {
        document.update(secondsSinceStart);
        view.follow();
    }

    Document document;
    View view;
    Input input;

  private:
    Session(gpu::Device& device, const SessionStart& start, const Memory& memory, MessageLog& log,
            FrameSequence frames, gpu::RayQuery query);
};

}  // namespace pfvox::viewer
