/// Seams, weights, groups and flags: what collapses that make no vertex do with them.

#include <algorithm>
#include <set>

#include <decimesh.hpp>
#include <doctest/doctest.h>

#include "checks.hpp"
#include "shapes.hpp"

using decimesh::Options;
using decimesh::Target;

TEST_SUITE_BEGIN("quick");

namespace {

/// A sphere whose texture is cut from pole to pole: its vertices on the cut are there twice.
shapes::Dressed cut_sphere(std::uint32_t n, std::uint32_t m) {
    shapes::Shape shape = shapes::stone(n, m);
    const std::size_t whole = shape.positions.size();
    const auto is_on_cut = [&](std::uint32_t vertex) {
        const shapes::Point &point = shape.positions[vertex];
        return point[1] == 0 && point[0] > 0;
    };
    std::vector<std::uint32_t> twin(whole, UINT32_MAX);
    for (std::size_t corner = 0; corner < shape.indices.size(); corner += 3) {
        const auto *triangle = &shape.indices[corner];
        const bool is_beyond = std::any_of(triangle, triangle + 3, [&](std::uint32_t vertex) {
            return shape.positions[vertex][1] < 0 && !is_on_cut(vertex);
        });
        for (std::size_t side = 0; side < 3; ++side) {
            std::uint32_t &vertex = shape.indices[corner + side];
            if (is_beyond && is_on_cut(vertex)) {
                if (twin[vertex] == UINT32_MAX) {
                    twin[vertex] = static_cast<std::uint32_t>(shape.positions.size());
                    const shapes::Point point = shape.positions[vertex];
                    shape.positions.push_back(point);
                }
                vertex = twin[vertex];
            }
        }
    }
    REQUIRE(shape.positions.size() > whole + 2);
    return shapes::Dressed(shape);
}

/// Edges by the places of their ends, each of which a surface without cracks has as often one way as the other.
std::size_t cracks(const std::vector<shapes::Point> &positions, const std::uint32_t *indices, std::size_t count) {
    std::multiset<std::pair<checks::Bits, checks::Bits>> edges;
    for (std::size_t corner = 0; corner < count; ++corner) {
        const std::size_t next = corner % 3 == 2 ? corner - 2 : corner + 1;
        edges.insert({checks::bits(positions[indices[corner]].data()), checks::bits(positions[indices[next]].data())});
    }
    return static_cast<std::size_t>(std::count_if(edges.begin(), edges.end(), [&](const auto &edge) {
        return edges.count(edge) != edges.count({edge.second, edge.first});
    }));
}

decimesh::Buffers<> buffers_of(const shapes::Dressed &dressed) {
    return {dressed.shape.positions, dressed.shape.indices, dressed.normals, dressed.uvs, dressed.colors};
}

}   // namespace

TEST_CASE("attributes: vertices go along seams and no crack opens") {
    const shapes::Dressed dressed = cut_sphere(48, 32);
    REQUIRE(cracks(dressed.shape.positions, dressed.shape.indices.data(), dressed.shape.indices.size()) == 0);
    std::vector<std::uint32_t> destination(dressed.shape.indices.size());
    for (const bool has_attributes : {true, false}) {
        CAPTURE(has_attributes);
        decimesh::Buffers<> buffers = buffers_of(dressed);
        if (!has_attributes) {
            buffers = {dressed.shape.positions, dressed.shape.indices};
        }
        Options options;
        options.target = Target::ratio(0.05);
        const auto result = decimesh::simplify_indices(destination, buffers, options);
        checks::check_count(result.index_count / 3, dressed.shape.triangles() / 20);
        CHECK(result.report.locked_vertices == 0);
        CHECK(cracks(dressed.shape.positions, destination.data(), result.index_count) == 0);
        options.keep_seams = false;
        const auto parted = decimesh::simplify_indices(destination, buffers, options);
        checks::check_count(parted.index_count / 3, dressed.shape.triangles() / 20);
        CHECK(cracks(dressed.shape.positions, destination.data(), parted.index_count) > 0);
    }
}

