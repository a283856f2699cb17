/// The panel at the left.

#ifndef VIEWER_PANEL_HPP
#define VIEWER_PANEL_HPP

#include <string>

#include "session.hpp"
#include "view_settings.hpp"

namespace viewer {

/// In ImGui's coordinates.
inline constexpr float panel_width = 340;

/// What the panel's fields say, apart from the view.
struct PanelFields {
    std::string open_path;
    std::string save_path = "result.ply";
    Engine engine = Engine::hqms;
    int triangles = 0;   ///< 0: half of the original's, once there is one
    int levels = 6;
};

/// Draws the panel, and does what is asked for in it. Between ImGui's `NewFrame` and `Render`.
void draw_panel(Session &session, ViewSettings &view, PanelFields &fields);

}   // namespace viewer

#endif
