// SPDX-License-Identifier: GPL-3.0-or-later
#include "layers.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <tuple>

#include <doctest/doctest.h>

namespace layers {

namespace {

/// A grid of vertices, whose last row and column are its first again if it is `closed`.
template <class At>
void add_grid(CMeshO &mesh, int size, bool closed, At at) {
    const int side = closed ? size : size + 1;
    const auto first = static_cast<int>(mesh.vert.size());
    const auto vertex = [&](int row, int column) { return first + (row % side) * side + column % side; };
    vcg::tri::Allocator<CMeshO>::AddVertices(mesh, static_cast<std::size_t>(side * side));
    for (int row = 0; row < side; ++row) {
        for (int column = 0; column < side; ++column) {
            mesh.vert[static_cast<std::size_t>(vertex(row, column))].P() =
                at(static_cast<float>(column) / static_cast<float>(size),
                   static_cast<float>(row) / static_cast<float>(size));
        }
    }
    const auto add = [&mesh](int a, int b, int c) {
        vcg::tri::Allocator<CMeshO>::AddFace(mesh, static_cast<std::size_t>(a), static_cast<std::size_t>(b),
                                             static_cast<std::size_t>(c));
    };
    for (int row = 0; row < size; ++row) {
        for (int column = 0; column < size; ++column) {
            add(vertex(row, column), vertex(row, column + 1), vertex(row + 1, column + 1));
            add(vertex(row, column), vertex(row + 1, column + 1), vertex(row + 1, column));
        }
    }
}

Face in_order(Face face) {
    std::rotate(face.begin(), std::min_element(face.begin(), face.end()), face.end());
    return face;
}

}   // namespace

void add_bumps(CMeshO &mesh, int size, float height) {
    add_grid(mesh, size, false, [height](float x, float y) {
        return Point3m(x, y, height * std::sin(9 * x) * std::cos(7 * y));
    });
}

void add_torus(CMeshO &mesh, int size) {
    add_grid(mesh, size, true, [](float x, float y) {
        const float around = 6.2831853F * x;
        const float along = 6.2831853F * y;
        const float radius = 0.3F + 0.03F * std::sin(5 * around) * std::sin(4 * along);
        const float ring = 1 + radius * std::cos(along);
        return Point3m(ring * std::cos(around), ring * std::sin(around), radius * std::sin(along));
    });
}

void finish(MeshModel &layer) {
    layer.updateDataMask(MeshModel::MM_VERTNORMAL);
    layer.UpdateBoxAndNormals();
}

void select_below(CMeshO &mesh, float limit) {
    for (CFaceO &face : mesh.face) {
        if (!face.IsD() && face.cV(0)->cP().X() < limit) {
            face.SetS();
        }
    }
}

Bits bits(const Point3m &point) {
    Bits result;
    std::memcpy(result.data(), point.V(), sizeof result);
    return result;
}

std::multiset<Face> faces(const CMeshO &mesh) {
    std::multiset<Face> all = faces_if(mesh, true);
    all.merge(faces_if(mesh, false));
    return all;
}

std::multiset<Face> faces_if(const CMeshO &mesh, bool selected) {
    std::multiset<Face> result;
    for (const CFaceO &face : mesh.face) {
        if (!face.IsD() && face.IsS() == selected) {
            result.insert(in_order({bits(face.cP(0)), bits(face.cP(1)), bits(face.cP(2))}));
        }
    }
    return result;
}

std::map<Edge, int> edges(const std::multiset<Face> &faces) {
    std::map<Edge, int> result;
    for (const Face &face : faces) {
        for (std::size_t corner = 0; corner < 3; ++corner) {
            ++result[std::minmax(face[corner], face[(corner + 1) % 3])];
        }
    }
    return result;
}

void check_sound(const CMeshO &mesh) {
    int vertices = 0;
    std::vector<bool> is_used(mesh.vert.size(), false);
    for (const CVertexO &vertex : mesh.vert) {
        vertices += vertex.IsD() ? 0 : 1;
    }
    int faces = 0;
    for (const CFaceO &face : mesh.face) {
        if (face.IsD()) {
            continue;
        }
        ++faces;
        for (int corner = 0; corner < 3; ++corner) {
            const std::size_t index = vcg::tri::Index(mesh, face.cV(corner));
            REQUIRE(index < mesh.vert.size());
            CHECK_FALSE(mesh.vert[index].IsD());
        }
        CHECK(face.cV(0) != face.cV(1));
        CHECK(face.cV(1) != face.cV(2));
        CHECK(face.cV(2) != face.cV(0));
    }
    CHECK(vertices == mesh.vn);
    CHECK(faces == mesh.fn);
}

bool Snapshot::operator==(const Snapshot &other) const {
    const auto all = [](const Snapshot &of) {
        return std::tie(of.faces, of.positions, of.normals, of.colors, of.qualities, of.layers);
    };
    return all(*this) == all(other);
}

Snapshot snapshot(const MeshDocument &document) {
    Snapshot result;
    result.layers = static_cast<std::size_t>(document.meshList.size());
    for (const MeshModel *layer : document.meshList) {
        result.faces.merge(faces(layer->cm));
        for (const CVertexO &vertex : layer->cm.vert) {
            if (!vertex.IsD()) {
                result.positions.push_back(bits(vertex.cP()));
                result.normals.push_back(bits(vertex.cN()));
                std::uint32_t color;
                std::memcpy(&color, vertex.cC().V(), sizeof color);
                result.colors.push_back(color);
                result.qualities.push_back(vertex.cQ());
            }
        }
    }
    return result;
}

}   // namespace layers
