// SPDX-License-Identifier: GPL-3.0-or-later
#include "plugin.hpp"

#include <exception>
#include <new>
#include <stdexcept>
#include <vector>

#include <vcg/complex/append.h>

#include "parameters.hpp"

using namespace meshlab_plugin;

namespace {

decimesh::Progress progress_of(vcg::CallBackPos *callback, const char *what) {
    if (callback == nullptr) {
        return {};
    }
    return [callback, what](float fraction) { return callback(static_cast<int>(100 * fraction), what); };
}

Part take_from(const MeshModel &layer, const Scope &scope) {
    Attributes attributes;
    attributes.normals = scope.carries_normals;
    attributes.colors = layer.hasDataMask(MeshModel::MM_VERTCOLOR);
    attributes.vertex_uvs = layer.hasDataMask(MeshModel::MM_VERTTEXCOORD);
    attributes.wedge_uvs = layer.hasDataMask(MeshModel::MM_WEDGTEXCOORD);
    return take(layer.cm, scope.extent, attributes);
}

void put_into(MeshModel &layer, const Part &part, const Replacement &replacement, const Scope &scope) {
    const bool is_whole = scope.extent == Extent::all_faces;
    layer.clearDataMask(MeshModel::MM_FACEFACETOPO | MeshModel::MM_VERTFACETOPO);
    if (is_whole) {
        // Of faces that are no more, and of polygons that were drawn of several.
        layer.clearDataMask(MeshModel::MM_POLYGONAL | MeshModel::MM_FACECOLOR | MeshModel::MM_FACEQUALITY);
    }
    put(layer.cm, part, replacement, !is_whole);
    if (!scope.carries_normals) {
        layer.UpdateBoxAndNormals();
    }
}

MeshModel &current(MeshDocument &document) {
    if (document.mm() == nullptr) {
        throw std::invalid_argument("there is no layer");
    }
    return *document.mm();
}

/// A copy of `layer`, which has no deleted elements, as a new one.
MeshModel &duplicate(MeshDocument &document, MeshModel &layer, const QString &label) {
    MeshModel &copy = *document.addNewMesh("", label, false);
    copy.updateDataMask(layer.dataMask());
    copy.clearDataMask(MeshModel::MM_FACEFACETOPO | MeshModel::MM_VERTFACETOPO);
    vcg::tri::Append<CMeshO, CMeshO>::Mesh(copy.cm, layer.cm);
    copy.cm.Tr = layer.cm.Tr;
    return copy;
}

}   // namespace

DecimeshPlugin::DecimeshPlugin() {
    typeList << simplify << choose << levels << deviation;
    for (const FilterIDType filter : types()) {
        actionList << new QAction(filterName(filter), this);
    }
}

QString DecimeshPlugin::pluginName() const {
    return "decimesh";
}

QString DecimeshPlugin::filterName(FilterIDType filter) const {
    switch (filter) {
    case simplify: return "decimesh: simplify (HQMS)";
    case choose: return "decimesh: simplify keeping vertices (multiple choice)";
    case levels: return "decimesh: levels of detail";
    case deviation: return "decimesh: deviation";
    default: return {};
    }
}

QString DecimeshPlugin::filterInfo(FilterIDType filter) const {
    switch (filter) {
    case simplify:
        return "Simplifies the layer, or its selected faces, to as many faces as asked for, or as few as a distance "
               "allows, in linear time. Topology is kept where the target can be met with it, and seams stay closed. "
               "Colours, normals and texture coordinates are carried over; colours of faces are not.<br>"
               "After <i>Chen, Fahn, Tsai, Chen and Lin</i>: "
               "<b>\"A Linear Time Algorithm for High Quality Mesh Simplification\"</b>";
    case choose:
        return "Simplifies the layer, or its selected faces, by collapsing vertices into others: none is made or moved, "
               "and each keeps its attributes. Topology and seams are kept. <i>decimesh: simplify (HQMS)</i>, with new "
               "vertices where there are vertices, is faster and closer; this one is there to compare with.<br>"
               "After <i>Jia, Tang and Pan</i>: <b>\"Fast Mesh Simplification Algorithm Based on Edge Collapse\"</b>";
    case levels:
        return "Makes ever coarser levels of the layer, or of its selected faces, each as a new layer. The log says how "
               "far each is from the original.";
    case deviation:
        return "Measures how far each vertex of the current layer is from the surface of another, as its quality: "
               "<i>Colorize by vertex Quality</i> shows it. The log has the distances of both surfaces from each other.";
    default: return {};
    }
}

MeshFilterInterface::FilterClass DecimeshPlugin::getClass(QAction *action) {
    switch (ID(action)) {
    case levels: return FilterClass(Remeshing | Layer);
    case deviation: return FilterClass(Quality | Measure);
    default: return Remeshing;
    }
}

MeshFilterInterface::FILTER_ARITY DecimeshPlugin::filterArity(QAction *) const {
    return SINGLE_MESH;
}

int DecimeshPlugin::getPreConditions(QAction *action) const {
    return ID(action) == deviation ? MeshModel::MM_NONE : MeshModel::MM_FACENUMBER;
}

