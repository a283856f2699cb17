#include "contender.hpp"

#include <meshoptimizer.h>

#include <utility>

namespace comparison {
namespace {

/// Relative to the extent of the mesh, beyond what any collapse costs: the count is what shall stop it.
constexpr float any_error = 1e3f;

enum class Function { simplify, update, sloppy };

/// Indices are reduced over vertices that stay; `simplifyWithUpdate` moves those too. All work on the caller's
/// buffers, so the copy of them is this contender's mesh.
class MeshoptimizerTask final : public Task {
public:
    MeshoptimizerTask(const Mesh &mesh, Function called) : buffers(mesh), function(called) {}

    void simplify(std::size_t triangles) override { buffers.triangles.resize(call(3 * triangles) / 3); }

    Mesh result() override { return std::move(buffers); }

private:
    std::size_t call(std::size_t target) {
        std::uint32_t *indices = buffers.triangles.front().data();
        float *positions = buffers.positions.front().data();
        const std::size_t index_count = 3 * buffers.triangles.size();
        const std::size_t vertex_count = buffers.positions.size();
        switch (function) {
        case Function::simplify:
            return meshopt_simplify(indices, indices, index_count, positions, vertex_count, sizeof(Point), target,
                                    any_error, 0, nullptr);
        case Function::update:
            return meshopt_simplifyWithUpdate(indices, index_count, positions, vertex_count, sizeof(Point),
                                              nullptr, 0, nullptr, 0, nullptr, target, any_error, 0, nullptr);
        case Function::sloppy:
            break;
        }
        return meshopt_simplifySloppy(indices, indices, index_count, positions, vertex_count, sizeof(Point),
                                      nullptr, target, any_error, nullptr);
    }

    Mesh buffers;
    Function function;
};

Contender meshoptimizer(std::string name, Function function) {
    const auto version =
        std::to_string(MESHOPTIMIZER_VERSION / 1000) + '.' + std::to_string(MESHOPTIMIZER_VERSION / 10 % 100);
    return {std::move(name), "meshoptimizer " + version,
            [function](const Mesh &mesh) { return std::make_unique<MeshoptimizerTask>(mesh, function); }};
}

} // namespace

Contender meshoptimizer_simplify() { return meshoptimizer("meshoptimizer simplify", Function::simplify); }

Contender meshoptimizer_update() { return meshoptimizer("meshoptimizer simplifyWithUpdate", Function::update); }

Contender meshoptimizer_sloppy() { return meshoptimizer("meshoptimizer simplifySloppy", Function::sloppy); }

} // namespace comparison
