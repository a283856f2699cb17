/// \file
/// The mesh that all contenders get and give back. Single precision, as graphics have it and as
/// decimesh takes it: none of them can gain by digits that another never saw.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace comparison {

using Point = std::array<float, 3>;
using Triangle = std::array<std::uint32_t, 3>;

struct Mesh {
    std::vector<Point> positions;
    std::vector<Triangle> triangles;
};

} // namespace comparison
