/// Pictures of what is drawn.

#ifndef VIEWER_SCREENSHOT_HPP
#define VIEWER_SCREENSHOT_HPP

#include <string>

namespace viewer {

/// Writes what has been drawn into the window's back buffer, of that many pixels, as a PNG file. Throws
/// `std::runtime_error` if it cannot be written.
void write_screenshot(const std::string &path, int width, int height);

}   // namespace viewer

#endif
