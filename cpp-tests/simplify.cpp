/// Simplification: counts, placement, locks, topology, origins, progress.

#include <algorithm>
#include <cstddef>
#include <string>
#include <thread>
#include <vector>

#include <decimesh.hpp>
#include <doctest/doctest.h>

#include "checks.hpp"
#include "shapes.hpp"

using decimesh::Mesh;
using decimesh::Options;
using decimesh::Placement;
using decimesh::Simplified;
using decimesh::StoppedBy;
using decimesh::Target;

TEST_SUITE_BEGIN("quick");

TEST_CASE("simplify: the defaults are the library's") {
    decimesh_simplify_options library;
    decimesh_simplify_options_init(&library, sizeof library);
    const Options defaults;
    const decimesh::detail::SimplifyCall call(defaults, 0, 0);
    CHECK(std::memcmp(&call.raw, &library, sizeof library) == 0);

    decimesh_deviation_options measured;
    decimesh_deviation_options_init(&measured, sizeof measured);
    const decimesh::DeviationOptions measure;
    CHECK(measure.samples == measured.samples);
    CHECK(measure.seed == measured.seed);
    CHECK(measure.threads == measured.threads);

    decimesh_bound_options bounded;
    decimesh_bound_options_init(&bounded, sizeof bounded);
    const decimesh::BoundOptions bound;
    const decimesh::detail::BoundCall bounding(bound);
    CHECK(std::memcmp(&bounding.raw, &bounded, sizeof bounded) == 0);
}

TEST_CASE("simplify: an init function writes as much as its caller has room for") {
    std::vector<unsigned char> room(4096, 0xAB);
    auto *const options = reinterpret_cast<decimesh_simplify_options *>(room.data());

    // An older program's struct ends early; what lies behind it is not the library's.
    decimesh_simplify_options_init(options, 16);
    CHECK(options->struct_size == 16);
    CHECK(options->target_value == 0.5);
    CHECK(std::all_of(room.begin() + 16, room.end(), [](unsigned char byte) { return byte == 0xAB; }));

    // A newer program's struct goes on: with zeros, which mean that nothing is set.
    decimesh_simplify_options_init(options, room.size());
    CHECK(options->struct_size == room.size());
    CHECK(options->keep_seams == 1);
    const auto end = static_cast<std::ptrdiff_t>(sizeof *options);
    CHECK(std::all_of(room.begin() + end, room.end(), [](unsigned char byte) { return byte == 0; }));
}

TEST_CASE("simplify: as many triangles as asked for or one fewer") {
    for (const shapes::Shape &shape : {shapes::stone(24, 16), shapes::torus(24, 12), shapes::plane(16)}) {
        const Mesh mesh = shape.mesh();
        const Bytes before = bytes_of(mesh);
        for (const auto selection : {decimesh::Selection::sampled_threshold, decimesh::Selection::replacement}) {
            for (const std::size_t wanted : std::vector<std::size_t>{mesh.triangle_count(), 301, 100, 33}) {
                CAPTURE(wanted);
                Options options;
                options.target = Target::triangles(wanted);
                options.selection = selection;
                const Simplified result = decimesh::simplify(mesh, options);
                checks::check_result(result.mesh, result.report);
                checks::check_count(result.mesh.triangle_count(), wanted);
                CHECK(result.report.stopped_by == StoppedBy::target);
                CHECK(result.origins.empty());
            }
        }
        CHECK(bytes_of(mesh) == before);
    }
}

TEST_CASE("simplify: every kind of target") {
    const Mesh mesh = shapes::stone(24, 16).mesh();
    const auto run = [&](Target target) {
        Simplified result = decimesh::simplify(mesh, {target});
        checks::check_result(result.mesh, result.report);
        return result;
    };
    checks::check_count(run(Target::ratio(0.25)).mesh.triangle_count(), mesh.triangle_count() / 4);
    CHECK(run(Target::vertices(100)).mesh.vertex_count() == 100);

    const Simplified fine = run(Target::max_error(0.005));
    const Simplified coarse = run(Target::max_error(0.05));
    CHECK(fine.report.stopped_by == StoppedBy::error);
    CHECK(fine.report.error <= 0.005F);
    CHECK(coarse.report.error <= 0.05F);
    CHECK(coarse.mesh.triangle_count() < fine.mesh.triangle_count());
    CHECK(fine.mesh.triangle_count() < mesh.triangle_count());
}

