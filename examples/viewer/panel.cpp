#include "panel.hpp"

#include <algorithm>
#include <limits>

#include <imgui.h>
#include <imgui_stdlib.h>

namespace viewer {

namespace {

const char *reason(decimesh::StoppedBy stopped_by) {
    switch (stopped_by) {
    case decimesh::StoppedBy::target: return "the target is met";
    case decimesh::StoppedBy::error: return "more would exceed the error";
    case decimesh::StoppedBy::stuck: return "nothing more may collapse";
    }
    return "unknown";
}

void draw_file(Session &session, PanelFields &fields) {
    ImGui::SetNextItemWidth(-60);
    const bool is_entered =
        ImGui::InputTextWithHint("##open", "a mesh to open", &fields.open_path, ImGuiInputTextFlags_EnterReturnsTrue);
    ImGui::SameLine();
    if (ImGui::Button("Open", {-1, 0}) || is_entered) {
        fields.triangles = 0;
        session.open(fields.open_path);
    }
    if (const Original *original = session.original()) {
        ImGui::TextWrapped("%s", original->path.c_str());
        ImGui::Text("%zu triangles, %zu vertices", original->mesh.triangle_count(), original->mesh.vertex_count());
        ImGui::Text("diagonal %.6g", original->frame.diagonal);
    }
}

void draw_simplify(Session &session, PanelFields &fields) {
    const std::size_t most = std::numeric_limits<int>::max();
    const int triangles = static_cast<int>(std::min(session.original()->mesh.triangle_count(), most));
    if (fields.triangles == 0) {
        fields.triangles = std::max(triangles / 2, 1);
    }
    int engine = static_cast<int>(fields.engine);
    ImGui::AlignTextToFramePadding();
    ImGui::TextUnformatted("Engine");
    for (const Engine each : all_engines) {
        ImGui::SameLine();
        ImGui::RadioButton(name_of(each), &engine, static_cast<int>(each));
    }
    fields.engine = static_cast<Engine>(engine);
    ImGui::TextUnformatted("Triangles");
    ImGui::SetNextItemWidth(-1);
    ImGui::SliderInt("##triangles", &fields.triangles, 1, triangles, "%d",
                     ImGuiSliderFlags_Logarithmic | ImGuiSliderFlags_AlwaysClamp);
    // Released: the pictures follow the slider without a click.
    const bool is_chosen = ImGui::IsItemDeactivatedAfterEdit();
    if (ImGui::Button("Simplify", {-1, 0}) || is_chosen) {
        session.simplify(fields.engine, static_cast<std::size_t>(fields.triangles));
    }
}

void draw_levels(Session &session, ViewSettings &view, PanelFields &fields) {
    ImGui::SetNextItemWidth(-160);
    ImGui::SliderInt("##levels", &fields.levels, 1, static_cast<int>(most_levels), "%d levels", ImGuiSliderFlags_AlwaysClamp);
    ImGui::SameLine();
    if (ImGui::Button("Build nested levels", {-1, 0})) {
        view.level = 0;
        session.build_levels(static_cast<std::size_t>(fields.levels));
    }
    if (const std::size_t count = session.level_count(); count > 1) {
        int level = static_cast<int>(std::min(view.level, count - 1));
        ImGui::SetNextItemWidth(-1);
        ImGui::SliderInt("##level", &level, 0, static_cast<int>(count) - 1, "level %d", ImGuiSliderFlags_AlwaysClamp);
        view.level = static_cast<std::size_t>(level);
    }
}

void draw_activity(Session &session) {
    ImGui::Text("%s ...", session.activity().c_str());
    ImGui::ProgressBar(session.progress(), {-70, 0});
    ImGui::SameLine();
    if (ImGui::Button("Cancel", {-1, 0})) {
        session.cancel();
    }
}

void draw_view(ViewSettings &view) {
    int layout = static_cast<int>(view.layout);
    ImGui::RadioButton("original", &layout, static_cast<int>(Layout::original));
    ImGui::SameLine(140);
    ImGui::RadioButton("result", &layout, static_cast<int>(Layout::result));
    ImGui::RadioButton("side by side", &layout, static_cast<int>(Layout::side_by_side));
    ImGui::SameLine(140);
    ImGui::RadioButton("deviation", &layout, static_cast<int>(Layout::deviation));
    view.layout = static_cast<Layout>(layout);
    ImGui::Checkbox("wireframe", &view.wireframe);
    ImGui::SameLine(140);
    ImGui::Checkbox("facets", &view.facets);
    if (view.layout == Layout::deviation) {
        ImGui::SetNextItemWidth(-1);
        ImGui::SliderFloat("##scale", &view.scale, 0.01F, 1, "scale: %.2f of the largest",
                           ImGuiSliderFlags_Logarithmic | ImGuiSliderFlags_AlwaysClamp);
    }
}

void draw_distances(const Distances &distances, double diagonal) {
    const auto line = [diagonal](const char *name, float distance) {
        ImGui::Text("  %s %.3g (%.3g %%)", name, double{distance}, 100 * double{distance} / diagonal);
    };
    ImGui::TextUnformatted("distance of the original's vertices");
    line("RMS", distances.rms);
    line("largest", distances.largest);
}

void draw_result(const Session &session, const ViewSettings &view) {
    const double diagonal = session.original()->frame.diagonal;
    if (const auto *reduced = std::get_if<Reduced>(&session.result())) {
        ImGui::Text("%zu triangles in %.2f s", reduced->mesh.triangle_count(), reduced->seconds);
        ImGui::Text("stopped: %s", reason(reduced->stopped_by));
        draw_distances(reduced->distances, diagonal);
    } else if (const auto *set = std::get_if<LevelSet>(&session.result())) {
        const std::size_t shown = std::min(view.level, set->levels.size() - 1);
        const decimesh::NestedLevel level = set->levels.level(shown);
        ImGui::Text("%zu triangles, the first %zu vertices", level.index_count / 3, level.vertices);
        ImGui::Text("estimated error %.3g", double{level.error});
        draw_distances(set->distances[shown], diagonal);
    }
}

void draw_save(Session &session, const ViewSettings &view, PanelFields &fields) {
    ImGui::SetNextItemWidth(-60);
    ImGui::InputText("##save", &fields.save_path);
    ImGui::SameLine();
    if (ImGui::Button("Save", {-1, 0})) {
        session.save(fields.save_path, view.level);
    }
}

}   // namespace

void draw_panel(Session &session, ViewSettings &view, PanelFields &fields) {
    ImGui::SetNextWindowPos({0, 0});
    ImGui::SetNextWindowSize({panel_width, ImGui::GetIO().DisplaySize.y});
    ImGui::Begin("decimesh", nullptr,
                 ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoCollapse);
    draw_file(session, fields);
    if (session.original() != nullptr) {
        ImGui::Separator();
        draw_simplify(session, fields);
        ImGui::Separator();
        draw_levels(session, view, fields);
        ImGui::Separator();
        draw_view(view);
    }
    if (session.is_busy()) {
        ImGui::Separator();
        draw_activity(session);
    }
    if (session.level_count() > 0) {
        ImGui::Separator();
        draw_result(session, view);
        ImGui::Separator();
        draw_save(session, view, fields);
    }
    if (!session.message().empty()) {
        ImGui::Separator();
        const ImVec4 color = session.has_failed() ? ImVec4{1, 0.35F, 0.3F, 1} : ImVec4{0.7F, 0.75F, 0.8F, 1};
        ImGui::PushStyleColor(ImGuiCol_Text, color);
        ImGui::TextWrapped("%s", session.message().c_str());
        ImGui::PopStyleColor();
    }
    ImGui::End();
}

}   // namespace viewer
