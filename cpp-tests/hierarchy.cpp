/// Heights over a grid, and what is taken from them.

#include <decimesh.hpp>
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include "checks.hpp"
#include "shapes.hpp"

using decimesh::Detail;
using decimesh::Hierarchy;
using decimesh::HierarchyOptions;
using decimesh::Status;
using decimesh::Taken;

namespace {

/// Hills, one unit apart.
std::vector<float> hills(std::size_t columns, std::size_t rows) {
    std::vector<float> heights;
    for (std::size_t row = 0; row < rows; ++row) {
        for (std::size_t column = 0; column < columns; ++column) {
            const auto x = static_cast<float>(column);
            const auto y = static_cast<float>(row);
            heights.push_back(4 * std::sin(x * 0.4F) * std::cos(y * 0.3F) + 0.1F * x);
        }
    }
    return heights;
}

bool are_same(decimesh::Span<const std::uint32_t> one, decimesh::Span<const std::uint32_t> other) {
    return std::equal(one.begin(), one.end(), other.begin(), other.end());
}

Status status_of(const std::vector<float> &heights, std::size_t columns, const HierarchyOptions &options = {}) {
    try {
        Hierarchy::build(heights, columns, options);
    } catch (const decimesh::Error &error) {
        CHECK(std::string(error.what()) != "");
        return error.status();
    }
    return Status::ok;
}

}   // namespace

TEST_SUITE_BEGIN("quick");

TEST_CASE("hierarchy: what is asked for is what comes out") {
    const Hierarchy hierarchy = Hierarchy::build(hills(65, 65), 65);
    CHECK(hierarchy.samples() == 65 * 65);
    const Taken all = hierarchy.at(Detail::ratio(1));
    CHECK(all.mesh.vertex_count() == 65 * 65);
    CHECK(all.mesh.triangle_count() == 2 * 64 * 64);
    CHECK(all.max_error == 0);
    const Taken some = hierarchy.at(Detail::vertices(500));
    CHECK(some.mesh.vertex_count() == 500);
    CHECK(some.rms > 0);
    CHECK(some.certified_gap < 1);
    CHECK(some.mesh.statistics().non_manifold_edges == 0);
    const Taken close = hierarchy.at(Detail::rms(some.rms * 1.0001));
    CHECK(close.mesh.vertex_count() <= 500);
    const Taken bounded = hierarchy.at(Detail::max_error(0.5));
    CHECK(bounded.max_error <= 0.5);
    const Taken both = hierarchy.at(Detail::vertices(2000), 0.5);
    CHECK(both.max_error <= 0.5);
    CHECK(both.mesh.vertex_count() <= 2000);
    CHECK(both.rms < bounded.rms);
    CHECK(hierarchy.at(Detail::vertices(0)).mesh.vertex_count() == 4);
}

TEST_CASE("hierarchy: voids stay open and spacing places vertices") {
    std::vector<float> heights = hills(40, 30);
    heights[12 * 40 + 20] = -9999;
    HierarchyOptions options;
    options.no_data = -9999.0F;
    options.column_spacing = 2;
    options.row_spacing = 3;
    const Hierarchy hierarchy = Hierarchy::build(heights, 40, options);
    CHECK(hierarchy.samples() == heights.size() - 1);
    const Taken whole = hierarchy.at(Detail::ratio(1));
    CHECK(whole.mesh.statistics().boundary_loops == 2);
    float east = 0;
    float north = 0;
    const decimesh::Span<const float> positions = whole.mesh.positions();
    for (std::size_t place = 0; place < positions.size(); place += 3) {
        east = std::max(east, positions[place]);
        north = std::max(north, positions[place + 1]);
    }
    CHECK(east == 78);
    CHECK(north == 87);
}

TEST_CASE("hierarchy: weights count and threads change nothing") {
    const std::vector<float> heights = hills(129, 129);
    std::vector<float> weights(heights.size(), 1);
    for (std::size_t sample = 0; sample < weights.size(); ++sample) {
        weights[sample] = sample % 129 < 64 ? 100 : 1;
    }
    HierarchyOptions options;
    options.importance = weights;
    options.threads = 1;
    const Taken one = Hierarchy::build(heights, 129, options).at(Detail::ratio(0.1));
    options.threads = 3;
    const Taken three = Hierarchy::build(heights, 129, options).at(Detail::ratio(0.1));
    CHECK(one.mesh.vertex_count() == three.mesh.vertex_count());
    CHECK(are_same(one.mesh.indices(), three.mesh.indices()));
    std::size_t west = 0;
    const decimesh::Span<const float> positions = one.mesh.positions();
    for (std::size_t place = 0; place < positions.size(); place += 3) {
        west += positions[place] < 64 ? 1U : 0U;
    }
    CHECK(west > one.mesh.vertex_count() * 6 / 10);
}

