// SPDX-License-Identifier: GPL-3.0-or-later
/// Layers taken apart and put together again, and what has to stay as it was on the way.

#include "conversion.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include <doctest/doctest.h>

#include "layers.hpp"
#include "reduction.hpp"

using namespace meshlab_plugin;

namespace {

/// A document with one layer.
struct Document {
    MeshDocument document;
    MeshModel &layer = *document.addNewMesh("", "layer");
    CMeshO &mesh = layer.cm;
};

/// The replacement that changes nothing.
Replacement same(const Part &part) {
    std::vector<std::uint32_t> sources(part.vertices.size());
    for (std::uint32_t vertex = 0; vertex < sources.size(); ++vertex) {
        sources[vertex] = vertex;
    }
    return unmoved(part, sources, part.indices, part.textures);
}

Simplification to_ratio(double ratio) {
    Simplification simplification;
    simplification.options.target = decimesh::Target::ratio(ratio);
    return simplification;
}

std::string refusal(const CMeshO &mesh, Extent extent, const Attributes &attributes) {
    try {
        take(mesh, extent, attributes);
    } catch (const std::invalid_argument &refused) {
        return refused.what();
    }
    return "taken";
}

/// Texture coordinates of wedges: charts of columns, each with coordinates of its own, on `textures` textures.
void add_charts(MeshModel &layer, int charts, int textures) {
    layer.updateDataMask(MeshModel::MM_WEDGTEXCOORD);
    for (CFaceO &face : layer.cm.face) {
        const float middle = (face.cP(0).X() + face.cP(1).X() + face.cP(2).X()) / 3;
        const int chart = static_cast<int>(middle * static_cast<float>(charts));
        for (int corner = 0; corner < 3; ++corner) {
            face.WT(corner).u() = face.cP(corner).X() + static_cast<float>(10 * chart);
            face.WT(corner).v() = face.cP(corner).Y();
            face.WT(corner).n() = static_cast<short>(chart % textures);
        }
    }
}

/// Texture coordinates are those of the place, on each chart, on the input. So they are on the result where vertices
/// stayed; where they moved, they are interpolated along edges, and the place need not be on the edge: `tolerance`.
void check_charts(const CMeshO &mesh, int textures, float tolerance) {
    for (const CFaceO &face : mesh.face) {
        const float chart = std::floor(face.cWT(0).u() / 10 + 0.01F);
        for (int corner = 0; corner < 3; ++corner) {
            CHECK(std::abs(face.cWT(corner).u() - (face.cP(corner).X() + 10 * chart)) <= tolerance);
            CHECK(std::abs(face.cWT(corner).v() - face.cP(corner).Y()) <= tolerance);
            CHECK(face.cWT(corner).n() == static_cast<short>(chart) % textures);
        }
    }
}

/// All of a mesh with the texture coordinates of its wedges.
Part take_with_wedges(const CMeshO &mesh) {
    Attributes attributes;
    attributes.wedge_uvs = true;
    return take(mesh, Extent::all_faces, attributes);
}

/// Half of the way between neighbours when this part is left of the faces of a field of 24 by 24 quads.
float half_edge(double ratio) {
    return 0.5F / 24 / static_cast<float>(std::sqrt(ratio));
}

}   // namespace

TEST_CASE("what is taken and put back unchanged is the same, with holes in the arrays") {
    for (std::uint32_t seed = 0; seed < 20; ++seed) {
        CAPTURE(seed);
        Document with;
        layers::add_bumps(with.mesh, 6);
        layers::Numbers numbers(seed);
        for (CFaceO &face : with.mesh.face) {
            if (numbers.below(4) == 0) {
                vcg::tri::Allocator<CMeshO>::DeleteFace(with.mesh, face);
            } else if (numbers.below(2) == 0) {
                face.SetS();
            }
        }
        vcg::tri::Clean<CMeshO>::RemoveUnreferencedVertex(with.mesh);
        const auto before = layers::faces(with.mesh);
        for (const Extent extent : {Extent::selected_faces, Extent::all_faces}) {
            const Part part = take(with.mesh, extent, {});
            put(with.mesh, part, same(part), extent == Extent::selected_faces);
            layers::check_sound(with.mesh);
            CHECK(layers::faces(with.mesh) == before);
        }
    }
}

TEST_CASE("vertices are taken once for each texture coordinate of their wedges, and put together again") {
    Document with;
    layers::add_bumps(with.mesh, 8);
    add_charts(with.layer, 4, 2);
    const Part part = take_with_wedges(with.mesh);
    // Three seams of nine vertices.
    CHECK(part.vertices.size() == 81 + 27);
    CHECK(part.has_several_textures);
    put(with.mesh, part, same(part), false);
    CHECK(with.mesh.vn == 81);
    check_charts(with.mesh, 2, 0);
    layers::check_sound(with.mesh);
}

