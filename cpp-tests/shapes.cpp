#include "shapes.hpp"

#include <cmath>

namespace shapes {

namespace {

constexpr double pi = 3.14159265358979323846;

void add_quad(Shape &shape, std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    shape.indices.insert(shape.indices.end(), {a, b, c, a, c, d});
}

Point scaled(const Point &point, double factor) {
    Point result{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        result[axis] = static_cast<float>(point[axis] * factor);
    }
    return result;
}

}   // namespace

std::vector<std::uint16_t> Shape::short_indices() const {
    std::vector<std::uint16_t> result;
    result.reserve(indices.size());
    for (const std::uint32_t index : indices) {
        result.push_back(static_cast<std::uint16_t>(index));
    }
    return result;
}

Shape plane(std::uint32_t n) {
    Shape shape;
    for (std::uint32_t j = 0; j <= n; ++j) {
        for (std::uint32_t i = 0; i <= n; ++i) {
            const auto cells = static_cast<float>(n);
            shape.positions.push_back({static_cast<float>(i) / cells, static_cast<float>(j) / cells, 0});
        }
    }
    for (std::uint32_t j = 0; j < n; ++j) {
        for (std::uint32_t i = 0; i < n; ++i) {
            const std::uint32_t corner = j * (n + 1) + i;
            add_quad(shape, corner, corner + 1, corner + n + 2, corner + n + 1);
        }
    }
    return shape;
}

Shape sphere(std::uint32_t n, std::uint32_t m) {
    Shape shape;
    shape.positions.push_back({0, 0, -1});
    for (std::uint32_t j = 1; j < m; ++j) {
        const double latitude = pi * j / m;
        for (std::uint32_t i = 0; i < n; ++i) {
            const double longitude = 2 * pi * i / n;
            shape.positions.push_back({static_cast<float>(std::sin(latitude) * std::cos(longitude)),
                                       static_cast<float>(std::sin(latitude) * std::sin(longitude)),
                                       static_cast<float>(-std::cos(latitude))});
        }
    }
    shape.positions.push_back({0, 0, 1});
    const std::uint32_t north = (m - 1) * n + 1;
    const auto vertex = [n](std::uint32_t ring, std::uint32_t i) { return 1 + (ring - 1) * n + i % n; };
    for (std::uint32_t i = 0; i < n; ++i) {
        shape.indices.insert(shape.indices.end(), {0, vertex(1, i + 1), vertex(1, i)});
        for (std::uint32_t ring = 1; ring + 1 < m; ++ring) {
            add_quad(shape, vertex(ring, i), vertex(ring, i + 1), vertex(ring + 1, i + 1), vertex(ring + 1, i));
        }
        shape.indices.insert(shape.indices.end(), {vertex(m - 1, i), vertex(m - 1, i + 1), north});
    }
    return shape;
}

Shape stone(std::uint32_t n, std::uint32_t m) {
    Shape shape = sphere(n, m);
    for (Point &point : shape.positions) {
        const double lumps = 0.1 * std::sin(5.0 * point[0] + 1) * std::cos(4.0 * point[1] - 2);
        const double dents = 0.05 * std::sin(11.0 * point[2] + 3.0 * point[0]);
        point = scaled(point, 1 + lumps + dents);
    }
    return shape;
}

Shape torus(std::uint32_t n, std::uint32_t m) {
    Shape shape;
    for (std::uint32_t i = 0; i < n; ++i) {
        const double around = 2 * pi * i / n;
        for (std::uint32_t j = 0; j < m; ++j) {
            const double tube = 2 * pi * j / m;
            const double radius = 1 + 0.4 * std::cos(tube);
            shape.positions.push_back({static_cast<float>(radius * std::cos(around)),
                                       static_cast<float>(radius * std::sin(around)),
                                       static_cast<float>(0.4 * std::sin(tube))});
        }
    }
    const auto vertex = [n, m](std::uint32_t i, std::uint32_t j) { return i % n * m + j % m; };
    for (std::uint32_t i = 0; i < n; ++i) {
        for (std::uint32_t j = 0; j < m; ++j) {
            add_quad(shape, vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1), vertex(i, j + 1));
        }
    }
    return shape;
}

Shape cube_soup(std::uint32_t count) {
    // Corners by number, a bit an axis; each side counter-clockwise from outside.
    constexpr std::uint32_t sides[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                           {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
    Shape shape;
    for (std::uint32_t cube = 0; cube < count; ++cube) {
        for (const auto &side : sides) {
            for (const std::size_t place : {0U, 1U, 2U, 0U, 2U, 3U}) {
                const std::uint32_t corner = side[place];
                shape.indices.push_back(static_cast<std::uint32_t>(shape.positions.size()));
                shape.positions.push_back({static_cast<float>((corner & 1) + 3 * cube),
                                           static_cast<float>(corner >> 1 & 1), static_cast<float>(corner >> 2)});
            }
        }
    }
    return shape;
}

Dressed::Dressed(Shape undressed) : shape(std::move(undressed)) {
    for (const Point &point : shape.positions) {
        const double length = std::hypot(point[0], point[1], point[2]);
        normals.push_back(length > 0 ? scaled(point, 1 / length) : Point{0, 0, 1});
        uvs.push_back({point[0] / 2 + 0.5F, point[1] / 2 + 0.5F});
        const auto number = static_cast<std::uint32_t>(colors.size());
        colors.push_back({static_cast<std::uint8_t>(number % 251), static_cast<std::uint8_t>(number % 7), 100, 255});
    }
}

decimesh_buffers Dressed::raw() const {
    decimesh_buffers buffers;
    decimesh_buffers_init(&buffers, sizeof buffers);
    buffers.positions = shape.positions.data()->data();
    buffers.vertex_count = shape.positions.size();
    buffers.indices = shape.indices.data();
    buffers.index_count = shape.indices.size();
    buffers.normals = normals.data()->data();
    buffers.uvs = uvs.data()->data();
    buffers.colors = colors.data()->data();
    return buffers;
}

decimesh_mutable_buffers Dressed::raw_mutable() {
    decimesh_mutable_buffers buffers;
    decimesh_mutable_buffers_init(&buffers, sizeof buffers);
    buffers.positions = shape.positions.data()->data();
    buffers.vertex_count = shape.positions.size();
    buffers.indices = shape.indices.data();
    buffers.index_count = shape.indices.size();
    buffers.normals = normals.data()->data();
    buffers.uvs = uvs.data()->data();
    buffers.colors = colors.data()->data();
    return buffers;
}

decimesh::Mesh Dressed::mesh() const {
    return decimesh::Mesh::from_buffers(
        decimesh::Buffers<>{shape.positions, shape.indices, normals, uvs, colors});
}

Bytes Dressed::bytes() const {
    const auto of = [](const auto &values) { return bytes_of(decimesh::Span(values.data(), values.size())); };
    return of(shape.positions) + of(shape.indices) + of(normals) + of(uvs) + of(colors);
}

}   // namespace shapes
