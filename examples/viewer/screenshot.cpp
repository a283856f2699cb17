#include "screenshot.hpp"

#include <stdexcept>
#include <vector>

#include <epoxy/gl.h>
#include <png.h>

namespace viewer {

void write_screenshot(const std::string &path, int width, int height) {
    const int row = 3 * width;
    std::vector<png_byte> pixels(static_cast<std::size_t>(row) * static_cast<std::size_t>(height));
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glReadBuffer(GL_BACK);
    glReadPixels(0, 0, width, height, GL_RGB, GL_UNSIGNED_BYTE, pixels.data());

    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    image.format = PNG_FORMAT_RGB;
    image.width = static_cast<png_uint_32>(width);
    image.height = static_cast<png_uint_32>(height);
    // A negative stride: OpenGL's first row is the lowest.
    if (png_image_write_to_file(&image, path.c_str(), 0, pixels.data(), -row, nullptr) == 0) {
        throw std::runtime_error("cannot write " + path + ": " + image.message);
    }
}

}   // namespace viewer
