#include "scene.hpp"

namespace viewer {

void Scene::update(const Session &session) {
    if (original_version_ != session.original_version()) {
        original_version_ = session.original_version();
        original_ = {};
    }
    if (result_version_ != session.result_version()) {
        result_version_ = session.result_version();
        result_ = {};
        distances_.clear();
    }
}

Drawable Scene::original(const Session &session) {
    const Original *original = session.original();
    if (original == nullptr) {
        return {};
    }
    return show(original_, original->mesh, original->frame, 0, original->mesh.indices());
}

Drawable Scene::result(const Session &session, std::size_t level) {
    if (const auto *reduced = std::get_if<Reduced>(&session.result())) {
        const decimesh::Mesh &mesh = reduced->mesh;
        return show(result_, mesh, session.original()->frame, 0, mesh.indices());
    }
    if (const auto *set = std::get_if<LevelSet>(&session.result())) {
        return show(result_, set->levels.mesh(), session.original()->frame, level, set->levels.indices(level));
    }
    return {};
}

Drawable Scene::deviation(const Session &session, std::size_t level) {
    const Distances *distances = session.distances(level);
    if (distances == nullptr || distances->of_vertices.empty()) {
        return {};
    }
    // Level 0 is the original with its vertices in the order of the levels, which the distances have as well.
    const bool is_nested = std::holds_alternative<LevelSet>(session.result());
    Drawable drawable = is_nested ? result(session, 0) : original(session);
    const auto [values, is_new] = distances_.try_emplace(level, distances->of_vertices);
    uploads_.values += is_new ? 1 : 0;
    drawable.values = &values->second;
    return drawable;
}

Drawable Scene::show(Shared &shared, decimesh::MeshView mesh, const Frame &frame, std::size_t level,
                     decimesh::Span<const std::uint32_t> indices) {
    if (!shared.vertices) {
        shared.vertices.emplace(mesh, frame);
        ++uploads_.vertices;
    }
    const auto [at_level, is_new] = shared.indices.try_emplace(level, indices);
    uploads_.indices += is_new ? 1 : 0;
    return {&*shared.vertices, &at_level->second, nullptr};
}

}   // namespace viewer
