// SPDX-License-Identifier: GPL-3.0-or-later
/// The filters, as MeshLab loads and calls them, on documents that no file would give.

#include <algorithm>
#include <limits>
#include <set>
#include <vector>

#include <QPluginLoader>
#include <common/interfaces.h>
#include <doctest/doctest.h>

#include "layers.hpp"

namespace {

constexpr const char *names[] = {"decimesh: simplify (HQMS)", "decimesh: simplify keeping vertices (multiple choice)",
                                 "decimesh: levels of detail", "decimesh: deviation"};

MeshFilterInterface &plugin() {
    static QPluginLoader loader(PLUGIN);
    auto *filters = qobject_cast<MeshFilterInterface *>(loader.instance());
    REQUIRE_MESSAGE(filters != nullptr, loader.errorString().toStdString());
    return *filters;
}

std::vector<int> heard;
bool hear(int percent, const char *) {
    heard.push_back(percent);
    return true;
}
bool cancel(int, const char *) {
    return false;
}

RichParameterList defaults(const char *filter, MeshDocument &document) {
    RichParameterList parameters;
    plugin().initParameterSet(plugin().AC(QString(filter)), document, parameters);
    return parameters;
}

bool apply(const char *filter, MeshDocument &document, const RichParameterList &parameters,
           vcg::CallBackPos *callback = hear) {
    return plugin().applyFilter(plugin().AC(QString(filter)), document, parameters, callback);
}

MeshModel &add_torus(MeshDocument &document, int size = 60) {
    MeshModel &layer = *document.addNewMesh("", "torus");
    layers::add_torus(layer.cm, size);
    layers::finish(layer);
    return layer;
}

}   // namespace

TEST_CASE("every parameter has a name, a description and a tooltip, without a layer too") {
    MeshDocument document;
    for (const char *filter : names) {
        for (const RichParameter &parameter : defaults(filter, document)) {
            CHECK_FALSE(parameter.name().isEmpty());
            CHECK_FALSE(parameter.fieldDescription().isEmpty());
            CHECK_FALSE(parameter.toolTip().isEmpty());
        }
        CHECK_FALSE(apply(filter, document, defaults(filter, document)));
        CHECK(plugin().errorMsg() == "there is no layer");
    }
}

TEST_CASE("progress is told, from low to high, and ends what it answers false to, without a trace") {
    for (const char *filter : names) {
        CAPTURE(filter);
        MeshDocument document;
        add_torus(document);
        add_torus(document, 30);
        const layers::Snapshot before = layers::snapshot(document);
        CHECK_FALSE(apply(filter, document, defaults(filter, document), cancel));
        CHECK(plugin().errorMsg() == "cancelled; nothing has changed");
        CHECK(layers::snapshot(document) == before);
        heard.clear();
        CHECK(apply(filter, document, defaults(filter, document)));
        CHECK(plugin().errorMsg().isEmpty());
        CHECK_FALSE(heard.empty());
        CHECK(std::is_sorted(heard.begin(), heard.end()));
        CHECK(apply(filter, document, defaults(filter, document), nullptr));
        for (const MeshModel *layer : document.meshList) {
            layers::check_sound(layer->cm);
        }
    }
}

TEST_CASE("a position that is none is refused, and nothing changes") {
    for (const char *filter : names) {
        CAPTURE(filter);
        MeshDocument document;
        add_torus(document, 10);
        MeshModel &layer = add_torus(document, 10);
        layer.cm.vert[3].P().X() = std::numeric_limits<float>::quiet_NaN();
        const layers::Snapshot before = layers::snapshot(document);
        CHECK_FALSE(apply(filter, document, defaults(filter, document)));
        CHECK(plugin().errorMsg() == "vertex 3 has a coordinate that is infinite or not a number");
        CHECK(layers::snapshot(document) == before);
    }
}

TEST_CASE("meshes that are no surfaces are simplified") {
    for (const char *filter : {names[0], names[1], names[2]}) {
        CAPTURE(filter);
        MeshDocument document;
        MeshModel &layer = add_torus(document, 20);
        CMeshO &mesh = layer.cm;
        // Three and more faces at an edge, one face twice, one with a corner twice, and vertices of no face.
        vcg::tri::Allocator<CMeshO>::AddFace(mesh, 0, 1, 200);
        vcg::tri::Allocator<CMeshO>::AddFace(mesh, 0, 1, 300);
        vcg::tri::Allocator<CMeshO>::AddFace(mesh, 0, 1, 300);
        vcg::tri::Allocator<CMeshO>::AddFace(mesh, 5, 6, 9)->V(1) = &mesh.vert[5];
        vcg::tri::Allocator<CMeshO>::AddVertices(mesh, 7);
        CHECK(apply(filter, document, defaults(filter, document)));
        CHECK(document.meshList.back()->cm.fn < 810);
    }
}

