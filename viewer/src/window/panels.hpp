// Panels: the windows upon the picture. They show a Session and change what is public in it.
#pragma once

#include "session.hpp"

namespace pfvox::viewer {

/// Between Overlay::build's beginning and end.
void drawPanels(Session& session);

}  // namespace pfvox::viewer
