#include "legend.hpp"

#include <cstdio>

#include "color_map.hpp"

namespace viewer {

namespace {

constexpr float bar_width = 24;
constexpr float bar_height = 256;
constexpr float text_width = 180;
constexpr float margin = 16;
constexpr int ticks = 5;

}   // namespace

void draw_legend(ImVec2 lower_right, double top, double diagonal) {
    ImDrawList &list = *ImGui::GetBackgroundDrawList();
    const ImU32 text_color = IM_COL32(235, 235, 235, 255);
    const float left = lower_right.x - margin - text_width - bar_width;
    const float bottom = lower_right.y - margin - ImGui::GetFontSize();
    const float line = ImGui::GetFontSize();
    list.AddRectFilled({left - margin, bottom - bar_height - 3 * line}, {lower_right.x, lower_right.y},
                       IM_COL32(20, 22, 28, 200));
    list.AddText({left, bottom - bar_height - 2.3F * line}, text_color, "distance (% of the diagonal)");

    const auto colors = color_table();
    const float height = bar_height / static_cast<float>(colors.size());
    for (std::size_t i = 0; i < colors.size(); ++i) {
        const float low = bottom - height * static_cast<float>(i);
        list.AddRectFilled({left, low - height}, {left + bar_width, low},
                           IM_COL32(colors[i][0], colors[i][1], colors[i][2], 255));
    }
    for (int tick = 0; tick < ticks; ++tick) {
        const double share = static_cast<double>(tick) / (ticks - 1);
        const float y = bottom - bar_height * static_cast<float>(share);
        list.AddLine({left + bar_width, y}, {left + bar_width + 5, y}, text_color);
        char text[64];
        std::snprintf(text, sizeof text, "%.3g (%.3g %%)", share * top, 100 * share * top / diagonal);
        list.AddText({left + bar_width + 9, y - line / 2}, text_color, text);
    }
}

}   // namespace viewer
