// Decomposes heights over a grid once, and takes meshes from that: by number, by error, and where somebody looks.

#include <decimesh.hpp>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <vector>

namespace {

constexpr std::size_t side = 257;   ///< 2^8 + 1: fits the hierarchy; any other size does as well
constexpr float spacing = 30;       ///< metres

/// The height, in metres, of a range of hills, rough in small.
float height(std::size_t column, std::size_t row) {
    const float x = static_cast<float>(column) / side;
    const float y = static_cast<float>(row) / side;
    return 300 * std::sin(7 * x) * std::cos(5 * y) + 40 * std::sin(41 * x + 13 * y) + 5 * std::sin(173 * x * y);
}

/// What a sample's error counts to a viewer who stands at one: less, the farther away it is.
float importance(std::size_t column, std::size_t row, std::size_t from_column, std::size_t from_row) {
    const float east = spacing * (static_cast<float>(column) - static_cast<float>(from_column));
    const float north = spacing * (static_cast<float>(row) - static_cast<float>(from_row));
    // What is seen of an error falls with the distance, and its square with the square of that.
    return 1 / (1 + (east * east + north * north) / (500.0F * 500.0F));
}

void print(const char *what, const decimesh::Taken &taken) {
    std::printf("%-24s %6zu vertices, RMS %5.2f m, maximum %5.1f m", what, taken.mesh.vertex_count(), taken.rms,
                taken.max_error);
    if (std::isfinite(taken.certified_gap)) {
        std::printf(", at most %.3f dB above the best", taken.certified_gap);
    }
    std::printf("\n");
}

}   // namespace

int main() {
    std::vector<float> heights;
    std::vector<float> seen;
    for (std::size_t row = 0; row < side; ++row) {
        for (std::size_t column = 0; column < side; ++column) {
            heights.push_back(height(column, row));
            seen.push_back(importance(column, row, 40, 200));
        }
    }
    try {
        decimesh::HierarchyOptions options;
        options.column_spacing = spacing;
        options.row_spacing = spacing;
        const decimesh::Hierarchy hierarchy = decimesh::Hierarchy::build(heights, side, options);
        const decimesh::Taken tenth = hierarchy.at(decimesh::Detail::ratio(0.1));
        const decimesh::Taken close = hierarchy.at(decimesh::Detail::max_error(2));
        print("a tenth:", tenth);
        print("no sample beyond 2 m:", close);
        print("as free triangles:", hierarchy.tin(tenth.mesh.vertex_count()));

        options.importance = seen;
        const decimesh::Hierarchy from_here = decimesh::Hierarchy::build(heights, side, options);
        print("as seen from a place:", from_here.at(decimesh::Detail::ratio(0.02)));

        const bool is_right = tenth.mesh.vertex_count() == (side * side + 5) / 10 && close.max_error <= 2;
        return is_right ? EXIT_SUCCESS : EXIT_FAILURE;
    } catch (const decimesh::Error &error) {
        std::fprintf(stderr, "%s\n", error.what());
        return EXIT_FAILURE;
    }
}
