#include "shapes.hpp"

#include <cmath>
#include <vector>

namespace shapes {

decimesh::Mesh pebble(std::uint32_t rings, std::array<float, 3> centre) {
    // Between the poles, rings of 2 * rings vertices: the triangles are those of rings - 1 bands, and two caps.
    constexpr float pi = 3.14159265F;
    const std::uint32_t sides = 2 * rings;
    std::vector<std::array<float, 3>> positions;
    const auto add = [&](float latitude, float longitude) {
        const float x = std::sin(latitude) * std::cos(longitude);
        const float y = std::cos(latitude);
        const float z = std::sin(latitude) * std::sin(longitude);
        const float radius = 1 + 0.15F * std::sin(4 * x + 1) * std::sin(5 * y) + 0.02F * std::sin(20 * z + 9 * x);
        positions.push_back({centre[0] + radius * x, centre[1] + radius * y, centre[2] + radius * z});
    };
    add(0, 0);
    for (std::uint32_t ring = 1; ring <= rings; ++ring) {
        for (std::uint32_t side = 0; side < sides; ++side) {
            add(pi * static_cast<float>(ring) / static_cast<float>(rings + 1),
                2 * pi * static_cast<float>(side) / static_cast<float>(sides));
        }
    }
    add(pi, 0);

    std::vector<std::uint32_t> indices;
    const auto at = [sides](std::uint32_t ring, std::uint32_t side) { return 1 + ring * sides + side % sides; };
    const auto last = static_cast<std::uint32_t>(positions.size() - 1);
    for (std::uint32_t side = 0; side < sides; ++side) {
        indices.insert(indices.end(), {0, at(0, side + 1), at(0, side)});
        indices.insert(indices.end(), {last, at(rings - 1, side), at(rings - 1, side + 1)});
        for (std::uint32_t ring = 0; ring + 1 < rings; ++ring) {
            const std::uint32_t a = at(ring, side), b = at(ring, side + 1);
            const std::uint32_t c = at(ring + 1, side), d = at(ring + 1, side + 1);
            indices.insert(indices.end(), {a, b, d, a, d, c});
        }
    }
    return decimesh::Mesh::from_buffers(positions, indices);
}

}   // namespace shapes
