/// What of a mesh is on the graphics card: vertices, indices and values a vertex, each by itself, so that any number of
/// index buffers share the vertices, and values change without them.

#ifndef VIEWER_GPU_MESH_HPP
#define VIEWER_GPU_MESH_HPP

#include <cstddef>
#include <vector>

#include <decimesh.hpp>

#include "frame.hpp"
#include "gl_objects.hpp"

namespace viewer {

/// Where shaders find what.
namespace attribute {
inline constexpr GLuint position = 0;
inline constexpr GLuint normal = 1;
inline constexpr GLuint value = 2;
}   // namespace attribute

/// The positions, in the frame, and the normals of a mesh: those that it has, or else those of its surface.
class GpuVertices {
public:
    GpuVertices(decimesh::MeshView mesh, const Frame &frame);

    /// The array to draw with.
    GLuint array() const noexcept { return array_.name(); }
    std::size_t bytes() const noexcept { return bytes_; }

private:
    gl::VertexArray array_;
    gl::Buffer buffer_;
    std::size_t bytes_;
};

/// Triangles over vertices.
class GpuIndices {
public:
    explicit GpuIndices(decimesh::Span<const std::uint32_t> indices);

    GLuint buffer() const noexcept { return buffer_.name(); }
    std::size_t count() const noexcept { return count_; }
    std::size_t bytes() const noexcept { return count_ * sizeof(std::uint32_t); }

private:
    gl::Buffer buffer_;
    std::size_t count_;
};

/// A number a vertex.
class GpuValues {
public:
    explicit GpuValues(const std::vector<float> &values);

    GLuint buffer() const noexcept { return buffer_.name(); }

private:
    gl::Buffer buffer_;
};

/// Draws the triangles, with the values if there are any, by the program in use.
void draw(const GpuVertices &vertices, const GpuIndices &indices, const GpuValues *values);

}   // namespace viewer

#endif
