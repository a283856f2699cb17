#include "contender.hpp"

#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <OpenMesh/Core/System/config.h>
#include <OpenMesh/Tools/Decimater/DecimaterT.hh>
#include <OpenMesh/Tools/Decimater/McDecimaterT.hh>
#include <OpenMesh/Tools/Decimater/ModQuadricT.hh>

#include <cstdlib>
#include <stdexcept>
#include <utility>

namespace comparison {
namespace {

using TriangleMesh = OpenMesh::TriMesh_ArrayKernelT<>;
using Quadric = OpenMesh::Decimater::ModQuadricT<TriangleMesh>;

template <typename Decimater> class OpenMeshTask final : public Task {
public:
    explicit OpenMeshTask(const Mesh &mesh) {
        const auto vertices = mesh.positions.size();
        const auto triangles = mesh.triangles.size();
        surface.reserve(vertices, vertices + triangles, triangles);
        for (const auto &[x, y, z] : mesh.positions)
            surface.add_vertex({x, y, z});
        for (const auto &[a, b, c] : mesh.triangles) {
            const auto vertex = [](std::uint32_t index) {
                return TriangleMesh::VertexHandle(static_cast<int>(index));
            };
            if (!surface.add_face(vertex(a), vertex(b), vertex(c)).is_valid())
                throw std::runtime_error("OpenMesh takes oriented manifolds only");
        }
    }

    void simplify(std::size_t triangles) override {
        // The multiple-choice decimater draws from `rand`: each run shall draw the same.
        std::srand(1);
        Decimater decimater(surface);
        typename OpenMesh::Decimater::ModHandleT<Quadric> quadric;
        decimater.add(quadric);
        if (!decimater.initialize())
            throw std::runtime_error("OpenMesh's decimater refuses to start");
        decimater.decimate_to_faces(0, triangles);
        surface.garbage_collection();
    }

    Mesh result() override {
        Mesh mesh;
        for (const auto vertex : surface.vertices()) {
            const auto &point = surface.point(vertex);
            mesh.positions.push_back({point[0], point[1], point[2]});
        }
        for (const auto face : surface.faces()) {
            auto corner = mesh.triangles.emplace_back().begin();
            for (const auto vertex : face.vertices())
                *corner++ = static_cast<std::uint32_t>(vertex.idx());
        }
        return mesh;
    }

private:
    TriangleMesh surface;
};

template <typename Decimater> Contender openmesh(std::string name) {
    const auto version =
        std::to_string((OM_VERSION & 0xf0000) >> 16) + '.' + std::to_string((OM_VERSION & 0x0ff00) >> 8);
    return {std::move(name), "OpenMesh " + version,
            [](const Mesh &mesh) { return std::make_unique<OpenMeshTask<Decimater>>(mesh); }};
}

} // namespace

Contender openmesh_quadric() {
    return openmesh<OpenMesh::Decimater::DecimaterT<TriangleMesh>>("OpenMesh quadric");
}

Contender openmesh_multiple_choice() {
    return openmesh<OpenMesh::Decimater::McDecimaterT<TriangleMesh>>("OpenMesh multiple choice");
}

} // namespace comparison
