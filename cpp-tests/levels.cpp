/// Chains of levels of detail.

#include <algorithm>
#include <vector>

#include <decimesh.hpp>
#include <doctest/doctest.h>

#include "checks.hpp"
#include "shapes.hpp"

using decimesh::Levels;
using decimesh::Mesh;
using decimesh::Target;

TEST_SUITE_BEGIN("quick");

namespace {

decimesh::Status status_of(const Levels &levels, std::size_t level) {
    try {
        levels.report(level);
    } catch (const decimesh::Error &error) {
        CHECK(checks::says(error.what(), {"level"}));
        return error.status();
    }
    return decimesh::Status::ok;
}

}   // namespace

TEST_CASE("levels: exact and ever coarser") {
    const shapes::Dressed dressed(shapes::stone(32, 24));
    const Mesh mesh = dressed.mesh();
    const std::vector<double> ratios = {1.0, 0.5, 0.25, 0.25, 0.05};
    std::vector<Target> targets;
    for (const double ratio : ratios) {
        targets.push_back(Target::ratio(ratio));
    }
    const Levels levels = Levels::build(mesh, targets);
    REQUIRE(levels.size() == ratios.size());
    for (std::size_t level = 0; level < levels.size(); ++level) {
        CAPTURE(level);
        const decimesh::MeshView view = levels.mesh(level);
        const decimesh::Report report = levels.report(level);
        checks::check_result(view, report);
        checks::check_count(view.triangle_count(),
                            static_cast<std::size_t>(ratios[level] * static_cast<double>(mesh.triangle_count())));
        CHECK(report.stopped_by == decimesh::StoppedBy::target);
        CHECK(view.colors().size() == 4 * view.vertex_count());
        if (level > 0) {
            CHECK(view.triangle_count() <= levels.mesh(level - 1).triangle_count());
            CHECK(report.error >= levels.report(level - 1).error);
        }
    }
}

TEST_CASE("levels: the first is what simplify gives") {
    const Mesh mesh = shapes::torus(32, 16).mesh();
    for (const Target target :
         {Target::ratio(0.3), Target::triangles(200), Target::vertices(90), Target::max_error(0.02)}) {
        const Levels levels = Levels::build(mesh, {target});
        CHECK(bytes_of(levels.mesh(0)) == bytes_of(decimesh::simplify(mesh, {target}).mesh));
    }
}

TEST_CASE("levels: the coarsest that is good enough is selected") {
    const Mesh mesh = shapes::stone(32, 24).mesh();
    const Levels levels = Levels::build(mesh, {Target::ratio(0.5), Target::ratio(0.2), Target::ratio(0.05)});
    CHECK(levels.select(1e6F) == 2);
    CHECK(levels.select(levels.report(1).error) == 1);
    CHECK(levels.select(levels.report(0).error) == 0);
    REQUIRE(levels.report(0).error > 0);
    CHECK_FALSE(levels.select(levels.report(0).error / 2).has_value());
    CHECK_FALSE(levels.select(0).has_value());
}

TEST_CASE("levels: what does not exist or does not fit is refused") {
    const Mesh mesh = shapes::plane(8).mesh();
    const Levels levels = Levels::build(mesh, {Target::ratio(0.5)});
    CHECK(status_of(levels, 1) == decimesh::Status::out_of_range);
    CHECK_THROWS_AS(levels.mesh(7), decimesh::Error);
    CHECK(status_of(Levels(), 0) == decimesh::Status::null);
    CHECK(Levels().size() == 0);
    CHECK_THROWS_AS(Levels::build(mesh, {Target::ratio(0.5), Target::triangles(9)}), std::invalid_argument);
}

TEST_CASE("levels: where vertices went is known, of every level, if asked for") {
    const Mesh mesh = shapes::stone(32, 24).mesh();
    const std::vector<Target> targets = {Target::ratio(0.5), Target::ratio(0.1)};
    const Levels untracked = Levels::build(mesh, targets);
    CHECK(untracked.origins(0).empty());
    for (const auto placement : {decimesh::Placement::optimal, decimesh::Placement::existing}) {
        decimesh::Options options;
        options.placement = placement;
        options.track_origins = true;
        const Levels levels = Levels::build(mesh, targets, options);
        CHECK_THROWS_AS(levels.origins(2), decimesh::Error);
        for (std::size_t level = 0; level < levels.size(); ++level) {
            const decimesh::Span<const std::uint32_t> origins = levels.origins(level);
            REQUIRE(origins.size() == mesh.vertex_count());
            std::vector<bool> is_named(levels.mesh(level).vertex_count(), false);
            for (const std::uint32_t origin : origins) {
                if (origin != decimesh::vanished) {
                    REQUIRE(origin < is_named.size());
                    is_named[origin] = true;
                }
            }
            CHECK(std::find(is_named.begin(), is_named.end(), false) == is_named.end());
        }
        options.target = targets[0];
        const std::vector<std::uint32_t> alone = decimesh::simplify(mesh, options).origins;
        CHECK(std::equal(alone.begin(), alone.end(), levels.origins(0).begin()));
    }
}

TEST_CASE("levels: meshes stay where they are when the levels move") {
    Levels levels = Levels::build(shapes::plane(8).mesh(), {Target::ratio(0.5)});
    const decimesh::MeshView view = levels.mesh(0);
    const Levels moved = std::move(levels);
    CHECK(view.get() == moved.mesh(0).get());
    checks::check_count(view.triangle_count(), 64);
    CHECK(levels.size() == 0);
}

TEST_CASE("levels: options count for every level") {
    const shapes::Shape shape = shapes::stone(32, 24);
    const Mesh mesh = shape.mesh();
    decimesh::Options options;
    options.placement = decimesh::Placement::existing;
    options.locked_vertices = {5, 100, 300};
    std::vector<float> locked;
    for (const std::uint32_t vertex : options.locked_vertices) {
        locked.insert(locked.end(), shape.positions[vertex].begin(), shape.positions[vertex].end());
    }
    const Levels levels = Levels::build(mesh, {Target::ratio(0.5), Target::ratio(0.1)}, options);
    for (std::size_t level = 0; level < levels.size(); ++level) {
        CHECK(checks::are_all_in(levels.mesh(level).positions(), mesh.positions()));
        CHECK(checks::are_all_in(locked, levels.mesh(level).positions()));
        CHECK(levels.report(level).locked_vertices == 3);
    }
}

TEST_SUITE_END();
