// A plate of 8 x 8 squares becomes two triangles, in C++. What scripts/consumers.sh builds in every way there is.

#include <decimesh.hpp>

#include <array>
#include <cstdint>
#include <cstdlib>
#include <exception>
#include <iostream>
#include <string>
#include <vector>

namespace {

constexpr std::uint32_t side = 8;
constexpr std::uint32_t row = side + 1;

decimesh::Mesh plate() {
    std::vector<std::array<float, 3>> positions;
    for (std::uint32_t v = 0; v < row * row; ++v) {
        positions.push_back({static_cast<float>(v % row), static_cast<float>(v / row), 0.0F});
    }
    std::vector<std::uint32_t> indices;
    for (std::uint32_t square = 0; square < side * side; ++square) {
        const std::uint32_t corner = square / side * row + square % side;
        indices.insert(indices.end(), {corner, corner + 1, corner + row, corner + 1, corner + row + 1, corner + row});
    }
    return decimesh::Mesh::from_buffers(positions, indices);
}

}   // namespace

int main() try {
    const decimesh::Mesh mesh = plate();
    decimesh::Options options;
    options.target = decimesh::Target::triangles(2);
    const decimesh::Simplified simplified = decimesh::simplify(mesh, options);

    std::cout << "C++, decimesh " << decimesh::version() << ": " << mesh.triangle_count() << " triangles become "
              << simplified.mesh.triangle_count() << '\n';
    const std::string compiled = std::to_string(DECIMESH_VERSION_MAJOR) + '.' +
                                 std::to_string(DECIMESH_VERSION_MINOR) + '.' + std::to_string(DECIMESH_VERSION_PATCH);
    return simplified.mesh.triangle_count() == 2 && decimesh::version() == compiled ? EXIT_SUCCESS : EXIT_FAILURE;
} catch (const std::exception &error) {
    std::cerr << error.what() << '\n';
    return EXIT_FAILURE;
}
