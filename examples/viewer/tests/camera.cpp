#include "camera.hpp"

#include <initializer_list>

#include <doctest/doctest.h>

namespace {

/// Where a point is in the picture: -1 to 1 from left to right and from bottom to top; z is the depth.
glm::vec3 in_picture(const viewer::Camera &camera, float aspect, const glm::vec3 &point) {
    const glm::vec4 at = camera.projection(aspect) * camera.view() * glm::vec4(point, 1);
    return glm::vec3(at) / at.w;
}

}   // namespace

TEST_CASE("camera: what it looks at is in the middle, wherever it goes") {
    viewer::Camera camera;
    for (int turn = 0; turn < 50; ++turn) {
        camera.orbit(37, turn % 2 == 0 ? 61.0F : -53.0F);
        camera.zoom(turn % 3 == 0 ? 2.0F : -1.0F);
        const glm::vec3 middle = in_picture(camera, 1.5F, {0, 0, 0});
        CHECK(middle.x == doctest::Approx(0).epsilon(1e-5));
        CHECK(middle.y == doctest::Approx(0).epsilon(1e-5));
        CHECK(middle.z > -1);
        CHECK(middle.z < 1);
    }
}

TEST_CASE("camera: at first all of a frame is in the picture, wide or narrow, from all sides") {
    for (const float aspect : {0.3F, 0.7F, 1.0F, 2.5F}) {
        viewer::Camera camera;
        for (int turn = 0; turn < 24; ++turn) {
            camera.orbit(15, turn < 12 ? 10.0F : -15.0F);
            // A frame's diagonal is 1: its corners are on this sphere.
            for (const glm::vec3 &axis : {glm::vec3{1, 0, 0}, glm::vec3{0, 1, 0}, glm::vec3{0, 0, 1},
                                          glm::normalize(glm::vec3{1, 1, 1}), glm::normalize(glm::vec3{1, -1, 1})}) {
                for (const float side : {-0.5F, 0.5F}) {
                    const glm::vec3 corner = in_picture(camera, aspect, side * axis);
                    CAPTURE(aspect);
                    CHECK(glm::abs(corner.x) <= 1);
                    CHECK(glm::abs(corner.y) <= 1);
                    CHECK(glm::abs(corner.z) <= 1);
                }
            }
        }
    }
}

TEST_CASE("camera: up stays up, and the poles are not passed") {
    viewer::Camera camera;
    camera.orbit(0, 1000);
    CHECK(camera.pitch() < 90);
    CHECK(in_picture(camera, 1, {0, 0.1F, 0}).y > 0);
    camera.orbit(0, -5000);
    CHECK(camera.pitch() > -90);
    CHECK(in_picture(camera, 1, {0, 0.1F, 0}).y > 0);
}

TEST_CASE("camera: turned once around, it is where it was") {
    viewer::Camera camera;
    const glm::mat4 before = camera.view();
    for (int turn = 0; turn < 36; ++turn) {
        camera.orbit(10, 0);
    }
    const glm::mat4 after = camera.view();
    for (int column = 0; column < 4; ++column) {
        for (int row = 0; row < 4; ++row) {
            CHECK(after[column][row] == doctest::Approx(before[column][row]).epsilon(1e-4));
        }
    }
}

TEST_CASE("camera: what is dragged goes with the mouse") {
    viewer::Camera camera;
    camera.orbit(70, 20);
    camera.pan(0.25F, -0.1F);
    const glm::vec3 moved = in_picture(camera, 1, {0, 0, 0});
    // A picture is 2 high.
    CHECK(moved.x == doctest::Approx(0.5).epsilon(1e-4));
    CHECK(moved.y == doctest::Approx(-0.2).epsilon(1e-4));
}

TEST_CASE("camera: it comes near and goes far, but not through and not away") {
    viewer::Camera camera;
    const float before = camera.distance();
    camera.zoom(3);
    CHECK(camera.distance() < before);
    camera.zoom(10000);
    CHECK(camera.distance() > 0);
    CHECK(glm::abs(in_picture(camera, 1, {0, 0, 0}).z) < 1);
    camera.zoom(-10000);
    CHECK(camera.distance() < 100);
    CHECK(glm::abs(in_picture(camera, 1, {0, 0, 0}).z) < 1);
}
