#include "decimesh_mesh.hpp"

#include <algorithm>
#include <stdexcept>

namespace comparison {

void check(decimesh_status status) {
    if (status != DECIMESH_OK)
        throw std::runtime_error(decimesh_last_error_message());
}

Handle to_decimesh(const Mesh &mesh) {
    if (mesh.triangles.empty())
        throw std::runtime_error("a mesh without triangles");
    decimesh_buffers buffers;
    decimesh_buffers_init(&buffers, sizeof buffers);
    buffers.positions = mesh.positions.front().data();
    buffers.vertex_count = mesh.positions.size();
    buffers.indices = mesh.triangles.front().data();
    buffers.index_count = 3 * mesh.triangles.size();
    decimesh_mesh *created = nullptr;
    check(decimesh_mesh_from_buffers(&buffers, &created));
    return Handle(created);
}

Mesh from_decimesh(const decimesh_mesh *mesh) {
    Mesh copy;
    copy.positions.resize(decimesh_mesh_vertex_count(mesh));
    copy.triangles.resize(decimesh_mesh_triangle_count(mesh));
    if (copy.triangles.empty())
        throw std::runtime_error("a mesh without triangles");
    std::copy_n(decimesh_mesh_positions(mesh), 3 * copy.positions.size(), copy.positions.front().data());
    std::copy_n(decimesh_mesh_indices(mesh), 3 * copy.triangles.size(), copy.triangles.front().data());
    return copy;
}

} // namespace comparison
