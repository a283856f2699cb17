/// Simplification within a guaranteed error.

#include <decimesh.hpp>
#include <doctest/doctest.h>

#include <cmath>

#include "bytes.hpp"
#include "calls.hpp"
#include "checks.hpp"
#include "shapes.hpp"

using decimesh::Certified;
using decimesh::Mesh;

TEST_SUITE_BEGIN("quick");

TEST_CASE("certified: the limit is kept and made use of") {
    const Mesh fine = shapes::stone(24, 16).mesh();
    decimesh::Options options;
    options.track_origins = true;
    for (const double max_error : {0.01, 0.05, 0.2}) {
        CAPTURE(max_error);
        for (const auto placement : {decimesh::Placement::optimal, decimesh::Placement::existing}) {
            options.placement = placement;
            const Certified found = decimesh::simplify_within(fine, max_error, options);
            const Mesh &coarse = found.simplified.mesh;
            CHECK(found.bound.upper <= max_error);
            CHECK(found.bound.lower <= found.bound.upper);
            CHECK(found.simplified.report.error >= found.bound.upper);
            CHECK(found.simplified.report.stopped_by == decimesh::StoppedBy::error);
            CHECK(found.simplified.report.triangles == coarse.triangle_count());
            CHECK(found.simplified.origins.size() == fine.vertex_count());
            CHECK(decimesh::bound(fine, coarse).lower <= max_error);
            options.threads = 2;
            CHECK(bytes_of(decimesh::simplify_within(fine, max_error, options).simplified.mesh) == bytes_of(coarse));
            options.threads = 0;
        }
    }
    CHECK(decimesh::simplify_within(fine, 0.05).simplified.mesh.triangle_count() < fine.triangle_count() / 2);
}

TEST_CASE("certified: without room nothing goes") {
    const Mesh fine = shapes::stone(24, 16).mesh();
    const Certified same = decimesh::simplify_within(fine, 0);
    CHECK(same.bound.upper == 0);
    CHECK(same.simplified.mesh.triangle_count() == fine.triangle_count());
}

TEST_CASE("certified: what is no distance is an error that writes nothing") {
    const Mesh mesh = shapes::plane(4).mesh();
    const decimesh_simplify_options options = calls::default_options();
    for (const double max_error : {-1.0, double(INFINITY), double(NAN)}) {
        decimesh_mesh *made = nullptr;
        auto report = calls::untouched_struct<decimesh_simplify_report>();
        auto bound = calls::untouched_struct<decimesh_bound_result>();
        CHECK(decimesh_simplify_within(mesh.get(), max_error, &options, &made, &report, &bound) ==
              DECIMESH_ERROR_OPTION);
        CHECK(checks::says(decimesh_last_error_message(), {"maximum error"}));
        CHECK(made == nullptr);
        CHECK(calls::is_untouched(report));
        CHECK(calls::is_untouched(bound));
    }
    // Neither of the two is needed.
    decimesh_mesh *made = nullptr;
    CHECK(decimesh_simplify_within(mesh.get(), 0.1, &options, &made, nullptr, nullptr) == DECIMESH_OK);
    CHECK(decimesh_mesh_triangle_count(made) == 2);
    decimesh_mesh_destroy(made);
}

TEST_SUITE_END();
