/// \file
/// Meshes from files and to files, by decimesh: any format that it knows.
#pragma once

#include "mesh.hpp"

#include <string>

namespace comparison {

/// PLY, OBJ, STL, OFF, glTF or GLB, as the extension says; polygons are cut into fans. What goes wrong is
/// thrown as `std::runtime_error`, here as below.
Mesh read(const std::string &path);

/// The same with one vertex for all that lie at one place: a surface for libraries that know no seams.
Mesh read_welded(const std::string &path);

/// Binary, where the format has a choice. The file appears whole or not at all.
void write(const Mesh &mesh, const std::string &path);

} // namespace comparison
