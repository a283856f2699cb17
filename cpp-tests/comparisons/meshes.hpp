/// \file
/// What the contenders are compared on.
#pragma once

#include "mesh.hpp"

#include <string>

namespace comparison {

/// A file of any format that CGAL knows (OFF, PLY, STL, OBJ); polygons are cut into fans.
Mesh read(const std::string &path);

/// A closed surface with bumps of two sizes: 20 x 4^`halvings` triangles.
Mesh bumpy_sphere(int halvings);

/// A ring with a handle and with waves around it: 6 x `cells`² triangles.
Mesh wavy_torus(int cells);

/// Hills over a field whose outline is no straight line anywhere: 2 x `cells`² triangles.
Mesh wavy_field(int cells);

} // namespace comparison