TEST_CASE("attributes: in place vertices that move do not leave a seam") {
    shapes::Dressed dressed = cut_sphere(24, 16);
    const std::vector<shapes::Point> before = dressed.shape.positions;
    Options options;
    options.target = Target::ratio(0.2);
    decimesh::MutableBuffers<> buffers{dressed.shape.positions, dressed.shape.indices};
    const auto result = decimesh::simplify_in_place(buffers, options);
    CHECK(result.report.locked_vertices > 0);
    CHECK(cracks(dressed.shape.positions, dressed.shape.indices.data(), result.index_count) == 0);

    // With vertices that stay, it is what the call for indices does.
    const shapes::Dressed again = cut_sphere(24, 16);
    options.placement = decimesh::Placement::existing;
    std::vector<std::uint32_t> expected(again.shape.indices.size());
    const decimesh::Buffers<> unchanged{again.shape.positions, again.shape.indices};
    const auto apart = decimesh::simplify_indices(expected, unchanged, options);
    std::vector<std::uint32_t> own = again.shape.indices;
    std::vector<shapes::Point> positions = again.shape.positions;
    const auto within = decimesh::simplify_in_place(decimesh::MutableBuffers<>{positions, own}, options);
    REQUIRE(within.index_count == apart.index_count);
    CHECK(within.report.locked_vertices == 0);
    CHECK(positions == again.shape.positions);
    CHECK(std::equal(own.begin(), own.begin() + static_cast<std::ptrdiff_t>(within.index_count), expected.begin()));
}

TEST_CASE("attributes: a faceted mesh sticks unless vertices may cross") {
    const shapes::Shape smooth = shapes::stone(16, 12);
    shapes::Shape shape;
    for (const std::uint32_t vertex : smooth.indices) {
        shape.indices.push_back(static_cast<std::uint32_t>(shape.positions.size()));
        shape.positions.push_back(smooth.positions[vertex]);
    }
    const shapes::Dressed dressed(shape);
    std::vector<std::uint32_t> destination(shape.indices.size());
    Options options;
    options.target = Target::ratio(0.2);
    options.topology = decimesh::Topology::keep;
    const auto kept = decimesh::simplify_indices(destination, buffers_of(dressed), options);
    CHECK(kept.report.stopped_by == decimesh::StoppedBy::stuck);
    options.cross_seams = true;
    const auto crossed = decimesh::simplify_indices(destination, buffers_of(dressed), options);
    CHECK(crossed.report.stopped_by == decimesh::StoppedBy::target);
    CHECK(crossed.index_count < kept.index_count);
    CHECK(cracks(shape.positions, destination.data(), crossed.index_count) == 0);
}

TEST_CASE("attributes: where all vertices are protected none crosses") {
    const shapes::Dressed dressed = cut_sphere(48, 32);
    Options options;
    options.target = Target::ratio(0.05);
    std::vector<std::uint32_t> kept(dressed.shape.indices.size()), crossed = kept, guarded = kept;
    const std::size_t count = decimesh::simplify_indices(kept, buffers_of(dressed), options).index_count;
    options.cross_seams = true;
    decimesh::simplify_indices(crossed, buffers_of(dressed), options);
    CHECK(crossed != kept);
    options.vertex_flags.assign(dressed.shape.positions.size(), decimesh::vertex_flag::protect);
    CHECK(decimesh::simplify_indices(guarded, buffers_of(dressed), options).index_count == count);
    CHECK(guarded == kept);
}

TEST_CASE("attributes: weights count and the error says so") {
    const shapes::Dressed dressed(shapes::stone(32, 24));
    std::vector<std::uint32_t> plain(dressed.shape.indices.size()), weighted = plain;
    Options options;
    options.target = Target::ratio(0.2);
    const auto without = decimesh::simplify_indices(plain, buffers_of(dressed), options);
    CHECK(without.report.attribute_error == 0);
    for (float decimesh::AttributeWeights::*weight :
         {&decimesh::AttributeWeights::normals, &decimesh::AttributeWeights::uvs,
          &decimesh::AttributeWeights::colors}) {
        options.attribute_weights = {};
        options.attribute_weights.*weight = 0.5F;
        const auto with = decimesh::simplify_indices(weighted, buffers_of(dressed), options);
        CHECK(with.report.attribute_error > 0);
        CHECK(weighted != plain);
        // Of attributes that are not there, a weight changes nothing.
        const decimesh::Buffers<> bare{dressed.shape.positions, dressed.shape.indices};
        CHECK(decimesh::simplify_indices(weighted, bare, options).report.attribute_error == 0);
    }
    options.placement = decimesh::Placement::existing;
    CHECK(decimesh::simplify(dressed.mesh(), options).report.attribute_error > 0);
}