TEST_CASE("simplify: a plane becomes its two triangles") {
    const Simplified flat = decimesh::simplify(shapes::plane(12).mesh(), {Target::triangles(2)});
    CHECK(flat.mesh.triangle_count() == 2);
    CHECK(flat.mesh.statistics().surface_area == doctest::Approx(1.0));
    CHECK(flat.report.error == doctest::Approx(0.0));
}

TEST_CASE("simplify: existing placement gives vertices of the input") {
    const Mesh mesh = shapes::stone(24, 16).mesh();
    Options options;
    options.target = Target::ratio(0.2);
    options.placement = Placement::existing;
    const Simplified existing = decimesh::simplify(mesh, options);
    checks::check_result(existing.mesh, existing.report);
    CHECK(checks::are_all_in(existing.mesh.positions(), mesh.positions()));

    options.placement = Placement::optimal;
    const Mesh moved = decimesh::simplify(mesh, options).mesh;
    CHECK_FALSE(checks::are_all_in(moved.positions(), mesh.positions()));
}

TEST_CASE("simplify: locked vertices stay bit for bit") {
    const shapes::Shape shape = shapes::stone(24, 16);
    const Mesh mesh = shape.mesh();
    Options options;
    options.target = Target::triangles(120);
    options.track_origins = true;
    for (std::uint32_t vertex = 0; vertex < mesh.vertex_count(); vertex += 17) {
        options.locked_vertices.push_back(vertex);
    }
    for (const auto placement : {Placement::optimal, Placement::existing}) {
        options.placement = placement;
        const Simplified result = decimesh::simplify(mesh, options);
        checks::check_result(result.mesh, result.report);
        CHECK(result.report.locked_vertices == options.locked_vertices.size());
        for (const std::uint32_t vertex : options.locked_vertices) {
            const std::uint32_t origin = result.origins[vertex];
            REQUIRE(origin < result.mesh.vertex_count());
            CHECK(checks::bits(result.mesh.positions().data() + 3 * origin) ==
                  checks::bits(shape.positions[vertex].data()));
        }
    }
}

TEST_CASE("simplify: refinement moves vertices, and wins or loses none") {
    const Mesh mesh = shapes::stone(24, 16).mesh();
    Options options;
    options.target = Target::triangles(120);
    const Simplified plain = decimesh::simplify(mesh, options);
    options.refine = true;
    const Simplified refined = decimesh::simplify(mesh, options);
    checks::check_result(refined.mesh, refined.report);
    CHECK(refined.mesh.vertex_count() == plain.mesh.vertex_count());
    CHECK(refined.mesh.triangle_count() == plain.mesh.triangle_count());
    options.placement = Placement::existing;
    CHECK_THROWS_AS(decimesh::simplify(mesh, options), decimesh::Error);
}

TEST_CASE("simplify: a locked border stays bit for bit") {
    const shapes::Shape shape = shapes::plane(10);
    Options options;
    options.target = Target::triangles(2);
    options.lock_boundary = true;
    const Simplified result = decimesh::simplify(shape.mesh(), options);
    checks::check_result(result.mesh, result.report);
    CHECK(result.report.stopped_by == StoppedBy::stuck);
    CHECK(result.report.locked_vertices == 40);
    std::vector<float> border;
    for (const shapes::Point &point : shape.positions) {
        if (point[0] == 0 || point[0] == 1 || point[1] == 0 || point[1] == 1) {
            border.insert(border.end(), point.begin(), point.end());
        }
    }
    CHECK(checks::are_all_in(border, result.mesh.positions()));
}

TEST_CASE("simplify: topology is kept or said to be given up") {
    const Mesh torus = shapes::torus(24, 12).mesh();
    Options options;
    options.target = Target::triangles(4);
    options.topology = decimesh::Topology::keep;
    const Simplified kept = decimesh::simplify(torus, options);
    checks::check_result(kept.mesh, kept.report);
    CHECK(kept.report.stopped_by == StoppedBy::stuck);
    CHECK_FALSE(kept.report.topology_changed);
    CHECK(kept.mesh.statistics().euler_characteristic == 0);

    options.topology = decimesh::Topology::relax_if_stuck;
    const Simplified relaxed = decimesh::simplify(torus, options);
    CHECK(relaxed.report.topology_changed);
    CHECK(relaxed.mesh.triangle_count() <= 4);
}

