/// A landscape to try things on, 1000 m wide.

#ifndef HILLS_HPP
#define HILLS_HPP

#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

/// A vertex as a renderer might have it.
struct Vertex {
    std::array<float, 3> position;
    std::array<float, 3> normal;
    std::array<float, 2> uv;
};

struct Hills {
    std::vector<Vertex> vertices;
    std::vector<std::uint32_t> indices;

    /// `cells` by `cells` squares of two triangles each.
    explicit Hills(std::uint32_t cells) {
        for (std::uint32_t j = 0; j <= cells; ++j) {
            for (std::uint32_t i = 0; i <= cells; ++i) {
                vertices.push_back(vertex(static_cast<float>(i) / static_cast<float>(cells),
                                          static_cast<float>(j) / static_cast<float>(cells)));
            }
        }
        for (std::uint32_t j = 0; j < cells; ++j) {
            for (std::uint32_t i = 0; i < cells; ++i) {
                const std::uint32_t a = j * (cells + 1) + i, b = a + 1, c = b + cells + 1, d = a + cells + 1;
                indices.insert(indices.end(), {a, b, c, a, c, d});
            }
        }
    }

private:
    static Vertex vertex(float u, float v) {
        const float slope_x = 1.5F * std::cos(25 * u) + 0.405F * std::cos(90 * u + 30 * v);
        const float slope_y = -0.8F * std::sin(20 * v) + 0.135F * std::cos(90 * u + 30 * v);
        const float length = std::hypot(slope_x, slope_y, 1.0F);
        const float height = 60 * std::sin(25 * u) + 40 * std::cos(20 * v) + 4.5F * std::sin(90 * u + 30 * v);
        return {{1000 * u, 1000 * v, height}, {-slope_x / length, -slope_y / length, 1 / length}, {u, v}};
    }
};

#endif
