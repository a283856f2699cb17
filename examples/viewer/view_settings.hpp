/// How to look at what there is.

#ifndef VIEWER_VIEW_SETTINGS_HPP
#define VIEWER_VIEW_SETTINGS_HPP

#include <cstddef>

namespace viewer {

/// What is in the picture.
enum class Layout {
    original,
    result,
    side_by_side,   ///< original and result, by one camera
    deviation,      ///< the original, coloured by how far the result is from it
};

struct ViewSettings {
    Layout layout = Layout::side_by_side;
    bool wireframe = false;
    bool facets = false;
    /// Of nested levels the one to show.
    std::size_t level = 0;
    /// Where the heat map's scale ends, as a share of the largest distance: above 0, at most 1.
    float scale = 1;
};

}   // namespace viewer

#endif
