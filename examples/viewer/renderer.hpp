/// Draws surfaces.

#ifndef VIEWER_RENDERER_HPP
#define VIEWER_RENDERER_HPP

#include <glm/glm.hpp>

#include "gl_objects.hpp"
#include "scene.hpp"

namespace viewer {

/// A part of the framebuffer in pixels, from its lower left corner.
struct Viewport {
    int x = 0;
    int y = 0;
    int width = 0;
    int height = 0;
};

/// How to draw a surface.
struct Look {
    bool facets = false;       ///< triangles are flat; else shading goes over their edges
    bool wireframe = false;    ///< edges are drawn over the surface
    float top_of_scale = 0;    ///< the value with the last colour, where there are values
};

class Renderer {
public:
    Renderer();

    /// Fills all of a framebuffer of that size with the background.
    void clear(int width, int height) const;

    /// Draws `drawable` into the viewport as the matrices say, by its values where it has some. Nothing where there is
    /// nothing to draw, or no room.
    void draw(const Drawable &drawable, const Look &look, const Viewport &viewport, const glm::mat4 &view,
              const glm::mat4 &projection) const;

    /// Draws its edges alone, over what is there.
    void draw_edges(const Drawable &drawable, const Viewport &viewport, const glm::mat4 &view,
                    const glm::mat4 &projection) const;

private:
    void begin(const Viewport &viewport, const glm::mat4 &view, const glm::mat4 &projection) const;
    void edges(const Drawable &drawable) const;

    gl::Program program_;
    gl::Texture colors_;
    GLint view_ = program_.uniform("view");
    GLint projection_ = program_.uniform("projection");
    GLint mode_ = program_.uniform("mode");
    GLint facets_ = program_.uniform("facets");
    GLint top_of_scale_ = program_.uniform("top_of_scale");
};

}   // namespace viewer

#endif
