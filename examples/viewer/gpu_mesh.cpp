#include "gpu_mesh.hpp"

#include <array>

#include <glm/glm.hpp>

namespace viewer {

namespace {

struct Vertex {
    std::array<float, 3> position;
    std::array<float, 3> normal;
};

/// Three numbers of `values`, those of `vertex`.
glm::dvec3 triple(decimesh::Span<const float> values, std::size_t vertex) {
    return {values[3 * vertex], values[3 * vertex + 1], values[3 * vertex + 2]};
}

/// The sums of the normals of the triangles around each vertex, by their area. In doubles: the products of small
/// lengths are no floats.
std::vector<glm::dvec3> normals_of_surface(decimesh::MeshView mesh) {
    std::vector<glm::dvec3> normals(mesh.vertex_count(), glm::dvec3{0});
    const auto positions = mesh.positions();
    const auto indices = mesh.indices();
    for (std::size_t corner = 0; corner < indices.size(); corner += 3) {
        const glm::dvec3 a = triple(positions, indices[corner]);
        const glm::dvec3 b = triple(positions, indices[corner + 1]);
        const glm::dvec3 c = triple(positions, indices[corner + 2]);
        const glm::dvec3 normal = glm::cross(b - a, c - a);
        for (std::size_t i = corner; i < corner + 3; ++i) {
            normals[indices[i]] += normal;
        }
    }
    return normals;
}

std::array<float, 3> normalized(const glm::dvec3 &normal) {
    const double length = glm::length(normal);
    if (length > 0) {
        return {static_cast<float>(normal.x / length), static_cast<float>(normal.y / length),
                static_cast<float>(normal.z / length)};
    }
    return {0, 0, 1};
}

template <class T>
void upload(GLenum target, const gl::Buffer &buffer, const T *first, std::size_t count) {
    glBindBuffer(target, buffer.name());
    glBufferData(target, static_cast<GLsizeiptr>(count * sizeof(T)), first, GL_STATIC_DRAW);
}

/// Where a member is, as OpenGL has offsets into buffers.
const void *offset(std::size_t bytes) {
    return reinterpret_cast<const void *>(bytes);
}

}   // namespace

GpuVertices::GpuVertices(decimesh::MeshView mesh, const Frame &frame)
    : bytes_(mesh.vertex_count() * sizeof(Vertex)) {
    const auto positions = mesh.positions();
    const auto own_normals = mesh.normals();
    const std::vector<glm::dvec3> made_normals =
        own_normals.empty() ? normals_of_surface(mesh) : std::vector<glm::dvec3>();
    std::vector<Vertex> vertices(mesh.vertex_count());
    for (std::size_t vertex = 0; vertex < vertices.size(); ++vertex) {
        vertices[vertex].position = frame.place(&positions[3 * vertex]);
        vertices[vertex].normal =
            normalized(own_normals.empty() ? made_normals[vertex] : triple(own_normals, vertex));
    }

    glBindVertexArray(array_.name());
    upload(GL_ARRAY_BUFFER, buffer_, vertices.data(), vertices.size());
    glEnableVertexAttribArray(attribute::position);
    glVertexAttribPointer(attribute::position, 3, GL_FLOAT, GL_FALSE, sizeof(Vertex),
                          offset(offsetof(Vertex, position)));
    glEnableVertexAttribArray(attribute::normal);
    glVertexAttribPointer(attribute::normal, 3, GL_FLOAT, GL_FALSE, sizeof(Vertex), offset(offsetof(Vertex, normal)));
    glBindVertexArray(0);
}

GpuIndices::GpuIndices(decimesh::Span<const std::uint32_t> indices) : count_(indices.size()) {
    // The element buffer is part of the array that is bound: of none.
    glBindVertexArray(0);
    upload(GL_ARRAY_BUFFER, buffer_, indices.data(), indices.size());
}

GpuValues::GpuValues(const std::vector<float> &values) {
    upload(GL_ARRAY_BUFFER, buffer_, values.data(), values.size());
}

void draw(const GpuVertices &vertices, const GpuIndices &indices, const GpuValues *values) {
    glBindVertexArray(vertices.array());
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, indices.buffer());
    if (values != nullptr) {
        glBindBuffer(GL_ARRAY_BUFFER, values->buffer());
        glEnableVertexAttribArray(attribute::value);
        glVertexAttribPointer(attribute::value, 1, GL_FLOAT, GL_FALSE, sizeof(float), offset(0));
    } else {
        glDisableVertexAttribArray(attribute::value);
    }
    glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(indices.count()), GL_UNSIGNED_INT, offset(0));
    glBindVertexArray(0);
}

}   // namespace viewer
