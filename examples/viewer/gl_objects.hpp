/// OpenGL's objects with owners. Each needs the context that it was made in to be current, when it ends too.

#ifndef VIEWER_GL_OBJECTS_HPP
#define VIEWER_GL_OBJECTS_HPP

#include <string>
#include <utility>

#include <epoxy/gl.h>

namespace viewer::gl {

/// The name of an object of a `Kind`, which knows how to make and delete it. Move-only.
template <class Kind>
class Object {
public:
    Object() : name_(Kind::make()) {}
    Object(Object &&other) noexcept : name_(std::exchange(other.name_, 0)) {}
    Object &operator=(Object &&other) noexcept {
        std::swap(name_, other.name_);
        return *this;
    }
    ~Object() {
        if (name_ != 0) {
            Kind::destroy(name_);
        }
    }

    GLuint name() const noexcept { return name_; }

private:
    GLuint name_;
};

struct BufferKind {
    static GLuint make();
    static void destroy(GLuint name) noexcept;
};
struct VertexArrayKind {
    static GLuint make();
    static void destroy(GLuint name) noexcept;
};
struct TextureKind {
    static GLuint make();
    static void destroy(GLuint name) noexcept;
};
struct ProgramKind {
    static GLuint make();
    static void destroy(GLuint name) noexcept;
};

using Buffer = Object<BufferKind>;
using VertexArray = Object<VertexArrayKind>;
using Texture = Object<TextureKind>;

/// A program of a vertex and a fragment shader.
class Program {
public:
    /// Throws `std::runtime_error` with the driver's words where it does not compile or link.
    Program(const char *vertex_source, const char *fragment_source);

    void use() const { glUseProgram(object_.name()); }

    /// Where a uniform is; -1, which is set without effect, if the program has none of that name.
    GLint uniform(const char *name) const { return glGetUniformLocation(object_.name(), name); }

private:
    Object<ProgramKind> object_;
};

}   // namespace viewer::gl

#endif
