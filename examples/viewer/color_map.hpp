/// The colours of the heat map.

#ifndef VIEWER_COLOR_MAP_HPP
#define VIEWER_COLOR_MAP_HPP

#include <array>
#include <cstdint>

namespace viewer {

/// Red, green and blue.
using Color = std::array<std::uint8_t, 3>;

/// The colour of `value`, from 0 (dark violet) over blue-green to 1 (yellow); what is below or above has that of the
/// end, and what is no number that of 0. Ever lighter, so that it can be read without seeing colours.
Color color_of(float value);

/// The colours of evenly spread values from 0 to 1, for a texture.
std::array<Color, 256> color_table();

}   // namespace viewer

#endif
