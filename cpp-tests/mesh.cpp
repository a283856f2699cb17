/// Meshes: made from buffers and files, asked, welded, written, moved.

#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <type_traits>

#include <decimesh.hpp>
#include <doctest/doctest.h>

#include "checks.hpp"
#include "shapes.hpp"

using decimesh::Mesh;
using decimesh::MeshView;

TEST_SUITE_BEGIN("quick");

namespace {

/// A directory of its own, gone in the end.
class Directory {
public:
    explicit Directory(const std::string &name)
        : path_(std::filesystem::temp_directory_path() / ("decimesh-tests-" + name)) {
        std::filesystem::remove_all(path_);
        std::filesystem::create_directory(path_);
    }
    ~Directory() { std::filesystem::remove_all(path_); }
    Directory(const Directory &) = delete;
    Directory &operator=(const Directory &) = delete;

    std::string file(const std::string &name) const { return (path_ / name).string(); }

private:
    std::filesystem::path path_;
};

struct Vector {
    float x, y, z;
};

/// A vertex as an engine might have it: nothing in the order of decimesh, and something else besides.
struct Vertex {
    std::uint8_t color[4];
    Vector position;
    std::uint32_t bone;
    std::array<float, 2> uv;
    float normal[3];
};

std::vector<Vertex> engine_vertices(const shapes::Dressed &dressed) {
    std::vector<Vertex> vertices(dressed.shape.positions.size());
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        const shapes::Point &position = dressed.shape.positions[i];
        vertices[i].position = {position[0], position[1], position[2]};
        vertices[i].bone = 77;
        vertices[i].uv = dressed.uvs[i];
        std::copy(dressed.colors[i].begin(), dressed.colors[i].end(), vertices[i].color);
        std::copy(dressed.normals[i].begin(), dressed.normals[i].end(), vertices[i].normal);
    }
    return vertices;
}

template <class Call>
decimesh::Status status_of(Call call) {
    try {
        call();
    } catch (const decimesh::Error &error) {
        CHECK(std::string(error.what()) != "");
        return error.status();
    }
    return decimesh::Status::ok;
}

}   // namespace

TEST_CASE("mesh: buffers come back as they went in") {
    const shapes::Dressed dressed(shapes::stone(12, 8));
    const Mesh mesh = dressed.mesh();
    CHECK(mesh.vertex_count() == dressed.shape.positions.size());
    CHECK(mesh.triangle_count() == dressed.shape.triangles());
    const Bytes held = bytes_of(mesh.positions()) + bytes_of(mesh.indices()) +
                             bytes_of(mesh.normals()) + bytes_of(mesh.uvs()) +
                             bytes_of(mesh.colors());
    CHECK(held == dressed.bytes());
}

TEST_CASE("mesh: 16-bit indices and interleaved vertices make the same mesh") {
    const shapes::Dressed dressed(shapes::stone(12, 8));
    const std::vector<Vertex> vertices = engine_vertices(dressed);
    const std::vector<std::uint16_t> indices = dressed.shape.short_indices();
    decimesh::Buffers<std::uint16_t> buffers;
    buffers.positions = decimesh::interleaved(vertices, &Vertex::position);
    buffers.indices = indices;
    buffers.normals = decimesh::interleaved(vertices, &Vertex::normal);
    buffers.uvs = decimesh::interleaved(vertices, &Vertex::uv);
    buffers.colors = decimesh::interleaved(vertices, &Vertex::color);
    CHECK(buffers.positions.stride() == sizeof(Vertex));
    CHECK(bytes_of(Mesh::from_buffers(buffers)) == bytes_of(dressed.mesh()));
}

TEST_CASE("mesh: attributes that are absent are empty") {
    const Mesh mesh = shapes::plane(3).mesh();
    CHECK(mesh.normals().empty());
    CHECK(mesh.uvs().empty());
    CHECK(mesh.colors().empty());
}

