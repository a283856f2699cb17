#include "renderer.hpp"

#include <glm/gtc/type_ptr.hpp>

#include "color_map.hpp"

namespace viewer {

namespace {

/// What a fragment's colour is made of: `mode` of the shader.
enum Mode : GLint { plain = 0, by_value = 1, edge = 2 };

constexpr const char *vertex_source = R"(#version 330 core
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in float value;
uniform mat4 view;
uniform mat4 projection;
out vec3 eye_position;
out vec3 eye_normal;
out float fragment_value;

void main() {
    vec4 at = view * vec4(position, 1.0);
    eye_position = at.xyz;
    eye_normal = mat3(view) * normal;
    fragment_value = value;
    gl_Position = projection * at;
}
)";

// The light is at the eye, so that what is seen is lit, from whichever side.
constexpr const char *fragment_source = R"(#version 330 core
in vec3 eye_position;
in vec3 eye_normal;
in float fragment_value;
uniform int mode;
uniform bool facets;
uniform float top_of_scale;
uniform sampler1D colors;
out vec4 color;

void main() {
    if (mode == 2) {
        color = vec4(0.05, 0.06, 0.08, 1.0);
        return;
    }
    vec3 normal = facets ? cross(dFdx(eye_position), dFdy(eye_position)) : eye_normal;
    float light = abs(dot(normalize(normal), normalize(eye_position)));
    if (mode == 1) {
        // Colours are to be read: they are shaded no more than it takes to see the shape.
        float share = top_of_scale > 0.0 ? clamp(fragment_value / top_of_scale, 0.0, 1.0) : 0.0;
        float texel = (share * 255.0 + 0.5) / 256.0;
        color = vec4(texture(colors, texel).rgb * (0.6 + 0.4 * light), 1.0);
    } else {
        color = vec4(vec3(0.78, 0.80, 0.84) * (0.15 + 0.85 * light), 1.0);
    }
}
)";

constexpr glm::vec3 background{0.13F, 0.14F, 0.17F};

}   // namespace

Renderer::Renderer() : program_(vertex_source, fragment_source) {
    const auto table = color_table();
    glBindTexture(GL_TEXTURE_1D, colors_.name());
    glTexImage1D(GL_TEXTURE_1D, 0, GL_RGB8, static_cast<GLsizei>(table.size()), 0, GL_RGB, GL_UNSIGNED_BYTE,
                 table.data());
    glTexParameteri(GL_TEXTURE_1D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_1D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_1D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
}

void Renderer::clear(int width, int height) const {
    glViewport(0, 0, width, height);
    glClearColor(background.r, background.g, background.b, 1);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
}

void Renderer::draw(const Drawable &drawable, const Look &look, const Viewport &viewport, const glm::mat4 &view,
                    const glm::mat4 &projection) const {
    if (!drawable || viewport.width <= 0 || viewport.height <= 0) {
        return;
    }
    begin(viewport, view, projection);
    glUniform1i(mode_, drawable.values != nullptr ? by_value : plain);
    glUniform1i(facets_, look.facets ? 1 : 0);
    glUniform1f(top_of_scale_, look.top_of_scale);
    // Edges that lie in the surface win.
    glEnable(GL_POLYGON_OFFSET_FILL);
    glPolygonOffset(1, 1);
    viewer::draw(*drawable.vertices, *drawable.indices, drawable.values);
    glDisable(GL_POLYGON_OFFSET_FILL);
    if (look.wireframe) {
        edges(drawable);
    }
}

void Renderer::draw_edges(const Drawable &drawable, const Viewport &viewport, const glm::mat4 &view,
                          const glm::mat4 &projection) const {
    if (drawable && viewport.width > 0 && viewport.height > 0) {
        begin(viewport, view, projection);
        edges(drawable);
    }
}

void Renderer::begin(const Viewport &viewport, const glm::mat4 &view, const glm::mat4 &projection) const {
    glViewport(viewport.x, viewport.y, viewport.width, viewport.height);
    glEnable(GL_DEPTH_TEST);
    glDisable(GL_CULL_FACE);
    glActiveTexture(GL_TEXTURE0);
    glBindTexture(GL_TEXTURE_1D, colors_.name());
    program_.use();
    glUniformMatrix4fv(view_, 1, GL_FALSE, glm::value_ptr(view));
    glUniformMatrix4fv(projection_, 1, GL_FALSE, glm::value_ptr(projection));
}

void Renderer::edges(const Drawable &drawable) const {
    glUniform1i(mode_, edge);
    glPolygonMode(GL_FRONT_AND_BACK, GL_LINE);
    viewer::draw(*drawable.vertices, *drawable.indices, nullptr);
    glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
}

}   // namespace viewer
