#include "frame.hpp"

#include <cmath>
#include <vector>

#include <doctest/doctest.h>

#include "shapes.hpp"

using viewer::Frame;

TEST_CASE("frame: a mesh comes to the origin with a diagonal of 1") {
    const decimesh::Mesh mesh = shapes::pebble(20, {1000, -50, 7});
    const Frame frame = Frame::of(mesh);
    CHECK(frame.diagonal == doctest::Approx(mesh.statistics().diagonal));
    std::array<float, 3> low{1, 1, 1};
    std::array<float, 3> high{-1, -1, -1};
    for (std::size_t vertex = 0; vertex < mesh.vertex_count(); ++vertex) {
        const auto placed = frame.place(&mesh.positions()[3 * vertex]);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            low[axis] = std::min(low[axis], placed[axis]);
            high[axis] = std::max(high[axis], placed[axis]);
        }
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
        CHECK(low[axis] == doctest::Approx(-high[axis]));
    }
    CHECK(std::hypot(high[0] - low[0], high[1] - low[1], high[2] - low[2]) == doctest::Approx(1));
}

TEST_CASE("frame: vertices that no triangle uses do not count, and the ends of floats do not overflow") {
    const std::vector<float> positions{-3e38F, 0, 0, 3e38F, 0, 0, 0, 3e38F, 0, 0, 0, -3.4e38F};
    const std::vector<std::uint32_t> indices{0, 1, 2};
    const Frame frame = Frame::of(decimesh::Mesh::from_buffers(positions, indices));
    CHECK(std::isfinite(frame.diagonal));
    const auto placed = frame.place(&positions[3]);
    CHECK(placed[0] == doctest::Approx(2 / std::sqrt(5.0) / 2));
    CHECK(placed[2] == 0);
}

TEST_CASE("frame: triangles that are all one point have a frame") {
    const std::vector<float> positions{5, 5, 5, 5, 5, 5, 5, 5, 5};
    const std::vector<std::uint32_t> indices{0, 1, 2};
    const Frame frame = Frame::of(decimesh::Mesh::from_buffers(positions, indices));
    CHECK(frame.diagonal == 1);
    CHECK(frame.place(positions.data()) == std::array<float, 3>{0, 0, 0});
}