TEST_CASE("mesh: positions come as numbers or vectors or pointers") {
    const shapes::Shape shape = shapes::plane(1);
    const Bytes expected = bytes_of(shape.mesh());
    std::vector<float> numbers;
    std::vector<Vector> vectors;
    float arrays[4][3];
    for (std::size_t i = 0; i < 4; ++i) {
        const shapes::Point &position = shape.positions[i];
        numbers.insert(numbers.end(), position.begin(), position.end());
        vectors.push_back({position[0], position[1], position[2]});
        std::copy(position.begin(), position.end(), arrays[i]);
    }
    CHECK(bytes_of(Mesh::from_buffers(numbers, shape.indices)) == expected);
    CHECK(bytes_of(Mesh::from_buffers(vectors, shape.indices)) == expected);
    CHECK(bytes_of(Mesh::from_buffers(arrays, shape.indices)) == expected);
    CHECK(bytes_of(Mesh::from_buffers({numbers.data(), 4}, shape.indices)) == expected);
    const auto short_indices = shape.short_indices();
    CHECK(bytes_of(Mesh::from_buffers(numbers, short_indices)) == expected);

    numbers.pop_back();
    CHECK_THROWS_WITH_AS(Mesh::from_buffers(numbers, shape.indices),
                         "decimesh: 11 numbers do not make whole groups of 3", std::invalid_argument);
}

TEST_CASE("mesh: attributes of another length than the positions are refused before anything is read") {
    shapes::Dressed dressed(shapes::plane(1));
    dressed.normals.pop_back();
    CHECK_THROWS_WITH_AS(dressed.mesh(), "decimesh: 3 normals for 4 positions", std::invalid_argument);
}

TEST_CASE("mesh: broken buffers throw their status and say where") {
    const shapes::Shape good = shapes::plane(1);
    const auto refused = [](const shapes::Shape &shape, std::initializer_list<const char *> words) {
        try {
            shape.mesh();
        } catch (const decimesh::Error &error) {
            INFO(std::string(error.what()));
            CHECK(checks::says(error.what(), words));
            return error.status();
        }
        return decimesh::Status::ok;
    };
    shapes::Shape shape = good;
    shape.indices[4] = 4;
    CHECK(refused(shape, {"triangle 1", "index 4", "4 vertices"}) == decimesh::Status::index_range);
    shape = good;
    shape.positions[2][1] = NAN;
    CHECK(refused(shape, {"position", "vertex 2"}) == decimesh::Status::not_finite);
    shape = good;
    shape.indices.pop_back();
    CHECK(refused(shape, {"5", "no multiple of three"}) == decimesh::Status::index_count);
    CHECK(refused({}, {}) != decimesh::Status::ok);
}