TEST_CASE("attributes: groups come back and keep their borders") {
    const shapes::Shape shape = shapes::plane(24);
    Options options;
    options.target = Target::ratio(0.1);
    // Left and right of the middle.
    const auto side = [&](const std::uint32_t *triangle) -> std::uint32_t {
        const float x = shape.positions[triangle[0]][0] + shape.positions[triangle[1]][0] +
                        shape.positions[triangle[2]][0];
        return x < 1.5F ? 7 : 4000000000U;
    };
    for (std::size_t triangle = 0; triangle < shape.triangles(); ++triangle) {
        options.triangle_groups.push_back(side(&shape.indices[3 * triangle]));
    }
    std::vector<std::uint32_t> destination(shape.indices.size());
    const decimesh::Buffers<> buffers{shape.positions, shape.indices};
    const auto result = decimesh::simplify_indices(destination, buffers, options);
    REQUIRE(result.groups.size() == result.index_count / 3);
    for (std::size_t triangle = 0; triangle < result.groups.size(); ++triangle) {
        CHECK(result.groups[triangle] == side(&destination[3 * triangle]));
    }
    options.placement = decimesh::Placement::existing;
    CHECK(decimesh::simplify(shape.mesh(), options).groups == result.groups);

    const decimesh::Mesh mesh = shape.mesh();
    const decimesh::Levels levels = decimesh::Levels::build(mesh, {options.target}, options);
    const decimesh::NestedLevels nested = decimesh::NestedLevels::build(mesh, {options.target}, options);
    const Bytes expected = bytes_of(decimesh::Span<const std::uint32_t>(result.groups));
    CHECK(bytes_of(levels.groups(0)) == expected);
    CHECK(bytes_of(nested.groups(1)) == expected);
    CHECK(nested.groups(0).empty());
    const decimesh::Levels without = decimesh::Levels::build(mesh, {options.target});
    CHECK(without.groups(0).empty());
    CHECK_THROWS_AS(without.groups(1), decimesh::Error);
    CHECK_THROWS_AS(nested.groups(2), decimesh::Error);
    options.placement = decimesh::Placement::optimal;
    CHECK_THROWS_AS(decimesh::simplify(shape.mesh(), options), decimesh::Error);
    options.triangle_groups.pop_back();
    CHECK_THROWS_WITH_AS(decimesh::simplify(shape.mesh(), options), "decimesh: 1151 groups for 1152 triangles",
                         std::invalid_argument);
}

TEST_CASE("attributes: flags lock and prioritize") {
    const shapes::Shape shape = shapes::stone(24, 16);
    std::vector<std::uint32_t> destination(shape.indices.size());
    const decimesh::Buffers<> buffers{shape.positions, shape.indices};
    Options options;
    options.target = Target::triangles(60);
    options.vertex_flags.resize(shape.positions.size());
    for (const std::size_t vertex : {3U, 60U, 222U}) {
        options.vertex_flags[vertex] = decimesh::vertex_flag::lock;
    }
    options.locked_vertices = {100};
    const auto locked = decimesh::simplify_indices(destination, buffers, options);
    CHECK(locked.report.locked_vertices == 4);
    const auto end = destination.begin() + static_cast<std::ptrdiff_t>(locked.index_count);
    for (const std::uint32_t vertex : {3U, 60U, 222U, 100U}) {
        CHECK(std::find(destination.begin(), end, vertex) != end);
    }
    // Flags are the list, and the list is flags.
    Options listed = options;
    listed.vertex_flags = {};
    listed.locked_vertices = {3, 60, 100, 222};
    std::vector<std::uint32_t> same(shape.indices.size());
    CHECK(decimesh::simplify_indices(same, buffers, listed).index_count == locked.index_count);
    CHECK(same == destination);

    std::fill(options.vertex_flags.begin(), options.vertex_flags.end(), std::uint8_t{0});
    options.locked_vertices = {};
    const auto plain = decimesh::simplify_indices(same, buffers, options);
    const std::set<std::uint32_t> used(same.begin(), same.begin() + static_cast<std::ptrdiff_t>(plain.index_count));
    std::vector<std::uint32_t> wanted;
    for (std::uint32_t vertex = 40; wanted.size() < 10; vertex += 7) {
        if (used.count(vertex) == 0) {
            wanted.push_back(vertex);
            options.vertex_flags[vertex] = decimesh::vertex_flag::prioritize;
        }
    }
    const auto kept = decimesh::simplify_indices(same, buffers, options);
    const auto kept_end = same.begin() + static_cast<std::ptrdiff_t>(kept.index_count);
    const auto present = std::count_if(wanted.begin(), wanted.end(), [&](std::uint32_t vertex) {
        return std::find(same.begin(), kept_end, vertex) != kept_end;
    });
    CHECK(present >= 8);
}

TEST_SUITE_END();
