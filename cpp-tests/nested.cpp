/// Levels that are prefixes of one vertex buffer.

#include <cmath>
#include <filesystem>
#include <fstream>
#include <numeric>
#include <type_traits>

#include "calls.hpp"

using calls::check_refused;
using decimesh::Mesh;
using decimesh::NestedLevels;
using decimesh::Span;
using decimesh::Target;

TEST_SUITE_BEGIN("quick");

namespace {

const std::vector<Target> three_ratios = {Target::ratio(0.5), Target::ratio(0.2), Target::ratio(0.05)};

static_assert(std::is_nothrow_move_constructible_v<NestedLevels> && !std::is_copy_constructible_v<NestedLevels>);

/// Corner by corner the positions that a level draws.
std::vector<checks::Bits> corners(const NestedLevels &levels, std::size_t level) {
    std::vector<checks::Bits> bits;
    for (const std::uint32_t vertex : levels.indices(level)) {
        bits.push_back(checks::bits(levels.mesh().positions().data() + 3 * vertex));
    }
    return bits;
}

}   // namespace

TEST_CASE("nested: each level is a prefix and the first is the mesh") {
    const shapes::Dressed dressed(shapes::stone(32, 24));
    const Mesh mesh = dressed.mesh();
    const NestedLevels levels = NestedLevels::build(mesh, three_ratios);
    REQUIRE(levels.size() == 4);
    const decimesh::MeshView buffer = levels.mesh();
    CHECK(buffer.vertex_count() == mesh.vertex_count());
    CHECK(buffer.indices().data() == levels.indices(0).data());
    for (std::size_t level = 0; level < levels.size(); ++level) {
        CAPTURE(level);
        const decimesh::NestedLevel described = levels.level(level);
        CHECK(described.index_count == levels.indices(level).size());
        CHECK(described.stopped_by == decimesh::StoppedBy::target);
        CHECK_FALSE(described.topology_changed);
        checks::check_triangles(levels.indices(level), described.vertices);
        if (level > 0) {
            checks::check_count(described.index_count / 3,
                                static_cast<std::size_t>(three_ratios[level - 1].value() *
                                                         static_cast<double>(mesh.triangle_count())));
            CHECK(described.vertices <= levels.level(level - 1).vertices);
            CHECK(described.error >= levels.level(level - 1).error);
        }
    }
    CHECK(levels.level(0).error == 0);
}

TEST_CASE("nested: the order says where each vertex was") {
    const shapes::Dressed dressed(shapes::stone(24, 16));
    const Mesh mesh = dressed.mesh();
    const NestedLevels levels = NestedLevels::build(mesh, three_ratios);
    const Span<const std::uint32_t> order = levels.order();
    REQUIRE(order.size() == mesh.vertex_count());
    std::vector<std::uint32_t> sorted(order.begin(), order.end()), all(order.size());
    std::sort(sorted.begin(), sorted.end());
    std::iota(all.begin(), all.end(), 0U);
    CHECK(sorted == all);
    for (std::size_t vertex = 0; vertex < order.size(); ++vertex) {
        CHECK(checks::bits(levels.mesh().positions().data() + 3 * vertex) ==
              checks::bits(mesh.positions().data() + 3 * order[vertex]));
        CHECK(std::memcmp(levels.mesh().uvs().data() + 2 * vertex, mesh.uvs().data() + 2 * order[vertex],
                          2 * sizeof(float)) == 0);
    }
    for (std::size_t corner = 0; corner < mesh.indices().size(); ++corner) {
        CHECK(order[levels.indices(0)[corner]] == mesh.indices()[corner]);
    }
}

TEST_CASE("nested: levels are what a chain of existing vertices gives") {
    const Mesh mesh = shapes::stone(24, 16).mesh();
    const NestedLevels levels = NestedLevels::build(mesh, three_ratios);
    decimesh::Options options;
    options.placement = decimesh::Placement::existing;
    const decimesh::Levels chain = decimesh::Levels::build(mesh, three_ratios, options);
    for (std::size_t level = 0; level < chain.size(); ++level) {
        CAPTURE(level);
        const decimesh::MeshView view = chain.mesh(level);
        std::vector<checks::Bits> expected;
        for (const std::uint32_t vertex : view.indices()) {
            expected.push_back(checks::bits(view.positions().data() + 3 * vertex));
        }
        CHECK(corners(levels, level + 1) == expected);
        CHECK(levels.level(level + 1).error == chain.report(level).error);
    }
}

