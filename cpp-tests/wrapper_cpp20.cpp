/// The wrapper under C++20, where spans are also the standard's, and without run-time type information.

#include <decimesh.hpp>

#include <algorithm>
#include <ranges>
#include <span>
#include <string>

namespace {

static_assert(std::is_convertible_v<decimesh::Span<const float>, std::span<const float>>);
static_assert(std::is_convertible_v<decimesh::Span<float>, std::span<const float>>);
static_assert(std::is_convertible_v<std::span<float>, decimesh::Span<const float>>);
static_assert(std::is_convertible_v<std::span<float>, decimesh::Stream<float, 3>>);
static_assert(!std::is_convertible_v<std::span<const float>, decimesh::Stream<float, 3>>);
static_assert(std::ranges::contiguous_range<decimesh::Span<const float>>);
static_assert(std::ranges::borrowed_range<decimesh::Span<const float>>);

/// A mesh that is about to end gives no spans of itself away; a view of one that stays does.
template <class Mesh>
concept gives_positions = requires(Mesh &&mesh) { std::forward<Mesh>(mesh).positions(); };
static_assert(gives_positions<decimesh::Mesh &>);
static_assert(gives_positions<const decimesh::Mesh &>);
static_assert(gives_positions<decimesh::MeshView>);
static_assert(!gives_positions<decimesh::Mesh>);

template <class Mesh>
concept gives_colors = requires(Mesh &&mesh) { std::forward<Mesh>(mesh).colors(); };
static_assert(gives_colors<decimesh::Mesh &>);
static_assert(!gives_colors<decimesh::Mesh>);

/// Levels that are about to end give no mesh away.
template <class Levels>
concept gives_mesh = requires(Levels &&levels) { std::forward<Levels>(levels).mesh(0); };
static_assert(gives_mesh<decimesh::Levels &>);
static_assert(!gives_mesh<decimesh::Levels>);

template <class Levels>
concept gives_indices = requires(Levels &&levels) { std::forward<Levels>(levels).indices(0); };
static_assert(gives_indices<const decimesh::NestedLevels &>);
static_assert(!gives_indices<decimesh::NestedLevels>);

template <class Player>
concept gives_a_view = requires(Player &&player) { std::forward<Player>(player).indices(); };
static_assert(gives_a_view<const decimesh::Player &>);
static_assert(!gives_a_view<decimesh::Player>);

}   // namespace

int main() {
    const float corners[] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    const std::uint32_t triangle[] = {0, 1, 2};
    const decimesh::Mesh mesh = decimesh::Mesh::from_buffers(corners, triangle);
    const decimesh::Simplified same =
        decimesh::simplify(mesh, {.target = decimesh::Target::triangles(1), .lock_boundary = true});
    const std::span<const std::uint32_t> indices = same.mesh.indices();
    try {
        decimesh::simplify(mesh, {.progress = [](float) -> bool { throw std::string("stop"); }});
    } catch (const std::string &) {
        return std::ranges::equal(indices, triangle) ? 0 : 1;
    }
    return 1;
}