TEST_CASE("mesh: statistics of shapes that are known") {
    SUBCASE("a closed sphere") {
        const decimesh::Statistics sphere = shapes::sphere(16, 8).mesh().statistics();
        CHECK(sphere.is_closed);
        CHECK(sphere.is_oriented_manifold);
        CHECK(sphere.vertices == 16 * 7 + 2);
        CHECK(sphere.triangles == 2 * 16 * 7);
        CHECK(sphere.edges == 3 * 16 * 7);
        CHECK(sphere.euler_characteristic == 2);
        CHECK(sphere.components == 1);
        CHECK(sphere.bounds_min[2] == -1);
        CHECK(sphere.bounds_max[2] == 1);
        CHECK(sphere.diagonal == doctest::Approx(std::sqrt(12.0)));
        CHECK(sphere.surface_area < 4 * 3.14159265);
        CHECK(sphere.surface_area > 11);
    }
    SUBCASE("a torus") {
        const decimesh::Statistics torus = shapes::torus(12, 6).mesh().statistics();
        CHECK(torus.is_closed);
        CHECK(torus.euler_characteristic == 0);
    }
    SUBCASE("a plane") {
        const decimesh::Statistics plane = shapes::plane(5).mesh().statistics();
        CHECK_FALSE(plane.is_closed);
        CHECK(plane.is_oriented_manifold);
        CHECK(plane.border_edges == 20);
        CHECK(plane.boundary_loops == 1);
        CHECK(plane.euler_characteristic == 1);
        CHECK(plane.surface_area == doctest::Approx(1.0));
    }
    SUBCASE("dirt") {
        shapes::Shape dirty = shapes::plane(1);
        dirty.positions.push_back(dirty.positions[0]);
        dirty.indices.insert(dirty.indices.end(), {0, 0, 1, 1, 0, 3});
        const decimesh::Statistics found = dirty.mesh().statistics();
        CHECK(found.unreferenced_vertices == 1);
        CHECK(found.duplicate_positions == 1);
        CHECK(found.degenerate_triangles == 1);
    }
    SUBCASE("cubes without common vertices") {
        const decimesh::Statistics soup = shapes::cube_soup(2).mesh().statistics();
        CHECK(soup.components == 24);
        CHECK(soup.duplicate_positions == 72 - 16);
        CHECK(soup.surface_area == doctest::Approx(12.0));
    }
}

TEST_CASE("mesh: welding makes solids of a soup") {
    const Mesh soup = shapes::cube_soup(3).mesh();
    const Mesh welded = soup.weld();
    const decimesh::Statistics statistics = welded.statistics();
    CHECK(welded.vertex_count() == 24);
    CHECK(welded.triangle_count() == 36);
    CHECK(statistics.is_closed);
    CHECK(statistics.is_oriented_manifold);
    CHECK(statistics.components == 3);
    CHECK(soup.vertex_count() == 108);
    CHECK(soup.weld(0.5F).vertex_count() == 24);
    CHECK(soup.weld(1.01F).vertex_count() < 24);
    CHECK(status_of([&] { soup.weld(-1); }) == decimesh::Status::option);
}

TEST_CASE("mesh: files hold what was written") {
    const Directory directory("files");
    const shapes::Dressed dressed(shapes::stone(12, 8));
    const Mesh mesh = dressed.mesh();
    for (const std::string name : {"stone.ply", "stone.obj", "stone.off", "stone.gltf", "stone.glb"}) {
        CAPTURE(name);
        mesh.write(directory.file(name));
        const Mesh back = Mesh::read(directory.file(name));
        CHECK(bytes_of(back.positions()) == bytes_of(mesh.positions()));
        CHECK(bytes_of(back.indices()) == bytes_of(mesh.indices()));
        CHECK(back.colors().size() == mesh.colors().size());
    }
    for (const auto encoding : {decimesh::Encoding::binary, decimesh::Encoding::binary_big_endian,
                                decimesh::Encoding::ascii}) {
        mesh.write(directory.file("stone.ply"), encoding);
        const Mesh back = Mesh::read(directory.file("stone.ply"));
        CHECK(bytes_of(back.positions()) == bytes_of(mesh.positions()));
    }
    mesh.write(directory.file("stone.stl"));
    CHECK(Mesh::read(directory.file("stone.stl")).triangle_count() == mesh.triangle_count());
    // The letters are UTF-8 bytes, whatever this file is taken for.
    mesh.write(directory.file("gr\xc3\xb6\xc3\x9f" "e.ply"));
    CHECK(Mesh::read(directory.file("gr\xc3\xb6\xc3\x9f" "e.ply")).vertex_count() == mesh.vertex_count());
}

