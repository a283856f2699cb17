#include "color_map.hpp"

#include <algorithm>
#include <cmath>

namespace viewer {

namespace {

/// Of viridis, by Nathaniel Smith and Stéfan van der Walt, which they put into the public domain (CC0): nine of its
/// colours, evenly spread. Between them, straight lines are within a few steps of it.
constexpr std::array<Color, 9> stops{{{68, 1, 84},
                                      {71, 45, 123},
                                      {59, 82, 139},
                                      {44, 114, 142},
                                      {33, 145, 140},
                                      {40, 174, 128},
                                      {94, 201, 98},
                                      {173, 220, 48},
                                      {253, 231, 37}}};

}   // namespace

Color color_of(float value) {
    const float at = value > 0 ? std::min(value, 1.0F) * static_cast<float>(stops.size() - 1) : 0.0F;
    const std::size_t below = std::min(static_cast<std::size_t>(at), stops.size() - 2);
    const float part = at - static_cast<float>(below);
    Color color{};
    for (std::size_t channel = 0; channel < color.size(); ++channel) {
        const float from = stops[below][channel];
        const float to = stops[below + 1][channel];
        color[channel] = static_cast<std::uint8_t>(std::lround(from + part * (to - from)));
    }
    return color;
}

std::array<Color, 256> color_table() {
    std::array<Color, 256> table{};
    for (std::size_t i = 0; i < table.size(); ++i) {
        table[i] = color_of(static_cast<float>(i) / static_cast<float>(table.size() - 1));
    }
    return table;
}

}   // namespace viewer
