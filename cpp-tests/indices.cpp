/// The calls for engines, on the caller's own buffers.

#include <algorithm>
#include <type_traits>

#include <decimesh.hpp>
#include <doctest/doctest.h>

#include "checks.hpp"
#include "shapes.hpp"

using decimesh::Options;
using decimesh::Span;
using decimesh::Target;

TEST_SUITE_BEGIN("quick");

namespace {

template <class Index>
std::vector<Index> indices_of(const shapes::Shape &shape) {
    return std::vector<Index>(shape.indices.begin(), shape.indices.end());
}

template <>
std::vector<std::uint16_t> indices_of(const shapes::Shape &shape) {
    return shape.short_indices();
}

/// Vertices as they lie in a vertex buffer, with room that is none of decimesh's business.
struct Vertex {
    std::uint32_t before;
    shapes::Point position;
    shapes::Point normal;
    std::array<float, 2> uv;
    std::array<std::uint8_t, 4> color;
    std::uint32_t after;
};

std::vector<Vertex> vertex_buffer(const shapes::Dressed &dressed) {
    std::vector<Vertex> vertices;
    for (std::size_t i = 0; i < dressed.shape.positions.size(); ++i) {
        vertices.push_back({0xAAAAAAAA, dressed.shape.positions[i], dressed.normals[i], dressed.uvs[i],
                            dressed.colors[i], 0xBBBBBBBB});
    }
    return vertices;
}

template <class Vertices, class Buffers>
void point_to(Buffers &buffers, Vertices &vertices) {
    buffers.positions = decimesh::interleaved(vertices, &Vertex::position);
    buffers.normals = decimesh::interleaved(vertices, &Vertex::normal);
    buffers.uvs = decimesh::interleaved(vertices, &Vertex::uv);
    buffers.colors = decimesh::interleaved(vertices, &Vertex::color);
}

/// What an engine would draw is the mesh, corner by corner.
template <class Index>
void check_same_surface(Span<const Index> indices, const std::vector<Vertex> &vertices, const decimesh::Mesh &mesh) {
    REQUIRE(mesh.indices().size() == indices.size());
    for (std::size_t corner = 0; corner < indices.size(); ++corner) {
        const Vertex &vertex = vertices[indices[corner]];
        const std::size_t own = mesh.indices()[corner];
        CHECK(checks::bits(vertex.position.data()) == checks::bits(mesh.positions().data() + 3 * own));
        CHECK(checks::bits(vertex.normal.data()) == checks::bits(mesh.normals().data() + 3 * own));
        CHECK(std::memcmp(vertex.uv.data(), mesh.uvs().data() + 2 * own, sizeof vertex.uv) == 0);
        CHECK(std::memcmp(vertex.color.data(), mesh.colors().data() + 4 * own, sizeof vertex.color) == 0);
    }
}

}   // namespace

TEST_CASE_TEMPLATE("indices: fewer triangles over the same vertices", Index, std::uint16_t, std::uint32_t) {
    const shapes::Shape shape = shapes::stone(24, 16);
    const std::vector<Index> indices = indices_of<Index>(shape);
    const decimesh::Buffers<Index> buffers{shape.positions, indices};
    for (const std::size_t wanted : {shape.triangles(), std::size_t{300}, std::size_t{51}}) {
        CAPTURE(wanted);
        constexpr Index untouched = 0x7777;
        std::vector<Index> destination(indices.size() + 1, untouched);
        Options options;
        options.target = Target::triangles(wanted);
        options.track_origins = true;
        const auto result = decimesh::simplify_indices<Index>(destination, buffers, options);
        checks::check_count(result.index_count / 3, wanted);
        CHECK(result.report.triangles == result.index_count / 3);
        CHECK(result.report.stopped_by == decimesh::StoppedBy::target);
        checks::check_triangles(Span<const Index>(destination.data(), result.index_count), shape.positions.size());
        CHECK(destination.back() == untouched);

        std::vector<bool> is_used(shape.positions.size());
        for (std::size_t corner = 0; corner < result.index_count; ++corner) {
            is_used[destination[corner]] = true;
        }
        CHECK(result.report.vertices ==
              static_cast<std::size_t>(std::count(is_used.begin(), is_used.end(), true)));
        REQUIRE(result.origins.size() == shape.positions.size());
        for (std::size_t vertex = 0; vertex < result.origins.size(); ++vertex) {
            const std::uint32_t origin = result.origins[vertex];
            CHECK((origin == decimesh::vanished || (origin < is_used.size() && is_used[origin])));
            if (is_used[vertex]) {
                CHECK(origin == vertex);
            }
        }
    }
}

