/// \file
/// A mesh as decimesh's C interface has it.
#pragma once

#include "mesh.hpp"

#include <decimesh.h>

#include <memory>

namespace comparison {

struct Destroy {
    void operator()(decimesh_mesh *mesh) const { decimesh_mesh_destroy(mesh); }
};
using Handle = std::unique_ptr<decimesh_mesh, Destroy>;

/// Throws what the library says as `std::runtime_error`, unless all went well.
void check(decimesh_status status);

Handle to_decimesh(const Mesh &mesh);
Mesh from_decimesh(const decimesh_mesh *mesh);

} // namespace comparison
