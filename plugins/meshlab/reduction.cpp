// SPDX-License-Identifier: GPL-3.0-or-later
#include "reduction.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>
#include <utility>

namespace meshlab_plugin {

namespace {

/// The progress of one of several pieces of work. `whole` must outlive it.
decimesh::Progress piece(const decimesh::Progress &whole, std::size_t index, std::size_t count) {
    if (!whole) {
        return {};
    }
    return [&whole, index, count](float fraction) {
        return whole((static_cast<float>(index) + fraction) / static_cast<float>(count));
    };
}

std::uint8_t flag_of(VertexSelection selection) {
    switch (selection) {
    case VertexSelection::ignored: return 0;
    case VertexSelection::locked: return decimesh::vertex_flag::lock;
    case VertexSelection::along_seams: return decimesh::vertex_flag::protect;
    case VertexSelection::prioritized: return decimesh::vertex_flag::prioritize;
    }
    return 0;
}

/// The options that go with the part.
decimesh::Options options_for(const Part &part, const Simplification &simplification) {
    decimesh::Options options = simplification.options;
    options.locked_vertices = part.kept;
    options.vertex_flags.clear();
    if (simplification.selection != VertexSelection::ignored) {
        options.vertex_flags.resize(part.vertices.size());
        for (std::size_t vertex = 0; vertex < part.vertices.size(); ++vertex) {
            options.vertex_flags[vertex] = part.is_selected[vertex] ? flag_of(simplification.selection) : 0;
        }
    }
    // Where vertices move, no edge joins two textures, and so nothing that becomes of them does.
    options.triangle_groups.clear();
    if (options.placement == decimesh::Placement::existing && part.has_several_textures) {
        options.triangle_groups = part.textures;
    }
    if (!part.kept.empty()) {
        options.topology = decimesh::Topology::keep;
    }
    return options;
}

const char *complaint(decimesh::StoppedBy stopped_by) {
    return stopped_by == decimesh::StoppedBy::stuck ? "; no more can go: topology, seams, locks or folds forbid it"
                                                    : "";
}

std::string counts(const Part &part, std::size_t faces) {
    return std::to_string(part.faces.size()) + " faces, simplified to " + std::to_string(faces);
}

const char *within(bool is_proven) {
    return is_proven ? ", proven to be within " : ", within about ";
}

std::string in_words(const Part &part, const decimesh::Report &report, bool is_proven) {
    std::ostringstream words;
    words << counts(part, report.triangles) << within(is_proven) << report.error;
    if (report.attribute_error > 0) {
        words << "; attributes within about " << report.attribute_error;
    }
    if (report.topology_changed) {
        words << "; holes, handles or components had to go";
    }
    words << complaint(report.stopped_by);
    return words.str();
}

std::vector<Reduced> nested_levels(const Part &part, const std::vector<decimesh::Target> &targets, bool is_certified,
                                   const Simplification &simplification) {
    Simplification existing = simplification;
    existing.options.placement = decimesh::Placement::existing;
    decimesh::Options options = options_for(part, existing);
    options.progress = piece(simplification.options.progress, 0, is_certified ? 2 : 1);
    decimesh::NestedLevels levels =
        decimesh::NestedLevels::build(decimesh::Mesh::from_buffers(buffers_of(part)), targets, options);
    if (is_certified) {
        decimesh::BoundOptions bound;
        bound.threads = options.threads;
        bound.progress = piece(simplification.options.progress, 1, 2);
        levels.certify(bound);
    }
    std::vector<Reduced> reduced;
    // Level 0 is the part itself.
    for (std::size_t level = 1; level < levels.size(); ++level) {
        const decimesh::NestedLevel known = levels.level(level);
        std::ostringstream words;
        words << counts(part, known.index_count / 3) << within(is_certified) << known.error
              << complaint(known.stopped_by);
        const decimesh::Span<const std::uint32_t> sources(levels.order().data(), known.vertices);
        reduced.push_back({unmoved(part, sources, levels.indices(level), levels.groups(level)), words.str()});
    }
    return reduced;
}

decimesh::Mesh mesh_of(const Placed &placed) {
    return decimesh::Mesh::from_buffers(placed.positions, placed.indices);
}

}   // namespace

Reduced simplify(const Part &part, const Simplification &simplification, std::optional<double> guaranteed_error) {
    decimesh::Options options = options_for(part, simplification);
    options.track_origins = true;
    const decimesh::Mesh mesh = decimesh::Mesh::from_buffers(buffers_of(part));
    const decimesh::Simplified result =
        guaranteed_error ? decimesh::simplify_within(mesh, *guaranteed_error, options).simplified
                         : decimesh::simplify(mesh, options);
    return {moved(part, result.mesh, result.origins, result.groups),
            in_words(part, result.report, guaranteed_error.has_value())};
}

Reduced choose(const Part &part, std::size_t faces, decimesh::MultipleChoiceOptions options) {
    options.locked_vertices.insert(options.locked_vertices.end(), part.kept.begin(), part.kept.end());
    const decimesh::Decimated result =
        decimesh::multiple_choice(decimesh::Mesh::from_buffers(buffers_of(part)), faces, options);
    return {unmoved(part, result.sources, result.mesh.indices(), {}),
            counts(part, result.mesh.triangle_count()) + complaint(result.stopped_by)};
}

std::vector<Reduced> build_levels(const Part &part, const Chain &chain, const Simplification &simplification) {
    if (chain.count < 1) {
        throw std::invalid_argument("there must be at least one level");
    }
    if (!(chain.ratio > 0 && chain.ratio < 1)) {
        throw std::invalid_argument("the ratio of levels must be above 0 and below 1");
    }
    std::vector<decimesh::Target> targets;
    for (std::size_t level = 1; level <= chain.count; ++level) {
        targets.push_back(decimesh::Target::ratio(std::pow(chain.ratio, static_cast<double>(level))));
    }
    if (chain.is_nested) {
        return nested_levels(part, targets, chain.is_certified, simplification);
    }
    decimesh::Options options = options_for(part, simplification);
    options.track_origins = true;
    const auto levels = decimesh::Levels::build(decimesh::Mesh::from_buffers(buffers_of(part)), targets, options);
    std::vector<Reduced> reduced;
    for (std::size_t level = 0; level < levels.size(); ++level) {
        reduced.push_back({moved(part, levels.mesh(level), levels.origins(level), levels.groups(level)),
                           in_words(part, levels.report(level), false)});
    }
    return reduced;
}

Distances measure(const Placed &from, const Placed &to, const Measurement &measurement) {
    if (to.indices.empty()) {
        throw std::invalid_argument("the layer that distances are from has no faces");
    }
    const decimesh::Mesh measured = mesh_of(from);
    const decimesh::Mesh reference = mesh_of(to);
    const bool has_surface = !from.indices.empty();
    const bool is_bounded = has_surface && measurement.bound.has_value();
    const std::size_t pieces = is_bounded ? 3 : has_surface ? 2 : 1;
    const decimesh::Progress &progress = measurement.options.progress;

    decimesh::DeviationOptions options = measurement.options;
    options.progress = piece(progress, 0, pieces);
    Distances distances{decimesh::vertex_distances(measured, reference, options), {}};
    std::ostringstream words;
    words << "vertices are up to " << *std::max_element(distances.of_vertices.begin(), distances.of_vertices.end())
          << " away";
    if (has_surface) {
        options.progress = piece(progress, 1, pieces);
        const decimesh::Deviation both = decimesh::deviation(measured, reference, options);
        words << "; both surfaces: RMS " << both.rms << ", mean " << both.mean << ", largest " << both.max
              << ", of a diagonal of " << both.diagonal << "; normals RMS " << both.normal_rms_degrees << " degrees";
    }
    if (is_bounded) {
        decimesh::BoundOptions bound = *measurement.bound;
        bound.progress = piece(progress, 2, pieces);
        const decimesh::Bound proven = decimesh::bound(measured, reference, bound);
        words << "; the largest distance is proven to be between " << proven.lower << " and " << proven.upper;
    }
    distances.summary = words.str();
    return distances;
}

}   // namespace meshlab_plugin