TEST_CASE("nested: morphs lead to the next level") {
    const Mesh mesh = shapes::stone(24, 16).mesh();
    const NestedLevels levels = NestedLevels::build(mesh, three_ratios);
    for (std::size_t level = 0; level + 1 < levels.size(); ++level) {
        const Span<const std::uint32_t> morphs = levels.morphs(level);
        REQUIRE(morphs.size() == levels.level(level).vertices);
        const std::size_t kept = levels.level(level + 1).vertices;
        for (std::size_t vertex = 0; vertex < morphs.size(); ++vertex) {
            CHECK((vertex < kept ? morphs[vertex] == vertex : morphs[vertex] < kept));
        }
    }
    CHECK(levels.morphs(levels.size() - 1).empty());
}

TEST_CASE("nested: indices are copied where they fit") {
    const NestedLevels levels = NestedLevels::build(shapes::stone(24, 16).mesh(), three_ratios);
    const Span<const std::uint32_t> own = levels.indices(2);
    std::vector<std::uint32_t> wide(own.size() + 1, 0x77777777);
    CHECK(levels.copy_indices(2, wide) == own.size());
    CHECK(std::equal(own.begin(), own.end(), wide.begin()));
    CHECK(wide.back() == 0x77777777);
    std::vector<std::uint16_t> narrow(own.size());
    CHECK(levels.copy_indices(2, narrow) == own.size());
    CHECK(std::equal(own.begin(), own.end(), narrow.begin()));
    // No alignment is asked for.
    std::vector<unsigned char> bytes(1 + 4 * own.size());
    CHECK(decimesh_nested_copy_indices(levels.get(), 2, DECIMESH_INDEX_U32, bytes.data() + 1, own.size()) ==
          DECIMESH_OK);
    CHECK(std::memcmp(bytes.data() + 1, own.data(), 4 * own.size()) == 0);

    narrow.assign(own.size() - 1, 7);
    const auto room = narrow.size();
    check_refused(decimesh_nested_copy_indices(levels.get(), 2, DECIMESH_INDEX_U16, narrow.data(), room),
                  DECIMESH_ERROR_TOO_LARGE, {"indices", std::to_string(room).c_str()});
    check_refused(decimesh_nested_copy_indices(levels.get(), 2, 3, narrow.data(), room), DECIMESH_ERROR_ENUM,
                  {"index_type is 3"});
    check_refused(decimesh_nested_copy_indices(levels.get(), 9, DECIMESH_INDEX_U16, narrow.data(), room),
                  DECIMESH_ERROR_OUT_OF_RANGE, {"level 9 of 4"});
    CHECK(narrow == std::vector<std::uint16_t>(room, 7));
    CHECK_THROWS_AS(levels.copy_indices(0, Span<std::uint32_t>()), decimesh::Error);
}

TEST_CASE("nested: 16 bits name the vertices of the levels that have few") {
    const NestedLevels levels = NestedLevels::build(shapes::plane(260).mesh(), {Target::ratio(0.1)});
    REQUIRE(levels.level(0).vertices > 65536);
    std::vector<std::uint16_t> narrow(levels.level(0).index_count);
    check_refused(decimesh_nested_copy_indices(levels.get(), 0, DECIMESH_INDEX_U16, narrow.data(), narrow.size()),
                  DECIMESH_ERROR_TOO_LARGE, {"16 bits"});
    CHECK(levels.copy_indices(1, narrow) == levels.level(1).index_count);
}

TEST_CASE("nested: the coarsest that is good enough is selected or else the mesh") {
    const NestedLevels levels = NestedLevels::build(shapes::stone(24, 16).mesh(), three_ratios);
    CHECK(levels.select(1e6F) == 3);
    CHECK(levels.select(levels.level(2).error) == 2);
    CHECK(levels.select(levels.level(1).error / 2) == 0);
    CHECK(levels.select(-1) == 0);
}

