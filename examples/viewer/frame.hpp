/// Where a mesh is, and how large.

#ifndef VIEWER_FRAME_HPP
#define VIEWER_FRAME_HPP

#include <array>

#include <decimesh.hpp>

namespace viewer {

/// Takes a mesh to the origin and to a diagonal of 1. Coordinates of maps, far out and large, leave a graphics card's
/// floats no digits for detail; and the camera need not know what size things are.
struct Frame {
    std::array<double, 3> centre{};
    /// In units of the positions; above 0.
    double diagonal = 1;

    /// The frame of the box around the triangles of `mesh`. Linear time.
    static Frame of(decimesh::MeshView mesh);

    /// `position`, three numbers, in the frame: between -0.5 and 0.5 for what it was made of.
    std::array<float, 3> place(const float *position) const;
};

}   // namespace viewer

#endif
