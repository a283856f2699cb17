// Simplifies in a thread of its own, while the thread of the user interface shows how far it has come and cancels.

#include <decimesh.hpp>

#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <future>

#include "hills.hpp"

int main() {
    using namespace std::chrono_literals;

    const Hills hills(500);
    decimesh::Buffers<> buffers;
    buffers.positions = decimesh::interleaved(hills.vertices, &Vertex::position);
    buffers.indices = hills.indices;
    const decimesh::Mesh mesh = decimesh::Mesh::from_buffers(buffers);

    std::atomic<float> done{0};
    std::atomic<bool> is_cancelled{false};
    decimesh::Options options;
    options.target = decimesh::Target::ratio(0.01);
    // Called by decimesh, in the worker, now and then: false ends the work.
    options.progress = [&](float fraction) {
        done = fraction;
        return !is_cancelled;
    };
    std::future<decimesh::Simplified> work =
        std::async(std::launch::async, [&] { return decimesh::simplify(mesh, options); });

    // The loop of the user interface. This user runs out of patience as soon as there is progress to see.
    while (work.wait_for(1ms) != std::future_status::ready) {
        if (done > 0 && !is_cancelled) {
            std::printf("%.0f %% done; cancelling\n", 100.0 * static_cast<double>(done));
            is_cancelled = true;
        }
    }

    try {
        const decimesh::Simplified result = work.get();
        std::printf("it was faster: %zu triangles\n", result.mesh.triangle_count());
    } catch (const decimesh::Cancelled &) {
        std::printf("ended, as asked\n");
    } catch (const std::exception &error) {
        std::fprintf(stderr, "%s\n", error.what());
        return EXIT_FAILURE;
    }
    return mesh.triangle_count() == hills.indices.size() / 3 ? EXIT_SUCCESS : EXIT_FAILURE;
}