TEST_CASE("seams of wedges stay closed, charts and textures apart, whichever engine simplifies") {
    for (const int textures : {1, 2, 3}) {
        for (const int engine : {0, 1, 2, 3}) {
            CAPTURE(textures);
            CAPTURE(engine);
            Document with;
            layers::add_bumps(with.mesh, 24);
            add_charts(with.layer, 4, textures);
            const Part part = take_with_wedges(with.mesh);
            Simplification simplification = to_ratio(0.3);
            if (engine == 1) {
                simplification.options.placement = decimesh::Placement::existing;
            }
            Replacement replacement;
            if (engine == 2) {
                replacement = choose(part, 400, {}).replacement;
            } else if (engine == 3) {
                Chain chain;
                chain.count = 2;
                chain.is_nested = true;
                replacement = build_levels(part, chain, simplification).back().replacement;
            } else {
                replacement = simplify(part, simplification).replacement;
            }
            put(with.mesh, part, replacement, false);
            layers::check_sound(with.mesh);
            CHECK(with.mesh.fn < 800);
            check_charts(with.mesh, textures, engine == 0 ? half_edge(0.3) : 0);
            // A seam that is open is a border; the only border is that of the square.
            int borders = 0;
            for (const auto &edge : layers::edges(layers::faces(with.mesh))) {
                borders += edge.second == 1 ? 1 : 0;
            }
            with.layer.updateDataMask(MeshModel::MM_FACEFACETOPO);
            int borders_of_topology = 0;
            for (CFaceO &face : with.mesh.face) {
                for (int corner = 0; corner < 3; ++corner) {
                    borders_of_topology += vcg::face::IsBorder(face, corner) ? 1 : 0;
                }
            }
            CHECK(borders == borders_of_topology);
            CHECK(vcg::tri::Clean<CMeshO>::CountConnectedComponents(with.mesh) == 1);
        }
    }
}

TEST_CASE("seams may part where that is wished for, and vertices are made for it") {
    Document with;
    layers::add_bumps(with.mesh, 24);
    add_charts(with.layer, 4, 1);
    const Part part = take_with_wedges(with.mesh);
    Simplification simplification = to_ratio(0.2);
    simplification.options.keep_seams = false;
    put(with.mesh, part, simplify(part, simplification).replacement, false);
    layers::check_sound(with.mesh);
    check_charts(with.mesh, 1, half_edge(0.2));
    CHECK(with.mesh.fn <= 230);
}

TEST_CASE("selected vertices go along seams alone where that is asked for, though others may go across") {
    Document with;
    layers::add_bumps(with.mesh, 24);
    add_charts(with.layer, 8, 1);
    for (CVertexO &vertex : with.mesh.vert) {
        vertex.SetS();
    }
    const Part part = take_with_wedges(with.mesh);
    Simplification simplification = to_ratio(0.05);
    simplification.options.placement = decimesh::Placement::existing;
    simplification.options.topology = decimesh::Topology::keep;
    const std::vector<std::uint32_t> along = simplify(part, simplification).replacement.indices;
    simplification.options.cross_seams = true;
    CHECK(simplify(part, simplification).replacement.indices != along);
    simplification.selection = VertexSelection::along_seams;
    CHECK(simplify(part, simplification).replacement.indices == along);
}

TEST_CASE("outside of a selection nothing changes, and its border does not crack") {
    for (std::uint32_t seed = 0; seed < 24; ++seed) {
        CAPTURE(seed);
        Document with;
        seed % 2 == 0 ? layers::add_torus(with.mesh, 20) : layers::add_bumps(with.mesh, 20);
        layers::Numbers numbers(seed);
        // Scattered faces, and a region: borders of every kind.
        layers::select_below(with.mesh, 0.1F * static_cast<float>(numbers.below(9)));
        for (CFaceO &face : with.mesh.face) {
            if (numbers.below(10) == 0) {
                face.IsS() ? face.ClearS() : face.SetS();
            }
        }
        const auto outside = layers::faces_if(with.mesh, false);
        const auto outside_edges = layers::edges(outside);
        const auto inside_edges = layers::edges(layers::faces_if(with.mesh, true));
        const auto all_edges = layers::edges(layers::faces(with.mesh));
        const int before = with.mesh.fn;

        const Part part = take(with.mesh, Extent::selected_faces, {});
        Simplification simplification = to_ratio(0.1);
        const int engine = static_cast<int>(numbers.below(3));
        if (engine == 1) {
            simplification.options.placement = decimesh::Placement::existing;
        }
        const Replacement replacement = engine == 2 ? choose(part, part.faces.size() / 10, {}).replacement
                                                    : simplify(part, simplification).replacement;
        put(with.mesh, part, replacement, true);

        layers::check_sound(with.mesh);
        CHECK(with.mesh.fn < before);
        CHECK(layers::faces_if(with.mesh, false) == outside);
        const auto inside_after = layers::edges(layers::faces_if(with.mesh, true));
        for (const auto &edge : outside_edges) {
            // Inner borders, of one face on each side, are of one face on each side still.
            if (all_edges.at(edge.first) == 2 && inside_edges.count(edge.first) == 1) {
                CHECK(inside_after.count(edge.first) == 1);
            }
        }
        // A vertex at the border is one vertex, not one for each side.
        std::set<layers::Bits> places;
        for (const CVertexO &vertex : with.mesh.vert) {
            places.insert(layers::bits(vertex.cP()));
        }
        CHECK(places.size() == with.mesh.vert.size());
    }
}