TEST_CASE("vertices that are not moved keep all they have") {
    for (const char *filter : {names[0], names[1]}) {
        CAPTURE(filter);
        MeshDocument document;
        MeshModel &layer = add_torus(document, 30);
        layer.updateDataMask(MeshModel::MM_VERTCOLOR | MeshModel::MM_VERTQUALITY | MeshModel::MM_VERTTEXCOORD);
        std::map<layers::Bits, int> number_at;
        int number = 0;
        for (CVertexO &vertex : layer.cm.vert) {
            number_at[layers::bits(vertex.cP())] = number;
            vertex.Q() = static_cast<float>(number);
            vertex.T().u() = static_cast<float>(number);
            vertex.T().v() = 0;
            vertex.C() =
                vcg::Color4b(static_cast<unsigned char>(number), static_cast<unsigned char>(number / 256), 7, 9);
            ++number;
        }
        RichParameterList parameters = defaults(filter, document);
        if (filter == names[0]) {
            parameters.setValue("Placement", EnumValue(1));
        }
        CHECK(apply(filter, document, parameters));
        CHECK(layer.cm.fn <= 900);
        for (const CVertexO &vertex : layer.cm.vert) {
            const int was = number_at.at(layers::bits(vertex.cP()));
            CHECK(vertex.cQ() == static_cast<float>(was));
            CHECK(vertex.cT().u() == static_cast<float>(was));
            CHECK(vertex.cC()[0] == static_cast<unsigned char>(was));
            CHECK(vertex.cC()[1] == static_cast<unsigned char>(was / 256));
        }
    }
}

TEST_CASE("selected vertices stay where that is asked for, and are like others where not") {
    // How many of the selected ones are left, bit for bit.
    const auto survivors = [](const char *filter, const char *parameter, const Value &value, bool existing = false) {
        MeshDocument document;
        CMeshO &mesh = add_torus(document, 30).cm;
        std::set<layers::Bits> selected;
        for (std::size_t vertex = 0; vertex < mesh.vert.size(); vertex += 6) {
            mesh.vert[vertex].SetS();
            selected.insert(layers::bits(mesh.vert[vertex].cP()));
        }
        REQUIRE(selected.size() == 150);
        RichParameterList parameters = defaults(filter, document);
        parameters.setValue("TargetFaces", IntValue(450));
        parameters.setValue(parameter, value);
        if (existing) {
            parameters.setValue("Placement", EnumValue(1));
        }
        CHECK(apply(filter, document, parameters));
        std::size_t found = 0;
        for (const CVertexO &vertex : mesh.vert) {
            found += selected.count(layers::bits(vertex.cP()));
        }
        return found;
    };
    CHECK(survivors(names[0], "SelectedVertices", EnumValue(0)) < 75);
    CHECK(survivors(names[0], "SelectedVertices", EnumValue(1)) == 150);
    CHECK(survivors(names[0], "SelectedVertices", EnumValue(0), true) < 75);
    CHECK(survivors(names[0], "SelectedVertices", EnumValue(3), true) > 100);
    CHECK(survivors(names[1], "LockSelectedVertices", BoolValue(false)) < 75);
    CHECK(survivors(names[1], "LockSelectedVertices", BoolValue(true)) == 150);
}

TEST_CASE("normals are made anew of the faces where that is asked for, and carried over where not") {
    for (const int choice : {0, 1}) {
        CAPTURE(choice);
        MeshDocument document;
        MeshModel &layer = add_torus(document);
        RichParameterList parameters = defaults(names[0], document);
        parameters.setValue("Normals", EnumValue(choice));
        CHECK(apply(names[0], document, parameters));
        const layers::Snapshot left = layers::snapshot(document);
        layer.UpdateBoxAndNormals();
        CHECK((layers::snapshot(document).normals == left.normals) == (choice == 1));
    }
}

TEST_CASE("a selection is simplified by default, and stays selected") {
    for (const char *filter : {names[0], names[1], names[2]}) {
        CAPTURE(filter);
        MeshDocument document;
        MeshModel &layer = add_torus(document);
        layers::select_below(layer.cm, 0);
        const auto outside = layers::faces_if(layer.cm, false);
        CHECK(apply(filter, document, defaults(filter, document)));
        const CMeshO &result = document.meshList.back()->cm;
        CHECK(layers::faces_if(result, false) == outside);
        CHECK(layers::faces_if(result, true).size() < outside.size());
        layers::check_sound(result);
    }
}

TEST_CASE("the deviation of a layer that was moved is how far it was moved") {
    MeshDocument document;
    for (const float height : {0.0F, 0.25F}) {
        MeshModel &layer = *document.addNewMesh("", "plane");
        layers::add_bumps(layer.cm, 10, 0);
        layers::finish(layer);
        layer.cm.Tr.SetTranslate(0, 0, height);
    }
    CHECK(apply(names[3], document, defaults(names[3], document)));
    CHECK(document.mm()->hasDataMask(MeshModel::MM_VERTQUALITY));
    for (const CVertexO &vertex : document.mm()->cm.vert) {
        CHECK(vertex.cQ() == doctest::Approx(0.25));
    }
}
