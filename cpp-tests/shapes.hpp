/// Meshes made by rule, with known properties, and attributes to go with them.

#ifndef DECIMESH_TESTS_SHAPES_HPP
#define DECIMESH_TESTS_SHAPES_HPP

#include <array>
#include <cstdint>
#include <vector>

#include <decimesh.hpp>

#include "bytes.hpp"

namespace shapes {

using Point = std::array<float, 3>;

struct Shape {
    std::vector<Point> positions;
    std::vector<std::uint32_t> indices;

    std::size_t triangles() const { return indices.size() / 3; }
    std::vector<std::uint16_t> short_indices() const;
    decimesh::Mesh mesh() const { return decimesh::Mesh::from_buffers(positions, indices); }
};

/// The unit square in the plane z = 0, `n` by `n` cells: 2n² triangles.
Shape plane(std::uint32_t n);

/// The unit sphere, `n` cells round and `m` from pole to pole: 2n(m - 1) triangles.
Shape sphere(std::uint32_t n, std::uint32_t m);

/// The sphere with dents and lumps, so that no two of its edges cost the same.
Shape stone(std::uint32_t n, std::uint32_t m);

/// A torus, `n` cells round the axis and `m` round the tube: 2nm triangles.
Shape torus(std::uint32_t n, std::uint32_t m);

/// `count` unit cubes in a row; their triangles share no vertices: 12 triangles and 36 vertices each.
Shape cube_soup(std::uint32_t count);

/// A shape with an attribute of each kind, different from vertex to vertex.
struct Dressed {
    explicit Dressed(Shape shape);

    /// What the C interface takes, valid as long as this stays where it is.
    decimesh_buffers raw() const;
    /// The same, to write to.
    decimesh_mutable_buffers raw_mutable();
    decimesh::Mesh mesh() const;
    Bytes bytes() const;

    Shape shape;
    std::vector<Point> normals;
    std::vector<std::array<float, 2>> uvs;
    std::vector<std::array<std::uint8_t, 4>> colors;
};

}   // namespace shapes

#endif