TEST_CASE("vertices that edges use stay") {
    Document with;
    layers::add_bumps(with.mesh, 10);
    const layers::Bits ends[] = {layers::bits(with.mesh.vert[37].cP()), layers::bits(with.mesh.vert[38].cP())};
    vcg::tri::Allocator<CMeshO>::AddEdge(with.mesh, 37, 38);
    const Part part = take(with.mesh, Extent::all_faces, {});
    CHECK(part.kept == std::vector<std::uint32_t>{37, 38});
    put(with.mesh, part, simplify(part, to_ratio(0.1)).replacement, false);
    layers::check_sound(with.mesh);
    CHECK(layers::bits(with.mesh.edge[0].cV(0)->cP()) == ends[0]);
    CHECK(layers::bits(with.mesh.edge[0].cV(1)->cP()) == ends[1]);
}

TEST_CASE("what cannot be taken is refused with its place") {
    Document with;
    CHECK(refusal(with.mesh, Extent::all_faces, {}) == "the layer has no faces");
    layers::add_bumps(with.mesh, 3);
    CHECK(refusal(with.mesh, Extent::selected_faces, {}) == "no face is selected");
    with.layer.updateDataMask(MeshModel::MM_WEDGTEXCOORD | MeshModel::MM_VERTTEXCOORD);
    const float nan = std::numeric_limits<float>::quiet_NaN();
    with.mesh.face[5].WT(1).u() = nan;
    Attributes attributes;
    attributes.wedge_uvs = true;
    CHECK(refusal(with.mesh, Extent::all_faces, attributes) ==
          "face 5 has a texture coordinate that is infinite or not a number");
    attributes = {};
    attributes.vertex_uvs = true;
    with.mesh.vert[4].T().v() = std::numeric_limits<float>::infinity();
    CHECK(refusal(with.mesh, Extent::all_faces, attributes) ==
          "vertex 4 has a texture coordinate that is infinite or not a number");
    CHECK(refusal(with.mesh, Extent::all_faces, {}) == "taken");
    with.mesh.vert[7].P().Y() = nan;
    CHECK(refusal(with.mesh, Extent::all_faces, {}) == "vertex 7 has a coordinate that is infinite or not a number");
    vcg::tri::Allocator<CMeshO>::DeleteVertex(with.mesh, with.mesh.vert[7]);
    for (CFaceO &face : with.mesh.face) {
        if (face.cV(0) == &with.mesh.vert[7] || face.cV(1) == &with.mesh.vert[7] || face.cV(2) == &with.mesh.vert[7]) {
            vcg::tri::Allocator<CMeshO>::DeleteFace(with.mesh, face);
        }
    }
    CHECK(refusal(with.mesh, Extent::all_faces, {}) == "taken");
}

TEST_CASE("normals that are none are taken as zero") {
    Document with;
    layers::add_bumps(with.mesh, 3);
    with.mesh.vert[2].N() = Point3m(1, 2, std::numeric_limits<float>::quiet_NaN());
    Attributes attributes;
    attributes.normals = true;
    const Part part = take(with.mesh, Extent::all_faces, attributes);
    CHECK(part.normals[6] == 0);
    CHECK(part.normals[8] == 0);
}

TEST_CASE("a mesh that stands elsewhere is placed there") {
    Document with;
    layers::add_bumps(with.mesh, 2);
    with.mesh.Tr.SetTranslate(10, 20, 30);
    const Placed placed = place(with.mesh);
    CHECK(placed.vertices.size() == 9);
    CHECK(placed.indices.size() == 24);
    CHECK(placed.positions[0] == doctest::Approx(10));
    CHECK(placed.positions[1] == doctest::Approx(20));
}
