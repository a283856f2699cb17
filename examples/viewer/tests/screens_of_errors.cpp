/// What cannot be done ends with a message and a status, and never otherwise.

#include <fstream>

#include <doctest/doctest.h>

#include "picture.hpp"
#include "program.hpp"
#include "shapes.hpp"

namespace {

std::string file(const std::string &name, const std::string &text) {
    std::ofstream(name, std::ios::binary) << text;
    return name;
}

std::string pebble() {
    shapes::pebble(10).write("small.ply");
    return "small.ply";
}

void check_refused(const std::string &arguments, int status, const std::string &words) {
    CAPTURE(arguments);
    const Ended ended = view(arguments);
    CAPTURE(ended.output);
    CHECK(ended.status == status);
    CHECK(ended.says(words));
}

}   // namespace

TEST_CASE("errors: files that are no meshes") {
    const std::string header = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
                               "property float z\nelement face ";
    const std::string list = "\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n";
    check_refused("missing.ply --frames 1", 1, "missing.ply");
    check_refused(". --frames 1", 1, ".");
    check_refused(file("empty.ply", "") + " --frames 1", 1, "empty.ply");
    check_refused(file("letter.ply", "Dear reader,\n") + " --frames 1", 1, "letter.ply");
    check_refused(file("letter.obj", "Dear reader,\n") + " --frames 1", 1, "letter.obj");
    check_refused(file("picture.xyz", "0 0 0\n") + " --frames 1", 1, "picture.xyz");
    check_refused(file("noise.stl", std::string(84, '\xFF')) + " --frames 1", 1, "noise.stl");
    check_refused(file("faceless.ply", header + "0" + list) + " --frames 1", 1, "no triangles");
    check_refused(file("cut.ply", header + "5" + list + "3 0 1 2\n") + " --frames 1", 1, "cut.ply");
    check_refused(file("beyond.ply", header + "1" + list + "3 0 1 7\n") + " --frames 1", 1, "7");
}

TEST_CASE("errors: what leaves nothing to see, or cannot be written") {
    check_refused(pebble() + " --triangles 0 --frames 1", 1, "0 triangles");
    check_refused(pebble() + " --levels 0 --frames 1", 1, "0 levels");
    check_refused(pebble() + " --levels 3 --level 9 --save level.ply --frames 1", 1, "level 9");
    check_refused(pebble() + " --triangles 50 --save no/such/place.ply --frames 1", 1, "no/such/place.ply");
    check_refused(pebble() + " --triangles 50 --save mesh.unknown --frames 1", 1, "unknown");
    check_refused(pebble() + " --screenshot no/such/place.png", 1, "no/such/place.png");
    // The first failure ends what was asked for.
    check_refused("missing.ply --triangles 50 --save never.ply --frames 1", 1, "missing.ply");
    CHECK_FALSE(std::ifstream("never.ply").good());
}

TEST_CASE("errors: command lines that make no sense, and no display") {
    check_refused(pebble() + " --engine magic", 2, "magic");
    check_refused("--triangles 5", 2, "no mesh");
    CHECK(view("--help").status == 0);
    const Ended blind = run("unset DISPLAY WAYLAND_DISPLAY; exec \"$VIEWER\" --frames 1");
    CAPTURE(blind.output);
    CHECK(blind.status == 1);
    CHECK(blind.says("display"));
}

TEST_CASE("errors: they are in the panel, in red") {
    const auto is_red = [](const viewer::Color &color) { return color[0] > 200 && color[1] < 120 && color[2] < 120; };
    const Part panel{0, 0, 330, 400};
    CHECK(view("missing.ply --screenshot failed.png").status == 1);
    CHECK(Picture("failed.png").share(panel, is_red) > 0.001);
    CHECK(view(pebble() + " --screenshot well.png").status == 0);
    CHECK(Picture("well.png").share(panel, is_red) == 0);
}

TEST_CASE("errors: meshes that wish it ill are shown, or refused, but nothing breaks") {
    // All in one point, a line, far out, and with a vertex farther still.
    const std::string point = "OFF\n3 1 0\n5 5 5\n5 5 5\n5 5 5\n3 0 1 2\n";
    const std::string line = "OFF\n3 1 0\n0 0 0\n1 0 0\n2 0 0\n3 0 1 2\n";
    const std::string far_out = "OFF\n4 1 0\n1e30 0 0\n1.1e30 0 0\n1e30 1e29 0\n-3e38 0 0\n3 0 1 2\n";
    for (const std::string &text : {point, line, far_out}) {
        for (const char *what : {"--triangles 1", "--triangles 1 --engine indices", "--levels 24"}) {
            const Ended ended =
                view(file("odd.off", text) + " " + what + " --view deviation --wireframe --frames 2");
            CAPTURE(text);
            CAPTURE(what);
            CAPTURE(ended.output);
            CHECK(ended.status <= 1);
        }
    }
    CHECK(view(pebble() + " --size 1 1 --frames 2").status == 0);
    CHECK(view(pebble() + " --triangles 1000000 --view deviation --frames 2").status == 0);
    CHECK(view(pebble() + " --view result --level 99 --frames 2").status == 0);
}
