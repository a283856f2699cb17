/// What the viewer has decimesh do, on any thread.

#ifndef VIEWER_REDUCTION_HPP
#define VIEWER_REDUCTION_HPP

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include <decimesh.hpp>

#include "frame.hpp"

namespace viewer {

/// A mesh as it came.
struct Original {
    std::string path;
    decimesh::Mesh mesh;
    Frame frame;
};

/// By their names on decimesh's command line.
enum class Engine {
    hqms,              ///< vertices go where the error is least
    indices,           ///< vertices stay: fewer indices into the ones that there are
    multiple_choice,   ///< the same by the visual cost and random choices of Jia, Tang and Pan
};

inline constexpr std::array<Engine, 3> all_engines{Engine::hqms, Engine::indices, Engine::multiple_choice};

/// The engine's name on the command line.
const char *name_of(Engine engine);

/// What a surface is away from the original.
struct Distances {
    /// Of each vertex of the original from the surface, in units of the positions. (Those of the surface's own vertices
    /// would say little: where they stay, they are on the original, whatever is between them.)
    std::vector<float> of_vertices;
    /// Of those that a triangle uses.
    float largest = 0;
    float rms = 0;
};

/// A simplified mesh.
struct Reduced {
    Engine engine;
    decimesh::Mesh mesh;
    decimesh::StoppedBy stopped_by;   ///< why it is as large as it is
    Distances distances;
    double seconds;                   ///< that the simplification took
};

/// Nested levels: level 0 is the original, with its vertices in another order.
struct LevelSet {
    decimesh::NestedLevels levels;
    std::vector<Distances> distances;   ///< of level 0's vertices from each level
    double seconds;                     ///< that building took
};

/// Reads a file of any kind that decimesh knows. Throws `decimesh::Error`, also where there is no triangle to see.
Original read(const std::string &path);

/// Simplifies to `triangles`, and measures. Throws `decimesh::Error` if there would be nothing left to see, and what
/// decimesh throws.
Reduced reduce(const Original &original, Engine engine, std::size_t triangles, const decimesh::Progress &progress);

/// More than this would halve a mesh to nothing.
inline constexpr std::size_t most_levels = 24;

/// Builds `count` levels below the original, 1 to `most_levels`, each of half as many triangles as the one before, and
/// measures. Throws `decimesh::Error` for another count, and what decimesh throws.
LevelSet build_levels(const Original &original, std::size_t count, const decimesh::Progress &progress);

/// A level as a mesh of its own.
decimesh::Mesh mesh_of(const decimesh::NestedLevels &levels, std::size_t level);

}   // namespace viewer

#endif
