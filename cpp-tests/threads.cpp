/// Many threads at once: one handle for all, a last error for each.

#include <atomic>
#include <thread>

#include "calls.hpp"

TEST_SUITE_BEGIN("quick");

namespace {

constexpr std::size_t thread_count = 8;

/// Calls `work` with its number in so many threads, which begin together.
template <class Work>
void at_once(Work work) {
    std::atomic<std::size_t> waiting{thread_count};
    std::vector<std::thread> threads;
    for (std::size_t number = 0; number < thread_count; ++number) {
        threads.emplace_back([&, number] {
            --waiting;
            while (waiting > 0) {
                std::this_thread::yield();
            }
            work(number);
        });
    }
    for (std::thread &thread : threads) {
        thread.join();
    }
}

}   // namespace

TEST_CASE("threads: one mesh and one chain serve many with the same bytes") {
    const decimesh::Mesh mesh = shapes::Dressed(shapes::stone(48, 32)).mesh();
    const decimesh::Levels levels =
        decimesh::Levels::build(mesh, {decimesh::Target::ratio(0.5), decimesh::Target::ratio(0.1)});
    const Bytes input = bytes_of(mesh);
    const auto work = [&](std::size_t number) {
        decimesh::Options options;
        options.target = decimesh::Target::ratio(0.2);
        options.threads = static_cast<std::uint32_t>(number % 3);
        decimesh::DeviationOptions measuring;
        measuring.samples = 500;
        measuring.threads = options.threads;
        const Bytes simplified = bytes_of(decimesh::simplify(mesh, options).mesh);
        const double numbers[] = {decimesh::deviation(mesh, levels.mesh(1), measuring).rms,
                                  mesh.statistics().surface_area,
                                  static_cast<double>(levels.select(levels.report(1).error).value_or(9))};
        return simplified + bytes_of(levels.mesh(0)) + bytes_of(decimesh::Span<const double>(numbers));
    };
    const Bytes expected = work(0);
    std::vector<Bytes> results(thread_count);
    at_once([&](std::size_t number) { results[number] = work(number); });
    for (const Bytes &result : results) {
        CHECK(result == expected);
    }
    CHECK(bytes_of(mesh) == input);
}

TEST_CASE("threads: one progressive mesh has a player in each and nested levels serve all") {
    const decimesh::Mesh mesh = shapes::stone(32, 24).mesh();
    const std::vector<decimesh::Target> targets = {decimesh::Target::ratio(0.1)};
    const decimesh::NestedLevels nested = decimesh::NestedLevels::build(mesh, targets);
    std::optional<decimesh::Progressive> progressive = decimesh::Progressive::build(mesh, targets);
    const decimesh::Mesh whole = progressive->mesh(SIZE_MAX);
    const Bytes finest = bytes_of(whole.indices());
    std::vector<decimesh::Player> players;
    for (std::size_t number = 0; number < thread_count; ++number) {
        players.emplace_back(*progressive);
    }
    // Ended beside those that play it.
    std::thread end([&] { progressive.reset(); });
    at_once([&](std::size_t number) {
        decimesh::Player &player = players[number];
        for (std::size_t round = 0; round < 4; ++round) {
            player.go_to(100 * round);
            player.go_to(SIZE_MAX);
        }
        CHECK(bytes_of(player.indices()) == finest);
        std::vector<std::uint16_t> indices(nested.level(1).index_count);
        CHECK(nested.copy_indices(1, indices) == indices.size());
        CHECK(std::equal(indices.begin(), indices.end(), nested.indices(1).begin()));
    });
    end.join();
}

TEST_CASE("threads: a mesh made by one may end in another") {
    decimesh::Mesh mesh = shapes::plane(8).mesh();
    std::thread([taken = std::move(mesh)] { CHECK(taken.triangle_count() == 128); }).join();
}

TEST_CASE("threads: each has a last error of its own") {
    const decimesh::Mesh mesh = shapes::plane(4).mesh();
    at_once([&](std::size_t number) {
        CHECK(std::string(decimesh_last_error_message()).empty());
        if (number == 0) {
            return;
        }
        for (int round = 0; round < 20; ++round) {
            const std::uint32_t missing = static_cast<std::uint32_t>(1000 * number);
            decimesh_simplify_options options = calls::default_options();
            options.locked_vertices = &missing;
            options.locked_count = 1;
            decimesh_mesh *made = nullptr;
            CHECK(decimesh_simplify(mesh.get(), &options, &made, nullptr) == DECIMESH_ERROR_OPTION);
            std::this_thread::yield();
            const std::string expected = "locked vertex " + std::to_string(missing) + " ";
            CHECK(checks::says(decimesh_last_error_message(), {expected.c_str()}));
        }
    });
}

TEST_CASE("threads: a message stays until the thread's next failure") {
    const decimesh::Mesh mesh = shapes::plane(4).mesh();
    CHECK(decimesh_mesh_weld(nullptr, 0, nullptr) == DECIMESH_ERROR_NULL);
    const char *const message = decimesh_last_error_message();
    const std::string before = message;
    decimesh::simplify(mesh);
    CHECK(static_cast<const void *>(decimesh_last_error_message()) == message);
    CHECK(std::string(message) == before);
}

TEST_SUITE_END();
