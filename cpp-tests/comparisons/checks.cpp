#include "checks.hpp"

#include <CGAL/AABB_segment_primitive.h>
#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/Simple_cartesian.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace comparison {
namespace {

using Edge = std::pair<std::uint32_t, std::uint32_t>;
using Segment = std::array<Vector, 2>;

/// Faces at each edge.
std::map<Edge, std::size_t> edges(const Mesh &mesh) {
    std::map<Edge, std::size_t> faces;
    for (const auto &[a, b, c] : mesh.triangles)
        for (const auto &[from, to] : {Edge{a, b}, Edge{b, c}, Edge{c, a}})
            ++faces[std::minmax(from, to)];
    return faces;
}

using Kernel = CGAL::Simple_cartesian<double>;
using Segments = std::vector<Kernel::Segment_3>;
using Primitive = CGAL::AABB_segment_primitive<Kernel, Segments::const_iterator>;
using Tree = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>>;

Kernel::Point_3 point(const Vector &vector) { return {vector[0], vector[1], vector[2]}; }

double length(const Segment &segment) {
    const Vector direction = segment[1] - segment[0];
    return std::sqrt(dot(direction, direction));
}

std::vector<Vector> samples(const std::vector<Segment> &segments, std::size_t count) {
    double total = 0.0;
    for (const Segment &segment : segments)
        total += length(segment);
    const double step = total / static_cast<double>(count);
    std::vector<Vector> samples;
    double next = 0.5 * step;
    for (const Segment &segment : segments) {
        const double end = length(segment);
        for (; next < end; next += step)
            samples.push_back(segment[0] + (next / end) * (segment[1] - segment[0]));
        next -= end;
    }
    return samples;
}

BorderDistance directed(const std::vector<Segment> &from, const std::vector<Segment> &to, std::size_t count) {
    Segments primitives;
    for (const Segment &segment : to)
        primitives.emplace_back(point(segment[0]), point(segment[1]));
    Tree tree(primitives.cbegin(), primitives.cend());
    const std::vector<Vector> places = samples(from, count);
    double sum = 0.0;
    double maximum = 0.0;
    for (const Vector &place : places) {
        const double squared = tree.squared_distance(point(place));
        sum += squared;
        maximum = std::max(maximum, squared);
    }
    for (const Segment &segment : from)
        for (const Vector &end : segment)
            maximum = std::max(maximum, tree.squared_distance(point(end)));
    return {std::sqrt(sum / static_cast<double>(places.size())), std::sqrt(maximum)};
}

} // namespace

std::size_t flips(const Surface &original, const Surface &simplified) {
    const auto turned_over = [&](const std::array<Vector, 3> &corners) {
        const Vector centre = (1.0 / 3.0) * (corners[0] + corners[1] + corners[2]);
        const Vector normal = cross(corners[1] - corners[0], corners[2] - corners[0]);
        const auto against = [&](const Vector &place) {
            return dot(original.nearest(place).normal, normal) < 0.0;
        };
        return against(centre) && std::all_of(corners.begin(), corners.end(), [&](const Vector &corner) {
                   return against(0.5 * (centre + corner));
               });
    };
    const auto &faces = simplified.triangles();
    return static_cast<std::size_t>(std::count_if(faces.begin(), faces.end(), turned_over));
}

std::size_t non_manifold_edges(const Mesh &mesh) {
    const auto faces = edges(mesh);
    return static_cast<std::size_t>(
        std::count_if(faces.begin(), faces.end(), [](const auto &edge) { return edge.second > 2; }));
}

std::vector<Segment> border(const Mesh &mesh) {
    std::vector<Segment> segments;
    const auto position = [&](std::uint32_t index) -> Vector {
        const auto &[x, y, z] = mesh.positions.at(index);
        return {x, y, z};
    };
    for (const auto &[edge, faces] : edges(mesh))
        if (faces == 1)
            segments.push_back({position(edge.first), position(edge.second)});
    return segments;
}

BorderDistance border_distance(const Mesh &original, const Mesh &simplified, std::size_t samples) {
    const auto before = border(original);
    const auto after = border(simplified);
    if (before.empty() && after.empty())
        return {0.0, 0.0};
    if (before.empty() || after.empty()) {
        constexpr double infinity = std::numeric_limits<double>::infinity();
        return {infinity, infinity};
    }
    const BorderDistance there = directed(before, after, samples);
    const BorderDistance back = directed(after, before, samples);
    return {std::max(there.rms, back.rms), std::max(there.maximum, back.maximum)};
}

} // namespace comparison