TEST_CASE("nested: certified errors are bounds and the mesh stays where it is") {
    NestedLevels levels = NestedLevels::build(shapes::stone(24, 16).mesh(), three_ratios);
    const decimesh_mesh *const buffer = levels.mesh().get();
    const Bytes before = bytes_of(levels.mesh());
    levels.certify();
    CHECK(levels.mesh().get() == buffer);
    CHECK(bytes_of(levels.mesh()) == before);
    for (std::size_t level = 1; level < levels.size(); ++level) {
        const Span<const std::uint32_t> indices = levels.indices(level);
        const Mesh coarse = Mesh::from_buffers(levels.mesh().positions(), indices);
        const decimesh::Bound found = decimesh::bound(levels.mesh(), coarse);
        CHECK(levels.level(level).error >= found.lower);
        CHECK(levels.level(level).error <= doctest::Approx(found.upper).epsilon(1e-6));
    }
    decimesh::BoundOptions options;
    options.progress = [](float) { return false; };
    const float error = levels.level(3).error;
    CHECK_THROWS_AS(levels.certify(options), decimesh::Cancelled);
    options.progress = {};
    options.tolerance = -1;
    CHECK_THROWS_AS(levels.certify(options), decimesh::Error);
    CHECK(levels.level(3).error == error);
    CHECK(bytes_of(levels.mesh()) == before);
}

