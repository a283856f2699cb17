/// Measured distances.

#include <algorithm>
#include <vector>

#include <decimesh.hpp>
#include <doctest/doctest.h>

#include "checks.hpp"
#include "shapes.hpp"

using decimesh::Deviation;
using decimesh::DeviationOptions;
using decimesh::Mesh;

TEST_SUITE_BEGIN("quick");

namespace {

DeviationOptions few_samples() {
    DeviationOptions options;
    options.samples = 2000;
    return options;
}

}   // namespace

TEST_CASE("deviation: none from a surface to itself") {
    const Mesh mesh = shapes::stone(16, 12).mesh();
    const Deviation none = decimesh::deviation(mesh, mesh, few_samples());
    CHECK(none.rms == 0);
    CHECK(none.max == 0);
    CHECK(none.normal_rms_degrees == doctest::Approx(0.0));
    CHECK(none.diagonal == doctest::Approx(mesh.statistics().diagonal));
}

TEST_CASE("deviation: planes are as far apart as they are") {
    const shapes::Shape low = shapes::plane(4);
    shapes::Shape high = shapes::plane(7);
    for (shapes::Point &point : high.positions) {
        point[2] = 0.25F;
    }
    const Deviation apart = decimesh::deviation(low.mesh(), high.mesh(), few_samples());
    for (const double distance : {apart.rms, apart.mean, apart.max, apart.forward.rms, apart.forward.mean,
                                  apart.forward.max, apart.backward.rms, apart.backward.mean, apart.backward.max}) {
        CHECK(distance == doctest::Approx(0.25));
    }
}

TEST_CASE("deviation: exchanging the meshes exchanges the directions") {
    const Mesh whole = shapes::plane(6).mesh();
    shapes::Shape shape = shapes::plane(6);
    shape.indices.resize(shape.indices.size() / 2);
    const Mesh half = shape.mesh();
    const Deviation there = decimesh::deviation(whole, half, few_samples());
    const Deviation back = decimesh::deviation(half, whole, few_samples());
    CHECK(there.forward.max == doctest::Approx(0.5));
    CHECK(there.backward.max == doctest::Approx(0.0));
    CHECK(there.max == there.forward.max);
    CHECK(there.forward.rms == back.backward.rms);
    CHECK(there.backward.mean == back.forward.mean);
}

TEST_CASE("deviation: seeds choose the points and threads change nothing") {
    const Mesh fine = shapes::stone(16, 12).mesh();
    const Mesh coarse = decimesh::simplify(fine, {decimesh::Target::ratio(0.2)}).mesh;
    DeviationOptions options = few_samples();
    const Deviation one = decimesh::deviation(fine, coarse, options);
    CHECK(one.rms > 0);
    CHECK(one.mean <= one.rms);
    CHECK(one.rms <= one.max);
    options.threads = 2;
    CHECK(decimesh::deviation(fine, coarse, options).rms == one.rms);
    options.seed = 1;
    const Deviation other = decimesh::deviation(fine, coarse, options);
    CHECK(other.rms != one.rms);
    CHECK(other.rms == doctest::Approx(one.rms).epsilon(0.2));
}

TEST_CASE("deviation: progress rises and a missing mesh is an error") {
    const Mesh mesh = shapes::plane(4).mesh();
    DeviationOptions options = few_samples();
    float last = 0;
    options.progress = [&](float fraction) {
        CHECK(fraction >= last);
        last = fraction;
        return true;
    };
    decimesh::deviation(mesh, mesh, options);
    CHECK(last == 1);
    CHECK_THROWS_AS(decimesh::deviation(mesh, Mesh()), decimesh::Error);
}

TEST_CASE("deviation: each vertex has its distance") {
    shapes::Shape hill = shapes::plane(4);
    hill.positions[7][2] = 0.25F;
    hill.positions.push_back({0.5F, 0.5F, 2.0F});
    const std::vector<float> distances = decimesh::vertex_distances(hill.mesh(), shapes::plane(3).mesh());
    REQUIRE(distances.size() == hill.positions.size());
    for (std::size_t vertex = 0; vertex < distances.size(); ++vertex) {
        CAPTURE(vertex);
        CHECK(distances[vertex] == hill.positions[vertex][2]);
    }
}

TEST_CASE("deviation: the farthest vertex is the maximum where samples are few") {
    const Mesh fine = shapes::stone(16, 12).mesh();
    const Mesh coarse = decimesh::simplify(fine, {decimesh::Target::ratio(0.1)}).mesh;
    const std::vector<float> distances = decimesh::vertex_distances(fine, coarse);
    DeviationOptions vertices_only;
    vertices_only.samples = 0;
    const double farthest = *std::max_element(distances.begin(), distances.end());
    CHECK(farthest > 0);
    CHECK(farthest == doctest::Approx(decimesh::deviation(fine, coarse, vertices_only).forward.max).epsilon(1e-6));
    DeviationOptions two_threads;
    two_threads.threads = 2;
    CHECK(decimesh::vertex_distances(fine, coarse, two_threads) == distances);
}

TEST_CASE("deviation: distances of vertices report, cancel and refuse") {
    const Mesh mesh = shapes::plane(4).mesh();
    DeviationOptions options;
    float last = 0;
    options.progress = [&](float fraction) {
        last = fraction;
        return true;
    };
    decimesh::vertex_distances(mesh, mesh, options);
    CHECK(last == 1);
    options.progress = [](float) { return false; };
    CHECK_THROWS_AS(decimesh::vertex_distances(mesh, mesh, options), decimesh::Cancelled);
    CHECK_THROWS_AS(decimesh::vertex_distances(mesh, Mesh()), decimesh::Error);
    CHECK_THROWS_AS(decimesh::vertex_distances(Mesh(), mesh), decimesh::Error);
}

TEST_SUITE_END();
