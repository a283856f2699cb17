#include "arguments.hpp"

#include <doctest/doctest.h>

using viewer::Arguments;
using viewer::parse;
using viewer::UsageError;

TEST_CASE("arguments: all of them") {
    const Arguments arguments = parse({"mesh.ply", "--engine", "indices", "--triangles", "20000", "--view", "deviation",
                                       "--wireframe", "--facets", "--scale", "0.5", "--orbit", "-30", "12.5", "--zoom",
                                       "2", "--size", "640", "480", "--frames", "7", "--no-wait", "--screenshot",
                                       "a.png", "--save", "b.obj"});
    CHECK(arguments.path == "mesh.ply");
    CHECK(arguments.engine == viewer::Engine::indices);
    CHECK(arguments.triangles == 20000);
    CHECK_FALSE(arguments.levels);
    CHECK(arguments.view.layout == viewer::Layout::deviation);
    CHECK(arguments.view.wireframe);
    CHECK(arguments.view.facets);
    CHECK(arguments.view.scale == 0.5F);
    CHECK(arguments.orbit_right == -30);
    CHECK(arguments.orbit_up == 12.5F);
    CHECK(arguments.zoom == 2);
    CHECK(arguments.width == 640);
    CHECK(arguments.height == 480);
    CHECK(arguments.frames == 7);
    CHECK(arguments.no_wait);
    CHECK(arguments.screenshot_path == "a.png");
    CHECK(arguments.save_path == "b.obj");
    CHECK(arguments.ends());
}

TEST_CASE("arguments: none is a window that stays") {
    const Arguments arguments = parse({});
    CHECK(arguments.path.empty());
    CHECK_FALSE(arguments.ends());
    CHECK(parse({"--screenshot", "a.png"}).ends());
    CHECK(parse({"-h"}).help);
}

TEST_CASE("arguments: what makes no sense is refused, and named") {
    struct Case {
        std::vector<std::string_view> words;
        const char *named;
    };
    const std::vector<Case> cases{
        {{"--triangles"}, "--triangles"},
        {{"a.ply", "--triangles", "-5"}, "-5"},
        {{"a.ply", "--triangles", "many"}, "many"},
        {{"a.ply", "--triangles", "1e3"}, "1e3"},
        {{"a.ply", "--triangles", "99999999999999999999999"}, "99999999999999999999999"},
        {{"a.ply", "--engine", "magic"}, "magic"},
        {{"a.ply", "--view", "inside"}, "inside"},
        {{"a.ply", "--scale", "nan"}, "nan"},
        {{"a.ply", "--scale", "0"}, "--scale"},
        {{"a.ply", "--size", "100", "0"}, "--size"},
        {{"a.ply", "--size", "100", "100000"}, "--size"},
        {{"a.ply", "--orbit", "5"}, "--orbit"},
        {{"a.ply", "--frames", "0"}, "--frames"},
        {{"a.ply", "--fames", "3"}, "--fames"},
        {{"a.ply", "b.ply"}, "b.ply"},
        {{"a.ply", "--triangles", "5", "--levels", "3"}, "both"},
        {{"--triangles", "5"}, "no mesh"},
        {{"a.ply", "--save", "b.ply"}, "no result"},
    };
    for (const Case &refused : cases) {
        CAPTURE(refused.named);
        try {
            parse(refused.words);
            FAIL("it was taken");
        } catch (const UsageError &error) {
            CHECK(std::string(error.what()).find(refused.named) != std::string::npos);
        }
    }
}