int DecimeshPlugin::postCondition(QAction *action) const {
    switch (ID(action)) {
    case levels: return MeshModel::MM_NONE;
    case deviation: return MeshModel::MM_VERTQUALITY;
    default: return MeshModel::MM_GEOMETRY_AND_TOPOLOGY_CHANGE;
    }
}

void DecimeshPlugin::initParameterSet(QAction *action, MeshDocument &document, RichParameterList &parameters) {
    // MeshLab asks without a layer, too; the filter then says that there is none.
    CMeshO nothing;
    const CMeshO &layer = document.mm() == nullptr ? nothing : document.mm()->cm;
    switch (ID(action)) {
    case simplify: add_simplify_parameters(layer, parameters); break;
    case choose: add_choose_parameters(layer, parameters); break;
    case levels: add_levels_parameters(layer, parameters); break;
    case deviation: add_deviation_parameters(document, parameters); break;
    default: break;
    }
}

bool DecimeshPlugin::applyFilter(QAction *action, MeshDocument &document, const RichParameterList &parameters,
                                 vcg::CallBackPos *callback) {
    errorMessage.clear();
    try {
        MeshModel &layer = current(document);
        switch (ID(action)) {
        case simplify: apply_simplify(layer, parameters, callback); break;
        case choose: apply_choose(layer, parameters, callback); break;
        case levels: apply_levels(document, parameters, callback); break;
        case deviation: apply_deviation(layer, parameters, callback); break;
        default: throw std::invalid_argument("there is no such filter");
        }
        return true;
    } catch (const decimesh::Cancelled &) {
        errorMessage = "cancelled; nothing has changed";
    } catch (const std::bad_alloc &) {
        errorMessage = "there is not enough memory";
    } catch (const std::exception &failure) {
        errorMessage = failure.what();
    }
    log(errorMessage.toStdString());
    return false;
}

void DecimeshPlugin::apply_simplify(MeshModel &layer, const RichParameterList &parameters,
                                    vcg::CallBackPos *callback) {
    SimplifyRequest request = read_simplify_parameters(parameters);
    request.simplification.options.progress = progress_of(callback, "decimesh: simplifying");
    const Part part = take_from(layer, request.scope);
    const Reduced reduced = meshlab_plugin::simplify(part, request.simplification, request.guaranteed_error);
    put_into(layer, part, reduced.replacement, request.scope);
    log(reduced.summary);
}

void DecimeshPlugin::apply_choose(MeshModel &layer, const RichParameterList &parameters, vcg::CallBackPos *callback) {
    ChooseRequest request = read_choose_parameters(parameters);
    request.options.progress = progress_of(callback, "decimesh: simplifying");
    const Part part = take_from(layer, request.scope);
    if (request.locks_selected_vertices) {
        for (std::uint32_t vertex = 0; vertex < part.is_selected.size(); ++vertex) {
            if (part.is_selected[vertex]) {
                request.options.locked_vertices.push_back(vertex);
            }
        }
    }
    const Reduced reduced = meshlab_plugin::choose(part, request.faces, request.options);
    put_into(layer, part, reduced.replacement, request.scope);
    log(reduced.summary);
}

void DecimeshPlugin::apply_levels(MeshDocument &document, const RichParameterList &parameters,
                                  vcg::CallBackPos *callback) {
    LevelsRequest request = read_levels_parameters(parameters);
    request.simplification.options.progress = progress_of(callback, "decimesh: building levels");
    MeshModel &layer = current(document);
    // Copies have no deleted elements; with none here, their numbers are the same there.
    layer.clearDataMask(MeshModel::MM_FACEFACETOPO | MeshModel::MM_VERTFACETOPO);
    vcg::tri::Allocator<CMeshO>::CompactEveryVector(layer.cm);
    const Part part = take_from(layer, request.scope);
    const std::vector<Reduced> reduced = build_levels(part, request.chain, request.simplification);
    for (std::size_t level = 0; level < reduced.size(); ++level) {
        const QString label = QString("%1, level %2").arg(layer.label()).arg(level + 1);
        put_into(duplicate(document, layer, label), part, reduced[level].replacement, request.scope);
        log("level " + std::to_string(level + 1) + ": " + reduced[level].summary);
    }
}

void DecimeshPlugin::apply_deviation(MeshModel &layer, const RichParameterList &parameters,
                                     vcg::CallBackPos *callback) {
    DeviationRequest request = read_deviation_parameters(parameters);
    request.measurement.options.progress = progress_of(callback, "decimesh: measuring");
    if (request.reference == nullptr) {
        throw std::invalid_argument("Reference is no layer of this project");
    }
    const Placed placed = place(layer.cm);
    const Distances distances = measure(placed, place(request.reference->cm), request.measurement);
    layer.updateDataMask(MeshModel::MM_VERTQUALITY);
    for (std::size_t vertex = 0; vertex < placed.vertices.size(); ++vertex) {
        layer.cm.vert[placed.vertices[vertex]].Q() = distances.of_vertices[vertex];
    }
    log("distance from " + request.reference->label().toStdString() + ": " + distances.summary);
}

void DecimeshPlugin::log(const std::string &line) {
    Log("decimesh: " + line);
}

MESHLAB_PLUGIN_NAME_EXPORTER(DecimeshPlugin)
