/// \file
/// How far two surfaces are apart.
#pragma once

#include "surface.hpp"

namespace comparison {

/// Of both directions the larger, as shares of the first surface's diagonal.
struct Distance {
    /// Of the samples alone: an integral over the area.
    double rms;
    /// Of the samples and the vertices: tips count, however little area they have.
    double maximum;
};

Distance distance(const Surface &original, const Surface &simplified, std::size_t samples);

} // namespace comparison
