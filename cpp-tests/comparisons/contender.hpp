/// \file
/// Who can simplify. All take the same buffers and give buffers back; between the two they work on a
/// mesh of their own, so that what it costs to come to it can be told from what it costs to simplify.
#pragma once

#include "mesh.hpp"

#include <cstddef>
#include <functional>
#include <memory>
#include <string>

namespace comparison {

/// A contender's own copy of a mesh. What goes wrong is thrown as `std::runtime_error`.
class Task {
public:
    virtual ~Task() = default;

    /// Once only.
    virtual void simplify(std::size_t triangles) = 0;

    /// What `simplify` left.
    virtual Mesh result() = 0;
};

struct Contender {
    std::string name;
    /// Whose it is, with its version.
    std::string library;
    std::function<std::unique_ptr<Task>(const Mesh &)> load;
};

/// All defaults, but for the threads; 0 are all that the machine has.
Contender decimesh_default(unsigned threads);

/// The cost and the placement that CGAL takes if nothing is said.
Contender cgal_lindstrom_turk();

/// Garland and Heckbert's quadrics of planes, with optimal placement.
Contender cgal_garland_heckbert();

/// A queue of half-edge collapses by quadrics.
Contender openmesh_quadric();

/// The same costs, but the best of ten halfedges drawn at random.
Contender openmesh_multiple_choice();

/// Collapses into vertices of the input.
Contender meshoptimizer_simplify();

/// Moves the vertices too.
Contender meshoptimizer_update();

/// Clusters of vertices: no collapses, and no regard for the topology.
Contender meshoptimizer_sloppy();

} // namespace comparison
