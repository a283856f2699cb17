/// Meshes to try things on.

#ifndef VIEWER_TESTS_SHAPES_HPP
#define VIEWER_TESTS_SHAPES_HPP

#include <array>
#include <cstdint>

#include <decimesh.hpp>

namespace shapes {

/// A closed pebble of `4 * rings * rings` triangles, about 2 in size, around `centre`: with waves, so that
/// simplification has something to lose.
decimesh::Mesh pebble(std::uint32_t rings, std::array<float, 3> centre = {});

}   // namespace shapes

#endif
