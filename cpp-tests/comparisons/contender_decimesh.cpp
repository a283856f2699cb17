#include "contender.hpp"

#include <decimesh.h>

#include <algorithm>
#include <stdexcept>

namespace comparison {
namespace {

struct Destroy {
    void operator()(decimesh_mesh *mesh) const { decimesh_mesh_destroy(mesh); }
};
using Handle = std::unique_ptr<decimesh_mesh, Destroy>;

void check(decimesh_status status) {
    if (status != DECIMESH_OK)
        throw std::runtime_error(decimesh_last_error_message());
}

class DecimeshTask final : public Task {
public:
    DecimeshTask(const Mesh &mesh, unsigned threads) : thread_count(threads) {
        decimesh_buffers buffers;
        decimesh_buffers_init(&buffers, sizeof buffers);
        buffers.positions = mesh.positions.front().data();
        buffers.vertex_count = mesh.positions.size();
        buffers.indices = mesh.triangles.front().data();
        buffers.index_count = 3 * mesh.triangles.size();
        decimesh_mesh *created = nullptr;
        check(decimesh_mesh_from_buffers(&buffers, &created));
        original.reset(created);
    }

    void simplify(std::size_t triangles) override {
        decimesh_simplify_options options;
        decimesh_simplify_options_init(&options, sizeof options);
        options.target = DECIMESH_TARGET_TRIANGLES;
        options.target_value = static_cast<double>(triangles);
        options.threads = thread_count;
        decimesh_mesh *created = nullptr;
        check(decimesh_simplify(original.get(), &options, &created, nullptr));
        simplified.reset(created);
    }

    Mesh result() override {
        Mesh mesh;
        mesh.positions.resize(decimesh_mesh_vertex_count(simplified.get()));
        mesh.triangles.resize(decimesh_mesh_triangle_count(simplified.get()));
        const float *positions = decimesh_mesh_positions(simplified.get());
        std::copy_n(positions, 3 * mesh.positions.size(), mesh.positions.front().data());
        const std::uint32_t *indices = decimesh_mesh_indices(simplified.get());
        std::copy_n(indices, 3 * mesh.triangles.size(), mesh.triangles.front().data());
        return mesh;
    }

private:
    unsigned thread_count;
    Handle original;
    Handle simplified;
};

std::string name(unsigned threads) {
    switch (threads) {
    case 0:
        return "decimesh";
    case 1:
        return "decimesh, 1 thread";
    default:
        return "decimesh, " + std::to_string(threads) + " threads";
    }
}

} // namespace

Contender decimesh_default(unsigned threads) {
    return {name(threads),
            [threads](const Mesh &mesh) { return std::make_unique<DecimeshTask>(mesh, threads); }};
}

} // namespace comparison