TEST_CASE("simplify: origins lead from each input vertex to where it went") {
    const Mesh mesh = shapes::stone(24, 16).mesh();
    Options options;
    options.target = Target::ratio(0.1);
    options.track_origins = true;
    const Simplified result = decimesh::simplify(mesh, options);
    REQUIRE(result.origins.size() == mesh.vertex_count());
    std::vector<bool> reached(result.mesh.vertex_count());
    for (const std::uint32_t origin : result.origins) {
        if (origin != decimesh::vanished) {
            REQUIRE(origin < reached.size());
            reached[origin] = true;
        }
    }
    CHECK(std::all_of(reached.begin(), reached.end(), [](bool is_reached) { return is_reached; }));
}

TEST_CASE("simplify: attributes are carried along and seams kept") {
    const shapes::Dressed dressed(shapes::stone(24, 16));
    const Simplified result = decimesh::simplify(dressed.mesh(), {Target::ratio(0.3)});
    CHECK(result.mesh.normals().size() == 3 * result.mesh.vertex_count());
    CHECK(result.mesh.uvs().size() == 2 * result.mesh.vertex_count());
    CHECK(result.mesh.colors().size() == 4 * result.mesh.vertex_count());

    const shapes::Dressed soup(shapes::cube_soup(4));
    Options options;
    options.target = Target::ratio(0.5);
    CHECK(decimesh::simplify(soup.mesh(), options).report.stopped_by == StoppedBy::stuck);
    options.keep_seams = false;
    CHECK(decimesh::simplify(soup.mesh(), options).mesh.triangle_count() <= 24);
}

TEST_CASE("simplify: the number of threads changes no byte") {
    const Mesh mesh = shapes::stone(64, 48).mesh();
    Options options;
    options.target = Target::ratio(0.1);
    options.threads = 1;
    const Bytes expected = bytes_of(decimesh::simplify(mesh, options).mesh);
    for (const std::uint32_t threads : {2U, 3U, 0U}) {
        options.threads = threads;
        CHECK(bytes_of(decimesh::simplify(mesh, options).mesh) == expected);
    }
}

TEST_CASE("simplify: progress rises from 0 to 1 on the caller's thread") {
    const Mesh mesh = shapes::stone(48, 32).mesh();
    std::vector<float> fractions;
    Options options;
    options.target = Target::ratio(0.1);
    const auto caller = std::this_thread::get_id();
    options.progress = [&](float fraction) {
        CHECK((std::this_thread::get_id() == caller));
        fractions.push_back(fraction);
        return true;
    };
    decimesh::simplify(mesh, options);
    REQUIRE(fractions.size() > 2);
    CHECK(fractions.front() >= 0);
    CHECK(fractions.back() == 1);
    CHECK(std::is_sorted(fractions.begin(), fractions.end()));
}

TEST_CASE("simplify: options out of their range say what is wrong") {
    const Mesh mesh = shapes::plane(2).mesh();
    const auto refused = [&](const Options &options, std::initializer_list<const char *> words) {
        try {
            decimesh::simplify(mesh, options);
        } catch (const decimesh::Error &error) {
            INFO(std::string(error.what()));
            CHECK(checks::says(error.what(), words));
            return error.status();
        }
        return decimesh::Status::ok;
    };
    CHECK(refused({Target::ratio(1.5)}, {"ratio", "1.5"}) == decimesh::Status::option);
    CHECK(refused({Target::max_error(-1)}, {"-1"}) == decimesh::Status::option);
    Options options;
    options.locked_vertices = {3, 9};
    CHECK(refused(options, {"locked vertex 9", "9 vertices"}) == decimesh::Status::option);
    options = {};
    options.placement = static_cast<Placement>(7);
    CHECK(refused(options, {"placement", "7"}) == decimesh::Status::enumeration);
}

TEST_SUITE_END();
