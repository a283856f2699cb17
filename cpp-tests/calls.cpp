#include "calls.hpp"

namespace calls {

namespace {

constexpr std::size_t untouched_count = 123456789;

decimesh_status from_buffers(const decimesh_buffers *buffers, const decimesh_simplify_options *) {
    decimesh_mesh *mesh = nobody<decimesh_mesh>();
    const decimesh_status status = decimesh_mesh_from_buffers(buffers, &mesh);
    CHECK((status == DECIMESH_OK) == (mesh != nobody<decimesh_mesh>()));
    if (status == DECIMESH_OK) {
        decimesh_mesh_destroy(mesh);
    }
    return status;
}

decimesh::Mesh made(const decimesh_buffers *buffers) {
    decimesh_mesh *mesh = nullptr;
    REQUIRE(decimesh_mesh_from_buffers(buffers, &mesh) == DECIMESH_OK);
    return decimesh::Mesh::adopt(mesh);
}

decimesh_status simplify(const decimesh_buffers *buffers, const decimesh_simplify_options *options) {
    const decimesh::Mesh mesh = made(buffers);
    const Bytes before = bytes_of(mesh);
    decimesh_mesh *simplified = nobody<decimesh_mesh>();
    auto report = untouched_struct<decimesh_simplify_report>();
    const decimesh_status status = decimesh_simplify(mesh.get(), options, &simplified, &report);
    CHECK((status == DECIMESH_OK) == (simplified != nobody<decimesh_mesh>()));
    CHECK((status == DECIMESH_OK) != is_untouched(report));
    CHECK(bytes_of(mesh) == before);
    if (status == DECIMESH_OK) {
        decimesh_mesh_destroy(simplified);
    }
    return status;
}

/// A call that makes levels, of one kind or another.
template <class Handle, decimesh_status (*Build)(const decimesh_mesh *, const decimesh_simplify_options *,
                                                 const double *, std::size_t, Handle **),
          void (*Destroy)(Handle *)>
decimesh_status build_levels(const decimesh_buffers *buffers, const decimesh_simplify_options *options) {
    const decimesh::Mesh mesh = made(buffers);
    const Bytes before = bytes_of(mesh);
    Handle *levels = nobody<Handle>();
    // The values that levels have are their own; bad ones must be refused here as well.
    const double value = options == nullptr ? 0.5 : options->target_value;
    const double values[] = {value, value};
    const decimesh_status status = Build(mesh.get(), options, values, 2, &levels);
    CHECK((status == DECIMESH_OK) == (levels != nobody<Handle>()));
    CHECK(bytes_of(mesh) == before);
    if (status == DECIMESH_OK) {
        Destroy(levels);
    }
    return status;
}

decimesh_status simplify_indices(const decimesh_buffers *buffers, const decimesh_simplify_options *options) {
    std::vector<unsigned char> destination(1 << 20, untouched);
    std::size_t count = untouched_count;
    auto report = untouched_struct<decimesh_simplify_report>();
    const decimesh_status status = decimesh_simplify_indices(destination.data(), buffers, options, &count, &report);
    CHECK((status == DECIMESH_OK) == (count != untouched_count));
    CHECK((status == DECIMESH_OK) != is_untouched(report));
    const bool is_written = std::any_of(destination.begin(), destination.end(),
                                        [](unsigned char byte) { return byte != untouched; });
    CHECK((status == DECIMESH_OK) == is_written);
    return status;
}

/// Its buffers are written to if it succeeds.
decimesh_status simplify_in_place(const decimesh_buffers *buffers, const decimesh_simplify_options *options) {
    decimesh_mutable_buffers writable;
    static_assert(sizeof writable == sizeof *buffers);
    if (buffers != nullptr) {
        std::memcpy(&writable, buffers, sizeof writable);
    }
    std::size_t count = untouched_count;
    auto report = untouched_struct<decimesh_simplify_report>();
    const decimesh_status status =
        decimesh_simplify_in_place(buffers == nullptr ? nullptr : &writable, options, &count, &report);
    CHECK((status == DECIMESH_OK) == (count != untouched_count));
    CHECK((status == DECIMESH_OK) != is_untouched(report));
    return status;
}

const Named indices_call = {"decimesh_simplify_indices", simplify_indices};
const Named in_place_call = {"decimesh_simplify_in_place", simplify_in_place};

}   // namespace

const std::array<Named, 3> on_buffers = {
    Named{"decimesh_mesh_from_buffers", from_buffers}, indices_call, in_place_call};
const std::array<Named, 6> on_options = {
    Named{"decimesh_simplify", simplify},
    Named{"decimesh_levels_build", build_levels<decimesh_levels, decimesh_levels_build, decimesh_levels_destroy>},
    Named{"decimesh_nested_build", build_levels<decimesh_nested, decimesh_nested_build, decimesh_nested_destroy>},
    Named{"decimesh_progressive_build",
          build_levels<decimesh_progressive, decimesh_progressive_build, decimesh_progressive_destroy>},
    indices_call,
    in_place_call};

}   // namespace calls
