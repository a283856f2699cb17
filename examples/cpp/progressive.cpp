// Keeps every level of a landscape in one file, loads the coarse part of it first, and follows a flight with a player
// that changes only what differs from frame to frame.

#include <decimesh.hpp>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>

#include "hills.hpp"

int main() {
    const Hills hills(150);
    const std::string path = (std::filesystem::temp_directory_path() / "decimesh-example-hills.dpm").string();
    try {
        decimesh::Buffers<> buffers;
        buffers.positions = decimesh::interleaved(hills.vertices, &Vertex::position);
        buffers.normals = decimesh::interleaved(hills.vertices, &Vertex::normal);
        buffers.indices = hills.indices;
        const decimesh::Mesh mesh = decimesh::Mesh::from_buffers(buffers);

        // The targets become marks: levels whose error is known.
        using decimesh::Target;
        const std::vector<Target> targets = {Target::ratio(0.5), Target::ratio(0.1), Target::ratio(0.01)};
        decimesh::Progressive::build(mesh, targets).write(path);

        // The coarsest levels lie at the beginning of the file: enough to draw something at once.
        const decimesh::Progressive beginning = decimesh::Progressive::read(path, mesh.triangle_count() / 10);
        std::printf("%zu levels in %zu bytes; the first %zu have at most %zu triangles\n",
                    decimesh::Progressive::read(path).steps() + 1,
                    static_cast<std::size_t>(std::filesystem::file_size(path)), beginning.steps() + 1,
                    beginning.triangle_count(beginning.steps()));

        const decimesh::Progressive progressive = decimesh::Progressive::read(path);
        std::filesystem::remove(path);
        for (const decimesh::Progressive::Mark &mark : progressive.marks()) {
            std::printf("%zu triangles are within about %.2f m\n", progressive.triangle_count(mark.step),
                        static_cast<double>(mark.error));
        }

        // A flight towards the landscape and away from it: as many triangles as the distance is worth.
        bool is_right = true;
        decimesh::Player player(progressive);
        for (int frame = 0; frame <= 8; ++frame) {
            const double distance = 250 * std::exp2(std::abs(frame - 4));
            const auto wanted = static_cast<std::size_t>(1e7 / distance);
            player.go_to(progressive.step_within(wanted));
            std::printf("from %.0f m away, draw %zu triangles over the first %zu vertices\n", distance,
                        player.triangle_count(), player.vertex_count());
            is_right &= player.triangle_count() <= wanted && player.indices().size() == 3 * player.triangle_count();
        }
        return is_right ? EXIT_SUCCESS : EXIT_FAILURE;
    } catch (const decimesh::Error &error) {
        std::fprintf(stderr, "%s\n", error.what());
        return EXIT_FAILURE;
    }
}
