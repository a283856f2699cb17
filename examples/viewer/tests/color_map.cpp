#include "color_map.hpp"

#include <cmath>

#include <doctest/doctest.h>

using viewer::Color;
using viewer::color_of;

namespace {

/// As bright as it looks, roughly: Rec. 709.
double brightness(const Color &color) {
    return 0.2126 * color[0] + 0.7152 * color[1] + 0.0722 * color[2];
}

}   // namespace

TEST_CASE("color map: it ends where it should, and what is beyond has the colour of the end") {
    CHECK(color_of(0) == Color{68, 1, 84});
    CHECK(color_of(1) == Color{253, 231, 37});
    CHECK(color_of(0.5F) == Color{33, 145, 140});
    CHECK(color_of(-3) == color_of(0));
    CHECK(color_of(1e30F) == color_of(1));
    CHECK(color_of(INFINITY) == color_of(1));
    CHECK(color_of(NAN) == color_of(0));
}

TEST_CASE("color map: more is lighter, step by step, and no step is a leap") {
    for (int i = 1; i <= 1000; ++i) {
        const Color below = color_of(static_cast<float>(i - 1) / 1000);
        const Color above = color_of(static_cast<float>(i) / 1000);
        CAPTURE(i);
        // Rounded to whole steps.
        CHECK(brightness(above) >= brightness(below) - 1);
        for (std::size_t channel = 0; channel < 3; ++channel) {
            CHECK(std::abs(int{above[channel]} - int{below[channel]}) <= 2);
        }
    }
}

TEST_CASE("color map: the table is the function") {
    const auto table = viewer::color_table();
    CHECK(table.front() == color_of(0));
    CHECK(table.back() == color_of(1));
    CHECK(table[51] == color_of(0.2F));
}
