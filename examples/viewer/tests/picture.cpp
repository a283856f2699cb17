#include "picture.hpp"

#include <stdexcept>

#include <png.h>

Picture::Picture(const std::string &path) {
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    if (png_image_begin_read_from_file(&image, path.c_str()) == 0) {
        throw std::runtime_error("cannot read " + path + ": " + image.message);
    }
    image.format = PNG_FORMAT_RGB;
    pixels_.resize(PNG_IMAGE_SIZE(image));
    if (png_image_finish_read(&image, nullptr, pixels_.data(), 0, nullptr) == 0) {
        throw std::runtime_error("cannot read " + path + ": " + image.message);
    }
    width_ = static_cast<int>(image.width);
    height_ = static_cast<int>(image.height);
}

viewer::Color Picture::at(int x, int y) const {
    const std::size_t first = 3 * static_cast<std::size_t>(y * width_ + x);
    return {pixels_.at(first), pixels_.at(first + 1), pixels_.at(first + 2)};
}

double Picture::share(const Part &part, const std::function<bool(const viewer::Color &)> &holds) const {
    int count = 0;
    for (int y = part.y; y < part.y + part.height; ++y) {
        for (int x = part.x; x < part.x + part.width; ++x) {
            count += holds(at(x, y)) ? 1 : 0;
        }
    }
    return static_cast<double>(count) / (static_cast<double>(part.width) * part.height);
}

double Picture::difference(const Part &part, const Picture &other, const Part &other_part) const {
    int count = 0;
    for (int y = 0; y < part.height; ++y) {
        for (int x = 0; x < part.width; ++x) {
            count += at(part.x + x, part.y + y) != other.at(other_part.x + x, other_part.y + y) ? 1 : 0;
        }
    }
    return static_cast<double>(count) / (static_cast<double>(part.width) * part.height);
}
