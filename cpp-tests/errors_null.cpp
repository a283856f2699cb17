/// NULL where something must be: a status, a name, and nothing written.

#include <cmath>

#include "calls.hpp"

using calls::check_refused;
using calls::nobody;

TEST_SUITE_BEGIN("quick");

TEST_CASE("errors: NULL buffers and options are named") {
    shapes::Dressed dressed(shapes::plane(4));
    const decimesh_buffers buffers = dressed.raw();
    const decimesh_simplify_options options = calls::default_options();
    const Bytes before = dressed.bytes();

    for (const calls::Named &named : calls::on_buffers) {
        CAPTURE(named.name);
        check_refused(named.call(nullptr, &options), DECIMESH_ERROR_NULL, {"buffers is NULL"});
        decimesh_buffers incomplete = buffers;
        incomplete.positions = nullptr;
        check_refused(named.call(&incomplete, &options), DECIMESH_ERROR_NULL, {"positions is NULL"});
        incomplete = buffers;
        incomplete.indices = nullptr;
        check_refused(named.call(&incomplete, &options), DECIMESH_ERROR_NULL, {"indices is NULL"});
    }
    for (const calls::Named &named : calls::on_options) {
        CAPTURE(named.name);
        check_refused(named.call(&buffers, nullptr), DECIMESH_ERROR_NULL, {"options is NULL"});
        decimesh_simplify_options incomplete = options;
        incomplete.locked_count = 3;
        check_refused(named.call(&buffers, &incomplete), DECIMESH_ERROR_NULL, {"locked_vertices is NULL"});
    }
    check_refused(decimesh_mesh_from_buffers(&buffers, nullptr), DECIMESH_ERROR_NULL, {"mesh is NULL"});
    std::size_t count = 77;
    check_refused(decimesh_simplify_indices(nullptr, &buffers, &options, &count, nullptr), DECIMESH_ERROR_NULL,
                  {"destination is NULL"});
    std::vector<std::uint32_t> destination(dressed.shape.indices.size(), 77);
    check_refused(decimesh_simplify_indices(destination.data(), &buffers, &options, nullptr, nullptr),
                  DECIMESH_ERROR_NULL, {"index_count is NULL"});
    const decimesh_mutable_buffers writable = dressed.raw_mutable();
    check_refused(decimesh_simplify_in_place(&writable, &options, nullptr, nullptr), DECIMESH_ERROR_NULL,
                  {"index_count is NULL"});
    CHECK(count == 77);
    CHECK(destination == std::vector<std::uint32_t>(destination.size(), 77));
    CHECK(dressed.bytes() == before);
}

