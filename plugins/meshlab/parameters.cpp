// SPDX-License-Identifier: GPL-3.0-or-later
#include "parameters.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>

namespace meshlab_plugin {

namespace {

/// The order in which the choices are shown.
enum TargetChoice { to_faces, to_vertices, to_ratio, to_distance };

int count_selected_faces(const CMeshO &mesh) {
    return static_cast<int>(std::count_if(mesh.face.begin(), mesh.face.end(),
                                          [](const CFaceO &face) { return !face.IsD() && face.IsS(); }));
}

/// Half of what there is to simplify.
int half_of_faces(const CMeshO &mesh) {
    const int selected = count_selected_faces(mesh);
    return (selected > 0 ? selected : mesh.fn) / 2;
}

[[noreturn]] void refuse(const char *name, const std::string &why) {
    throw std::invalid_argument(std::string(name) + " " + why);
}

int read_choice(const RichParameterList &parameters, const char *name, int choices) {
    const int choice = parameters.getEnum(name);
    if (choice < 0 || choice >= choices) {
        refuse(name, "is " + std::to_string(choice) + ", which is none of its choices, 0 to " +
                         std::to_string(choices - 1));
    }
    return choice;
}

unsigned read_count(const RichParameterList &parameters, const char *name) {
    const int count = parameters.getInt(name);
    if (count < 0) {
        refuse(name, "is " + std::to_string(count) + ", and must not be negative");
    }
    return static_cast<unsigned>(count);
}

/// The number that was typed. MeshLab keeps 32 bits of it, which are no round number to 64: a ratio of 0.1 could leave
/// another count than elsewhere.
double as_typed(float number) {
    return QString::number(static_cast<double>(number), 'g', 7).toDouble();
}

void add_scope(const CMeshO &layer, RichParameterList &parameters) {
    parameters.addParam(RichEnum(
        "Normals", 0, {"Carry over", "Make anew of the faces"}, "Normals of vertices",
        "Carried over, they stay where vertices do and are interpolated where vertices move; vertices at one place "
        "count as a seam, for their normals may differ. Made anew, they are as other filters of MeshLab leave them, "
        "on the whole layer."));
    parameters.addParam(RichBool(
        "SelectedFaces", count_selected_faces(layer) > 0, "Only selected faces",
        "Simplify the selected faces alone. All others stay as they are, and so does the border of the selection: no "
        "crack opens. Targets are then about the selected faces, and their topology is kept."));
}

Scope read_scope(const RichParameterList &parameters) {
    Scope scope;
    scope.carries_normals = read_choice(parameters, "Normals", 2) == 0;
    scope.extent = parameters.getBool("SelectedFaces") ? Extent::selected_faces : Extent::all_faces;
    return scope;
}

/// The options of HQMS but for target and placement.
void add_engine(RichParameterList &parameters) {
    parameters.addParam(RichBool(
        "KeepTopology", false, "Keep the topology",
        "Holes, handles and components stay, even if the target is missed. Otherwise they are kept as long as the "
        "target can be met so, and the log says if they were not."));
    parameters.addParam(
        RichBool("LockBoundary", false, "Keep the border", "Vertices of the border of the surface stay, bit for bit."));
    parameters.addParam(RichBool(
        "KeepSeams", true, "Keep seams closed",
        "Where several vertices are at one place, and where texture coordinates of wedges differ, no crack opens: "
        "vertices there stay if new ones go where the error is least, and go along their seam together if not. "
        "Without this, the sides of a seam may part."));
    parameters.addParam(RichBool(
        "CrossSeams", false, "Go across seams",
        "If new vertices go where there are vertices: they may go across seams too, where the attributes allow it by "
        "their weights; the surface stays closed. For meshes of many small charts, and for faceted ones."));
    parameters.addParam(RichBool(
        "Refine", false, "Refine in the end",
        "If new vertices go where the error is least: move vertices and turn edges in the end, so that the surface "
        "is nearer to the original. The RMS distance falls by 6 to 10 %; the largest one may rise. Up to four times "
        "as long."));
    const auto add_weight = [&parameters](const char *name, const char *description, const char *of) {
        parameters.addParam(RichFloat(
            name, 0, description,
            QString("If new vertices go where there are vertices: what a difference of 1 in %1 weighs, beside a "
                    "distance as long as the longest side of the bounding box. 0: it does not count.")
                .arg(of)));
    };
    add_weight("NormalWeight", "Weight of normals", "each coordinate of normals");
    add_weight("UVWeight", "Weight of texture coordinates", "texture coordinates");
    add_weight("ColorWeight", "Weight of colours", "each channel of colours, from none to full,");
    parameters.addParam(RichEnum(
        "Selection", 0, {"Sampled threshold", "Replacement selection"}, "Which edges collapse in a pass",
        "Sampled threshold: all that cost less than a sampled quantile, the best and fastest. Replacement selection: "
        "those that leave a small heap first, as Chen et al. have it."));
    parameters.addParam(RichInt("HeapRecords", 15, "Size of the heap",
                                "Of replacement selection: how many edges compete. At least 1."));
    parameters.addParam(RichEnum(
        "SelectedVertices", 0,
        {"Are like others", "Stay as they are", "Go along seams only", "Are kept as long as others can go"},
        "Vertices that are selected",
        "Stay as they are: bit for bit. If new vertices go where there are vertices, also: go along seams only, whatever "
        "else seams may do; or are kept as long as others can go: they cost a hundred times as much."));
    parameters.addParam(RichInt("Threads", 0, "Threads",
                                "How many threads work; 0: as many as the machine has. The result is the same."));
}

decimesh::Options read_engine(const RichParameterList &parameters) {
    decimesh::Options options;
    options.topology =
        parameters.getBool("KeepTopology") ? decimesh::Topology::keep : decimesh::Topology::relax_if_stuck;
    options.lock_boundary = parameters.getBool("LockBoundary");
    options.keep_seams = parameters.getBool("KeepSeams");
    options.cross_seams = parameters.getBool("CrossSeams");
    options.refine = parameters.getBool("Refine");
    options.attribute_weights.normals = parameters.getFloat("NormalWeight");
    options.attribute_weights.uvs = parameters.getFloat("UVWeight");
    options.attribute_weights.colors = parameters.getFloat("ColorWeight");
    options.selection = read_choice(parameters, "Selection", 2) == 0 ? decimesh::Selection::sampled_threshold
                                                                     : decimesh::Selection::replacement;
    options.heap_records = read_count(parameters, "HeapRecords");
    options.threads = read_count(parameters, "Threads");
    return options;
}

VertexSelection read_vertex_selection(const RichParameterList &parameters) {
    switch (read_choice(parameters, "SelectedVertices", 4)) {
    case 1: return VertexSelection::locked;
    case 2: return VertexSelection::along_seams;
    case 3: return VertexSelection::prioritized;
    default: return VertexSelection::ignored;
    }
}

decimesh::Target read_target(const RichParameterList &parameters) {
    switch (read_choice(parameters, "Target", 4)) {
    case to_vertices: return decimesh::Target::vertices(read_count(parameters, "TargetVertices"));
    case to_ratio: return decimesh::Target::ratio(as_typed(parameters.getFloat("Ratio")));
    case to_distance: return decimesh::Target::max_error(as_typed(parameters.getAbsPerc("MaxError")));
    default: return decimesh::Target::triangles(read_count(parameters, "TargetFaces"));
    }
}

}   // namespace

void add_simplify_parameters(const CMeshO &layer, RichParameterList &parameters) {
    const float diagonal = layer.bbox.IsNull() ? 1 : layer.bbox.Diag();
    parameters.addParam(RichEnum(
        "Target", to_faces, {"Number of faces", "Number of vertices", "Part of the faces", "Distance"}, "Simplify to",
        "Which of the four below is the target. If it cannot be met, the result is as small as the other options "
        "allow, and the log says why."));
    parameters.addParam(RichInt("TargetFaces", half_of_faces(layer), "Number of faces",
                                "At most so many faces are left: this number or one fewer."));
    parameters.addParam(RichInt("TargetVertices", layer.vn / 2, "Number of vertices",
                                "At most so many vertices that faces use are left."));
    parameters.addParam(RichFloat("Ratio", 0.5F, "Part of the faces", "This part of the faces is left: 0 to 1."));
    parameters.addParam(RichAbsPerc(
        "MaxError", diagonal / 1000, 0, diagonal, "Distance",
        "As few faces are left as a distance of this much from the original allows: estimated, unless it is proven."));
    parameters.addParam(RichBool(
        "Certify", false, "Prove the distance",
        "If the target is a distance: no point of either surface is farther from the other, proven. It keeps the "
        "topology, and takes 10 to 140 times as long."));
    parameters.addParam(RichEnum(
        "Placement", 0, {"Where the error is least", "Where there are vertices"}, "New vertices go",
        "Where the error is least, a vertex that two become is put there. Where there are vertices, it is one of the "
        "two: none is made or moved, and attributes count by their weights. That makes 1.3 to 2 times the error."));
    add_engine(parameters);
    add_scope(layer, parameters);
}

SimplifyRequest read_simplify_parameters(const RichParameterList &parameters) {
    SimplifyRequest request;
    request.scope = read_scope(parameters);
    decimesh::Options &options = request.simplification.options;
    options = read_engine(parameters);
    options.target = read_target(parameters);
    options.placement = read_choice(parameters, "Placement", 2) == 0 ? decimesh::Placement::optimal
                                                                     : decimesh::Placement::existing;
    request.simplification.selection = read_vertex_selection(parameters);
    if (parameters.getBool("Certify")) {
        if (options.target.kind() != decimesh::Target::Kind::max_error) {
            refuse("Certify", "is for a distance as the target");
        }
        request.guaranteed_error = options.target.value();
    }
    return request;
}

void add_choose_parameters(const CMeshO &layer, RichParameterList &parameters) {
    parameters.addParam(RichInt("TargetFaces", half_of_faces(layer), "Number of faces",
                                "At most so many faces are left: this number or one fewer, unless topology, seams or "
                                "folds forbid it before."));
    parameters.addParam(RichInt("Candidates", 6, "Candidates",
                                "Of so many vertices, drawn at random, the one that is seen least goes. At least 1."));
    parameters.addParam(RichInt("Seed", 0, "Seed",
                                "Where the random numbers start: the same seed gives the same result."));
    parameters.addParam(
        RichBool("LockSelectedVertices", false, "Keep selected vertices", "Vertices that are selected stay."));
    add_scope(layer, parameters);
}

ChooseRequest read_choose_parameters(const RichParameterList &parameters) {
    ChooseRequest request;
    request.scope = read_scope(parameters);
    request.faces = read_count(parameters, "TargetFaces");
    request.options.candidates = read_count(parameters, "Candidates");
    request.options.seed = read_count(parameters, "Seed");
    request.locks_selected_vertices = parameters.getBool("LockSelectedVertices");
    return request;
}

void add_levels_parameters(const CMeshO &layer, RichParameterList &parameters) {
    parameters.addParam(
        RichInt("Levels", 4, "How many levels", "Each becomes a layer. The original stays. At least 1."));
    parameters.addParam(RichFloat("Ratio", 0.5F, "From level to level",
                                  "Each level has this part of the faces of the one before: above 0 and below 1."));
    parameters.addParam(RichBool(
        "Nested", false, "On the vertices that there are",
        "All levels are made of vertices of the original, and each of vertices of the one before, so that they can "
        "share one vertex buffer. Otherwise each level has vertices of its own, where its error is least."));
    parameters.addParam(RichBool(
        "Certify", false, "Prove the distances",
        "Of levels on the vertices that there are: the log has the largest distance of each from the original as it is "
        "proven, not as it is estimated. Takes far longer."));
    add_engine(parameters);
    add_scope(layer, parameters);
}

LevelsRequest read_levels_parameters(const RichParameterList &parameters) {
    LevelsRequest request;
    request.scope = read_scope(parameters);
    request.simplification.options = read_engine(parameters);
    request.simplification.selection = read_vertex_selection(parameters);
    request.chain.count = read_count(parameters, "Levels");
    request.chain.ratio = as_typed(parameters.getFloat("Ratio"));
    request.chain.is_nested = parameters.getBool("Nested");
    request.chain.is_certified = parameters.getBool("Certify");
    if (request.chain.is_certified && !request.chain.is_nested) {
        refuse("Certify", "is for levels on the vertices that there are");
    }
    return request;
}

void add_deviation_parameters(MeshDocument &document, RichParameterList &parameters) {
    MeshModel *reference = document.mm();
    for (MeshModel *layer : document.meshList) {
        if (layer != document.mm()) {
            reference = layer;
            break;
        }
    }
    // MeshLab ends itself over a parameter that names no layer of a project.
    MeshDocument *const project = reference == nullptr ? nullptr : &document;
    parameters.addParam(RichMesh(
        "Reference", reference, project, "Distance from the layer",
        "Each vertex of the current layer gets its distance from the surface of this one as its quality, in the "
        "units of the positions. Both layers are taken where they stand, by their matrices."));
    parameters.addParam(RichInt("Samples", 500000, "Samples",
                                "Points on each surface, for the distances of both surfaces that the log has: RMS, "
                                "mean and largest."));
    parameters.addParam(RichInt("Seed", 0, "Seed", "Chooses the points: the same seed gives the same result."));
    parameters.addParam(RichBool("Bound", false, "Prove the largest distance",
                                 "Bounds the largest distance over all points of both surfaces, not over samples. "
                                 "Takes longer."));
    parameters.addParam(RichFloat("Tolerance", 0.01F, "Tolerance of the proof",
                                  "How far above the lower bound the upper may be, as a part of it. Not negative."));
    parameters.addParam(RichInt("Pieces", 5000000, "Pieces of the proof",
                                "How many pieces of triangles to look at before giving up on the tolerance: some "
                                "microseconds each, and at most about 120 bytes."));
    parameters.addParam(RichInt("Threads", 0, "Threads",
                                "How many threads work; 0: as many as the machine has. The result is the same."));
}

DeviationRequest read_deviation_parameters(const RichParameterList &parameters) {
    DeviationRequest request;
    request.reference = parameters.getMesh("Reference");
    decimesh::DeviationOptions &options = request.measurement.options;
    options.samples = read_count(parameters, "Samples");
    options.seed = read_count(parameters, "Seed");
    options.threads = read_count(parameters, "Threads");
    if (parameters.getBool("Bound")) {
        decimesh::BoundOptions bound;
        bound.tolerance = as_typed(parameters.getFloat("Tolerance"));
        bound.pieces = read_count(parameters, "Pieces");
        bound.threads = options.threads;
        request.measurement.bound = bound;
    }
    return request;
}

}   // namespace meshlab_plugin
