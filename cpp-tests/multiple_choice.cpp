/// The engine of Jia, Tang and Pan.

#include <algorithm>
#include <vector>

#include "calls.hpp"

using decimesh::Mesh;
using decimesh::MultipleChoiceOptions;

TEST_SUITE_BEGIN("quick");

namespace {

Mesh stone() {
    return shapes::Dressed(shapes::stone(24, 16)).mesh();
}

}   // namespace

TEST_CASE("multiple choice: it arrives at the target with vertices of the input alone") {
    const Mesh mesh = stone();
    const decimesh::Decimated result = decimesh::multiple_choice(mesh, 200);
    CHECK(result.stopped_by == decimesh::StoppedBy::target);
    checks::check_count(result.mesh.triangle_count(), 200);
    CHECK(checks::are_all_in(result.mesh.positions(), mesh.positions()));
    CHECK(result.mesh.statistics().unreferenced_vertices == 0);
    CHECK(result.mesh.statistics().is_closed == mesh.statistics().is_closed);
    CHECK(result.mesh.uvs().empty() == mesh.uvs().empty());
    CHECK(result.mesh.colors().empty() == mesh.colors().empty());
    REQUIRE(result.sources.size() == result.mesh.vertex_count());
    for (std::size_t vertex = 0; vertex < result.sources.size(); ++vertex) {
        REQUIRE(result.sources[vertex] < mesh.vertex_count());
        const float *const was = &mesh.positions()[3 * std::size_t{result.sources[vertex]}];
        CHECK(std::equal(was, was + 3, &result.mesh.positions()[3 * vertex]));
    }
}

TEST_CASE("multiple choice: the seed and the candidates choose, and the same choose the same") {
    const Mesh mesh = stone();
    const Bytes first = bytes_of(decimesh::multiple_choice(mesh, 200).mesh);
    CHECK(bytes_of(decimesh::multiple_choice(mesh, 200).mesh) == first);
    MultipleChoiceOptions options;
    options.seed = 1;
    CHECK(bytes_of(decimesh::multiple_choice(mesh, 200, options).mesh) != first);
    options.seed = 0;
    options.candidates = 2;
    CHECK(bytes_of(decimesh::multiple_choice(mesh, 200, options).mesh) != first);
}

TEST_CASE("multiple choice: what cannot be met says so, and what is met changes nothing") {
    const Mesh mesh = stone();
    const decimesh::Decimated stuck = decimesh::multiple_choice(mesh, 0);
    CHECK(stuck.stopped_by == decimesh::StoppedBy::stuck);
    CHECK(stuck.mesh.triangle_count() >= 4);
    const decimesh::Decimated whole = decimesh::multiple_choice(mesh, SIZE_MAX);
    CHECK(whole.stopped_by == decimesh::StoppedBy::target);
    CHECK(whole.mesh.triangle_count() == mesh.triangle_count());
    CHECK(whole.sources.size() == mesh.vertex_count());
}

TEST_CASE("multiple choice: locked vertices stay") {
    const Mesh mesh = shapes::stone(24, 16).mesh();
    MultipleChoiceOptions options;
    for (std::uint32_t vertex = 0; vertex < mesh.vertex_count(); vertex += 10) {
        options.locked_vertices.push_back(vertex);
    }
    std::vector<float> locked;
    for (const std::uint32_t vertex : options.locked_vertices) {
        locked.insert(locked.end(), &mesh.positions()[3 * vertex], &mesh.positions()[3 * vertex] + 3);
    }
    const decimesh::Decimated result = decimesh::multiple_choice(mesh, 200, options);
    CHECK(result.mesh.triangle_count() < mesh.triangle_count());
    CHECK(checks::are_all_in(decimesh::Span<const float>(locked), result.mesh.positions()));
}

TEST_CASE("multiple choice: options that cannot be are refused, and nothing is written") {
    const Mesh mesh = stone();
    decimesh_multiple_choice_options options;
    decimesh_multiple_choice_options_init(&options, sizeof options);
    CHECK(options.candidates == MultipleChoiceOptions().candidates);
    CHECK(options.seed == MultipleChoiceOptions().seed);
    decimesh_mesh *made = calls::nobody<decimesh_mesh>();
    decimesh_stopped_by stopped_by = 77;
    std::vector<std::uint32_t> sources(mesh.vertex_count(), 77);
    options.sources = sources.data();
    const auto refused = [&](decimesh_status status, std::initializer_list<const char *> words) {
        calls::check_refused(decimesh_multiple_choice(mesh.get(), 100, &options, &made, &stopped_by), status, words);
        CHECK(made == calls::nobody<decimesh_mesh>());
        CHECK(stopped_by == 77);
        CHECK(std::count(sources.begin(), sources.end(), 77) == static_cast<std::ptrdiff_t>(sources.size()));
    };
    options.candidates = 0;
    refused(DECIMESH_ERROR_OPTION, {"candidates"});
    options.candidates = 6;
    options.locked_count = 1;
    refused(DECIMESH_ERROR_NULL, {"locked_vertices"});
    const std::uint32_t beyond = 100000;
    options.locked_vertices = &beyond;
    refused(DECIMESH_ERROR_OPTION, {"100000"});
    const std::uint32_t good = 3;
    options.locked_vertices = &good;
    options.progress = [](void *, float) { return std::int32_t{1}; };
    refused(DECIMESH_ERROR_CANCELLED, {"cancelled"});
    options.progress = nullptr;
    options.sources = nullptr;
    CHECK(decimesh_multiple_choice(mesh.get(), 100, &options, &made, nullptr) == DECIMESH_OK);
    decimesh_mesh_destroy(made);
}

TEST_SUITE_END();