TEST_CASE("errors: NULL meshes and paths are named") {
    const decimesh::Mesh owner = shapes::plane(4).mesh();
    const decimesh_mesh *const mesh = owner.get();
    const decimesh_simplify_options options = calls::default_options();
    const double values[] = {0.5};
    decimesh_mesh *made = nobody<decimesh_mesh>();
    decimesh_levels *levels = nobody<decimesh_levels>();
    auto statistics = calls::untouched_struct<decimesh_statistics>();
    auto result = calls::untouched_struct<decimesh_deviation_result>();
    auto bound = calls::untouched_struct<decimesh_bound_result>();
    const auto refused = [](decimesh_status status, const char *words) {
        check_refused(status, DECIMESH_ERROR_NULL, {words});
    };
    refused(decimesh_mesh_read(nullptr, &made), "path is NULL");
    refused(decimesh_mesh_read("mesh.ply", nullptr), "mesh is NULL");
    refused(decimesh_mesh_write(nullptr, "mesh.ply", DECIMESH_ENCODING_BINARY), "mesh is NULL");
    refused(decimesh_mesh_write(mesh, nullptr, DECIMESH_ENCODING_BINARY), "path is NULL");
    refused(decimesh_mesh_weld(nullptr, 0, &made), "mesh is NULL");
    refused(decimesh_mesh_weld(mesh, 0, nullptr), "welded is NULL");
    refused(decimesh_mesh_statistics(nullptr, &statistics), "mesh is NULL");
    refused(decimesh_mesh_statistics(mesh, nullptr), "statistics is NULL");
    refused(decimesh_simplify(nullptr, &options, &made, nullptr), "mesh is NULL");
    refused(decimesh_simplify(mesh, &options, nullptr, nullptr), "simplified is NULL");
    refused(decimesh_simplify_within(nullptr, 1, &options, &made, nullptr, &bound), "mesh is NULL");
    refused(decimesh_simplify_within(mesh, 1, nullptr, &made, nullptr, &bound), "options is NULL");
    refused(decimesh_simplify_within(mesh, 1, &options, nullptr, nullptr, &bound), "simplified is NULL");
    decimesh_stopped_by stopped_by = 77;
    refused(decimesh_multiple_choice(nullptr, 2, nullptr, &made, &stopped_by), "mesh is NULL");
    refused(decimesh_multiple_choice(mesh, 2, nullptr, nullptr, &stopped_by), "simplified is NULL");
    CHECK(stopped_by == 77);
    refused(decimesh_levels_build(nullptr, &options, values, 1, &levels), "mesh is NULL");
    refused(decimesh_levels_build(mesh, &options, nullptr, 1, &levels), "target_values is NULL");
    refused(decimesh_levels_build(mesh, &options, values, 1, nullptr), "levels is NULL");
    refused(decimesh_deviation(nullptr, mesh, nullptr, &result), "a is NULL");
    refused(decimesh_deviation(mesh, nullptr, nullptr, &result), "b is NULL");
    refused(decimesh_deviation(mesh, mesh, nullptr, nullptr), "result is NULL");
    float distance = 77;
    refused(decimesh_vertex_distances(nullptr, mesh, nullptr, &distance), "from is NULL");
    refused(decimesh_vertex_distances(mesh, nullptr, nullptr, &distance), "to is NULL");
    refused(decimesh_vertex_distances(mesh, mesh, nullptr, nullptr), "distances is NULL");
    CHECK(distance == 77);
    refused(decimesh_bound(nullptr, mesh, nullptr, &bound), "a is NULL");
    refused(decimesh_bound(mesh, nullptr, nullptr, &bound), "b is NULL");
    refused(decimesh_bound(mesh, mesh, nullptr, nullptr), "result is NULL");
    CHECK(made == nobody<decimesh_mesh>());
    CHECK(levels == nobody<decimesh_levels>());
    CHECK(calls::is_untouched(bound));
    CHECK(calls::is_untouched(statistics));
    CHECK(calls::is_untouched(result));
}

