// A flat C face for OpenMesh's decimaters; ../src/handle.rs is its only caller and declares it again.
//
// Pointers and counts come checked: indices in range, positions finite, halfedges few enough for an
// `int`. No exception leaves; every function that can fail answers with a status.

#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <OpenMesh/Core/System/omstream.hh>
#include <OpenMesh/Tools/Decimater/DecimaterT.hh>
#include <OpenMesh/Tools/Decimater/McDecimaterT.hh>
#include <OpenMesh/Tools/Decimater/ModHausdorffT.hh>
#include <OpenMesh/Tools/Decimater/ModNormalFlippingT.hh>
#include <OpenMesh/Tools/Decimater/ModQuadricT.hh>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <mutex>
#include <new>
#include <stdexcept>
#include <vector>

struct openmesh_shim_mesh : OpenMesh::TriMesh_ArrayKernelT<> {
    std::size_t left_out = 0;
};

namespace {

namespace decimater = OpenMesh::Decimater;
using Mesh = OpenMesh::TriMesh_ArrayKernelT<>;

enum Status : std::int32_t { OK = 0, OUT_OF_MEMORY = 1, EXCEPTION = 2 };

enum Method : std::int32_t { QUADRIC = 0, MULTIPLE_CHOICE = 1 };

std::mutex turn;

// OpenMesh reports to streams of the process, and McDecimaterT draws from `rand`: calls take turns, in
// silence, and each begins with the same seed.
template <class Work>
std::int32_t in_turn(Work work) noexcept {
    try {
        const std::lock_guard<std::mutex> lock(turn);
        omlog().disable();
        omout().disable();
        omerr().disable();
        std::srand(1);
        work();
        return OK;
    } catch (const std::bad_alloc &) {
        return OUT_OF_MEMORY;
    } catch (const std::length_error &) {
        return OUT_OF_MEMORY;
    } catch (...) {
        return EXCEPTION;
    }
}

// What marks elements as deleted. A decimater holds these too, but only for as long as it lives.
class StatusHeld {
  public:
    explicit StatusHeld(Mesh &mesh) : mesh_(mesh) {
        mesh_.request_vertex_status();
        mesh_.request_halfedge_status();
        mesh_.request_edge_status();
        mesh_.request_face_status();
    }
    ~StatusHeld() {
        mesh_.release_vertex_status();
        mesh_.release_halfedge_status();
        mesh_.release_edge_status();
        mesh_.release_face_status();
    }
    StatusHeld(const StatusHeld &) = delete;
    StatusHeld &operator=(const StatusHeld &) = delete;

  private:
    Mesh &mesh_;
};

template <class Decimater>
void prepare(Decimater &with, bool prevent_flips, float max_distance) {
    decimater::ModQuadricT<Mesh>::Handle quadric;
    with.add(quadric);
    if (prevent_flips) {
        decimater::ModNormalFlippingT<Mesh>::Handle flipping;
        with.add(flipping);
    }
    if (max_distance >= 0.0f) {
        decimater::ModHausdorffT<Mesh>::Handle hausdorff;
        with.add(hausdorff);
        with.module(hausdorff).set_tolerance(max_distance);
    }
    if (!with.initialize()) {
        throw std::logic_error("a decimater has one module that sets priorities");
    }
}

// McDecimaterT draws among all halfedges, deleted ones included, and gives up when 210 in a row are of
// no use, as they would be long before a hundredth is left. So the deleted ones go at each halving; the
// quadrics stay.
void choose_down_to(decimater::McDecimaterT<Mesh> &with, Mesh &mesh, std::size_t triangles) {
    std::size_t collapses = 1;
    while (mesh.n_faces() > triangles && collapses > 0) {
        // To 0 vertices and 1 face would mean to McDecimaterT: no target, but constraints.
        collapses = with.decimate_to_faces(1, std::max(triangles, mesh.n_faces() / 2));
        mesh.garbage_collection();
    }
}

} // namespace

extern "C" {

// OpenMesh's version, as its macro has it: 0x90000 is 9.0.
std::uint32_t openmesh_shim_version() noexcept {
    return OM_VERSION;
}

std::int32_t openmesh_shim_build(const float *positions, std::size_t vertices, const std::uint32_t *indices,
                                 std::size_t triangles, openmesh_shim_mesh **out) noexcept {
    return in_turn([&] {
        auto mesh = std::make_unique<openmesh_shim_mesh>();
        mesh->reserve(vertices, vertices + triangles, triangles);
        for (std::size_t vertex = 0; vertex < vertices; ++vertex) {
            const float *position = positions + 3 * vertex;
            mesh->add_vertex({position[0], position[1], position[2]});
        }
        for (std::size_t triangle = 0; triangle < triangles; ++triangle) {
            const std::uint32_t *corner = indices + 3 * triangle;
            const Mesh::VertexHandle a(static_cast<int>(corner[0]));
            const Mesh::VertexHandle b(static_cast<int>(corner[1]));
            const Mesh::VertexHandle c(static_cast<int>(corner[2]));
            // A repeated vertex is not refused, but ends the process: Debian's library asserts.
            const bool is_face = a != b && b != c && c != a;
            if (!is_face || !mesh->add_face(a, b, c).is_valid()) {
                ++mesh->left_out;
            }
        }
        *out = mesh.release();
    });
}

// A negative `max_distance` is none. After a failure the mesh is good for nothing but to be destroyed.
std::int32_t openmesh_shim_decimate(openmesh_shim_mesh *mesh, std::int32_t method, std::size_t triangles,
                                    bool prevent_flips, float max_distance) noexcept {
    return in_turn([&] {
        const StatusHeld status(*mesh);
        if (method == MULTIPLE_CHOICE) {
            decimater::McDecimaterT<Mesh> with(*mesh);
            prepare(with, prevent_flips, max_distance);
            choose_down_to(with, *mesh, triangles);
        } else {
            decimater::DecimaterT<Mesh> with(*mesh);
            prepare(with, prevent_flips, max_distance);
            with.decimate_to_faces(0, triangles);
        }
        mesh->delete_isolated_vertices();
        mesh->garbage_collection();
    });
}

std::size_t openmesh_shim_vertices(const openmesh_shim_mesh *mesh) noexcept {
    return mesh->n_vertices();
}

std::size_t openmesh_shim_triangles(const openmesh_shim_mesh *mesh) noexcept {
    return mesh->n_faces();
}

std::size_t openmesh_shim_left_out(const openmesh_shim_mesh *mesh) noexcept {
    return mesh->left_out;
}

// Three values for each vertex and each triangle.
void openmesh_shim_copy(const openmesh_shim_mesh *mesh, float *positions, std::uint32_t *indices) noexcept {
    for (const auto vertex : mesh->vertices()) {
        const Mesh::Point &point = mesh->point(vertex);
        positions = std::copy(point.data(), point.data() + 3, positions);
    }
    for (const auto face : mesh->faces()) {
        for (const auto vertex : mesh->fv_range(face)) {
            *indices++ = static_cast<std::uint32_t>(vertex.idx());
        }
    }
}

void openmesh_shim_destroy(openmesh_shim_mesh *mesh) noexcept {
    delete mesh;
}

} // extern "C"
