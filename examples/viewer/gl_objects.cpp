#include "gl_objects.hpp"

#include <stdexcept>

namespace viewer::gl {

GLuint BufferKind::make() {
    GLuint name = 0;
    glGenBuffers(1, &name);
    return name;
}
void BufferKind::destroy(GLuint name) noexcept {
    glDeleteBuffers(1, &name);
}

GLuint VertexArrayKind::make() {
    GLuint name = 0;
    glGenVertexArrays(1, &name);
    return name;
}
void VertexArrayKind::destroy(GLuint name) noexcept {
    glDeleteVertexArrays(1, &name);
}

GLuint TextureKind::make() {
    GLuint name = 0;
    glGenTextures(1, &name);
    return name;
}
void TextureKind::destroy(GLuint name) noexcept {
    glDeleteTextures(1, &name);
}

GLuint ProgramKind::make() {
    return glCreateProgram();
}
void ProgramKind::destroy(GLuint name) noexcept {
    glDeleteProgram(name);
}

namespace {

struct VertexShaderKind {
    static GLuint make() { return glCreateShader(GL_VERTEX_SHADER); }
    static void destroy(GLuint name) noexcept { glDeleteShader(name); }
};
struct FragmentShaderKind {
    static GLuint make() { return glCreateShader(GL_FRAGMENT_SHADER); }
    static void destroy(GLuint name) noexcept { glDeleteShader(name); }
};

template <class Kind>
Object<Kind> compile(const char *source) {
    Object<Kind> shader;
    glShaderSource(shader.name(), 1, &source, nullptr);
    glCompileShader(shader.name());
    GLint is_compiled = GL_FALSE;
    glGetShaderiv(shader.name(), GL_COMPILE_STATUS, &is_compiled);
    if (is_compiled == GL_FALSE) {
        std::string log(4096, '\0');
        GLsizei length = 0;
        glGetShaderInfoLog(shader.name(), static_cast<GLsizei>(log.size()), &length, log.data());
        log.resize(static_cast<std::size_t>(length));
        throw std::runtime_error("a shader does not compile: " + log);
    }
    return shader;
}

}   // namespace

Program::Program(const char *vertex_source, const char *fragment_source) {
    const auto vertex = compile<VertexShaderKind>(vertex_source);
    const auto fragment = compile<FragmentShaderKind>(fragment_source);
    glAttachShader(object_.name(), vertex.name());
    glAttachShader(object_.name(), fragment.name());
    glLinkProgram(object_.name());
    GLint is_linked = GL_FALSE;
    glGetProgramiv(object_.name(), GL_LINK_STATUS, &is_linked);
    if (is_linked == GL_FALSE) {
        std::string log(4096, '\0');
        GLsizei length = 0;
        glGetProgramInfoLog(object_.name(), static_cast<GLsizei>(log.size()), &length, log.data());
        log.resize(static_cast<std::size_t>(length));
        throw std::runtime_error("the shaders do not link: " + log);
    }
}

}   // namespace viewer::gl