TEST_CASE_TEMPLATE("indices: the destination may be the source", Index, std::uint16_t, std::uint32_t) {
    const shapes::Shape shape = shapes::torus(24, 12);
    const std::vector<Index> indices = indices_of<Index>(shape);
    std::vector<Index> apart(indices.size());
    const auto expected = decimesh::simplify_indices<Index>(apart, {shape.positions, indices});
    std::vector<Index> own = indices;
    const auto result = decimesh::simplify_indices<Index>(own, {shape.positions, own});
    CHECK(result.index_count == expected.index_count);
    CHECK(std::equal(own.begin(), own.begin() + static_cast<std::ptrdiff_t>(result.index_count), apart.begin()));
}

TEST_CASE("indices: existing placement is what simplify does with it") {
    const shapes::Shape shape = shapes::stone(24, 16);
    Options options;
    options.target = Target::ratio(0.2);
    std::vector<std::uint32_t> destination(shape.indices.size());
    const decimesh::Buffers<> buffers{shape.positions, shape.indices};
    const auto result = decimesh::simplify_indices(destination, buffers, options);
    options.placement = decimesh::Placement::existing;
    const decimesh::Simplified mesh = decimesh::simplify(shape.mesh(), options);
    CHECK(result.report.triangles == mesh.report.triangles);
    CHECK(result.report.error == mesh.report.error);
    for (std::size_t corner = 0; corner < result.index_count; ++corner) {
        CHECK(checks::bits(shape.positions[destination[corner]].data()) ==
              checks::bits(mesh.mesh.positions().data() + 3 * mesh.mesh.indices()[corner]));
    }
}

TEST_CASE("indices: interleaved vertices are read where they lie") {
    const shapes::Dressed dressed(shapes::stone(24, 16));
    const std::vector<Vertex> vertices = vertex_buffer(dressed);
    const Bytes before = bytes_of(Span(vertices.data(), vertices.size()));
    decimesh::Buffers<> packed{dressed.shape.positions, dressed.shape.indices, dressed.normals, dressed.uvs,
                               dressed.colors};
    decimesh::Buffers<> buffers;
    point_to(buffers, vertices);
    buffers.indices = dressed.shape.indices;
    std::vector<std::uint32_t> a(dressed.shape.indices.size()), b = a;
    CHECK(decimesh::simplify_indices(a, packed).index_count == decimesh::simplify_indices(b, buffers).index_count);
    CHECK(a == b);
    CHECK(bytes_of(Span(vertices.data(), vertices.size())) == before);
}

TEST_CASE("indices: locked vertices stay in use") {
    const shapes::Shape shape = shapes::stone(24, 16);
    Options options;
    options.target = Target::triangles(40);
    options.locked_vertices = {0, 11, 222, 333};
    std::vector<std::uint32_t> destination(shape.indices.size());
    const decimesh::Buffers<> buffers{shape.positions, shape.indices};
    const auto result = decimesh::simplify_indices(destination, buffers, options);
    const auto end = destination.begin() + static_cast<std::ptrdiff_t>(result.index_count);
    for (const std::uint32_t vertex : options.locked_vertices) {
        CHECK(std::find(destination.begin(), end, vertex) != end);
    }
}

