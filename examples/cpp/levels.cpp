// Builds levels of detail, and picks one for each distance by the error that it makes on the screen.

#include <decimesh.hpp>

#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "hills.hpp"

namespace {

struct Camera {
    float fov;      ///< vertical field of view, in radians
    float height;   ///< of the screen, in pixels

    /// The error, in units of the mesh, that covers so many pixels.
    ///
    /// At a distance d the camera sees a slice of the world that is 2 * d * tan(fov / 2) high, on a screen of
    /// `height` pixels. So one pixel is 2 * d * tan(fov / 2) / height.
    ///
    /// d is the distance to the nearest point of the object, such as that to the middle of its bounding sphere
    /// less the radius: there the error looks largest.
    float error_of(float pixels, float distance) const {
        return pixels * 2 * distance * std::tan(fov / 2) / height;
    }
};

/// What to draw: the coarsest level that is wrong by `pixels` at most, or else the mesh itself.
decimesh::MeshView choose(const decimesh::Mesh &mesh, const decimesh::Levels &levels, const Camera &camera,
                          float distance, float pixels) {
    const auto level = levels.select(camera.error_of(pixels, distance));
    return level ? levels.mesh(*level) : mesh;
}

}   // namespace

int main() {
    const Hills hills(200);
    try {
        decimesh::Buffers<> buffers;
        buffers.positions = decimesh::interleaved(hills.vertices, &Vertex::position);
        buffers.normals = decimesh::interleaved(hills.vertices, &Vertex::normal);   // carried along to every level
        buffers.uvs = decimesh::interleaved(hills.vertices, &Vertex::uv);
        buffers.indices = hills.indices;
        const decimesh::Mesh mesh = decimesh::Mesh::from_buffers(buffers);

        // Each level has about 40 % of the triangles of the one before.
        std::vector<decimesh::Target> targets;
        for (double ratio = 0.4; ratio > 0.005; ratio *= 0.4) {
            targets.push_back(decimesh::Target::ratio(ratio));
        }
        const decimesh::Levels levels = decimesh::Levels::build(mesh, targets);

        std::printf("level  triangles  error\n    -  %9zu  0 m\n", mesh.triangle_count());
        for (std::size_t level = 0; level < levels.size(); ++level) {
            std::printf("%5zu  %9zu  %.2f m\n", level, levels.mesh(level).triangle_count(),
                        static_cast<double>(levels.report(level).error));
        }

        // What a renderer does each frame, for each object.
        const Camera camera{1.0F, 1080};
        std::size_t last_triangles = mesh.triangle_count();
        bool is_right = true;
        for (float distance = 50; distance < 1e5F; distance *= 3) {
            const decimesh::MeshView drawn = choose(mesh, levels, camera, distance, 1);
            std::printf("from %.0f m away, draw %zu triangles\n", static_cast<double>(distance), drawn.triangle_count());
            is_right &= drawn.triangle_count() <= last_triangles;
            last_triangles = drawn.triangle_count();
        }
        is_right &= last_triangles < mesh.triangle_count() / 50;
        return is_right ? EXIT_SUCCESS : EXIT_FAILURE;
    } catch (const decimesh::Error &error) {
        std::fprintf(stderr, "%s\n", error.what());
        return EXIT_FAILURE;
    }
}
