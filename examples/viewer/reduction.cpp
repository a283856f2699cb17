#include "reduction.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

namespace viewer {

namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

/// The progress of a part of the work, which is `from` to `to` of the whole.
decimesh::Progress part(const decimesh::Progress &whole, float from, float to) {
    return [&whole, from, to](float fraction) { return whole(from + fraction * (to - from)); };
}

Distances measure(decimesh::MeshView original, decimesh::MeshView surface, const decimesh::Progress &progress) {
    // Where nothing is left there is no distance to it.
    if (surface.triangle_count() == 0) {
        return {};
    }
    decimesh::DeviationOptions options;
    options.progress = progress;
    Distances distances{decimesh::vertex_distances(original, surface, options)};
    // A vertex that no triangle uses is not on the surface, and may be anywhere.
    std::vector<bool> is_seen(original.vertex_count(), false);
    std::size_t count = 0;
    double squares = 0;
    for (const std::uint32_t vertex : original.indices()) {
        if (!is_seen[vertex]) {
            is_seen[vertex] = true;
            ++count;
            const float distance = distances.of_vertices[vertex];
            distances.largest = std::max(distances.largest, distance);
            squares += double{distance} * double{distance};
        }
    }
    distances.rms = static_cast<float>(std::sqrt(squares / static_cast<double>(count)));
    return distances;
}

Reduced simplify(decimesh::MeshView mesh, Engine engine, std::size_t triangles, const decimesh::Progress &progress) {
    if (engine == Engine::multiple_choice) {
        decimesh::MultipleChoiceOptions options;
        options.progress = progress;
        decimesh::Decimated result = decimesh::multiple_choice(mesh, triangles, options);
        return {engine, std::move(result.mesh), result.stopped_by, {}, 0};
    }
    decimesh::Options options;
    options.target = decimesh::Target::triangles(triangles);
    options.placement = engine == Engine::hqms ? decimesh::Placement::optimal : decimesh::Placement::existing;
    options.progress = progress;
    decimesh::Simplified result = decimesh::simplify(mesh, options);
    return {engine, std::move(result.mesh), result.report.stopped_by, {}, 0};
}

}   // namespace

const char *name_of(Engine engine) {
    switch (engine) {
    case Engine::hqms: return "hqms";
    case Engine::indices: return "indices";
    case Engine::multiple_choice: return "multiple-choice";
    }
    return "unknown";
}

Original read(const std::string &path) {
    decimesh::Mesh mesh = decimesh::Mesh::read(path);
    if (mesh.triangle_count() == 0) {
        throw decimesh::Error(decimesh::Status::empty, path + ": there are no triangles to see");
    }
    const Frame frame = Frame::of(mesh);
    return {path, std::move(mesh), frame};
}

Reduced reduce(const Original &original, Engine engine, std::size_t triangles, const decimesh::Progress &progress) {
    if (triangles == 0) {
        throw decimesh::Error(decimesh::Status::option, "a target of 0 triangles leaves nothing to see");
    }
    const Clock::time_point start = Clock::now();
    Reduced reduced = simplify(original.mesh, engine, triangles, part(progress, 0, 0.5F));
    reduced.seconds = seconds_since(start);
    reduced.distances = measure(original.mesh, reduced.mesh, part(progress, 0.5F, 1));
    return reduced;
}

LevelSet build_levels(const Original &original, std::size_t count, const decimesh::Progress &progress) {
    if (count == 0 || count > most_levels) {
        throw decimesh::Error(decimesh::Status::option, std::to_string(count) + " levels are not 1 to " +
                                                            std::to_string(most_levels));
    }
    std::vector<decimesh::Target> targets;
    for (std::size_t level = 1; level <= count; ++level) {
        targets.push_back(decimesh::Target::ratio(std::ldexp(1.0, -static_cast<int>(level))));
    }
    decimesh::Options options;
    options.progress = part(progress, 0, 0.5F);
    const Clock::time_point start = Clock::now();
    LevelSet set{decimesh::NestedLevels::build(original.mesh, targets, options), {}, 0};
    set.seconds = seconds_since(start);

    for (std::size_t level = 0; level < set.levels.size(); ++level) {
        const float size = static_cast<float>(set.levels.size());
        const float from = 0.5F + 0.5F * static_cast<float>(level) / size;
        set.distances.push_back(
            measure(set.levels.mesh(), mesh_of(set.levels, level), part(progress, from, from + 0.5F / size)));
    }
    return set;
}

decimesh::Mesh mesh_of(const decimesh::NestedLevels &levels, std::size_t level) {
    const decimesh::MeshView all = levels.mesh();
    // Nested: a level needs the beginning of the buffers alone.
    const std::size_t vertices = levels.level(level).vertices;
    decimesh::Buffers<> buffers;
    buffers.positions = {all.positions().data(), vertices};
    buffers.indices = levels.indices(level);
    if (!all.normals().empty()) {
        buffers.normals = {all.normals().data(), vertices};
    }
    if (!all.uvs().empty()) {
        buffers.uvs = {all.uvs().data(), vertices};
    }
    if (!all.colors().empty()) {
        buffers.colors = {all.colors().data(), vertices};
    }
    return decimesh::Mesh::from_buffers(buffers);
}

}   // namespace viewer