TEST_CASE("nested: one file holds all levels") {
    const auto path = std::filesystem::temp_directory_path() / "decimesh-tests-nested.glb";
    const NestedLevels levels = NestedLevels::build(shapes::Dressed(shapes::stone(24, 16)).mesh(), three_ratios);
    levels.write_glb(path.string());
    std::ifstream file(path, std::ios::binary);
    const std::string text((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
    CHECK(text.substr(0, 4) == "glTF");
    CHECK(text.find("MSFT_lod") != std::string::npos);
    const std::size_t vertices = levels.mesh().vertex_count();
    CHECK(text.size() < 36 * vertices + 4 * 2 * levels.indices(0).size() + 8192);
    std::filesystem::remove(path);
    try {
        levels.write_glb("/no/such/directory/levels.glb");
        FAIL("a file appeared where there is no directory");
    } catch (const decimesh::Error &error) {
        CHECK(error.status() == decimesh::Status::io);
    }
}

TEST_CASE("nested: groups and flags and weights count") {
    const shapes::Dressed dressed(shapes::stone(24, 16));
    const Mesh mesh = dressed.mesh();
    decimesh::Options options;
    options.vertex_flags.resize(mesh.vertex_count());
    options.vertex_flags[77] = decimesh::vertex_flag::lock;
    options.attribute_weights.normals = 0.5F;
    options.triangle_groups.resize(mesh.triangle_count());
    const NestedLevels levels = NestedLevels::build(mesh, three_ratios, options);
    const std::uint32_t *const order = levels.order().data();
    const auto prefix = static_cast<std::ptrdiff_t>(levels.level(3).vertices);
    CHECK(std::find(order, order + prefix, 77) != order + prefix);
}

TEST_CASE("nested: bad calls are refused and write nothing") {
    const Mesh mesh = shapes::plane(8).mesh();
    decimesh_simplify_options options = calls::default_options();
    const double values[] = {0.5, 0.25};
    auto *nested = calls::nobody<decimesh_nested>();
    const auto build = [&](std::size_t count) {
        return decimesh_nested_build(mesh.get(), &options, values, count, &nested);
    };
    check_refused(build(0), DECIMESH_ERROR_EMPTY, {"count is 0"});
    check_refused(build(SIZE_MAX), DECIMESH_ERROR_OVERFLOW, {"target_values"});
    std::vector<std::uint32_t> room(1000, 7);
    options.origins = room.data();
    check_refused(build(2), DECIMESH_ERROR_OPTION, {"origins"});
    options.origins = nullptr;
    options.triangle_groups = room.data();
    options.result_groups = room.data();
    check_refused(build(2), DECIMESH_ERROR_OPTION, {"result_groups"});
    check_refused(decimesh_nested_build(nullptr, &options, values, 2, &nested), DECIMESH_ERROR_NULL, {"mesh"});
    check_refused(decimesh_nested_build(mesh.get(), nullptr, values, 2, &nested), DECIMESH_ERROR_NULL, {"options"});
    check_refused(decimesh_nested_build(mesh.get(), &options, nullptr, 2, &nested), DECIMESH_ERROR_NULL,
                  {"target_values"});
    check_refused(decimesh_nested_build(mesh.get(), &options, values, 2, nullptr), DECIMESH_ERROR_NULL, {"nested"});
    CHECK(nested == calls::nobody<decimesh_nested>());
    CHECK(room == std::vector<std::uint32_t>(1000, 7));

    NestedLevels owner = NestedLevels::build(mesh, {Target::ratio(0.5)});
    const decimesh_nested *const levels = owner.get();
    auto level = calls::untouched_struct<decimesh_nested_level>();
    const auto *indices = calls::nobody<const std::uint32_t>();
    std::size_t selected = 77;
    check_refused(decimesh_nested_describe(nullptr, 0, &level), DECIMESH_ERROR_NULL, {"nested"});
    check_refused(decimesh_nested_describe(levels, 0, nullptr), DECIMESH_ERROR_NULL, {"description"});
    check_refused(decimesh_nested_describe(levels, 2, &level), DECIMESH_ERROR_OUT_OF_RANGE, {"level 2 of 2"});
    check_refused(decimesh_nested_indices(levels, 2, &indices), DECIMESH_ERROR_OUT_OF_RANGE, {"level 2"});
    check_refused(decimesh_nested_indices(nullptr, 0, &indices), DECIMESH_ERROR_NULL, {"nested"});
    check_refused(decimesh_nested_indices(levels, 0, nullptr), DECIMESH_ERROR_NULL, {"indices"});
    check_refused(decimesh_nested_morphs(levels, SIZE_MAX, &indices), DECIMESH_ERROR_OUT_OF_RANGE, {"level"});
    check_refused(decimesh_nested_morphs(levels, 0, nullptr), DECIMESH_ERROR_NULL, {"morphs"});
    check_refused(decimesh_nested_groups(levels, 2, &indices), DECIMESH_ERROR_OUT_OF_RANGE, {"level 2"});
    check_refused(decimesh_nested_groups(levels, 0, nullptr), DECIMESH_ERROR_NULL, {"groups"});
    check_refused(decimesh_nested_copy_indices(levels, 0, DECIMESH_INDEX_U32, nullptr, 9), DECIMESH_ERROR_NULL,
                  {"destination"});
    check_refused(decimesh_nested_select(levels, NAN, &selected), DECIMESH_ERROR_NOT_FINITE, {"max_error"});
    check_refused(decimesh_nested_select(levels, 1, nullptr), DECIMESH_ERROR_NULL, {"level"});
    check_refused(decimesh_nested_certify(nullptr, nullptr), DECIMESH_ERROR_NULL, {"nested"});
    check_refused(decimesh_nested_write_glb(levels, nullptr), DECIMESH_ERROR_NULL, {"path"});
    check_refused(decimesh_nested_write_glb(levels, "\xFF.glb"), DECIMESH_ERROR_UTF8, {"UTF-8"});
    CHECK(calls::is_untouched(level));
    CHECK(indices == calls::nobody<const std::uint32_t>());
    CHECK(selected == 77);

    decimesh_nested_destroy(nullptr);
    decimesh_nested_level_init(nullptr, sizeof level);
    CHECK(decimesh_nested_count(nullptr) == 0);
    CHECK(decimesh_nested_mesh(nullptr) == nullptr);
    CHECK(decimesh_nested_order(nullptr) == nullptr);
    CHECK(NestedLevels().size() == 0);
    const NestedLevels none;
    CHECK(none.mesh().get() == nullptr);
    CHECK(none.order().empty());
    const Bytes before = bytes_of(owner.mesh());
    decimesh_mesh_destroy(const_cast<decimesh_mesh *>(owner.mesh().get()));
    CHECK(bytes_of(owner.mesh()) == before);
    const NestedLevels moved = std::move(owner);
    CHECK(bytes_of(moved.mesh()) == before);
}

TEST_SUITE_END();
