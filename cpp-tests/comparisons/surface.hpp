/// \file
/// A mesh as points in space: what is nearest to a place, and samples that stand for all of it. The
/// search is CGAL's, so that what is said about decimesh does not rest on decimesh.
#pragma once

#include "mesh.hpp"

#include <array>
#include <cstddef>
#include <memory>
#include <vector>

namespace comparison {

using Vector = std::array<double, 3>;

inline Vector operator+(const Vector &a, const Vector &b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
inline Vector operator-(const Vector &a, const Vector &b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
inline Vector operator*(double s, const Vector &v) { return {s * v[0], s * v[1], s * v[2]}; }
inline double dot(const Vector &a, const Vector &b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
inline Vector cross(const Vector &a, const Vector &b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

class Surface {
public:
    struct Nearest {
        double squared_distance;
        /// The normal of the triangle that is nearest, as long as twice its area.
        Vector normal;
    };

    /// Triangles without area do not count: their neighbours cover them.
    explicit Surface(const Mesh &mesh);
    ~Surface();
    Surface(Surface &&) noexcept;

    Nearest nearest(const Vector &place) const;

    /// Evenly spread over the area, and the same in each run: sample i lies in the triangle in which
    /// the share (i + 1/2) / `count` of the area is reached, triangles in their order.
    std::vector<Vector> samples(std::size_t count) const;

    /// The corners of the triangles, each vertex once.
    const std::vector<Vector> &vertices() const;

    /// Three corners a triangle.
    const std::vector<std::array<Vector, 3>> &triangles() const;

    /// Of the bounding box.
    double diagonal() const;

private:
    struct Parts;
    std::unique_ptr<Parts> parts;
};

} // namespace comparison
