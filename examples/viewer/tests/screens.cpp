/// The viewer's pictures, one of each kind, and whether they show what they should.

#include <cstdlib>
#include <fstream>
#include <sstream>

#include <decimesh.hpp>
#include <doctest/doctest.h>

#include "picture.hpp"
#include "program.hpp"
#include "reduction.hpp"
#include "shapes.hpp"

using viewer::Color;

namespace {

/// The stage and its halves, in pictures of the window's own size, 1280 by 800; captions and legend left out.
constexpr Part stage{340, 40, 640, 740};
constexpr Part left_half{340, 40, 460, 740};
constexpr Part right_half{815, 40, 460, 740};
/// In the scale of the heat map.
constexpr int scale_x = 1072;

bool is_background(const Color &color) {
    return std::abs(color[0] - 33) <= 2 && std::abs(color[1] - 36) <= 2 && std::abs(color[2] - 43) <= 2;
}

bool is_surface(const Color &color) {
    return !is_background(color);
}

bool is_edge(const Color &color) {
    return color == Color{13, 15, 20};
}

/// As grey as an uncoloured surface is.
bool is_grey(const Color &color) {
    return is_surface(color) && std::abs(color[0] - color[2]) < 25;
}

bool is_violet(const Color &color) {
    return color[2] > color[1] + 30 && color[0] > color[1] + 10;
}

bool is_green(const Color &color) {
    return color[1] > color[0] + 30 && color[1] > color[2] - 10;
}

/// A pebble of 10,000 triangles in the directory that tests run in.
std::string pebble() {
    shapes::pebble(50).write("pebble.ply");
    return "pebble.ply";
}

/// The picture that the viewer makes with these arguments, without an error.
Picture picture_of(const std::string &name, const std::string &arguments) {
    const Ended ended = view(arguments + " --screenshot " + name + ".png");
    CAPTURE(ended.output);
    REQUIRE(ended.status == 0);
    const Picture picture(name + ".png");
    REQUIRE(picture.width() == 1280);
    REQUIRE(picture.height() == 800);
    return picture;
}

/// The decimesh command, quoted for the shell; empty if there is none.
std::string decimesh_command() {
    const char *command = std::getenv("DECIMESH");
    return command == nullptr || *command == '\0' ? "" : "'" + std::string(command) + "'";
}

std::string bytes_of(const std::string &path) {
    std::ifstream file(path, std::ios::binary);
    REQUIRE(file.good());
    std::ostringstream bytes;
    bytes << file.rdbuf();
    return bytes.str();
}

}   // namespace

TEST_CASE("screens: nothing is open") {
    const Picture picture = picture_of("empty", "");
    CHECK(picture.share(stage, is_background) == 1);
}

TEST_CASE("screens: the original fills the stage, and nothing is behind it") {
    const Picture picture = picture_of("original", pebble() + " --view original");
    CHECK(picture.share(stage, is_surface) > 0.2);
    CHECK(picture.share(stage, is_background) > 0.1);
    CHECK(picture.share(stage, is_violet) == 0);
    // The same again, pixel by pixel.
    const Picture again = picture_of("original-again", pebble() + " --view original");
    CHECK(picture.difference(stage, again, stage) == 0);
}

TEST_CASE("screens: side by side, by one camera") {
    const Picture before = picture_of("side-before", pebble());
    CHECK(before.share(left_half, is_surface) > 0.1);
    CHECK(before.share(right_half, is_surface) < 0.01);
    const Picture picture = picture_of("side-by-side", pebble() + " --triangles 300");
    CHECK(picture.share(left_half, is_surface) > 0.1);
    CHECK(picture.share(right_half, is_surface) ==
          doctest::Approx(picture.share(left_half, is_surface)).epsilon(0.05));
    CHECK(picture.difference(left_half, picture, right_half) > 0.05);
    // Nothing gained, nothing lost: halves of the same triangles are the same.
    const Picture same = picture_of("side-same", pebble() + " --triangles 10000");
    CHECK(same.share(right_half, is_surface) == doctest::Approx(same.share(left_half, is_surface)).epsilon(0.001));
    const Picture turned = picture_of("side-turned", pebble() + " --triangles 300 --orbit 60 20 --zoom 2");
    CHECK(turned.difference(left_half, picture, left_half) > 0.1);
    CHECK(turned.share(right_half, is_surface) ==
          doctest::Approx(turned.share(left_half, is_surface)).epsilon(0.05));
}

