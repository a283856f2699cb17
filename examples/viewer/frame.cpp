#include "frame.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace viewer {

Frame Frame::of(decimesh::MeshView mesh) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    std::array<double, 3> low{infinity, infinity, infinity};
    std::array<double, 3> high{-infinity, -infinity, -infinity};
    const auto positions = mesh.positions();
    for (const std::uint32_t vertex : mesh.indices()) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double at = positions[3 * std::size_t{vertex} + axis];
            low[axis] = std::min(low[axis], at);
            high[axis] = std::max(high[axis], at);
        }
    }
    if (mesh.triangle_count() == 0) {
        return {};
    }
    Frame frame;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        frame.centre[axis] = (low[axis] + high[axis]) / 2;
    }
    const double diagonal = std::hypot(high[0] - low[0], high[1] - low[1], high[2] - low[2]);
    // A mesh whose triangles are all one point.
    frame.diagonal = diagonal > 0 ? diagonal : 1;
    return frame;
}

std::array<float, 3> Frame::place(const float *position) const {
    std::array<float, 3> placed{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        placed[axis] = static_cast<float>((double{position[axis]} - centre[axis]) / diagonal);
    }
    return placed;
}

}   // namespace viewer