TEST_CASE("indices: too little room is refused before anything is written") {
    const shapes::Shape shape = shapes::plane(4);
    std::vector<std::uint32_t> destination(shape.indices.size() - 1, 7);
    const decimesh::Buffers<> buffers{shape.positions, shape.indices};
    CHECK_THROWS_WITH_AS(decimesh::simplify_indices(destination, buffers),
                         "decimesh: room for 95 indices, but there are 96", std::invalid_argument);
    CHECK(destination == std::vector<std::uint32_t>(95, 7));
}

TEST_CASE_TEMPLATE("in place: vertices keep their places and the rest its values", Index, std::uint16_t, std::uint32_t) {
    const shapes::Dressed dressed(shapes::stone(24, 16));
    std::vector<Vertex> vertices = vertex_buffer(dressed);
    const std::vector<Vertex> before = vertices;
    std::vector<Index> indices = indices_of<Index>(dressed.shape);
    decimesh::MutableBuffers<Index> buffers;
    point_to(buffers, vertices);
    buffers.indices = indices;
    Options options;
    options.target = Target::ratio(0.2);
    options.track_origins = true;
    options.locked_vertices = {3, 50};
    const auto result = decimesh::simplify_in_place(buffers, options);
    checks::check_count(result.index_count / 3, dressed.shape.triangles() / 5);
    checks::check_triangles(Span<const Index>(indices.data(), result.index_count), vertices.size());

    std::vector<bool> is_used(vertices.size());
    for (std::size_t corner = 0; corner < result.index_count; ++corner) {
        is_used[indices[corner]] = true;
    }
    bool has_moved = false;
    for (std::size_t vertex = 0; vertex < vertices.size(); ++vertex) {
        CHECK(vertices[vertex].before == 0xAAAAAAAA);
        CHECK(vertices[vertex].after == 0xBBBBBBBB);
        if (!is_used[vertex]) {
            CHECK(std::memcmp(&vertices[vertex], &before[vertex], sizeof(Vertex)) == 0);
        }
        has_moved |= vertices[vertex].position != before[vertex].position;
    }
    CHECK(has_moved);
    for (const std::uint32_t vertex : options.locked_vertices) {
        CHECK(is_used[vertex]);
        CHECK(checks::bits(vertices[vertex].position.data()) == checks::bits(before[vertex].position.data()));
    }

    check_same_surface(Span<const Index>(indices.data(), result.index_count), vertices,
                       decimesh::simplify(dressed.mesh(), options).mesh);
}

TEST_CASE("in place: where the surface had to be parted both parts get vertices of their own") {
    const shapes::Dressed dressed(shapes::torus(24, 12));
    std::vector<Vertex> vertices = vertex_buffer(dressed);
    std::vector<std::uint32_t> indices = dressed.shape.indices;
    decimesh::MutableBuffers<> buffers;
    point_to(buffers, vertices);
    buffers.indices = indices;
    Options options;
    options.target = Target::triangles(8);
    const auto result = decimesh::simplify_in_place(buffers, options);
    CHECK(result.report.topology_changed);
    CHECK(result.index_count <= 24);
    check_same_surface(Span<const std::uint32_t>(indices.data(), result.index_count), vertices,
                       decimesh::simplify(dressed.mesh(), options).mesh);
}

TEST_CASE("in place: short indices reach their vertices only whatever lies beyond") {
    shapes::Shape shape = shapes::stone(24, 16);
    std::vector<std::uint16_t> indices = shape.short_indices();
    const shapes::Point far_away = {9, 9, 9};
    shape.positions.resize(70000, far_away);
    const auto result = decimesh::simplify_in_place(decimesh::MutableBuffers<std::uint16_t>{shape.positions, indices});
    checks::check_count(result.index_count, indices.size() / 2);
    for (std::size_t corner = 0; corner < result.index_count; ++corner) {
        CHECK(shape.positions[indices[corner]] != far_away);
    }
}

TEST_SUITE_END();
