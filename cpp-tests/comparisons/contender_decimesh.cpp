#include "contender.hpp"

#include "decimesh_mesh.hpp"

namespace comparison {
namespace {

class DecimeshTask final : public Task {
public:
    DecimeshTask(const Mesh &mesh, unsigned threads) : thread_count(threads), original(to_decimesh(mesh)) {}

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

    Mesh result() override { return from_decimesh(simplified.get()); }

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
    return {name(threads), std::string("decimesh ") + decimesh_version_string(),
            [threads](const Mesh &mesh) { return std::make_unique<DecimeshTask>(mesh, threads); }};
}

} // namespace comparison