TEST_CASE("hierarchy: what is no field is an error that says why") {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    CHECK(status_of({}, 0) == Status::null);
    CHECK(status_of({1, 2}, 2) == Status::empty);
    CHECK(status_of({1, 2}, 1) == Status::empty);
    CHECK(status_of({1, 2, 3}, 2) == Status::option);
    CHECK(status_of({1, 2, 3, nan}, 2) == Status::not_finite);
    CHECK(status_of({1, 2, 3, std::numeric_limits<float>::infinity()}, 2) == Status::not_finite);
    HierarchyOptions options;
    options.no_data = nan;
    CHECK(status_of({1, 2, 3, nan}, 2, options) == Status::ok);
    CHECK(status_of({nan, nan, nan, nan}, 2, options) == Status::empty);
    options.column_spacing = 0;
    CHECK(status_of({1, 2, 3, 4}, 2, options) == Status::option);
    options.column_spacing = 1;
    const std::vector<float> weights = {1, 1, -1, 1};
    options.importance = weights;
    CHECK(status_of({1, 2, 3, 4}, 2, options) == Status::not_finite);

    const std::vector<float> square = {1, 2, 3, 4};
    const Hierarchy hierarchy = Hierarchy::build(square, 2);
    CHECK_THROWS_AS(hierarchy.at(Detail::ratio(0)), decimesh::Error);
    CHECK_THROWS_AS(hierarchy.at(Detail::ratio(1.5)), decimesh::Error);
    CHECK_THROWS_AS(hierarchy.at(Detail::rms(-1)), decimesh::Error);
    CHECK_THROWS_AS(hierarchy.at(Detail::max_error(nan)), decimesh::Error);
    CHECK_THROWS_AS(hierarchy.at(Detail::ratio(1), -1), decimesh::Error);
    decimesh_mesh *mesh = nullptr;
    CHECK(decimesh_hierarchy_at(hierarchy.get(), 7, 1, 1, &mesh, nullptr) == DECIMESH_ERROR_ENUM);
    CHECK(decimesh_hierarchy_at(hierarchy.get(), 0, 1.5, 1, &mesh, nullptr) == DECIMESH_ERROR_OPTION);
    CHECK(decimesh_hierarchy_at(nullptr, 0, 1, 1, &mesh, nullptr) == DECIMESH_ERROR_NULL);
    CHECK(decimesh_hierarchy_at(hierarchy.get(), 0, 1, 1, nullptr, nullptr) == DECIMESH_ERROR_NULL);
    CHECK(mesh == nullptr);
}

TEST_CASE("hierarchy: a free triangulation is closer") {
    const Hierarchy hierarchy = Hierarchy::build(hills(129, 129), 129);
    const Taken nested = hierarchy.at(Detail::vertices(800));
    const Taken free = hierarchy.tin(800);
    CHECK(free.mesh.vertex_count() <= 800);
    CHECK(free.rms < nested.rms);
    const Taken fitted = hierarchy.tin(800, true);
    CHECK(fitted.rms < free.rms);
    CHECK(fitted.mesh.statistics().boundary_loops == 1);
    int calls = 0;
    CHECK_THROWS_AS(hierarchy.tin(800, true, [&](float) { return ++calls < 2; }), decimesh::Cancelled);
}

TEST_CASE("hierarchy: a file holds all of it") {
    const auto file = std::filesystem::temp_directory_path() / "decimesh-tests-hills.drd";
    const std::string path = file.string();
    const Hierarchy hierarchy = Hierarchy::build(hills(50, 70), 50);
    hierarchy.write(path);
    const Hierarchy read = Hierarchy::read(path);
    CHECK(read.samples() == hierarchy.samples());
    const Taken one = hierarchy.at(Detail::ratio(0.2));
    const Taken other = read.at(Detail::ratio(0.2));
    CHECK(one.rms == other.rms);
    CHECK(are_same(one.mesh.indices(), other.mesh.indices()));
    std::filesystem::remove(file);
    CHECK_THROWS_AS(Hierarchy::read(path), decimesh::Error);
}

TEST_CASE("hierarchy: surfaces are remeshed and decomposed") {
    const decimesh::Mesh stone = shapes::stone(24, 16).mesh();
    const Hierarchy hierarchy = Hierarchy::remesh(stone, 3, 40);
    const Taken all = hierarchy.at(Detail::ratio(1));
    CHECK(all.mesh.vertex_count() == hierarchy.samples());
    CHECK(all.mesh.statistics().is_closed == stone.statistics().is_closed);
    CHECK(all.rms == 0);
    const Taken some = hierarchy.at(Detail::vertices(300));
    CHECK(some.mesh.vertex_count() == 300);
    CHECK(some.mesh.statistics().euler_characteristic == stone.statistics().euler_characteristic);
    CHECK(some.mesh.statistics().is_oriented_manifold);
    CHECK(some.rms > 0);
    CHECK(std::isnan(some.max_error));
    CHECK(hierarchy.at(Detail::rms(some.rms * 1.001)).mesh.vertex_count() <= 300);
    for (const Detail &refused : {Detail::ratio(0), Detail::rms(-1), Detail::max_error(1)}) {
        CHECK_THROWS_AS(hierarchy.at(refused), decimesh::Error);
    }
    CHECK_THROWS_AS(hierarchy.at(Detail::ratio(1), 0.5), decimesh::Error);
    CHECK_THROWS_AS(hierarchy.tin(100), decimesh::Error);
    CHECK_THROWS_AS(hierarchy.write("surface.drd"), decimesh::Error);
    CHECK_THROWS_AS(Hierarchy::remesh(stone, 0), decimesh::Error);
    CHECK_THROWS_AS(Hierarchy::remesh(stone, 3, 0), decimesh::Error);
    CHECK_THROWS_AS(Hierarchy::remesh(decimesh::Mesh(), 3), decimesh::Error);
}

TEST_CASE("hierarchy: progress ends it") {
    HierarchyOptions options;
    int calls = 0;
    options.progress = [&](float) { return ++calls < 3; };
    CHECK_THROWS_AS(Hierarchy::build(hills(129, 129), 129, options), decimesh::Cancelled);
}

TEST_SUITE_END();
