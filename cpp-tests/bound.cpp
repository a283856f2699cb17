/// Guaranteed bounds of distances.

#include <decimesh.hpp>
#include <doctest/doctest.h>

#include "checks.hpp"
#include "shapes.hpp"

using decimesh::Bound;
using decimesh::BoundOptions;
using decimesh::Mesh;

TEST_SUITE_BEGIN("quick");

TEST_CASE("bound: none from a surface to itself") {
    const Mesh mesh = shapes::stone(16, 12).mesh();
    const Bound none = decimesh::bound(mesh, mesh);
    CHECK(none.lower == 0);
    CHECK(none.upper <= 1e-6 * none.diagonal);
    CHECK(none.diagonal == doctest::Approx(mesh.statistics().diagonal));
}

TEST_CASE("bound: the distance lies between and threads change nothing") {
    const Mesh fine = shapes::stone(24, 16).mesh();
    const Mesh coarse = decimesh::simplify(fine, {decimesh::Target::ratio(0.2)}).mesh;
    BoundOptions options;
    const Bound found = decimesh::bound(fine, coarse, options);
    CHECK(found.lower > 0);
    CHECK(found.upper <= 1.011 * found.lower);
    decimesh::DeviationOptions measuring;
    measuring.samples = 20000;
    CHECK(decimesh::deviation(fine, coarse, measuring).max <= found.upper);
    options.threads = 2;
    const Bound same = decimesh::bound(fine, coarse, options);
    CHECK(same.lower == found.lower);
    CHECK(same.upper == found.upper);
    CHECK(same.pieces == found.pieces);
    // With fewer pieces it is less close, and still a bound.
    options.pieces = 0;
    const Bound loose = decimesh::bound(fine, coarse, options);
    CHECK(loose.upper >= found.lower);
    CHECK(loose.lower <= found.upper);
}

TEST_CASE("bound: what is no tolerance or no surface is an error and progress may end it") {
    const Mesh mesh = shapes::plane(4).mesh();
    const auto status_of = [&](const Mesh &other, const BoundOptions &options) {
        try {
            decimesh::bound(mesh, other, options);
        } catch (const decimesh::Error &error) {
            return error.status();
        }
        return decimesh::Status::ok;
    };
    BoundOptions options;
    CHECK(status_of(mesh, options) == decimesh::Status::ok);
    CHECK(status_of(Mesh(), options) == decimesh::Status::null);
    options.tolerance = -0.5;
    CHECK(status_of(mesh, options) == decimesh::Status::option);
    options.tolerance = 0;
    options.progress = [](float) { return false; };
    CHECK(status_of(mesh, options) == decimesh::Status::cancelled);
}

TEST_SUITE_END();
