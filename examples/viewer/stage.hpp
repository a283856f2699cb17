/// What is to be seen beside the panel.

#ifndef VIEWER_STAGE_HPP
#define VIEWER_STAGE_HPP

#include "camera.hpp"
#include "renderer.hpp"
#include "scene.hpp"
#include "session.hpp"
#include "view_settings.hpp"

namespace viewer {

/// Puts the session's meshes beside the panel, and lets the mouse turn (left button), move (right button) and approach
/// (wheel) them.
class Stage {
public:
    /// Draws all that is not ImGui's, from `left` on in ImGui's coordinates. Between ImGui's `NewFrame` and `Render`.
    void draw(const Session &session, const ViewSettings &settings, float left);

    Camera &camera() noexcept { return camera_; }
    const Scene &scene() const noexcept { return scene_; }

private:
    /// In ImGui's coordinates, from the upper left.
    struct Area {
        float x, y, width, height;
    };

    void follow_mouse(const Area &area);
    void draw_surface(const Drawable &drawable, const Look &look, const Area &area, const Drawable &edges) const;

    Camera camera_;
    Renderer renderer_;
    Scene scene_;
};

}   // namespace viewer

#endif
