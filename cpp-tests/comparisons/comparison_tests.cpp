/// \file
/// decimesh beside CGAL and OpenMesh: the same meshes, the same number of triangles, one distance that is
/// none of theirs. One test for each mesh, so that they run side by side.

#define DOCTEST_CONFIG_IMPLEMENT_WITH_MAIN
#include <doctest/doctest.h>

#include "checks.hpp"
#include "contender.hpp"
#include "distance.hpp"
#include "files.hpp"
#include "meshes.hpp"

#include <cstdio>
#include <string>
#include <vector>

namespace {

using namespace comparison;

/// Enough that the RMS stands to a few parts in a thousand: twice as many change no verdict.
constexpr std::size_t surface_samples = 50'000;
constexpr std::size_t border_samples = 10'000;

/// As a share of the diagonal. The meshes' files have six digits, and what is handed over is in single
/// precision: a difference below this lies in the digits that the surface itself does not have.
constexpr double rounding = 1e-6;

struct Outcome {
    std::string name;
    std::size_t triangles;
    Distance distance;
    std::size_t flips;
    std::size_t non_manifold_edges;
    BorderDistance border;
};

Outcome run(const Contender &contender, const Mesh &mesh, const Surface &original, std::size_t triangles) {
    const auto task = contender.load(mesh);
    task->simplify(triangles);
    const Mesh result = task->result();
    const Surface surface(result);
    Outcome outcome{contender.name,
                    result.triangles.size(),
                    distance(original, surface, surface_samples),
                    flips(original, surface),
                    non_manifold_edges(result),
                    border_distance(mesh, result, border_samples)};
    outcome.border.rms /= original.diagonal();
    outcome.border.maximum /= original.diagonal();
    std::printf("    %-26s %7zu   %.3e   %.3e   %5zu   %5zu   %.3e   %.3e\n", outcome.name.c_str(),
                outcome.triangles, outcome.distance.rms, outcome.distance.maximum, outcome.flips,
                outcome.non_manifold_edges, outcome.border.rms, outcome.border.maximum);
    return outcome;
}

bool arrived(const Outcome &outcome, std::size_t triangles) {
    return outcome.triangles <= triangles && outcome.triangles + 2 >= triangles;
}

void compare(const Mesh &mesh) {
    const Surface original(mesh);
    for (const double share : {0.5, 0.1, 0.02}) {
        const auto triangles = static_cast<std::size_t>(share * static_cast<double>(mesh.triangles.size()));
        std::printf("  %zu to %zu triangles\n"
                    "    %-26s %7s   %-9s   %-9s   %5s   %5s   %-9s   %-9s\n",
                    mesh.triangles.size(), triangles, "", "left", "RMS", "maximum", "flips", "edges",
                    "border", "maximum");
        const Outcome ours = run(decimesh_default(1), mesh, original, triangles);
        REQUIRE(arrived(ours, triangles));
        const auto beside = [&](const Contender &contender) {
            const Outcome theirs = run(contender, mesh, original, triangles);
            if (!arrived(theirs, triangles))
                std::printf("    (it is stuck there, and compared with what it has)\n");
            return theirs;
        };
        const auto not_worse = [&](const Outcome &theirs) {
            CHECK(ours.flips <= theirs.flips);
            CHECK(ours.non_manifold_edges <= theirs.non_manifold_edges);
            CHECK(ours.border.rms <= theirs.border.rms + rounding);
            CHECK(ours.border.maximum <= theirs.border.maximum + rounding);
        };

        CAPTURE(triangles);
        {
            const Outcome theirs = beside(cgal_lindstrom_turk());
            CAPTURE(theirs.name);
            CHECK(ours.distance.rms <= 1.05 * theirs.distance.rms + rounding);
            not_worse(theirs);
        }
        for (const auto &contender : {cgal_garland_heckbert(), openmesh_quadric(), openmesh_multiple_choice()}) {
            const Outcome theirs = beside(contender);
            CAPTURE(theirs.name);
            CHECK(ours.distance.rms < theirs.distance.rms + rounding);
            not_worse(theirs);
        }
    }
}

Mesh archived(const std::string &name) { return read(std::string(COMPARISON_MESHES) + "/" + name + ".off"); }

} // namespace

TEST_CASE("a bumpy sphere") { compare(bumpy_sphere(5)); }

TEST_CASE("a wavy torus") { compare(wavy_torus(60)); }

TEST_CASE("a wavy field with a border") { compare(wavy_field(100)); }

TEST_CASE("an elephant") { compare(archived("refined_elephant")); }

TEST_CASE("an armadillo") { compare(archived("armadillo")); }

TEST_CASE("a mechanical part with sharp edges") { compare(archived("fandisk_large")); }

TEST_CASE("a lion's head with a border") { compare(archived("lion-head")); }

TEST_CASE("a head with a wide border and deep folds") { compare(archived("mannequin-devil")); }