TEST_CASE("screens: wireframe and facets") {
    const std::string result = pebble() + " --triangles 600 --view result";
    const Picture smooth = picture_of("smooth", result);
    const Picture wired = picture_of("wireframe", result + " --wireframe");
    const Picture facets = picture_of("facets", result + " --facets");
    CHECK(smooth.share(stage, is_edge) == 0);
    CHECK(wired.share(stage, is_edge) > 0.02);
    CHECK(wired.difference(stage, smooth, stage) > 0.02);
    // Between the edges it is as it was.
    CHECK(wired.difference(stage, smooth, stage) < 0.3);
    CHECK(facets.share(stage, is_edge) == 0);
    CHECK(facets.difference(stage, smooth, stage) > 0.1);
}

TEST_CASE("screens: the heat map has the colours of its scale, and the scale its numbers") {
    const std::string heat = pebble() + " --triangles 300 --view deviation";
    const Picture picture = picture_of("deviation", heat);
    CHECK(picture.share(stage, is_violet) > 0.05);
    CHECK(picture.share(stage, is_green) > 0.001);
    CHECK(picture.share(stage, is_grey) < 0.1);
    // The scale: a column of the colours, from the first at the bottom to the last at the top.
    const auto table = viewer::color_table();
    int color = 255;
    for (int y = 0; y < 800 && color >= 0; ++y) {
        if (picture.at(scale_x, y) == table[static_cast<std::size_t>(color)]) {
            --color;
        }
    }
    CHECK(color == -1);
    // A scale that ends sooner has more of its upper colours.
    const Picture shorter = picture_of("deviation-shorter", heat + " --scale 0.3");
    CHECK(shorter.share(stage, is_green) > 3 * picture.share(stage, is_green));
    // With edges: those of the result, which are few.
    const Picture wired = picture_of("deviation-wireframe", heat + " --wireframe");
    CHECK(wired.share(stage, is_edge) > 0.005);
    CHECK(wired.share(stage, is_edge) < 0.15);
    // What is the same everywhere is the first colour everywhere.
    const Picture none = picture_of("deviation-none", pebble() + " --triangles 10000 --view deviation");
    CHECK(none.share(stage, is_violet) > 0.2);
    CHECK(none.share(stage, is_green) == 0);
}

TEST_CASE("screens: levels are stepped through over vertices that are uploaded once") {
    const std::string levels = pebble() + " --levels 5 --view result --facets";
    const Picture fine = picture_of("level-0", levels + " --level 0");
    const Picture coarse = picture_of("level-5", levels + " --level 5");
    CHECK(coarse.share(stage, is_surface) > 0.2);
    CHECK(fine.difference(stage, coarse, stage) > 0.2);
    const Ended played = view(levels + " --play --frames 40");
    CHECK(played.status == 0);
    CAPTURE(played.output);
    // By halves, or one fewer.
    CHECK(played.says(": 10000 5000 2500 1250 6"));
    CHECK(played.says("40 frames; uploaded 1 vertex buffers, 6 index buffers, 0 value buffers"));
    const std::string deviation = pebble() + " --levels 5 --view deviation";
    const Ended heat = view(deviation + " --play --frames 40");
    CHECK(heat.says("40 frames; uploaded 1 vertex buffers, 1 index buffers, 6 value buffers"));
    // The colours of level 0 and the edges of another come from the same vertices.
    const Picture wired = picture_of("level-5-deviation", deviation + " --level 5 --wireframe");
    CHECK(wired.share(stage, is_violet) > 0.05);
    CHECK(wired.share(stage, is_edge) > 0.005);
    CHECK(wired.share(stage, is_edge) < 0.15);
    const Ended wired_heat = view(deviation + " --wireframe --play --frames 40");
    CHECK(wired_heat.says("40 frames; uploaded 1 vertex buffers, 6 index buffers, 6 value buffers"));
}

