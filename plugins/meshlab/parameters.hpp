// SPDX-License-Identifier: GPL-3.0-or-later
/// What users are asked for: MeshLab's lists of parameters, with tooltips, and what they mean to decimesh.
///
/// Names of parameters are what scripts (`.mlx`) say, and do not change.

#ifndef DECIMESH_MESHLAB_PARAMETERS_HPP
#define DECIMESH_MESHLAB_PARAMETERS_HPP

#include <cstddef>
#include <optional>

#include <common/interfaces.h>

#include "conversion.hpp"
#include "reduction.hpp"

namespace meshlab_plugin {

/// What all filters that simplify ask.
struct Scope {
    Extent extent = Extent::all_faces;
    bool carries_normals = true;    ///< otherwise those of vertices are made anew of the faces
};

struct SimplifyRequest {
    Scope scope;
    Simplification simplification;
    std::optional<double> guaranteed_error;
};

struct ChooseRequest {
    Scope scope;
    std::size_t faces;
    decimesh::MultipleChoiceOptions options;
    bool locks_selected_vertices;
};

struct LevelsRequest {
    Scope scope;
    Chain chain;
    Simplification simplification;
};

struct DeviationRequest {
    MeshModel *reference;    ///< nullptr if the document has no such layer
    Measurement measurement;
};

/// Add the parameters of each filter, with defaults for `layer`.
void add_simplify_parameters(const CMeshO &layer, RichParameterList &parameters);
void add_choose_parameters(const CMeshO &layer, RichParameterList &parameters);
void add_levels_parameters(const CMeshO &layer, RichParameterList &parameters);
void add_deviation_parameters(MeshDocument &document, RichParameterList &parameters);

/// Read them. They throw `std::invalid_argument`, which names the parameter, for what can be no such option whatever
/// the mesh; the rest is for decimesh to say.
SimplifyRequest read_simplify_parameters(const RichParameterList &parameters);
ChooseRequest read_choose_parameters(const RichParameterList &parameters);
LevelsRequest read_levels_parameters(const RichParameterList &parameters);
DeviationRequest read_deviation_parameters(const RichParameterList &parameters);

}   // namespace meshlab_plugin

#endif
