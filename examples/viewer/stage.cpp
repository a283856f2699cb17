#include "stage.hpp"

#include <algorithm>
#include <string>

#include <imgui.h>

#include "legend.hpp"

namespace viewer {

namespace {

constexpr float gap = 2;

void caption(float x, float y, const std::string &text) {
    ImGui::GetBackgroundDrawList()->AddText({x + 10, y + 8}, IM_COL32(235, 235, 235, 255), text.c_str());
}

std::string triangles(std::size_t count) {
    return std::to_string(count) + " triangles";
}

std::string result_caption(const Session &session, std::size_t level) {
    if (const auto *reduced = std::get_if<Reduced>(&session.result())) {
        return std::string(name_of(reduced->engine)) + ": " + triangles(reduced->mesh.triangle_count());
    }
    if (const auto *set = std::get_if<LevelSet>(&session.result())) {
        return "level " + std::to_string(level) + ": " + triangles(set->levels.level(level).index_count / 3);
    }
    return "no result yet";
}

}   // namespace

void Stage::draw(const Session &session, const ViewSettings &settings, float left) {
    const ImGuiIO &io = ImGui::GetIO();
    const Area area{left, 0, std::max(io.DisplaySize.x - left, 0.0F), io.DisplaySize.y};
    follow_mouse(area);
    renderer_.clear(static_cast<int>(io.DisplaySize.x * io.DisplayFramebufferScale.x),
                    static_cast<int>(io.DisplaySize.y * io.DisplayFramebufferScale.y));
    scene_.update(session);
    if (session.original() == nullptr) {
        caption(area.x, area.y, "Drop a mesh here: PLY, OBJ, STL, OFF, glTF or GLB");
        return;
    }

    const std::string whole = "original: " + triangles(session.original()->mesh.triangle_count());
    // Settings may be of levels that are no longer there.
    const std::size_t level = std::min(settings.level, std::max<std::size_t>(session.level_count(), 1) - 1);
    Look look{settings.facets, settings.wireframe, 0};
    switch (settings.layout) {
    case Layout::original:
        draw_surface(scene_.original(session), look, area, {});
        caption(area.x, area.y, whole);
        break;
    case Layout::result:
        draw_surface(scene_.result(session, level), look, area, {});
        caption(area.x, area.y, result_caption(session, level));
        break;
    case Layout::side_by_side: {
        const float half = (area.width - gap) / 2;
        const Area first{area.x, area.y, half, area.height};
        const Area second{area.x + half + gap, area.y, half, area.height};
        draw_surface(scene_.original(session), look, first, {});
        draw_surface(scene_.result(session, level), look, second, {});
        ImGui::GetBackgroundDrawList()->AddRectFilled({first.x + half, 0}, {second.x, area.height},
                                                      IM_COL32(0, 0, 0, 255));
        caption(first.x, first.y, whole);
        caption(second.x, second.y, result_caption(session, level));
        break;
    }
    case Layout::deviation: {
        const Drawable colored = scene_.deviation(session, level);
        const Distances *distances = session.distances(level);
        const double top = distances == nullptr ? 0 : double{settings.scale} * double{distances->largest};
        // The edges are those of the result: they show which triangle is how far off.
        look.wireframe = false;
        look.top_of_scale = static_cast<float>(top);
        draw_surface(colored, look, area, settings.wireframe ? scene_.result(session, level) : Drawable{});
        caption(area.x, area.y, "distance of the original from " + result_caption(session, level));
        if (colored) {
            draw_legend({area.x + area.width, area.y + area.height}, top, session.original()->frame.diagonal);
        }
        break;
    }
    }
}

void Stage::follow_mouse(const Area &area) {
    const ImGuiIO &io = ImGui::GetIO();
    if (io.WantCaptureMouse || area.height <= 0) {
        return;
    }
    const float degrees = 180 / area.height;
    if (ImGui::IsMouseDown(ImGuiMouseButton_Left)) {
        camera_.orbit(-degrees * io.MouseDelta.x, degrees * io.MouseDelta.y);
    } else if (ImGui::IsMouseDown(ImGuiMouseButton_Right)) {
        camera_.pan(io.MouseDelta.x / area.height, -io.MouseDelta.y / area.height);
    }
    camera_.zoom(io.MouseWheel);
}

void Stage::draw_surface(const Drawable &drawable, const Look &look, const Area &area, const Drawable &edges) const {
    const ImGuiIO &io = ImGui::GetIO();
    const ImVec2 scale = io.DisplayFramebufferScale;
    const Viewport viewport{static_cast<int>(area.x * scale.x),
                            static_cast<int>((io.DisplaySize.y - area.y - area.height) * scale.y),
                            static_cast<int>(area.width * scale.x), static_cast<int>(area.height * scale.y)};
    if (viewport.width <= 0 || viewport.height <= 0) {
        return;
    }
    const float aspect = static_cast<float>(viewport.width) / static_cast<float>(viewport.height);
    const glm::mat4 view = camera_.view();
    const glm::mat4 projection = camera_.projection(aspect);
    renderer_.draw(drawable, look, viewport, view, projection);
    renderer_.draw_edges(edges, viewport, view, projection);
}

}   // namespace viewer
