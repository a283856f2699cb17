/// Broken buffers: each kind with its status and a message that says what and where, from every call that
/// takes buffers, with nothing written.

#include <cmath>
#include <functional>
#include <limits>

#include "calls.hpp"

using calls::check_refused;

TEST_SUITE_BEGIN("quick");

namespace {

/// Something to break, and what must be said about it.
struct Defect {
    std::string name;
    decimesh_status status;
    std::vector<const char *> words;
    std::function<void(shapes::Dressed &, decimesh_buffers &)> make;
};

const float infinity = std::numeric_limits<float>::infinity();

const std::vector<Defect> defects = {
    {"no vertices", DECIMESH_ERROR_EMPTY, {"vertex_count is 0"},
     [](auto &, auto &buffers) { buffers.vertex_count = 0; }},
    {"no indices", DECIMESH_ERROR_EMPTY, {"index_count is 0"},
     [](auto &, auto &buffers) { buffers.index_count = 0; }},
    {"a torn triangle", DECIMESH_ERROR_INDEX_COUNT, {"index_count", "95"},
     [](auto &, auto &buffers) { buffers.index_count = 95; }},
    {"a short stride of positions", DECIMESH_ERROR_STRIDE, {"positions", "11", "12"},
     [](auto &, auto &buffers) { buffers.positions_stride = 11; }},
    {"a short stride of normals", DECIMESH_ERROR_STRIDE, {"normals", "8", "12"},
     [](auto &, auto &buffers) { buffers.normals_stride = 8; }},
    {"a short stride of texture coordinates", DECIMESH_ERROR_STRIDE, {"uvs", "4", "8"},
     [](auto &, auto &buffers) { buffers.uvs_stride = 4; }},
    {"a short stride of colours", DECIMESH_ERROR_STRIDE, {"colors", "3", "4"},
     [](auto &, auto &buffers) { buffers.colors_stride = 3; }},
    {"positions beyond the address space", DECIMESH_ERROR_OVERFLOW, {"positions"},
     [](auto &, auto &buffers) { buffers.positions_stride = SIZE_MAX / 8; }},
    {"a product that wraps round to something small", DECIMESH_ERROR_OVERFLOW, {"positions"},
     [](auto &, auto &buffers) {
         buffers.vertex_count = 32;
         buffers.positions_stride = SIZE_MAX / 32 + 1;
     }},
    {"normals beyond the address space", DECIMESH_ERROR_OVERFLOW, {"normals"},
     [](auto &, auto &buffers) { buffers.normals_stride = SIZE_MAX; }},
    {"texture coordinates beyond the address space", DECIMESH_ERROR_OVERFLOW, {"uvs"},
     [](auto &, auto &buffers) { buffers.uvs_stride = SIZE_MAX / 2; }},
    {"colours beyond the address space", DECIMESH_ERROR_OVERFLOW, {"colors"},
     [](auto &, auto &buffers) { buffers.colors_stride = SIZE_MAX / 3; }},
    {"more vertices than indices can name", DECIMESH_ERROR_OVERFLOW, {"vertex_count", "4294967296"},
     [](auto &, auto &buffers) { buffers.vertex_count = std::size_t{1} << 32; }},
    {"as many vertices as there are numbers", DECIMESH_ERROR_OVERFLOW, {"vertex_count"},
     [](auto &, auto &buffers) { buffers.vertex_count = SIZE_MAX; }},
    {"more indices than a mesh can hold", DECIMESH_ERROR_OVERFLOW, {"index_count"},
     [](auto &, auto &buffers) { buffers.index_count = 3 * (std::size_t{1} << 30); }},
    {"as many indices as there are numbers", DECIMESH_ERROR_OVERFLOW, {"index_count"},
     [](auto &, auto &buffers) { buffers.index_count = SIZE_MAX / 3 * 3; }},
    {"an index out of range", DECIMESH_ERROR_INDEX_RANGE, {"triangle 5", "index 25", "25 vertices"},
     [](auto &dressed, auto &) { dressed.shape.indices[17] = 25; }},
    {"an index far out of range", DECIMESH_ERROR_INDEX_RANGE, {"triangle 0", "4294967295"},
     [](auto &dressed, auto &) { dressed.shape.indices[1] = UINT32_MAX; }},
    {"indices of 16 bits that hold others of 32", DECIMESH_ERROR_INDEX_RANGE, {"triangle 0"},
     [](auto &dressed, auto &buffers) {
         dressed.shape.indices[0] = 0xFFFF0000;
         buffers.index_type = DECIMESH_INDEX_U16;
     }},
    {"a position that is no number", DECIMESH_ERROR_NOT_FINITE, {"position", "vertex 7"},
     [](auto &dressed, auto &) { dressed.shape.positions[7][2] = NAN; }},
    {"an infinite position", DECIMESH_ERROR_NOT_FINITE, {"position", "vertex 24"},
     [](auto &dressed, auto &) { dressed.shape.positions[24][0] = -infinity; }},
    {"a normal that is no number", DECIMESH_ERROR_NOT_FINITE, {"normal", "vertex 3"},
     [](auto &dressed, auto &) { dressed.normals[3][1] = NAN; }},
    {"an infinite texture coordinate", DECIMESH_ERROR_NOT_FINITE, {"uv", "vertex 2"},
     [](auto &dressed, auto &) { dressed.uvs[2][0] = infinity; }},
    {"an index type that does not exist", DECIMESH_ERROR_ENUM, {"index_type is 0"},
     [](auto &, auto &buffers) { buffers.index_type = 0; }},
    {"a negative index type", DECIMESH_ERROR_ENUM, {"index_type is -5"},
     [](auto &, auto &buffers) { buffers.index_type = -5; }},
};

void check_refused_by(const calls::Named &named, const Defect &defect) {
    CAPTURE(named.name);
    CAPTURE(defect.name);
    shapes::Dressed dressed(shapes::plane(4));
    decimesh_buffers buffers = dressed.raw();
    defect.make(dressed, buffers);
    const Bytes before = dressed.bytes();
    const decimesh_buffers as_given = buffers;
    const decimesh_simplify_options options = calls::default_options();
    check_refused(named.call(&buffers, &options), defect.status, {});
    const std::string message = decimesh_last_error_message();
    CAPTURE(message);
    for (const char *word : defect.words) {
        CHECK(checks::says(message, {word}));
    }
    CHECK(dressed.bytes() == before);
    CHECK(std::memcmp(&buffers, &as_given, sizeof buffers) == 0);
}

}   // namespace

