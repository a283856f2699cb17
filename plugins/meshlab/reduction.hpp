// SPDX-License-Identifier: GPL-3.0-or-later
/// All calls of decimesh: parts of layers are simplified, and layers measured.
///
/// What fails throws what decimesh throws (`decimesh::Error`, `std::invalid_argument`); nothing of the caller's
/// changes.

#ifndef DECIMESH_MESHLAB_REDUCTION_HPP
#define DECIMESH_MESHLAB_REDUCTION_HPP

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "conversion.hpp"

namespace meshlab_plugin {

/// What came of a part, and how that went, in words.
struct Reduced {
    Replacement replacement;
    std::string summary;
};

/// What it means for a vertex to be selected: nothing; that it stays; that it goes along seams alone; that it is kept
/// as long as others can go.
enum class VertexSelection { ignored, locked, along_seams, prioritized };

/// How a part is simplified. Locks, flags, groups and tracking in `options` are not looked at: they come from the part.
struct Simplification {
    decimesh::Options options;
    VertexSelection selection = VertexSelection::ignored;
};

/// Simplifies `part` to the target of `simplification`. With `guaranteed_error` that is the target: a distance that no
/// point of either surface exceeds, proven. Where there are vertices that must be kept, the topology is, whatever the
/// options say: a border between what is simplified and what is not could be closed otherwise. See
/// `decimesh::simplify` and `simplify_within` for time and memory.
Reduced simplify(const Part &part, const Simplification &simplification,
                 std::optional<double> guaranteed_error = std::nullopt);

/// Simplifies `part` to at most `faces` as Jia, Tang and Pan do. The vertices that `options` locks are of `part`; its
/// kept ones are locked besides. See `decimesh::multiple_choice`.
Reduced choose(const Part &part, std::size_t faces, decimesh::MultipleChoiceOptions options);

/// Which levels are wanted.
struct Chain {
    std::size_t count = 1;         ///< how many, at least 1
    double ratio = 0.5;            ///< of faces from each level to the next, above 0 and below 1
    bool is_nested = false;        ///< whether all levels are made of vertices of the part
    bool is_certified = false;     ///< whether errors of nested levels are proven
};

/// Levels of detail of `part`, from fine to coarse, all from one run.
///
/// Throws `std::invalid_argument` if `chain` is not as it says there.
std::vector<Reduced> build_levels(const Part &part, const Chain &chain, const Simplification &simplification);

/// What is asked of a measurement besides the distances of vertices.
struct Measurement {
    decimesh::DeviationOptions options;
    std::optional<decimesh::BoundOptions> bound;    ///< whether to prove a largest distance, too
};

/// Distances of a layer from another.
struct Distances {
    std::vector<float> of_vertices;     ///< in the order of `Placed::vertices`
    std::string summary;
};

/// Measures how far `from` is from `to`: each vertex, and, where `from` has faces, both surfaces from each other.
///
/// Throws `std::invalid_argument` if `to` has no faces.
Distances measure(const Placed &from, const Placed &to, const Measurement &measurement);

}   // namespace meshlab_plugin

#endif
