#include "surface.hpp"

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Simple_cartesian.h>

#include <cmath>
#include <stdexcept>

namespace comparison {
namespace {

using Kernel = CGAL::Simple_cartesian<double>;
using Triangles = std::vector<Kernel::Triangle_3>;
using Primitive = CGAL::AABB_triangle_primitive<Kernel, Triangles::const_iterator>;
using Tree = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>>;

Vector normal(const std::array<Vector, 3> &corners) {
    return cross(corners[1] - corners[0], corners[2] - corners[0]);
}

Kernel::Point_3 point(const Vector &vector) { return {vector[0], vector[1], vector[2]}; }

/// The multiples of the plane's "golden ratio" (the root of x³ = x + 1) and of its square: points of
/// low discrepancy, as Roberts has them. The odd ones out are folded back into the triangle.
Vector spread(const std::array<Vector, 3> &corners, std::size_t index) {
    constexpr double ratio = 1.32471795724474602596;
    const auto fraction = [](double value) { return value - std::floor(value); };
    double u = fraction(0.5 + static_cast<double>(index) / ratio);
    double v = fraction(0.5 + static_cast<double>(index) / (ratio * ratio));
    if (u + v > 1.0) {
        u = 1.0 - u;
        v = 1.0 - v;
    }
    return corners[0] + u * (corners[1] - corners[0]) + v * (corners[2] - corners[0]);
}

} // namespace

struct Surface::Parts {
    std::vector<Vector> vertices;
    std::vector<std::array<Vector, 3>> triangles;
    Triangles primitives;
    Tree tree;
    double diagonal = 0.0;
};

Surface::Surface(const Mesh &mesh) : parts(std::make_unique<Parts>()) {
    std::vector<bool> used(mesh.positions.size(), false);
    const auto position = [&](std::uint32_t index) -> Vector {
        const auto &[x, y, z] = mesh.positions.at(index);
        return {x, y, z};
    };
    for (const auto &[a, b, c] : mesh.triangles) {
        const std::array<Vector, 3> corners{position(a), position(b), position(c)};
        const Vector direction = normal(corners);
        if (!(dot(direction, direction) > 0.0))
            continue;
        parts->triangles.push_back(corners);
        parts->primitives.emplace_back(point(corners[0]), point(corners[1]), point(corners[2]));
        for (const auto index : {a, b, c}) {
            if (!used[index])
                parts->vertices.push_back(position(index));
            used[index] = true;
        }
    }
    if (parts->triangles.empty())
        throw std::runtime_error("a mesh without area is no surface");
    parts->tree.rebuild(parts->primitives.cbegin(), parts->primitives.cend());
    parts->tree.accelerate_distance_queries();
    const auto box = parts->tree.bbox();
    parts->diagonal = std::hypot(box.xmax() - box.xmin(), box.ymax() - box.ymin(), box.zmax() - box.zmin());
}

Surface::~Surface() = default;
Surface::Surface(Surface &&) noexcept = default;

Surface::Nearest Surface::nearest(const Vector &place) const {
    const auto query = point(place);
    const auto [nearest, primitive] = parts->tree.closest_point_and_primitive(query);
    const auto triangle = static_cast<std::size_t>(primitive - parts->primitives.cbegin());
    return {CGAL::squared_distance(query, nearest), normal(parts->triangles[triangle])};
}

std::vector<Vector> Surface::samples(std::size_t count) const {
    std::vector<double> reached;
    reached.reserve(parts->triangles.size());
    double total = 0.0;
    for (const auto &corners : parts->triangles) {
        const Vector direction = normal(corners);
        reached.push_back(total += std::sqrt(dot(direction, direction)));
    }
    std::vector<Vector> samples;
    samples.reserve(count);
    std::size_t triangle = 0;
    for (std::size_t index = 0; index < count; ++index) {
        const double share = (static_cast<double>(index) + 0.5) / static_cast<double>(count);
        while (triangle + 1 < reached.size() && reached[triangle] < share * total)
            ++triangle;
        samples.push_back(spread(parts->triangles[triangle], index));
    }
    return samples;
}

const std::vector<Vector> &Surface::vertices() const { return parts->vertices; }

const std::vector<std::array<Vector, 3>> &Surface::triangles() const { return parts->triangles; }

double Surface::diagonal() const { return parts->diagonal; }

} // namespace comparison