TEST_CASE("errors: broken buffers are refused by every call that takes them") {
    for (const calls::Named &named : calls::on_buffers) {
        for (const Defect &defect : defects) {
            check_refused_by(named, defect);
        }
    }
}

TEST_CASE("errors: odd strides and no alignment are fine") {
    const shapes::Dressed dressed(shapes::plane(4));
    constexpr std::size_t stride = 17;
    const std::size_t count = dressed.shape.positions.size();
    // The last element ends where the memory does: a sanitizer sees a byte read beyond it.
    std::vector<unsigned char> bytes((count - 1) * stride + 12 + 1);
    for (std::size_t vertex = 0; vertex < count; ++vertex) {
        std::memcpy(bytes.data() + 1 + vertex * stride, dressed.shape.positions[vertex].data(), 12);
    }
    decimesh_buffers buffers = dressed.raw();
    buffers.positions = reinterpret_cast<const float *>(bytes.data() + 1);
    buffers.positions_stride = stride;
    decimesh_mesh *mesh = nullptr;
    REQUIRE(decimesh_mesh_from_buffers(&buffers, &mesh) == DECIMESH_OK);
    const decimesh::Mesh owner = decimesh::Mesh::adopt(mesh);
    CHECK(bytes_of(owner) == bytes_of(dressed.mesh()));
}

TEST_CASE("errors: strides count for attributes that are there alone") {
    const shapes::Dressed dressed(shapes::plane(4));
    decimesh_buffers buffers = dressed.raw();
    buffers.normals = nullptr;
    buffers.normals_stride = 1;
    decimesh_mesh *mesh = nullptr;
    REQUIRE(decimesh_mesh_from_buffers(&buffers, &mesh) == DECIMESH_OK);
    CHECK(decimesh_mesh_normals(mesh) == nullptr);
    CHECK(decimesh_mesh_uvs(mesh) != nullptr);
    decimesh_mesh_destroy(mesh);
}

TEST_SUITE_END();
