#include "reduction.hpp"

#include <algorithm>

#include <doctest/doctest.h>

#include "shapes.hpp"

using viewer::Engine;
using viewer::Original;

namespace {

const decimesh::Progress nobody = [](float) { return true; };

Original pebble(std::uint32_t rings) {
    decimesh::Mesh mesh = shapes::pebble(rings);
    const viewer::Frame frame = viewer::Frame::of(mesh);
    return {"pebble.ply", std::move(mesh), frame};
}

}   // namespace

TEST_CASE("reduction: all engines arrive at the target and say how far off they are") {
    const Original original = pebble(50);
    for (const Engine engine : viewer::all_engines) {
        const viewer::Reduced reduced = viewer::reduce(original, engine, 500, nobody);
        const std::size_t triangles = reduced.mesh.triangle_count();
        CHECK((triangles == 500 || triangles == 499));
        REQUIRE(reduced.distances.of_vertices.size() == original.mesh.vertex_count());
        CHECK(reduced.distances.largest > 0);
        CHECK(reduced.distances.largest < 0.1 * original.frame.diagonal);
        CHECK(reduced.distances.rms > 0);
        CHECK(reduced.distances.rms < reduced.distances.largest);
        CHECK(reduced.distances.largest ==
              *std::max_element(reduced.distances.of_vertices.begin(), reduced.distances.of_vertices.end()));
    }
}

TEST_CASE("reduction: one engine moves the vertices, the others keep them, each in its way") {
    const Original original = pebble(20);
    const auto are_on_original = [&](const decimesh::Mesh &mesh) {
        const auto distances = decimesh::vertex_distances(mesh, original.mesh);
        return std::all_of(distances.begin(), distances.end(), [](float distance) { return distance == 0; });
    };
    const viewer::Reduced moved = viewer::reduce(original, Engine::hqms, 300, nobody);
    const viewer::Reduced kept = viewer::reduce(original, Engine::indices, 300, nobody);
    const viewer::Reduced chosen = viewer::reduce(original, Engine::multiple_choice, 300, nobody);
    CHECK_FALSE(are_on_original(moved.mesh));
    CHECK(are_on_original(kept.mesh));
    CHECK(are_on_original(chosen.mesh));
    CHECK(chosen.distances.rms != kept.distances.rms);
}

TEST_CASE("reduction: vertices that no triangle uses have no say in how far off a result is") {
    const std::vector<float> positions{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 0, 0, 1000};
    const std::vector<std::uint32_t> indices{0, 1, 2, 0, 2, 3};
    const Original original{"stray.ply", decimesh::Mesh::from_buffers(positions, indices), {}};
    const viewer::Reduced reduced = viewer::reduce(original, Engine::hqms, 2, nobody);
    CHECK(reduced.distances.largest == 0);
    CHECK(reduced.distances.rms == 0);
}

TEST_CASE("reduction: levels are nested, and each is a mesh by itself") {
    const Original original = pebble(40);
    const viewer::LevelSet set = viewer::build_levels(original, 4, nobody);
    REQUIRE(set.levels.size() == 5);
    REQUIRE(set.distances.size() == 5);
    CHECK(set.distances[0].largest == 0);
    std::size_t before = 2 * original.mesh.triangle_count();
    for (std::size_t level = 0; level < 5; ++level) {
        const decimesh::Mesh mesh = viewer::mesh_of(set.levels, level);
        CHECK(mesh.triangle_count() <= before / 2);
        CHECK(mesh.vertex_count() == set.levels.level(level).vertices);
        CHECK(mesh.statistics().unreferenced_vertices == 0);
        CHECK(set.distances[level].of_vertices.size() == original.mesh.vertex_count());
        before = mesh.triangle_count();
    }
    CHECK(set.distances[4].rms > set.distances[1].rms);
    CHECK_THROWS_AS(viewer::mesh_of(set.levels, 5), decimesh::Error);
}

TEST_CASE("reduction: what leaves nothing to see is refused") {
    const Original original = pebble(10);
    CHECK_THROWS_AS(viewer::reduce(original, Engine::hqms, 0, nobody), decimesh::Error);
    CHECK_THROWS_AS(viewer::build_levels(original, 0, nobody), decimesh::Error);
    CHECK_THROWS_AS(viewer::build_levels(original, 1000, nobody), decimesh::Error);
    CHECK_THROWS_AS(viewer::read("no-such-file.ply"), decimesh::Error);
}

TEST_CASE("reduction: progress rises to the end, and each step of it can be the last") {
    const Original original = pebble(30);
    const auto check = [](const auto &work) {
        int steps = 0;
        float last = 0;
        work([&](float fraction) {
            CHECK(fraction >= last);
            CHECK(fraction <= 1);
            last = fraction;
            ++steps;
            return true;
        });
        CHECK(last == doctest::Approx(1));
        CHECK(steps > 3);
        for (int allowed = 0; allowed < steps; ++allowed) {
            int reports = 0;
            CHECK_THROWS_AS(work([&](float) { return reports++ < allowed; }), decimesh::Cancelled);
        }
    };
    for (const Engine engine : viewer::all_engines) {
        check([&](const decimesh::Progress &progress) { viewer::reduce(original, engine, 100, progress); });
    }
    check([&](const decimesh::Progress &progress) { viewer::build_levels(original, 3, progress); });
}
