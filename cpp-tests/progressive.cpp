/// Progressive meshes and their players.

#include <cmath>
#include <filesystem>
#include <fstream>
#include <type_traits>

#include "calls.hpp"

using calls::check_refused;
using decimesh::Mesh;
using decimesh::Player;
using decimesh::Progressive;
using decimesh::Span;
using decimesh::Target;

TEST_SUITE_BEGIN("quick");

namespace {

static_assert(std::is_nothrow_move_constructible_v<Progressive> && !std::is_copy_constructible_v<Progressive>);
static_assert(std::is_nothrow_move_constructible_v<Player> && !std::is_copy_constructible_v<Player>);

const std::vector<Target> two_ratios = {Target::ratio(0.5), Target::ratio(0.1)};

Progressive made(const Mesh &mesh) {
    return Progressive::build(mesh, two_ratios);
}

std::vector<std::uint32_t> indices_at(const Progressive &progressive, std::size_t step) {
    std::vector<std::uint32_t> indices(3 * progressive.triangle_count(step));
    CHECK(progressive.copy_indices(step, indices) == indices.size());
    return indices;
}

/// A file's bytes, as the library writes them. Tests run side by side, so each has a `name` of its own.
std::string file_of(const Progressive &progressive, const std::string &name) {
    const auto path = std::filesystem::temp_directory_path() / ("decimesh-tests-" + name + ".dpm");
    progressive.write(path.string());
    std::ifstream file(path, std::ios::binary);
    std::string bytes((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
    file.close();
    std::filesystem::remove(path);
    return bytes;
}

}   // namespace

TEST_CASE("progressive: every level is a mesh in prefixes and the finest is the input") {
    const Mesh mesh = shapes::Dressed(shapes::stone(24, 16)).mesh();
    const Progressive progressive = made(mesh);
    REQUIRE(progressive.steps() > 100);
    for (std::size_t step = 0; step <= progressive.steps(); step += 37) {
        const std::vector<std::uint32_t> indices = indices_at(progressive, step);
        checks::check_triangles(Span<const std::uint32_t>(indices), progressive.vertex_count(step));
        const Mesh level = progressive.mesh(step);
        CHECK(bytes_of(level.indices()) == bytes_of(Span<const std::uint32_t>(indices)));
        CHECK(progressive.step_within(progressive.triangle_count(step)) == step);
    }
    CHECK(progressive.triangle_count(progressive.steps()) == mesh.triangle_count());
    CHECK(progressive.triangle_count(SIZE_MAX) == mesh.triangle_count());
    CHECK(progressive.vertices().vertex_count() == mesh.vertex_count());
    CHECK(progressive.vertices().triangle_count() == 0);
    REQUIRE(progressive.order().size() == mesh.vertex_count());
    for (std::size_t vertex = 0; vertex < mesh.vertex_count(); ++vertex) {
        CHECK(checks::bits(progressive.vertices().positions().data() + 3 * vertex) ==
              checks::bits(mesh.positions().data() + 3 * progressive.order()[vertex]));
    }
}

TEST_CASE("progressive: targets are marked") {
    const Mesh mesh = shapes::stone(24, 16).mesh();
    const Progressive progressive = made(mesh);
    const std::vector<Progressive::Mark> marks = progressive.marks();
    REQUIRE(marks.size() == 2);
    for (std::size_t mark = 0; mark < marks.size(); ++mark) {
        checks::check_count(progressive.triangle_count(marks[mark].step),
                            static_cast<std::size_t>(two_ratios[mark].value() *
                                                     static_cast<double>(mesh.triangle_count())));
    }
    CHECK(marks[1].step == 0);
    CHECK(marks[0].error <= marks[1].error);
    decimesh::Options options;
    options.placement = decimesh::Placement::existing;
    CHECK(marks[1].error == decimesh::Levels::build(mesh, two_ratios, options).report(1).error);
}

TEST_CASE("progressive: files and memory bring the same levels back") {
    const Progressive progressive = made(shapes::Dressed(shapes::stone(24, 16)).mesh());
    const std::string bytes = file_of(progressive, "back");
    const Progressive whole = Progressive::from_memory(bytes.data(), bytes.size());
    CHECK(whole.steps() == progressive.steps());
    CHECK(bytes_of(whole.vertices()) == bytes_of(progressive.vertices()));
    CHECK(whole.order().empty());
    CHECK(whole.marks().size() == progressive.marks().size());
    for (const std::size_t step : {std::size_t{0}, progressive.steps() / 2, progressive.steps()}) {
        CHECK(indices_at(whole, step) == indices_at(progressive, step));
    }
    CHECK(file_of(whole, "back") == bytes);

    // The beginning of a file is enough for a coarse level.
    const Progressive part = Progressive::from_memory(bytes.data(), bytes.size(), 200);
    CHECK(part.steps() == progressive.step_within(200));
    CHECK(indices_at(part, part.steps()) == indices_at(progressive, part.steps()));
    const Progressive beginning = Progressive::from_memory(bytes.data(), bytes.size() / 2, 200);
    CHECK(beginning.steps() == part.steps());

    const auto path = std::filesystem::temp_directory_path() / "decimesh-tests-read.dpm";
    progressive.write(path.string());
    CHECK(Progressive::read(path.string(), 200).steps() == part.steps());
    CHECK(Progressive::read(path.string()).steps() == progressive.steps());
    std::filesystem::remove(path);
}

TEST_CASE("progressive: damaged bytes are refused or are still a mesh") {
    const std::string bytes = file_of(made(shapes::stone(12, 8).mesh()), "beginning");
    auto *progressive = calls::nobody<decimesh_progressive>();
    for (std::size_t size = 0; size < bytes.size(); size += 1 + bytes.size() / 200) {
        // A copy no longer than that, so that sanitizers see what is read beyond its end.
        const std::vector<char> cut(bytes.data(), bytes.data() + size);
        const void *const first = cut.empty() ? bytes.data() : cut.data();
        check_refused(decimesh_progressive_from_memory(first, size, SIZE_MAX, &progressive), DECIMESH_ERROR_FORMAT,
                      {});
        CHECK(progressive == calls::nobody<decimesh_progressive>());
    }
    for (std::size_t place = 0; place < bytes.size(); place += 1 + bytes.size() / 300) {
        std::string damaged = bytes;
        damaged[place] = static_cast<char>(damaged[place] ^ 0x55);
        try {
            const Progressive read = Progressive::from_memory(damaged.data(), damaged.size());
            for (const std::size_t step : {std::size_t{0}, read.steps()}) {
                const std::vector<std::uint32_t> indices = indices_at(read, step);
                const std::size_t vertices = read.vertex_count(step);
                CHECK(std::all_of(indices.begin(), indices.end(),
                                  [&](std::uint32_t vertex) { return vertex < vertices; }));
            }
        } catch (const decimesh::Error &error) {
            CHECK(error.status() != decimesh::Status::panic);
        }
    }
}

TEST_CASE("progressive: indices are copied where they fit") {
    const Progressive progressive = made(shapes::stone(24, 16).mesh());
    const std::size_t step = progressive.step_within(100);
    const std::vector<std::uint32_t> wide = indices_at(progressive, step);
    std::vector<std::uint16_t> narrow(wide.size());
    CHECK(progressive.copy_indices(step, narrow) == wide.size());
    CHECK(std::equal(wide.begin(), wide.end(), narrow.begin()));
    const auto copy = [&](decimesh_index_type type, std::size_t room) {
        return decimesh_progressive_copy_indices(progressive.get(), step, type, narrow.data(), room);
    };
    check_refused(copy(DECIMESH_INDEX_U16, wide.size() - 1), DECIMESH_ERROR_TOO_LARGE, {"indices", "room"});
    check_refused(copy(0, wide.size()), DECIMESH_ERROR_ENUM, {"index_type is 0"});
}

TEST_CASE("player: goes to every level and back") {
    const Progressive progressive = made(shapes::stone(16, 12).mesh());
    Player player(progressive);
    CHECK(player.step() == 0);
    CHECK_FALSE(player.coarser());
    std::size_t step = 0;
    do {
        CHECK(player.step() == step);
        CHECK(player.vertex_count() == progressive.vertex_count(step));
        CHECK(bytes_of(player.indices()) == bytes_of(Span<const std::uint32_t>(indices_at(progressive, step))));
        ++step;
    } while (player.finer());
    CHECK(step == progressive.steps() + 1);
    for (const std::size_t goal : {progressive.steps() / 3, std::size_t{0}, SIZE_MAX, progressive.steps() / 2}) {
        player.go_to(goal);
        CHECK(player.step() == std::min(goal, progressive.steps()));
        CHECK(bytes_of(player.indices()) ==
              bytes_of(Span<const std::uint32_t>(indices_at(progressive, player.step()))));
    }
    CHECK(player.coarser());
    std::vector<std::uint16_t> narrow(player.indices().size());
    CHECK(player.copy_indices(narrow) == narrow.size());
    CHECK(std::equal(narrow.begin(), narrow.end(), player.indices().begin()));
    CHECK_THROWS_AS(player.copy_indices(Span<std::uint32_t>()), decimesh::Error);
}

TEST_CASE("player: outlives the handle of what it plays") {
    Player player;
    CHECK(player.indices().empty());
    CHECK_THROWS_AS(player.finer(), decimesh::Error);
    std::vector<std::uint32_t> finest;
    {
        const Progressive progressive = made(shapes::stone(16, 12).mesh());
        player = Player(progressive);
        finest = indices_at(progressive, progressive.steps());
    }
    player.go_to(SIZE_MAX);
    CHECK(bytes_of(player.indices()) == bytes_of(Span<const std::uint32_t>(finest)));
}

TEST_CASE("progressive: bad calls are refused and write nothing") {
    const Mesh mesh = shapes::plane(8).mesh();
    decimesh_simplify_options options = calls::default_options();
    const double values[] = {0.5};
    auto *progressive = calls::nobody<decimesh_progressive>();
    auto *player = calls::nobody<decimesh_player>();
    auto *level = calls::nobody<decimesh_mesh>();
    const auto build = [&] { return decimesh_progressive_build(mesh.get(), &options, values, 1, &progressive); };
    check_refused(decimesh_progressive_build(nullptr, &options, values, 1, &progressive), DECIMESH_ERROR_NULL,
                  {"mesh"});
    check_refused(decimesh_progressive_build(mesh.get(), &options, values, 0, &progressive), DECIMESH_ERROR_EMPTY,
                  {"count is 0"});
    options.topology = 3;
    check_refused(build(), DECIMESH_ERROR_ENUM, {"topology is 3"});
    options = calls::default_options();
    std::vector<std::uint32_t> origins(mesh.vertex_count(), 7);
    options.origins = origins.data();
    check_refused(build(), DECIMESH_ERROR_OPTION, {"origins"});
    CHECK(origins == std::vector<std::uint32_t>(mesh.vertex_count(), 7));
    const char bytes[8] = {};
    const auto from_memory = [&](const void *first, std::size_t size) {
        return decimesh_progressive_from_memory(first, size, SIZE_MAX, &progressive);
    };
    check_refused(from_memory(nullptr, 8), DECIMESH_ERROR_NULL, {"bytes is NULL"});
    check_refused(from_memory(bytes, SIZE_MAX), DECIMESH_ERROR_OVERFLOW, {"size"});
    check_refused(from_memory(bytes, 8), DECIMESH_ERROR_FORMAT, {});
    check_refused(decimesh_progressive_read(nullptr, 1, &progressive), DECIMESH_ERROR_NULL, {"path"});
    check_refused(decimesh_progressive_read("\xFF", 1, &progressive), DECIMESH_ERROR_UTF8, {"UTF-8"});
    check_refused(decimesh_progressive_read("/no/such.dpm", 1, &progressive), DECIMESH_ERROR_IO, {"no/such.dpm"});
    check_refused(decimesh_player_create(nullptr, &player), DECIMESH_ERROR_NULL, {"progressive"});
    check_refused(decimesh_player_finer(nullptr), DECIMESH_ERROR_NULL, {"player"});
    check_refused(decimesh_player_coarser(nullptr), DECIMESH_ERROR_NULL, {"player"});
    check_refused(decimesh_player_go_to(nullptr, 3), DECIMESH_ERROR_NULL, {"player"});

    const Progressive good = Progressive::build(mesh, {Target::ratio(0.5)});
    std::size_t step = 77;
    float error = 77;
    check_refused(decimesh_progressive_mark(good.get(), 1, &step, &error), DECIMESH_ERROR_OUT_OF_RANGE,
                  {"mark 1 of 1"});
    check_refused(decimesh_progressive_mark(good.get(), 0, nullptr, &error), DECIMESH_ERROR_NULL, {"step"});
    check_refused(decimesh_progressive_mark(good.get(), 0, &step, nullptr), DECIMESH_ERROR_NULL, {"error"});
    check_refused(decimesh_progressive_mesh(good.get(), 0, nullptr), DECIMESH_ERROR_NULL, {"mesh"});
    check_refused(decimesh_progressive_mesh(nullptr, 0, &level), DECIMESH_ERROR_NULL, {"progressive"});
    check_refused(decimesh_progressive_write(good.get(), "/no/such/directory/x.dpm"), DECIMESH_ERROR_IO, {"x.dpm"});
    check_refused(decimesh_progressive_write(good.get(), nullptr), DECIMESH_ERROR_NULL, {"path"});
    check_refused(decimesh_progressive_copy_indices(good.get(), 0, DECIMESH_INDEX_U32, nullptr, 9),
                  DECIMESH_ERROR_NULL, {"destination"});
    check_refused(decimesh_player_create(good.get(), nullptr), DECIMESH_ERROR_NULL, {"player"});
    check_refused(decimesh_player_copy_indices(nullptr, DECIMESH_INDEX_U32, &step, 1), DECIMESH_ERROR_NULL,
                  {"player"});
    CHECK(step == 77);
    CHECK(error == 77);
    CHECK(progressive == calls::nobody<decimesh_progressive>());
    CHECK(player == calls::nobody<decimesh_player>());
    CHECK(level == calls::nobody<decimesh_mesh>());

    decimesh_progressive_destroy(nullptr);
    decimesh_player_destroy(nullptr);
    CHECK(decimesh_progressive_steps(nullptr) == 0);
    CHECK(decimesh_progressive_vertex_count(nullptr, 1) == 0);
    CHECK(decimesh_progressive_triangle_count(nullptr, 1) == 0);
    CHECK(decimesh_progressive_step_within(nullptr, 1) == 0);
    CHECK(decimesh_progressive_vertices(nullptr) == nullptr);
    CHECK(decimesh_progressive_order(nullptr) == nullptr);
    CHECK(decimesh_progressive_mark_count(nullptr) == 0);
    CHECK(decimesh_player_step(nullptr) == 0);
    CHECK(decimesh_player_vertex_count(nullptr) == 0);
    CHECK(decimesh_player_triangle_count(nullptr) == 0);
    CHECK(decimesh_player_indices(nullptr) == nullptr);
}

TEST_SUITE_END();
