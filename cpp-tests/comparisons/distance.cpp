#include "distance.hpp"

#include <algorithm>
#include <cmath>

namespace comparison {
namespace {

struct Squares {
    double mean;
    double maximum;
};

Squares squares(const Surface &from, const Surface &to, std::size_t count) {
    double sum = 0.0;
    double maximum = 0.0;
    for (const Vector &sample : from.samples(count)) {
        const double squared = to.nearest(sample).squared_distance;
        sum += squared;
        maximum = std::max(maximum, squared);
    }
    for (const Vector &vertex : from.vertices())
        maximum = std::max(maximum, to.nearest(vertex).squared_distance);
    return {sum / static_cast<double>(count), maximum};
}

} // namespace

Distance distance(const Surface &original, const Surface &simplified, std::size_t samples) {
    const Squares there = squares(original, simplified, samples);
    const Squares back = squares(simplified, original, samples);
    const double diagonal = original.diagonal();
    return {std::sqrt(std::max(there.mean, back.mean)) / diagonal,
            std::sqrt(std::max(there.maximum, back.maximum)) / diagonal};
}

} // namespace comparison
