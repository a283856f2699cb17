#include "contender.hpp"

#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/GarlandHeckbert_plane_policies.h>
#include <CGAL/Surface_mesh_simplification/edge_collapse.h>
#include <CGAL/version.h>

#include <stdexcept>

namespace comparison {
namespace {

namespace simplification = CGAL::Surface_mesh_simplification;

using Kernel = CGAL::Simple_cartesian<double>;
using SurfaceMesh = CGAL::Surface_mesh<Kernel::Point_3>;

/// CGAL's own predicates count edges, from which the triangles of a mesh with a border do not follow.
struct FewEnoughTriangles {
    std::size_t triangles;

    template <typename Cost, typename Profile>
    bool operator()(const Cost &, const Profile &profile, std::size_t, std::size_t) const {
        return profile.surface_mesh().number_of_faces() <= triangles;
    }
};

class CgalTask : public Task {
public:
    explicit CgalTask(const Mesh &mesh) {
        const auto vertices = mesh.positions.size();
        const auto triangles = mesh.triangles.size();
        surface.reserve(static_cast<SurfaceMesh::size_type>(vertices),
                        static_cast<SurfaceMesh::size_type>(vertices + triangles),
                        static_cast<SurfaceMesh::size_type>(triangles));
        for (const auto &[x, y, z] : mesh.positions)
            surface.add_vertex(Kernel::Point_3(x, y, z));
        for (const auto &[a, b, c] : mesh.triangles) {
            using Vertex = SurfaceMesh::Vertex_index;
            if (surface.add_face(Vertex(a), Vertex(b), Vertex(c)) == SurfaceMesh::null_face())
                throw std::runtime_error("CGAL takes oriented manifolds only");
        }
    }

    Mesh result() override {
        Mesh mesh;
        surface.collect_garbage();
        for (const auto vertex : surface.vertices()) {
            const auto &point = surface.point(vertex);
            mesh.positions.push_back({static_cast<float>(point.x()), static_cast<float>(point.y()),
                                      static_cast<float>(point.z())});
        }
        for (const auto face : surface.faces()) {
            auto corner = mesh.triangles.emplace_back().begin();
            for (const auto vertex : surface.vertices_around_face(surface.halfedge(face)))
                *corner++ = static_cast<std::uint32_t>(vertex);
        }
        return mesh;
    }

protected:
    SurfaceMesh surface;
};

class LindstromTurk final : public CgalTask {
public:
    using CgalTask::CgalTask;

    void simplify(std::size_t triangles) override {
        simplification::edge_collapse(surface, FewEnoughTriangles{triangles});
    }
};

class GarlandHeckbert final : public CgalTask {
public:
    using CgalTask::CgalTask;

    void simplify(std::size_t triangles) override {
        const simplification::GarlandHeckbert_plane_policies<SurfaceMesh, Kernel> policies(surface);
        simplification::edge_collapse(
            surface, FewEnoughTriangles{triangles},
            CGAL::parameters::get_cost(policies.get_cost()).get_placement(policies.get_placement()));
    }
};

const std::string library = "CGAL " CGAL_VERSION_STR;

} // namespace

Contender cgal_lindstrom_turk() {
    return {"CGAL Lindstrom-Turk", library,
            [](const Mesh &mesh) { return std::make_unique<LindstromTurk>(mesh); }};
}

Contender cgal_garland_heckbert() {
    return {"CGAL Garland-Heckbert", library,
            [](const Mesh &mesh) { return std::make_unique<GarlandHeckbert>(mesh); }};
}

} // namespace comparison