TEST_CASE("screens: results are those of the library, byte by byte, and of the command where there is one") {
    const std::string mesh = pebble();
    const decimesh::Mesh original = decimesh::Mesh::read(mesh);
    for (const viewer::Engine engine : viewer::all_engines) {
        const std::string name = viewer::name_of(engine);
        CAPTURE(name);
        const std::string chosen = " --triangles 777 --engine " + name;
        const Ended ended = view(mesh + chosen + " --save saved.ply --frames 1");
        CAPTURE(ended.output);
        REQUIRE(ended.status == 0);
        const decimesh::Mesh saved = decimesh::Mesh::read("saved.ply");
        CHECK(ended.says(name + ": " + std::to_string(saved.triangle_count()) + " triangles"));

        if (engine == viewer::Engine::multiple_choice) {
            decimesh::multiple_choice(original, 777).mesh.write("library.ply");
        } else {
            decimesh::Options options;
            options.target = decimesh::Target::triangles(777);
            options.placement = engine == viewer::Engine::hqms ? decimesh::Placement::optimal
                                                               : decimesh::Placement::existing;
            decimesh::simplify(original, options).mesh.write("library.ply");
        }
        CHECK(bytes_of("saved.ply") == bytes_of("library.ply"));

        if (const std::string command = decimesh_command(); !command.empty()) {
            const Ended made = run(command + " simplify " + mesh + " command.ply --quiet" + chosen);
            CAPTURE(made.output);
            REQUIRE(made.status == 0);
            CHECK(bytes_of("saved.ply") == bytes_of("command.ply"));
        }
    }
}

TEST_CASE("screens: work shows its progress, and a window that closes does not wait for it") {
    shapes::pebble(500).write("large.ply");
    // The first frame comes while a million triangles are read; and there is none after it.
    const Ended ended = view("large.ply --levels 12 --no-wait --frames 1 --screenshot busy.png");
    CAPTURE(ended.output);
    CHECK(ended.status == 0);
    CHECK_FALSE(ended.says("levels in"));
    // A button to cancel, where there is none without work.
    const Part button{265, 75, 50, 12};
    const auto is_button = [](const Color &color) { return color[2] > color[0] + 60; };
    CHECK(Picture("busy.png").share(button, is_button) > 0.5);
    CHECK(picture_of("idle", "").share(button, is_button) == 0);
}

/// The pictures of docs/viewer.md, of the statue that the command makes.
TEST_CASE("screens: of the documentation") {
    const std::string command = decimesh_command();
    if (command.empty()) {
        MESSAGE("no command, no statue");
        return;
    }
    const Ended made = run(command + " demo statue --triangles 100000 --width 100 --quiet");
    CAPTURE(made.output);
    REQUIRE(made.status == 0);
    const std::string statue = "statue/statue.ply --size 1100 640 --orbit -25 -5";
    for (const auto &[name, arguments] : {std::pair{"viewer-side-by-side", " --triangles 4000 --wireframe --zoom 2"},
                                          std::pair{"viewer-deviation", " --triangles 4000 --view deviation --scale 0.5"},
                                          std::pair{"viewer-levels", " --levels 7 --level 5 --facets --zoom 2"}}) {
        const Ended ended = view(statue + arguments + " --screenshot " + name + ".png");
        CAPTURE(ended.output);
        REQUIRE(ended.status == 0);
        CHECK(Picture(std::string(name) + ".png").width() == 1100);
        CHECK(bytes_of(std::string(name) + ".png").size() < 300000);
    }
}
