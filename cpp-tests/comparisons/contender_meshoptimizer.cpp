#include "contender.hpp"

#include <meshoptimizer.h>

#include <utility>

namespace comparison {
namespace {

/// Relative to the extent of the mesh, beyond what any collapse costs: the count is what shall stop it.
constexpr float any_error = 1e3f;

/// Indices are reduced over vertices that stay; `simplifyWithUpdate` moves those too. Both work on the caller's
/// buffers, so the copy of them is this contender's mesh.
class MeshoptimizerTask final : public Task {
public:
    MeshoptimizerTask(const Mesh &mesh, bool update) : buffers(mesh), moves(update) {}

    void simplify(std::size_t triangles) override {
        std::uint32_t *indices = buffers.triangles.front().data();
        float *positions = buffers.positions.front().data();
        const std::size_t index_count = 3 * buffers.triangles.size();
        const std::size_t vertex_count = buffers.positions.size();
        const std::size_t left =
            moves ? meshopt_simplifyWithUpdate(indices, index_count, positions, vertex_count, sizeof(Point),
                                                nullptr, 0, nullptr, 0, nullptr, 3 * triangles, any_error, 0,
                                                nullptr)
                   : meshopt_simplify(indices, indices, index_count, positions, vertex_count, sizeof(Point),
                                      3 * triangles, any_error, 0, nullptr);
        buffers.triangles.resize(left / 3);
    }

    Mesh result() override { return std::move(buffers); }

private:
    Mesh buffers;
    bool moves;
};

Contender meshoptimizer(std::string name, bool update) {
    return {std::move(name),
            [update](const Mesh &mesh) { return std::make_unique<MeshoptimizerTask>(mesh, update); }};
}

} // namespace

Contender meshoptimizer_simplify() { return meshoptimizer("meshoptimizer simplify", false); }

Contender meshoptimizer_update() { return meshoptimizer("meshoptimizer simplifyWithUpdate", true); }

} // namespace comparison