TEST_CASE("errors: levels that are NULL or do not exist") {
    const decimesh::Mesh owner = shapes::plane(4).mesh();
    const decimesh::Levels chain = decimesh::Levels::build(owner, {decimesh::Target::ratio(0.5)});
    const decimesh_levels *const levels = chain.get();
    const decimesh_mesh *mesh = nobody<decimesh_mesh>();
    auto report = calls::untouched_struct<decimesh_simplify_report>();
    std::size_t level = 77;
    check_refused(decimesh_levels_mesh(nullptr, 0, &mesh), DECIMESH_ERROR_NULL, {"levels is NULL"});
    check_refused(decimesh_levels_mesh(levels, 0, nullptr), DECIMESH_ERROR_NULL, {"mesh is NULL"});
    check_refused(decimesh_levels_mesh(levels, 1, &mesh), DECIMESH_ERROR_OUT_OF_RANGE, {"level 1", "of 1"});
    check_refused(decimesh_levels_mesh(levels, SIZE_MAX, &mesh), DECIMESH_ERROR_OUT_OF_RANGE, {"level"});
    check_refused(decimesh_levels_report(nullptr, 0, &report), DECIMESH_ERROR_NULL, {"levels is NULL"});
    check_refused(decimesh_levels_report(levels, 0, nullptr), DECIMESH_ERROR_NULL, {"report is NULL"});
    check_refused(decimesh_levels_report(levels, 3, &report), DECIMESH_ERROR_OUT_OF_RANGE, {"level 3"});
    const auto *groups = nobody<const std::uint32_t>();
    const auto *origins = nobody<const std::uint32_t>();
    check_refused(decimesh_levels_groups(nullptr, 0, &groups), DECIMESH_ERROR_NULL, {"levels is NULL"});
    check_refused(decimesh_levels_groups(levels, 0, nullptr), DECIMESH_ERROR_NULL, {"groups is NULL"});
    check_refused(decimesh_levels_groups(levels, 1, &groups), DECIMESH_ERROR_OUT_OF_RANGE, {"level 1"});
    check_refused(decimesh_levels_origins(levels, 1, &origins), DECIMESH_ERROR_OUT_OF_RANGE, {"level 1"});
    check_refused(decimesh_levels_origins(nullptr, 0, &origins), DECIMESH_ERROR_NULL, {"levels is NULL"});
    check_refused(decimesh_levels_origins(levels, 0, nullptr), DECIMESH_ERROR_NULL, {"origins is NULL"});
    CHECK(groups == nobody<const std::uint32_t>());
    check_refused(decimesh_levels_select(nullptr, 1, &level), DECIMESH_ERROR_NULL, {"levels is NULL"});
    check_refused(decimesh_levels_select(levels, 1, nullptr), DECIMESH_ERROR_NULL, {"level is NULL"});
    check_refused(decimesh_levels_select(levels, NAN, &level), DECIMESH_ERROR_NOT_FINITE, {"max_error"});
    CHECK(mesh == nobody<decimesh_mesh>());
    CHECK(calls::is_untouched(report));
    CHECK(level == 77);
}

TEST_CASE("errors: what cannot fail takes NULL") {
    decimesh_mesh_destroy(nullptr);
    decimesh_levels_destroy(nullptr);
    decimesh_buffers_init(nullptr, sizeof(decimesh_buffers));
    decimesh_mutable_buffers_init(nullptr, sizeof(decimesh_mutable_buffers));
    decimesh_statistics_init(nullptr, sizeof(decimesh_statistics));
    decimesh_simplify_options_init(nullptr, sizeof(decimesh_simplify_options));
    decimesh_simplify_report_init(nullptr, sizeof(decimesh_simplify_report));
    decimesh_deviation_options_init(nullptr, sizeof(decimesh_deviation_options));
    decimesh_deviation_result_init(nullptr, sizeof(decimesh_deviation_result));
    decimesh_multiple_choice_options_init(nullptr, sizeof(decimesh_multiple_choice_options));
    decimesh_bound_options_init(nullptr, sizeof(decimesh_bound_options));
    decimesh_bound_result_init(nullptr, sizeof(decimesh_bound_result));
    CHECK(decimesh_mesh_vertex_count(nullptr) == 0);
    CHECK(decimesh_mesh_triangle_count(nullptr) == 0);
    CHECK(decimesh_levels_count(nullptr) == 0);
    CHECK(decimesh_mesh_positions(nullptr) == nullptr);
    CHECK(decimesh_mesh_indices(nullptr) == nullptr);
    CHECK(decimesh_mesh_normals(nullptr) == nullptr);
    CHECK(decimesh_mesh_uvs(nullptr) == nullptr);
    CHECK(decimesh_mesh_colors(nullptr) == nullptr);
}

TEST_CASE("errors: a mesh that belongs to levels outlives its destruction") {
    const decimesh::Levels levels = decimesh::Levels::build(shapes::plane(4).mesh(), {decimesh::Target::ratio(0.5)});
    const decimesh_mesh *borrowed = nullptr;
    REQUIRE(decimesh_levels_mesh(levels.get(), 0, &borrowed) == DECIMESH_OK);
    const Bytes before = bytes_of(levels.mesh(0));
    decimesh_mesh_destroy(const_cast<decimesh_mesh *>(borrowed));
    CHECK(bytes_of(levels.mesh(0)) == before);
}

TEST_SUITE_END();