TEST_CASE("mesh: files that are none say so") {
    const Directory directory("no-files");
    const Mesh mesh = shapes::plane(1).mesh();
    using decimesh::Status;
    CHECK(status_of([&] { Mesh::read(directory.file("missing.ply")); }) == Status::io);
    CHECK(status_of([&] { Mesh::read(directory.file("mesh.docx")); }) == Status::format);
    CHECK(status_of([&] { Mesh::read("\xff\xfe.ply"); }) == Status::utf8);
    CHECK(status_of([&] { mesh.write(directory.file("no/such/directory.ply")); }) == Status::io);
    CHECK(status_of([&] { mesh.write(directory.file("mesh")); }) == Status::format);
    std::ofstream(directory.file("torn.ply")) << "ply\nformat ascii 1.0\nelement vertex 3\n";
    CHECK(status_of([&] { Mesh::read(directory.file("torn.ply")); }) == Status::format);
}

TEST_CASE("mesh: owners move and views follow what they see") {
    Mesh mesh = shapes::plane(2).mesh();
    const MeshView view = mesh;
    const float *const positions = mesh.positions().data();
    Mesh moved = std::move(mesh);
    CHECK(moved.positions().data() == positions);
    CHECK(view.positions().data() == positions);
    CHECK(view.triangle_count() == 8);

    // What was moved from is a mesh still, if an empty one.
    CHECK(mesh.get() == nullptr);
    CHECK(mesh.vertex_count() == 0);
    CHECK(mesh.triangle_count() == 0);
    CHECK(mesh.positions().empty());
    CHECK(mesh.indices().empty());
    CHECK(mesh.normals().empty());
    CHECK(status_of([&] { mesh.statistics(); }) == decimesh::Status::null);
    CHECK(status_of([&] { mesh.weld(); }) == decimesh::Status::null);
    CHECK(status_of([&] { decimesh::simplify(mesh); }) == decimesh::Status::null);

    mesh = shapes::plane(3).mesh();
    CHECK(mesh.triangle_count() == 18);
    Mesh adopted = Mesh::adopt(mesh.release());
    CHECK(mesh.get() == nullptr);
    CHECK(adopted.triangle_count() == 18);
}

TEST_CASE("mesh: what moves and what converts") {
    static_assert(!std::is_copy_constructible_v<Mesh> && !std::is_copy_assignable_v<Mesh>);
    static_assert(std::is_nothrow_move_constructible_v<Mesh> && std::is_nothrow_move_assignable_v<Mesh>);
    static_assert(!std::is_copy_constructible_v<decimesh::Levels>);
    static_assert(std::is_nothrow_move_constructible_v<decimesh::Levels>);
    static_assert(std::is_convertible_v<const Mesh &, MeshView>);
    static_assert(!std::is_convertible_v<MeshView, Mesh>);
    static_assert(std::is_trivially_copyable_v<MeshView>);

    using decimesh::Span;
    static_assert(std::is_convertible_v<std::vector<float> &, Span<float>>);
    static_assert(std::is_convertible_v<const std::vector<float> &, Span<const float>>);
    static_assert(!std::is_convertible_v<const std::vector<float> &, Span<float>>);
    static_assert(!std::is_convertible_v<std::vector<double> &, Span<const float>>);
    static_assert(std::is_convertible_v<Span<float>, Span<const float>>);
    static_assert(std::is_convertible_v<int (&)[3], Span<int>>);

    using decimesh::Stream;
    static_assert(std::is_convertible_v<std::vector<Vector> &, Stream<float, 3>>);
    static_assert(!std::is_convertible_v<const std::vector<Vector> &, Stream<float, 3>>);
    static_assert(!std::is_convertible_v<std::vector<Vector> &, Stream<float, 2>>);
    static_assert(std::is_convertible_v<Stream<float, 3>, Stream<const float, 3>>);
    static_assert(!std::is_convertible_v<Stream<const float, 3>, Stream<float, 3>>);

    int numbers[] = {3, 1, 2};
    const Span<int> span = numbers;
    CHECK(span.size() == 3);
    CHECK(span[1] == 1);
    CHECK(*(span.end() - 1) == 2);
    CHECK(decimesh::version() == decimesh_version_string());
}

TEST_SUITE_END();
