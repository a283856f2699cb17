/// The scale of the heat map.

#ifndef VIEWER_LEGEND_HPP
#define VIEWER_LEGEND_HPP

#include <imgui.h>

namespace viewer {

/// Draws the colours from 0 to `top`, with distances in units of the positions and as a share of `diagonal`, with its
/// lower right corner there; over all that has been drawn, and under all windows.
void draw_legend(ImVec2 lower_right, double top, double diagonal);

}   // namespace viewer

#endif
