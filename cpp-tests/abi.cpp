/// Numbers that programs are compiled with: they never change, in the header or in the wrapper.

#include <string>

#include <decimesh.hpp>
#include <doctest/doctest.h>

// A second time: it must not matter.
#include <decimesh.hpp>

TEST_SUITE_BEGIN("quick");

namespace {

template <class Enumeration>
constexpr bool is(Enumeration value, std::int32_t constant, std::int32_t number) {
    static_assert(std::is_same_v<std::underlying_type_t<Enumeration>, std::int32_t>);
    return static_cast<std::int32_t>(value) == constant && constant == number;
}

using decimesh::Status;
static_assert(is(Status::ok, DECIMESH_OK, 0));
static_assert(is(Status::null, DECIMESH_ERROR_NULL, 1));
static_assert(is(Status::struct_size, DECIMESH_ERROR_STRUCT_SIZE, 2));
static_assert(is(Status::unknown_option, DECIMESH_ERROR_UNKNOWN_OPTION, 3));
static_assert(is(Status::enumeration, DECIMESH_ERROR_ENUM, 4));
static_assert(is(Status::option, DECIMESH_ERROR_OPTION, 5));
static_assert(is(Status::empty, DECIMESH_ERROR_EMPTY, 6));
static_assert(is(Status::stride, DECIMESH_ERROR_STRIDE, 7));
static_assert(is(Status::overflow, DECIMESH_ERROR_OVERFLOW, 8));
static_assert(is(Status::index_count, DECIMESH_ERROR_INDEX_COUNT, 9));
static_assert(is(Status::index_range, DECIMESH_ERROR_INDEX_RANGE, 10));
static_assert(is(Status::not_finite, DECIMESH_ERROR_NOT_FINITE, 11));
static_assert(is(Status::out_of_range, DECIMESH_ERROR_OUT_OF_RANGE, 12));
static_assert(is(Status::io, DECIMESH_ERROR_IO, 13));
static_assert(is(Status::format, DECIMESH_ERROR_FORMAT, 14));
static_assert(is(Status::cancelled, DECIMESH_ERROR_CANCELLED, 15));
static_assert(is(Status::threads, DECIMESH_ERROR_THREADS, 16));
static_assert(is(Status::utf8, DECIMESH_ERROR_UTF8, 17));
static_assert(is(Status::too_large, DECIMESH_ERROR_TOO_LARGE, 18));
static_assert(is(Status::out_of_memory, DECIMESH_ERROR_OUT_OF_MEMORY, 19));
static_assert(is(Status::panic, DECIMESH_ERROR_PANIC, 100));

using Kind = decimesh::Target::Kind;
static_assert(is(Kind::triangles, DECIMESH_TARGET_TRIANGLES, 0));
static_assert(is(Kind::vertices, DECIMESH_TARGET_VERTICES, 1));
static_assert(is(Kind::ratio, DECIMESH_TARGET_RATIO, 2));
static_assert(is(Kind::max_error, DECIMESH_TARGET_MAX_ERROR, 3));

static_assert(is(decimesh::Selection::sampled_threshold, DECIMESH_SELECTION_SAMPLED_THRESHOLD, 0));
static_assert(is(decimesh::Selection::replacement, DECIMESH_SELECTION_REPLACEMENT, 1));
static_assert(is(decimesh::Topology::relax_if_stuck, DECIMESH_TOPOLOGY_RELAX_IF_STUCK, 0));
static_assert(is(decimesh::Topology::keep, DECIMESH_TOPOLOGY_KEEP, 1));
static_assert(is(decimesh::Placement::optimal, DECIMESH_PLACEMENT_OPTIMAL, 0));
static_assert(is(decimesh::Placement::existing, DECIMESH_PLACEMENT_EXISTING, 1));
static_assert(is(decimesh::StoppedBy::target, DECIMESH_STOPPED_BY_TARGET, 0));
static_assert(is(decimesh::StoppedBy::error, DECIMESH_STOPPED_BY_ERROR, 1));
static_assert(is(decimesh::StoppedBy::stuck, DECIMESH_STOPPED_BY_STUCK, 2));
static_assert(is(decimesh::Encoding::binary, DECIMESH_ENCODING_BINARY, 0));
static_assert(is(decimesh::Encoding::binary_big_endian, DECIMESH_ENCODING_BINARY_BIG_ENDIAN, 1));
static_assert(is(decimesh::Encoding::ascii, DECIMESH_ENCODING_ASCII, 2));
static_assert(DECIMESH_INDEX_U16 == 1 && DECIMESH_INDEX_U32 == 2);
static_assert(decimesh::vertex_flag::lock == DECIMESH_VERTEX_LOCK && DECIMESH_VERTEX_LOCK == 1);
static_assert(decimesh::vertex_flag::protect == DECIMESH_VERTEX_PROTECT && DECIMESH_VERTEX_PROTECT == 2);
static_assert(decimesh::vertex_flag::prioritize == DECIMESH_VERTEX_PRIORITIZE && DECIMESH_VERTEX_PRIORITIZE == 4);

}   // namespace

TEST_CASE("abi: header and library are of one version") {
    CHECK(decimesh_version() == (DECIMESH_VERSION_MAJOR << 16 | DECIMESH_VERSION_MINOR << 8 | DECIMESH_VERSION_PATCH));
    CHECK(std::string(decimesh_version_string()) == std::to_string(DECIMESH_VERSION_MAJOR) + "." +
                                                        std::to_string(DECIMESH_VERSION_MINOR) + "." +
                                                        std::to_string(DECIMESH_VERSION_PATCH));
}

TEST_CASE("abi: statuses have names and other numbers have none") {
    CHECK(std::string(decimesh_status_name(DECIMESH_OK)) == "DECIMESH_OK");
    CHECK(std::string(decimesh_status_name(DECIMESH_ERROR_NOT_FINITE)) == "DECIMESH_ERROR_NOT_FINITE");
    CHECK(std::string(decimesh_status_name(DECIMESH_ERROR_PANIC)) == "DECIMESH_ERROR_PANIC");
    for (const decimesh_status status : {-1, 42, INT32_MAX, INT32_MIN}) {
        CHECK(std::string(decimesh_status_name(status)) == "unknown status");
    }
}

TEST_SUITE_END();
