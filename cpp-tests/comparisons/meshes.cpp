#include "meshes.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace comparison {
namespace {

constexpr double turn = 6.283185307179586;

Point point(double x, double y, double z) {
    return {static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)};
}

/// Two triangles for each cell of a grid, `index` says which vertex is where.
template <typename Index> void add_cells(Mesh &mesh, int columns, int rows, const Index &index) {
    for (int row = 0; row < rows; ++row) {
        for (int column = 0; column < columns; ++column) {
            const auto a = index(column, row);
            const auto b = index(column + 1, row);
            const auto c = index(column + 1, row + 1);
            const auto d = index(column, row + 1);
            mesh.triangles.push_back({a, b, c});
            mesh.triangles.push_back({a, c, d});
        }
    }
}

Mesh icosahedron() {
    const double golden = 0.5 * (1.0 + std::sqrt(5.0));
    Mesh mesh;
    for (const double side : {-1.0, 1.0})
        for (const double end : {-golden, golden}) {
            mesh.positions.push_back(point(0.0, side, end));
            mesh.positions.push_back(point(side, end, 0.0));
            mesh.positions.push_back(point(end, 0.0, side));
        }
    const auto squared = [&](std::size_t a, std::size_t b) {
        double sum = 0.0;
        for (std::size_t axis = 0; axis < 3; ++axis)
            sum += std::pow(mesh.positions[a][axis] - mesh.positions[b][axis], 2);
        return sum;
    };
    const auto is_edge = [&](std::size_t a, std::size_t b) { return squared(a, b) < 4.5; };
    for (std::uint32_t a = 0; a < 12; ++a)
        for (std::uint32_t b = a + 1; b < 12; ++b)
            for (std::uint32_t c = b + 1; c < 12; ++c) {
                if (!is_edge(a, b) || !is_edge(b, c) || !is_edge(c, a))
                    continue;
                const auto &p = mesh.positions[a];
                const auto &q = mesh.positions[b];
                const auto &r = mesh.positions[c];
                const double volume = p[0] * (q[1] * r[2] - q[2] * r[1]) + p[1] * (q[2] * r[0] - q[0] * r[2]) +
                                      p[2] * (q[0] * r[1] - q[1] * r[0]);
                mesh.triangles.push_back(volume > 0.0 ? Triangle{a, b, c} : Triangle{a, c, b});
            }
    return mesh;
}

/// Each triangle into four.
Mesh halved(const Mesh &mesh) {
    Mesh finer;
    finer.positions = mesh.positions;
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
        const auto next = static_cast<std::uint32_t>(finer.positions.size());
        const auto [place, is_new] = middles.try_emplace(std::minmax(a, b), next);
        if (is_new) {
            const auto &p = mesh.positions[a];
            const auto &q = mesh.positions[b];
            finer.positions.push_back(point(0.5 * (p[0] + q[0]), 0.5 * (p[1] + q[1]), 0.5 * (p[2] + q[2])));
        }
        return place->second;
    };
    for (const auto &[a, b, c] : mesh.triangles) {
        const auto ab = middle(a, b);
        const auto bc = middle(b, c);
        const auto ca = middle(c, a);
        finer.triangles.insert(finer.triangles.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
    }
    return finer;
}

} // namespace

Mesh bumpy_sphere(int halvings) {
    Mesh mesh = icosahedron();
    for (int halving = 0; halving < halvings; ++halving)
        mesh = halved(mesh);
    for (Point &position : mesh.positions) {
        const double x = position[0];
        const double y = position[1];
        const double z = position[2];
        const double length = std::sqrt(x * x + y * y + z * z);
        const double hills = std::sin(4.0 * x / length) * std::sin(5.0 * y / length) * std::sin(3.0 * z / length);
        const double grains = std::sin(17.0 * x / length) * std::sin(19.0 * y / length + 1.0);
        const double radius = 1.0 + 0.2 * hills + 0.03 * grains;
        position = point(radius * x / length, radius * y / length, radius * z / length);
    }
    return mesh;
}

Mesh wavy_torus(int cells) {
    const int around = 3 * cells;
    Mesh mesh;
    for (int row = 0; row < cells; ++row)
        for (int column = 0; column < around; ++column) {
            const double along = turn * column / around;
            const double across = turn * row / cells;
            const double thickness = 0.35 + 0.04 * std::sin(7.0 * along + across);
            const double distance = 1.0 + thickness * std::cos(across);
            mesh.positions.push_back(point(distance * std::cos(along), distance * std::sin(along),
                                           thickness * std::sin(across) + 0.1 * std::sin(3.0 * along)));
        }
    add_cells(mesh, around, cells, [&](int column, int row) {
        return static_cast<std::uint32_t>((row % cells) * around + column % around);
    });
    return mesh;
}

Mesh wavy_field(int cells) {
    Mesh mesh;
    for (int row = 0; row <= cells; ++row)
        for (int column = 0; column <= cells; ++column) {
            const double u = 2.0 * column / cells - 1.0;
            const double v = 2.0 * row / cells - 1.0;
            const double x = u * (1.0 + 0.1 * std::cos(5.0 * v));
            const double y = v * (1.0 + 0.1 * std::cos(4.0 * u + 1.0));
            const double height = 0.15 * std::sin(4.0 * x + y) * std::cos(3.0 * y) + 0.02 * std::sin(15.0 * x * y);
            mesh.positions.push_back(point(x, y, height));
        }
    add_cells(mesh, cells, cells, [&](int column, int row) {
        return static_cast<std::uint32_t>(row * (cells + 1) + column);
    });
    return mesh;
}

} // namespace comparison
