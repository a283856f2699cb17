/// \file
/// What a distance does not see: faces turned over, edges of more than two faces, borders that wandered.
#pragma once

#include "mesh.hpp"
#include "surface.hpp"

#include <cstddef>
#include <utility>
#include <vector>

namespace comparison {

/// Faces whose side is turned over. Near a crease, the closest original face may stand across to any
/// proper face, so one place alone proves nothing: a face counts where the original faces the other
/// way (more than 90 degrees off) at its centre and at all three places halfway to its corners.
/// Faces without area have no side, and do not count.
std::size_t flips(const Surface &original, const Surface &simplified);

/// Edges of more than two faces.
std::size_t non_manifold_edges(const Mesh &mesh);

/// Edges of one face.
std::vector<std::array<Vector, 2>> border(const Mesh &mesh);

/// How far two borders are apart.
struct BorderDistance {
    double rms;
    double maximum;
};

/// Of both directions the larger: samples evenly spread over the length, and for the maximum the ends
/// of the edges as well. Infinite where one mesh has a border and the other has none.
BorderDistance border_distance(const Mesh &original, const Mesh &simplified, std::size_t samples);

} // namespace comparison
