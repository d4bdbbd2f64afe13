#include "session.hpp"

#include <utility>

namespace pfvox::viewer {

Session::Session(gpu::Device& device, const SessionStart& start, const Memory& memory, MessageLog& log,
                 FrameSequence frames, gpu::RayQuery query)
    : document(device, log, start.read, start.probes),
      view(document, std::move(frames), std::move(query), start.camera, memory),
      input(document, view, start.screenshotFolder) {
    view.mode = start.mode;
    view.atlas = start.atlas;
}

Result<std::unique_ptr<Session>> Session::create(gpu::Device& device, const SessionStart& start,
                                                 const Memory& memory, MessageLog& log) {
    PFVOX_TRY(FrameSequence, frames, FrameSequence::create(device));
    PFVOX_TRY(gpu::RayQuery, query, gpu::RayQuery::create(device));
    std::unique_ptr<Session> session(
        new Session(device, start, memory, log, std::move(frames), std::move(query)));
    if (!start.path.empty()) session->document.open(start.path);
    return session;
}

}  // namespace pfvox::viewer
