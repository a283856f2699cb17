#include "session.hpp"

#include <filesystem>
#include <fstream>

#include <doctest/doctest.h>

#include "shapes.hpp"

using viewer::Engine;
using viewer::Session;

namespace {

namespace fs = std::filesystem;

/// A directory that goes with its owner.
class Scratch {
public:
    Scratch() {
        std::string name = (fs::temp_directory_path() / "viewer-XXXXXX").string();
        REQUIRE(mkdtemp(name.data()) != nullptr);
        directory_ = name;
    }
    ~Scratch() { fs::remove_all(directory_); }

    std::string path(const char *name) const { return (directory_ / name).string(); }
    std::string pebble(std::uint32_t rings) const {
        shapes::pebble(rings).write(path("pebble.ply"));
        return path("pebble.ply");
    }

private:
    fs::path directory_;
};

void finish(Session &session) {
    while (session.is_busy()) {
        session.poll();
        std::this_thread::yield();
    }
}

bool says(const Session &session, const char *words) {
    return session.message().find(words) != std::string::npos;
}

}   // namespace

TEST_CASE("session: open, simplify, save, and what was saved is what there is") {
    const Scratch scratch;
    Session session;
    CHECK(session.original() == nullptr);
    CHECK(session.level_count() == 0);
    session.open(scratch.pebble(40));
    finish(session);
    CHECK_FALSE(session.has_failed());
    REQUIRE(session.original() != nullptr);
    CHECK(session.original()->mesh.triangle_count() == 4 * 40 * 40);

    session.simplify(Engine::hqms, 500);
    CHECK(session.is_busy());
    CHECK(session.activity() == "simplifying");
    finish(session);
    CHECK(session.level_count() == 1);
    CHECK(session.distances(0) != nullptr);
    CHECK(session.distances(1) == nullptr);
    session.save(scratch.path("saved.obj"), 0);
    CHECK_FALSE(session.has_failed());
    CHECK(decimesh::Mesh::read(scratch.path("saved.obj")).triangle_count() ==
          std::get<viewer::Reduced>(session.result()).mesh.triangle_count());
}

TEST_CASE("session: levels are saved one by one, or all in a GLB") {
    const Scratch scratch;
    Session session;
    session.open(scratch.pebble(30));
    finish(session);
    session.build_levels(3);
    finish(session);
    REQUIRE(session.level_count() == 4);
    session.save(scratch.path("level.ply"), 2);
    CHECK_FALSE(session.has_failed());
    CHECK(decimesh::Mesh::read(scratch.path("level.ply")).triangle_count() <= 4 * 30 * 30 / 4);
    session.save(scratch.path("all.glb"), 0);
    CHECK_FALSE(session.has_failed());
    CHECK(fs::file_size(scratch.path("all.glb")) > 0);
    session.save(scratch.path("none.ply"), 4);
    CHECK(session.has_failed());
    CHECK(says(session, "level 4"));
    CHECK_FALSE(fs::exists(scratch.path("none.ply")));
}

TEST_CASE("session: a cancelled simplification leaves all as it was, and the next one works") {
    const Scratch scratch;
    Session session;
    session.open(scratch.pebble(400));
    finish(session);
    session.simplify(Engine::hqms, 2000);
    finish(session);
    const auto version = session.result_version();
    session.simplify(Engine::indices, 10);
    session.cancel();
    finish(session);
    CHECK_FALSE(session.has_failed());
    CHECK(says(session, "cancelled"));
    CHECK(session.result_version() == version);
    CHECK(session.level_count() == 1);
    session.build_levels(2);
    // Begun in the middle of the other, which goes.
    session.simplify(Engine::indices, 1000);
    finish(session);
    CHECK(session.level_count() == 1);
    CHECK(std::get<viewer::Reduced>(session.result()).mesh.triangle_count() <= 1000);
}

TEST_CASE("session: what fails says so, and leaves all as it was") {
    const Scratch scratch;
    Session session;
    session.simplify(Engine::hqms, 10);
    CHECK(session.has_failed());
    session.build_levels(2);
    CHECK(session.has_failed());
    session.save(scratch.path("nothing.ply"), 0);
    CHECK(session.has_failed());
    session.cancel();

    session.open(scratch.pebble(10));
    finish(session);
    session.open(scratch.path("missing.ply"));
    finish(session);
    CHECK(session.has_failed());
    CHECK(says(session, "missing.ply"));
    REQUIRE(session.original() != nullptr);
    CHECK(session.original()->mesh.triangle_count() == 400);

    session.simplify(Engine::hqms, 0);
    finish(session);
    CHECK(session.has_failed());
    session.simplify(Engine::hqms, 40);
    finish(session);
    CHECK_FALSE(session.has_failed());
    session.save(scratch.path("no/such/directory.ply"), 0);
    CHECK(session.has_failed());
    session.save(scratch.path("mesh.unknown"), 0);
    CHECK(session.has_failed());
    CHECK(session.level_count() == 1);
}

TEST_CASE("session: it may go while work is going on") {
    const Scratch scratch;
    Session session;
    session.open(scratch.pebble(300));
    finish(session);
    session.simplify(Engine::hqms, 10);
}
