/// Pictures to look at.

#ifndef VIEWER_TESTS_PICTURE_HPP
#define VIEWER_TESTS_PICTURE_HPP

#include <functional>
#include <string>
#include <vector>

#include "color_map.hpp"

/// A part of a picture, from its upper left corner.
struct Part {
    int x;
    int y;
    int width;
    int height;
};

class Picture {
public:
    /// Reads a PNG file; throws `std::runtime_error` if there is none.
    explicit Picture(const std::string &path);

    int width() const noexcept { return width_; }
    int height() const noexcept { return height_; }
    viewer::Color at(int x, int y) const;

    /// The share of the part's pixels for which that holds.
    double share(const Part &part, const std::function<bool(const viewer::Color &)> &holds) const;

    /// The share of the pixels of parts of the same size that differ, of this picture and another.
    double difference(const Part &part, const Picture &other, const Part &other_part) const;

private:
    int width_ = 0;
    int height_ = 0;
    std::vector<unsigned char> pixels_;
};

#endif
