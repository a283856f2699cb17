/// \file
/// Meshes made by rule, to compare contenders on.
#pragma once

#include "mesh.hpp"

namespace comparison {

/// A closed surface with bumps of two sizes: 20 x 4^`halvings` triangles.
Mesh bumpy_sphere(int halvings);

/// A ring with a handle and with waves around it: 6 x `cells`² triangles.
Mesh wavy_torus(int cells);

/// Hills over a field whose outline is no straight line anywhere: 2 x `cells`² triangles.
Mesh wavy_field(int cells);

} // namespace comparison
