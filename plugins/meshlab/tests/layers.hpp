// SPDX-License-Identifier: GPL-3.0-or-later
/// Layers to test with, and what can be asked of them.

#ifndef DECIMESH_MESHLAB_TESTS_LAYERS_HPP
#define DECIMESH_MESHLAB_TESTS_LAYERS_HPP

#include <array>
#include <cstdint>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include <common/meshmodel.h>

namespace layers {

using Bits = std::array<std::uint32_t, 3>;
/// Two places, the lesser first.
using Edge = std::pair<Bits, Bits>;
using Face = std::array<Bits, 3>;

/// A field of bumps over the unit square, of 2 `size`^2 faces; z is about `height`.
void add_bumps(CMeshO &mesh, int size, float height = 0.1F);

/// A closed surface of 2 `size`^2 faces: a torus with bumps.
void add_torus(CMeshO &mesh, int size);

/// Makes what MeshLab makes of a mesh that it has read.
void finish(MeshModel &layer);

/// Selects the faces whose first corner has an x below `limit`.
void select_below(CMeshO &mesh, float limit);

/// Numbers that look random, the same on each machine.
class Numbers {
public:
    explicit Numbers(std::uint32_t seed) : state_(seed) {}
    /// Below `bound`.
    std::uint32_t below(std::uint32_t bound) {
        state_ = state_ * 1664525U + 1013904223U;
        return static_cast<std::uint32_t>((std::uint64_t{state_} * bound) >> 32);
    }

private:
    std::uint32_t state_;
};

Bits bits(const Point3m &point);

/// Faces by the bits of their places, the least corner first: what a mesh is, whatever its numbers are.
std::multiset<Face> faces(const CMeshO &mesh);
std::multiset<Face> faces_if(const CMeshO &mesh, bool selected);

/// How many faces are at each edge.
std::map<Edge, int> edges(const std::multiset<Face> &faces);

/// Whether nothing refers to what is not there, and counts are as they should be.
void check_sound(const CMeshO &mesh);

/// Everything of a mesh that a filter may change, to see that none has.
struct Snapshot {
    std::multiset<Face> faces;
    std::vector<Bits> positions, normals;
    std::vector<std::uint32_t> colors;
    std::vector<float> qualities;
    std::size_t layers;
    bool operator==(const Snapshot &other) const;
};
Snapshot snapshot(const MeshDocument &document);

}   // namespace layers

#endif
