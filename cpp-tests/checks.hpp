/// What must hold of results, whatever the mesh.

#ifndef DECIMESH_TESTS_CHECKS_HPP
#define DECIMESH_TESTS_CHECKS_HPP

#include <algorithm>
#include <array>
#include <cstring>
#include <string>
#include <vector>

#include <decimesh.hpp>
#include <doctest/doctest.h>

#include "bytes.hpp"

namespace checks {

using Bits = std::array<std::uint32_t, 3>;

/// The bits of a position: equal numbers need not be equal bits, and it is bits that are promised.
inline Bits bits(const float *position) {
    Bits result;
    std::memcpy(result.data(), position, sizeof result);
    return result;
}

/// The bits of all positions, in order.
inline std::vector<Bits> sorted_bits(decimesh::Span<const float> positions) {
    std::vector<Bits> result;
    for (std::size_t place = 0; place < positions.size(); place += 3) {
        result.push_back(bits(positions.data() + place));
    }
    std::sort(result.begin(), result.end());
    return result;
}

inline bool are_all_in(decimesh::Span<const float> positions, decimesh::Span<const float> among) {
    const std::vector<Bits> all = sorted_bits(among);
    const std::vector<Bits> asked = sorted_bits(positions);
    return std::all_of(asked.begin(), asked.end(),
                       [&](const Bits &position) { return std::binary_search(all.begin(), all.end(), position); });
}

/// Whole triangles of three different vertices that exist.
template <class Index>
void check_triangles(decimesh::Span<const Index> indices, std::size_t vertices) {
    REQUIRE(indices.size() % 3 == 0);
    std::size_t wrong = 0;
    for (std::size_t corner = 0; corner < indices.size(); corner += 3) {
        const Index a = indices[corner], b = indices[corner + 1], c = indices[corner + 2];
        wrong += a >= vertices || b >= vertices || c >= vertices || a == b || b == c || c == a;
    }
    CHECK(wrong == 0);
}

/// A mesh as a simplification must leave it, and a report that says so.
inline void check_result(decimesh::MeshView mesh, const decimesh::Report &report) {
    check_triangles(mesh.indices(), mesh.vertex_count());
    CHECK(report.triangles == mesh.triangle_count());
    CHECK(report.vertices == mesh.vertex_count());
    CHECK(report.error >= 0);
    CHECK(mesh.statistics().unreferenced_vertices == 0);
}

/// That `count` is what was asked for, or one less.
inline void check_count(std::size_t count, std::size_t wanted) {
    CHECK(count <= wanted);
    CHECK(count + 1 >= wanted);
}

/// Whether `text` has all of `words` in it.
inline bool says(const std::string &text, std::initializer_list<const char *> words) {
    return std::all_of(words.begin(), words.end(),
                       [&](const char *word) { return text.find(word) != std::string::npos; });
}

}   // namespace checks

#endif
