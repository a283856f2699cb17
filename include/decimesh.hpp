/// decimesh for C++17 and later: a header over decimesh.h, with values, owners and exceptions in place of
/// structs, handles and statuses. Link the library as for C.
///
///     const decimesh::Mesh scan = decimesh::Mesh::read("scan.ply");
///     decimesh::Options options;
///     options.target = decimesh::Target::ratio(0.1);
///     const decimesh::Simplified result = decimesh::simplify(scan, options);
///     result.mesh.write("small.glb");
///
/// What holds throughout:
/// - **Units.** Lengths (errors, distances, tolerances) are in units of the positions.
/// - **Errors.** A call that fails throws `Error` with the library's status and message; one that was
///   cancelled throws `Cancelled`; arguments that do not fit each other, such as five normals for eight
///   positions, throw `std::invalid_argument` before the library is called. Whatever is thrown, nothing of
///   the caller's has changed and nothing is lost.
/// - **Threads.** What is const may be used by any number of threads at once, as long as none moves, changes or
///   destroys it; and little changes: a `Player`, and `NestedLevels` that are certified. The library's own
///   threads call nothing of the caller's.
/// - **Determinism.** The same input and options give the same bytes, for any number of threads.
///
/// Run-time type information is not needed; exceptions are.

#ifndef DECIMESH_HPP
#define DECIMESH_HPP

#include <array>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <iterator>
#include <limits>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#if __has_include(<version>)
#include <version>
#endif
#ifdef __cpp_lib_ranges
#include <ranges>
#endif

#include "decimesh.h"

namespace decimesh {

/// Version of the library that runs, such as "0.1.0". The one compiled against is in the macros
/// `DECIMESH_VERSION_MAJOR`, `_MINOR` and `_PATCH`.
inline std::string version() {
    return decimesh_version_string();
}

// ---- errors ----

/// What went wrong. A newer library may report values that have no name here.
enum class Status : std::int32_t {
    ok = DECIMESH_OK,
    null = DECIMESH_ERROR_NULL,                      ///< a mesh was moved from, or data is missing
    struct_size = DECIMESH_ERROR_STRUCT_SIZE,        ///< header and library do not belong together
    unknown_option = DECIMESH_ERROR_UNKNOWN_OPTION,  ///< the library is older than an option that is set
    enumeration = DECIMESH_ERROR_ENUM,               ///< an enumerated option has a value that does not exist
    option = DECIMESH_ERROR_OPTION,                  ///< an option is out of its range
    empty = DECIMESH_ERROR_EMPTY,                    ///< no vertices or no triangles
    stride = DECIMESH_ERROR_STRIDE,                  ///< a stride is shorter than an element
    overflow = DECIMESH_ERROR_OVERFLOW,              ///< more than memory or a mesh can hold
    index_count = DECIMESH_ERROR_INDEX_COUNT,        ///< the number of indices is no multiple of three
    index_range = DECIMESH_ERROR_INDEX_RANGE,        ///< an index names a vertex that does not exist
    not_finite = DECIMESH_ERROR_NOT_FINITE,          ///< a number is infinite or none
    out_of_range = DECIMESH_ERROR_OUT_OF_RANGE,      ///< a level or a mark that does not exist
    io = DECIMESH_ERROR_IO,                          ///< the system refused to read or write
    format = DECIMESH_ERROR_FORMAT,                  ///< a file breaks the rules, or is of no known kind
    cancelled = DECIMESH_ERROR_CANCELLED,            ///< `Progress` said so
    threads = DECIMESH_ERROR_THREADS,                ///< threads could not be started
    utf8 = DECIMESH_ERROR_UTF8,                      ///< a path is not UTF-8
    too_large = DECIMESH_ERROR_TOO_LARGE,            ///< the result does not fit its format or buffer
    out_of_memory = DECIMESH_ERROR_OUT_OF_MEMORY,    ///< no room for a copy of the buffers
    panic = DECIMESH_ERROR_PANIC,                    ///< a bug in decimesh: destroy the meshes involved
};

/// A call that failed. `what()` says what and where: "triangle 7 has index 12, but there are 8 vertices".
class Error : public std::runtime_error {
public:
    Error(Status status, const std::string &message) : std::runtime_error(message), status_(status) {}

    Status status() const noexcept { return status_; }

private:
    Status status_;
};

/// A call that `Progress` ended by answering false.
class Cancelled : public Error {
public:
    using Error::Error;
};

/// Hears how far a computation has come, from 0 to 1, never falling; answers true to go on and false to end
/// it. Called on the thread that called decimesh. An exception thrown from it ends the computation too, and
/// reaches the caller of decimesh as it was thrown.
using Progress = std::function<bool(float fraction)>;

// ---- views of the caller's memory ----

namespace detail {

template <class Container>
using ElementOf = std::remove_pointer_t<decltype(std::data(std::declval<Container &>()))>;

}   // namespace detail

/// Elements next to each other in memory that belongs to somebody else: `std::span`, for C++17. Made from
/// whatever has `data()` and `size()`, C arrays and `std::span` included; `std::span` can be made from it.
/// Valid as long as the elements stay where they are.
template <class T>
class Span {
public:
    using element_type = T;
    using value_type = std::remove_cv_t<T>;
    using size_type = std::size_t;
    using iterator = T *;

    constexpr Span() noexcept = default;
    constexpr Span(T *data, std::size_t size) noexcept : data_(data), size_(size) {}

    template <class Container, class Element = detail::ElementOf<Container>,
              class = std::enable_if_t<!std::is_same_v<std::decay_t<Container>, Span> &&
                                       std::is_convertible_v<Element (*)[], T (*)[]>>>
    constexpr Span(Container &&container) : data_(std::data(container)), size_(std::size(container)) {}

    constexpr T *data() const noexcept { return data_; }
    constexpr std::size_t size() const noexcept { return size_; }
    constexpr bool empty() const noexcept { return size_ == 0; }
    constexpr T *begin() const noexcept { return data_; }
    constexpr T *end() const noexcept { return data_ + size_; }
    /// The element at `index`, which must be below `size()`.
    constexpr T &operator[](std::size_t index) const noexcept { return data_[index]; }

private:
    T *data_ = nullptr;
    std::size_t size_ = 0;
};

/// One member of each of a row of vertices: what `interleaved` gives, for a `Stream` to take.
template <class Member>
struct Interleaved {
    Member *first;
    std::size_t count;
    std::size_t stride;
};

/// One value a vertex, of `Components` numbers each, `stride` bytes apart, in memory that belongs to somebody
/// else. Valid as long as the numbers stay where they are. An empty stream is an absent attribute.
///
/// Made from plain numbers (`std::vector<float>`: x y z x y z ...), from vectors of any library that are
/// `Components` numbers and nothing else (`std::vector<glm::vec3>`, `std::array<float, 3>[]`), from a pointer
/// with count and stride, or from vertices of a kind of one's own:
///
///     buffers.positions = decimesh::interleaved(vertices, &Vertex::position);
template <class T, std::size_t Components>
class Stream {
    template <class Element>
    static constexpr bool is_group =
        sizeof(Element) == Components * sizeof(T) && alignof(Element) >= alignof(T) &&
        (std::is_const_v<T> || !std::is_const_v<std::remove_all_extents_t<Element>>);

public:
    constexpr Stream() noexcept = default;

    /// `count` vertices, the first one's numbers at `first`. A `stride` of 0 means that they are packed.
    constexpr Stream(T *first, std::size_t count, std::size_t stride = 0) noexcept
        : first_(first), count_(count), stride_(stride) {}

    /// Throws `std::invalid_argument` if plain numbers do not come out even.
    template <class Container, class Element = detail::ElementOf<Container>,
              class = std::enable_if_t<std::is_convertible_v<Element (*)[], T (*)[]> || is_group<Element>>>
    Stream(Container &&container) : count_(std::size(container)) {
        if constexpr (std::is_convertible_v<Element (*)[], T (*)[]>) {
            first_ = std::data(container);
            if (count_ % Components != 0) {
                throw std::invalid_argument("decimesh: " + std::to_string(count_) +
                                            " numbers do not make whole groups of " + std::to_string(Components));
            }
            count_ /= Components;
        } else {
            first_ = reinterpret_cast<T *>(std::data(container));
        }
    }

    template <class Member, class = std::enable_if_t<is_group<Member>>>
    Stream(Interleaved<Member> members) noexcept
        : first_(reinterpret_cast<T *>(members.first)), count_(members.count), stride_(members.stride) {}

    template <class Other, class = std::enable_if_t<std::is_convertible_v<Other (*)[], T (*)[]>>>
    constexpr Stream(const Stream<Other, Components> &other) noexcept
        : first_(other.first()), count_(other.count()), stride_(other.stride()) {}

    constexpr T *first() const noexcept { return first_; }
    /// How many vertices.
    constexpr std::size_t count() const noexcept { return count_; }
    /// Bytes from one vertex to the next; 0: packed.
    constexpr std::size_t stride() const noexcept { return stride_; }

private:
    T *first_ = nullptr;
    std::size_t count_ = 0;
    std::size_t stride_ = 0;
};

/// The stream of one member of `vertices`: anything with `data()` and `size()`.
template <class Vertices, class Vertex, class Member>
auto interleaved(Vertices &&vertices, Member Vertex::*member) {
    using Element = detail::ElementOf<Vertices>;
    using Reached = std::conditional_t<std::is_const_v<Element>, const Member, Member>;
    const std::size_t count = std::size(vertices);
    return Interleaved<Reached>{count == 0 ? nullptr : &(std::data(vertices)->*member), count, sizeof(Element)};
}

/// Vertices and triangles in the caller's memory, to read from. `Index` is `std::uint16_t` or `std::uint32_t`.
template <class Index = std::uint32_t>
struct Buffers {
    Stream<const float, 3> positions = {};       ///< x y z
    Span<const Index> indices = {};              ///< three a triangle, counter-clockwise from outside
    Stream<const float, 3> normals = {};         ///< x y z; absent if empty
    Stream<const float, 2> uvs = {};             ///< u v; absent if empty
    Stream<const std::uint8_t, 4> colors = {};   ///< red, green, blue, alpha; absent if empty
};

/// Vertices and triangles in the caller's memory, to read from and write to.
template <class Index = std::uint32_t>
struct MutableBuffers {
    Stream<float, 3> positions = {};       ///< x y z
    Span<Index> indices = {};              ///< three a triangle, counter-clockwise from outside
    Stream<float, 3> normals = {};         ///< x y z; absent if empty
    Stream<float, 2> uvs = {};             ///< u v; absent if empty
    Stream<std::uint8_t, 4> colors = {};   ///< red, green, blue, alpha; absent if empty
};

// ---- options and reports ----

/// What a simplification shall arrive at.
class Target {
public:
    enum class Kind : decimesh_target {
        triangles = DECIMESH_TARGET_TRIANGLES,
        vertices = DECIMESH_TARGET_VERTICES,
        ratio = DECIMESH_TARGET_RATIO,
        max_error = DECIMESH_TARGET_MAX_ERROR,
    };

    /// At most `count` triangles: that many, or one fewer.
    static constexpr Target triangles(std::size_t count) noexcept {
        return Target(Kind::triangles, static_cast<double>(count));
    }
    /// At most `count` vertices that a triangle uses.
    static constexpr Target vertices(std::size_t count) noexcept {
        return Target(Kind::vertices, static_cast<double>(count));
    }
    /// This fraction of the input's triangles, 0 to 1, rounded down.
    static constexpr Target ratio(double fraction) noexcept { return Target(Kind::ratio, fraction); }
    /// As few triangles as an estimated distance of this much allows.
    static constexpr Target max_error(double distance) noexcept { return Target(Kind::max_error, distance); }

    constexpr Kind kind() const noexcept { return kind_; }
    constexpr double value() const noexcept { return value_; }

private:
    constexpr Target(Kind kind, double value) noexcept : kind_(kind), value_(value) {}

    Kind kind_;
    double value_;
};

/// Which collapses a pass over the mesh takes.
enum class Selection : decimesh_selection {
    /// All that cost less than a sampled quantile: the best and fastest.
    sampled_threshold = DECIMESH_SELECTION_SAMPLED_THRESHOLD,
    /// Those that leave a small heap first (replacement selection), as Chen et al. have it.
    replacement = DECIMESH_SELECTION_REPLACEMENT,
};

/// What may happen to holes, handles and components.
enum class Topology : decimesh_topology {
    relax_if_stuck = DECIMESH_TOPOLOGY_RELAX_IF_STUCK,   ///< kept as long as the target can be met so
    keep = DECIMESH_TOPOLOGY_KEEP,                       ///< kept, even if the target is missed
};

/// Where the vertex that two become goes.
enum class Placement : decimesh_placement {
    optimal = DECIMESH_PLACEMENT_OPTIMAL,     ///< where the error is least
    existing = DECIMESH_PLACEMENT_EXISTING,   ///< to one of the two: output vertices are input vertices
};

/// Why a simplification ended.
enum class StoppedBy : decimesh_stopped_by {
    target = DECIMESH_STOPPED_BY_TARGET,   ///< the target is met
    error = DECIMESH_STOPPED_BY_ERROR,     ///< every further collapse would exceed the error asked for
    stuck = DECIMESH_STOPPED_BY_STUCK,     ///< every further collapse is forbidden by topology, locks or folds
};

/// What a vertex may do: bits of `Options::vertex_flags`. The last two are for `Placement::existing`; otherwise they
/// change nothing.
namespace vertex_flag {
/// It stays, bit for bit.
inline constexpr std::uint8_t lock = DECIMESH_VERTEX_LOCK;
/// It goes along seams only, whatever `Options::cross_seams` says.
inline constexpr std::uint8_t protect = DECIMESH_VERTEX_PROTECT;
/// It is kept as long as others can go: it costs a hundred times as much.
inline constexpr std::uint8_t prioritize = DECIMESH_VERTEX_PRIORITIZE;
}   // namespace vertex_flag

/// What a difference of 1 in an attribute weighs, beside a distance as long as the longest side of the bounding
/// box. Finite, not negative; 0: no say. For `Placement::existing` only.
struct AttributeWeights {
    float normals = 0;   ///< for each of the three coordinates of normals
    float uvs = 0;       ///< for both texture coordinates
    float colors = 0;    ///< for each of the four channels of colours, from none (0) to full (255)
};

/// How to simplify. The defaults are the library's.
struct Options {
    /// What to arrive at.
    Target target = Target::ratio(0.5);
    /// Which collapses a pass takes.
    Selection selection = Selection::sampled_threshold;
    /// Size of the heap of `Selection::replacement`, at least 1.
    std::uint32_t heap_records = 15;
    /// What may happen to holes, handles and components.
    Topology topology = Topology::relax_if_stuck;
    /// Where new vertices go. The index-only call always takes `Placement::existing`.
    Placement placement = Placement::optimal;
    /// Vertices of the border stay, bit for bit.
    bool lock_boundary = false;
    /// Where several vertices are at one place, as along the seams of textures, no crack opens. With
    /// `Placement::existing` they go along their seam together; with `Placement::optimal` they stay, bit for
    /// bit, where there are attributes and in `simplify_in_place`, and a mesh that is all seams gets stuck: weld
    /// it, or let the seams go.
    bool keep_seams = true;
    /// With `Placement::existing`, vertices may go across seams too, at the cost of the attributes by their
    /// weights; the surface stays closed. For meshes of many small charts, and for faceted ones.
    bool cross_seams = false;
    /// Moves vertices and turns edges in the end, so that the surface is nearer to the input's: its RMS distance
    /// falls by 6 to 10 %; the largest one may rise. Up to four times as long. For `Placement::optimal` only.
    bool refine = false;
    /// What attributes count, beside the distance.
    AttributeWeights attribute_weights = {};
    /// The group of each triangle, such as its material, or empty: where groups meet, their border stays a
    /// border, and `groups` of the result says where each triangle belongs. For `Placement::existing` only.
    std::vector<std::uint32_t> triangle_groups = {};
    /// Indices of vertices that stay, bit for bit.
    std::vector<std::uint32_t> locked_vertices = {};
    /// For each vertex `vertex_flag` bits or 0, or empty. The `locked_vertices` count as well.
    std::vector<std::uint8_t> vertex_flags = {};
    /// Threads to work with; 0: all of the machine.
    std::uint32_t threads = 0;
    /// Fill `origins` of the result. For what makes one mesh, and for `Levels`.
    bool track_origins = false;
    /// Hears of progress, and may cancel. Empty: nobody does.
    Progress progress = {};
};

/// The output vertex that `origins` has for an input vertex which went into none.
inline constexpr std::uint32_t vanished = UINT32_MAX;

/// How a simplification went.
struct Report {
    StoppedBy stopped_by;            ///< why it ended
    std::uint64_t triangles;         ///< triangles of the result
    std::uint64_t vertices;          ///< vertices of the result
    std::uint64_t locked_vertices;   ///< input vertices that were locked: by index, as borders, or as seams
    float error;                     ///< estimated largest distance from the input
    bool topology_changed;           ///< whether holes, handles or components were given up for the target
    std::uint32_t passes;            ///< passes over the mesh
    float attribute_error;           ///< estimated largest difference of attributes, by weight, as a length
};

/// How `multiple_choice` chooses. The defaults are the library's.
struct MultipleChoiceOptions {
    /// Of how many vertices drawn at random the cheapest goes, at least 1.
    std::uint32_t candidates = 6;
    /// Where the random numbers start.
    std::uint64_t seed = 0;
    /// Indices of vertices that stay.
    std::vector<std::uint32_t> locked_vertices = {};
    /// Hears of progress, and may cancel. Empty: nobody does.
    Progress progress = {};
};

/// What a mesh is made of and what is wrong with it.
struct Statistics {
    bool is_closed;                         ///< no edge is a border
    bool is_oriented_manifold;              ///< a surface everywhere, with one outside
    std::uint64_t vertices;                 ///< used or not
    std::uint64_t triangles;                ///< proper or not
    std::uint64_t unreferenced_vertices;    ///< vertices that no triangle uses
    std::uint64_t duplicate_positions;      ///< vertices at the place of an earlier one
    std::uint64_t degenerate_triangles;     ///< triangles that name a vertex twice
    std::uint64_t zero_area_triangles;      ///< triangles with three vertices, but no area
    std::uint64_t duplicate_triangles;      ///< triangles on the same vertices as an earlier one
    std::uint64_t edges;                    ///< pairs of vertices that a triangle joins
    std::uint64_t border_edges;             ///< edges of one triangle
    std::uint64_t boundary_loops;           ///< rings of border edges
    std::uint64_t non_manifold_edges;       ///< edges of three triangles or more
    std::uint64_t inconsistent_edges;       ///< edges whose two triangles disagree about the outside
    std::uint64_t non_manifold_vertices;    ///< vertices where fans of triangles touch
    std::uint64_t components;               ///< connected parts
    std::int64_t euler_characteristic;      ///< vertices in use - edges + triangles
    std::array<float, 3> bounds_min;        ///< least coordinates
    std::array<float, 3> bounds_max;        ///< greatest coordinates
    double diagonal;                        ///< length of the diagonal of the bounds
    double surface_area;                    ///< in squared units of the positions
};

/// How densely to measure. The defaults are the library's.
struct DeviationOptions {
    /// Points on each surface, spread evenly over its area; the vertices are measured besides.
    std::uint64_t samples = 500000;
    /// Chooses the points: the same seed gives the same result.
    std::uint64_t seed = 0;
    /// Threads to work with; 0: all of the machine.
    std::uint32_t threads = 0;
    /// Hears of progress, and may cancel. Empty: nobody does.
    Progress progress = {};
};

/// Distances from one surface to another.
struct Distances {
    double rms;    ///< root of the mean squared distance
    double mean;   ///< mean distance
    double max;    ///< largest distance
};

/// How far two surfaces are apart.
struct Deviation {
    double rms;                  ///< the larger of both directions
    double mean;                 ///< the larger of both directions
    double max;                  ///< the larger of both directions
    Distances forward;           ///< from the first surface to the second
    Distances backward;          ///< from the second to the first
    double diagonal;             ///< of the box around the first mesh
    double normal_rms_degrees;   ///< RMS angle between normals, the larger of both directions
};

/// How close bounds shall come, and how much work that may be. The defaults are the library's.
struct BoundOptions {
    /// How far above the lower bound the upper may be, as a share of it: finite, not negative.
    double tolerance = 0.01;
    /// Pieces of triangles to look at before giving up on the tolerance: some microseconds each, and at most
    /// about 120 bytes.
    std::uint64_t pieces = 5000000;
    /// Threads to work with; 0: all of the machine.
    std::uint32_t threads = 0;
    /// Hears of progress, and may cancel. Empty: nobody does.
    Progress progress = {};
};

/// How a field of heights is decomposed. The defaults are the library's.
struct HierarchyOptions {
    /// Samples that are void: nothing is known there, and no triangle covers them. A NaN means all that are none.
    std::optional<float> no_data = {};
    /// How far columns and rows are apart, in the unit of the heights.
    float column_spacing = 1;
    float row_spacing = 1;
    /// For each sample how much its squared error counts: finite, not negative. Empty: 1 for all.
    Span<const float> importance = {};
    /// Sweeps before the gap is looked at, and between two looks.
    std::uint32_t sweeps = 8;
    /// Sweeps at most.
    std::uint32_t max_sweeps = 64;
    /// How far above the least squared error, in decibels, is good enough.
    double gap = 0.03;
    /// Threads to work with; 0: all of the machine.
    std::uint32_t threads = 0;
    /// Hears of progress, and may cancel. Empty: nobody does.
    Progress progress = {};
};

/// How much of a hierarchy is wanted.
class Detail {
public:
    enum class Kind : decimesh_detail {
        vertices = DECIMESH_DETAIL_VERTICES,
        ratio = DECIMESH_DETAIL_RATIO,
        rms = DECIMESH_DETAIL_RMS,
        max_error = DECIMESH_DETAIL_MAX_ERROR,
    };

    /// At most so many vertices, and as many as there can be below.
    static Detail vertices(std::uint32_t count) noexcept { return {Kind::vertices, static_cast<double>(count)}; }
    /// So large a part of the samples that are not void, above 0 and at most 1.
    static Detail ratio(double part) noexcept { return {Kind::ratio, part}; }
    /// As few vertices as there are with this root mean square of the vertical error.
    static Detail rms(double error) noexcept { return {Kind::rms, error}; }
    /// As few vertices as there can be with no sample farther from the surface, vertically.
    static Detail max_error(double error) noexcept { return {Kind::max_error, error}; }

    Kind kind() const noexcept { return kind_; }
    double value() const noexcept { return value_; }

private:
    Detail(Kind kind, double value) noexcept : kind_(kind), value_(value) {}
    Kind kind_;
    double value_;
};

/// What the two-sided Hausdorff distance between two surfaces lies between.
struct Bound {
    double lower;           ///< the largest distance found
    double upper;           ///< no point of either surface is farther from the other
    double diagonal;        ///< of the box around the first mesh
    std::uint64_t pieces;   ///< pieces that were looked at, other than the triangles themselves
};

// ---- meshes ----

/// How numbers are written, in file formats that leave the choice.
enum class Encoding : decimesh_encoding {
    binary = DECIMESH_ENCODING_BINARY,                           ///< little endian
    binary_big_endian = DECIMESH_ENCODING_BINARY_BIG_ENDIAN,     ///< PLY alone has it
    ascii = DECIMESH_ENCODING_ASCII,                             ///< as text
};

class Mesh;

namespace detail {

/// What can be asked of a mesh, owned or borrowed. Of a mesh that was moved from, counts are 0 and spans are
/// empty, and the other calls throw `Error` with `Status::null`.
template <class Self>
class MeshQueries {
public:
    std::size_t vertex_count() const noexcept { return decimesh_mesh_vertex_count(raw()); }
    std::size_t triangle_count() const noexcept { return decimesh_mesh_triangle_count(raw()); }

    /// x y z a vertex. This span and the next four are borrowed from the mesh and live as long as it does.
    Span<const float> positions() const & noexcept {
        return {decimesh_mesh_positions(raw()), 3 * vertex_count()};
    }
    /// Three a triangle, counter-clockwise from outside.
    Span<const std::uint32_t> indices() const & noexcept {
        return {decimesh_mesh_indices(raw()), 3 * triangle_count()};
    }
    /// x y z a vertex; empty if the mesh has no normals.
    Span<const float> normals() const & noexcept { return attribute(decimesh_mesh_normals(raw()), 3); }
    /// u v a vertex; empty if the mesh has no texture coordinates.
    Span<const float> uvs() const & noexcept { return attribute(decimesh_mesh_uvs(raw()), 2); }
    /// Red, green, blue, alpha a vertex; empty if the mesh has no colours.
    Span<const std::uint8_t> colors() const & noexcept { return attribute(decimesh_mesh_colors(raw()), 4); }

    /// Counts, flaws, topology and size, in n log n time.
    Statistics statistics() const;

    /// Writes a PLY, OBJ, STL, OFF, glTF or GLB file, as the extension of `path` (UTF-8) says. A file that is
    /// there already is replaced once all is written.
    void write(const std::string &path, Encoding encoding = Encoding::binary) const;

    /// The mesh with one vertex in place of all those within `tolerance` of each other; 0: at equal positions.
    Mesh weld(float tolerance = 0) const;

private:
    const decimesh_mesh *raw() const noexcept { return static_cast<const Self *>(this)->get(); }
    template <class T>
    Span<const T> attribute(const T *first, std::size_t components) const noexcept {
        return {first, first == nullptr ? 0 : components * vertex_count()};
    }
};

}   // namespace detail

/// A mesh that belongs to somebody else: to a `Mesh`, to levels, or to C code. Cheap to copy; valid as long
/// as its owner is. Every function that reads a mesh takes one, and a `Mesh` converts to it.
class MeshView : public detail::MeshQueries<MeshView> {
public:
    /// A view of a handle of the C interface.
    explicit MeshView(const decimesh_mesh *handle) noexcept : handle_(handle) {}

    /// The handle of the C interface.
    const decimesh_mesh *get() const noexcept { return handle_; }

private:
    const decimesh_mesh *handle_;
};

/// A mesh with its owner. Immutable; moving is cheap, and leaves an empty mesh behind.
class Mesh : public detail::MeshQueries<Mesh> {
public:
    /// An empty mesh, to assign to.
    Mesh() noexcept = default;

    /// A mesh copied from buffers. They are checked; dirty meshes are welcome, broken ones throw `Error`:
    /// no vertices, indices out of range, numbers that are not finite. Linear time.
    template <class Index>
    static Mesh from_buffers(const Buffers<Index> &buffers);

    /// A mesh of positions and triangles alone.
    static Mesh from_buffers(Stream<const float, 3> positions, Span<const std::uint32_t> indices) {
        return from_buffers(Buffers<std::uint32_t>{positions, indices});
    }
    static Mesh from_buffers(Stream<const float, 3> positions, Span<const std::uint16_t> indices) {
        return from_buffers(Buffers<std::uint16_t>{positions, indices});
    }

    /// The mesh of a PLY, OBJ, STL, OFF, glTF or GLB file, as the extension of `path` (UTF-8) says.
    static Mesh read(const std::string &path);

    // Of a mesh that is about to go, they would be of nothing: name it first.
    using MeshQueries::positions, MeshQueries::indices, MeshQueries::normals, MeshQueries::uvs, MeshQueries::colors;
    Span<const float> positions() const && = delete;
    Span<const std::uint32_t> indices() const && = delete;
    Span<const float> normals() const && = delete;
    Span<const float> uvs() const && = delete;
    Span<const std::uint8_t> colors() const && = delete;

    /// Takes over a handle of the C interface.
    static Mesh adopt(decimesh_mesh *handle) noexcept {
        Mesh mesh;
        mesh.handle_.reset(handle);
        return mesh;
    }
    /// The handle of the C interface.
    const decimesh_mesh *get() const noexcept { return handle_.get(); }
    /// Gives the handle of the C interface away: `decimesh_mesh_destroy` it.
    [[nodiscard]] decimesh_mesh *release() noexcept { return handle_.release(); }

    operator MeshView() const noexcept { return MeshView(get()); }

private:
    struct Destroy {
        void operator()(decimesh_mesh *handle) const noexcept { decimesh_mesh_destroy(handle); }
    };
    std::unique_ptr<decimesh_mesh, Destroy> handle_;
};

// ---- what decimesh does ----

/// A simplified mesh, and how it came about.
struct Simplified {
    Mesh mesh;
    Report report;
    /// For each input vertex the output vertex it went into, or `vanished`. Empty unless
    /// `Options::track_origins`.
    std::vector<std::uint32_t> origins;
    /// The group of each triangle. Empty unless there are `Options::triangle_groups`.
    std::vector<std::uint32_t> groups;
};

/// Simplifies `mesh`. A target that cannot be met is no error: the result is then as small as the options
/// allow, and `Report::stopped_by` says why.
///
/// Linear time; at its peak about 24 bytes a triangle of a closed mesh, and the result.
Simplified simplify(MeshView mesh, const Options &options = {});

/// A simplified mesh, and what its distance from the input is guaranteed to be.
struct Certified {
    Simplified simplified;  ///< its `report.error` is `bound.upper` too, rounded upwards
    Bound bound;            ///< `upper` is at most what was asked for
};

/// Simplifies `mesh` to few triangles whose two-sided Hausdorff distance from it is proven to be at most `max_error`.
/// `Options::target` is not looked at, and the topology is kept. Where nothing smaller can be shown to be so close, the
/// input comes back, without the vertices that no triangle uses, at distance 0.
///
/// At most nine times the time of `bound`: some ten to 200 microseconds a triangle. About 280 bytes a triangle of a
/// closed mesh, and at most 120 for each of 32 parts a triangle that have to be looked at.
Certified simplify_within(MeshView mesh, double max_error, const Options &options = {});

/// What `multiple_choice` comes to.
struct Decimated {
    Mesh mesh;
    StoppedBy stopped_by;                  ///< `target` or `stuck`
    std::vector<std::uint32_t> sources;    ///< for each vertex of `mesh` the one of the input that it is, ascending
};

/// Simplifies `mesh` to at most `triangles` as Jia, Tang and Pan do: time and again some vertices are drawn at random,
/// and the one with the least visual cost goes into a neighbour. No vertex is made or moved, and the topology is kept.
/// It is there to compare with: `simplify` with `Placement::existing` is faster and closer.
///
/// Linear time, on one thread; about 115 bytes a vertex.
Decimated multiple_choice(MeshView mesh, std::size_t triangles, const MultipleChoiceOptions &options = {});

/// What a call on the caller's own buffers leaves in them.
struct SimplifiedIndices {
    std::size_t index_count;   ///< how many of the indices count: the first ones
    Report report;
    /// As in `Simplified`; output vertices are input vertices here, by their old numbers.
    std::vector<std::uint32_t> origins;
    /// As in `Simplified`.
    std::vector<std::uint32_t> groups;
};

/// For engines: fewer triangles over the same, unchanged vertices, so that all levels of detail share one
/// vertex buffer. Writes the first `index_count` of `destination`, which has room for as many indices as
/// `buffers` has, and may be those.
template <class Index>
SimplifiedIndices simplify_indices(std::common_type_t<Span<Index>> destination, const Buffers<Index> &buffers,
                                   const Options &options = {});

/// For engines: simplifies within the caller's buffers. Indices, positions and attributes are overwritten;
/// vertices keep their places, and those that no index names any more their old values. Less error than
/// `simplify_indices`, at the price of vertices of one's own for each level.
template <class Index>
SimplifiedIndices simplify_in_place(const MutableBuffers<Index> &buffers, const Options &options = {});

/// A chain of ever coarser meshes, each made from the one before. Immutable, move-only.
class Levels {
public:
    /// A level for each of `targets`, from fine to coarse; all of one kind. `Options::target` is not looked at.
    /// Levels that cannot be met are the mesh before, and say so.
    ///
    /// A chain costs little more than its coarsest level.
    static Levels build(MeshView mesh, const std::vector<Target> &targets, const Options &options = {});

    /// How many levels.
    std::size_t size() const noexcept { return decimesh_levels_count(handle_.get()); }

    /// The mesh of `level`, borrowed: it lives as long as these levels. Throws `Error` if there is no such level.
    MeshView mesh(std::size_t level) const &;
    MeshView mesh(std::size_t level) const && = delete;

    /// How `level` came about; errors are distances from the mesh that the chain began with.
    Report report(std::size_t level) const;

    /// The group of each triangle of `level`, borrowed as the mesh is. Empty unless there were
    /// `Options::triangle_groups`.
    Span<const std::uint32_t> groups(std::size_t level) const &;
    Span<const std::uint32_t> groups(std::size_t level) const && = delete;

    /// For each vertex of the input the vertex of `level` that it went into, or `vanished`; borrowed as the mesh is.
    /// Empty unless `Options::track_origins`.
    Span<const std::uint32_t> origins(std::size_t level) const &;
    Span<const std::uint32_t> origins(std::size_t level) const && = delete;

    /// The coarsest level with an error of at most `max_error`; none if even the finest exceeds it: then draw
    /// the mesh itself.
    std::optional<std::size_t> select(float max_error) const;

    /// The handle of the C interface.
    const decimesh_levels *get() const noexcept { return handle_.get(); }

private:
    struct Destroy {
        void operator()(decimesh_levels *handle) const noexcept { decimesh_levels_destroy(handle); }
    };
    std::unique_ptr<decimesh_levels, Destroy> handle_;
    std::size_t input_vertices_ = 0;
};

/// What is known of a level of `NestedLevels`.
struct NestedLevel {
    StoppedBy stopped_by;       ///< why it is as large as it is
    std::size_t vertices;       ///< its vertices are so many, the first of the buffer
    std::size_t index_count;    ///< three a triangle
    float error;                ///< largest distance from level 0: estimated, or guaranteed once certified
    bool topology_changed;      ///< whether holes, handles or components were given up, here or on a finer level
};

/// Levels of detail that share one vertex buffer: level 0 is the mesh that they were made of, and each level
/// names vertices below a number that falls from level to level. Move-only.
class NestedLevels {
public:
    /// A level for each of `targets` after level 0, from fine to coarse; all of one kind. `Options::target`,
    /// `Options::placement` and `Options::track_origins` are not looked at. Levels that cannot be met are the
    /// same as the one before, and say so.
    static NestedLevels build(MeshView mesh, const std::vector<Target> &targets, const Options &options = {});

    /// How many levels, level 0 included.
    std::size_t size() const noexcept { return decimesh_nested_count(get()); }

    /// The vertex buffer of all levels, with the triangles of level 0. Borrowed, as all spans and views below:
    /// it lives as long as these levels.
    MeshView mesh() const & noexcept { return MeshView(decimesh_nested_mesh(get())); }
    MeshView mesh() const && = delete;

    /// For each vertex of the buffer the vertex of the input that it is: for streams that decimesh has not seen.
    Span<const std::uint32_t> order() const & noexcept {
        return {decimesh_nested_order(get()), decimesh_mesh_vertex_count(decimesh_nested_mesh(get()))};
    }
    Span<const std::uint32_t> order() const && = delete;

    /// What `level` is. Throws `Error` if there is no such level, as all that are asked for one do.
    NestedLevel level(std::size_t level) const;

    /// The indices of `level`.
    Span<const std::uint32_t> indices(std::size_t level) const &;
    Span<const std::uint32_t> indices(std::size_t level) const && = delete;

    /// Copies the indices of `level` to the beginning of `destination`, and answers how many there are. Throws
    /// `Error` if they do not fit: more than there is room for, or vertices that 16 bits cannot name.
    std::size_t copy_indices(std::size_t level, Span<std::uint32_t> destination) const;
    std::size_t copy_indices(std::size_t level, Span<std::uint16_t> destination) const;

    /// The group of each triangle of `level`. Empty unless there were `Options::triangle_groups`, and for level 0,
    /// whose triangles are those of the input in their order: its groups are those given.
    Span<const std::uint32_t> groups(std::size_t level) const &;
    Span<const std::uint32_t> groups(std::size_t level) const && = delete;

    /// For each vertex of `level` the one that it goes into on the next coarser level, to draw it on the way
    /// there; itself where it stays. Empty on the coarsest level.
    Span<const std::uint32_t> morphs(std::size_t level) const &;
    Span<const std::uint32_t> morphs(std::size_t level) const && = delete;

    /// The coarsest level with an error of at most `max_error`; 0 if none but the input is so good.
    std::size_t select(float max_error) const;

    /// Puts a guaranteed bound in the place of each level's estimated error, which takes far longer than
    /// `build`. If it throws, nothing has changed.
    void certify(const BoundOptions &options = {});

    /// Writes one GLB file: the vertex buffer once, each level a node, which the first names by the extension
    /// MSFT_lod. `path` is UTF-8.
    void write_glb(const std::string &path) const;

    /// The handle of the C interface.
    const decimesh_nested *get() const noexcept { return handle_.get(); }

private:
    struct Destroy {
        void operator()(decimesh_nested *handle) const noexcept { decimesh_nested_destroy(handle); }
    };
    std::unique_ptr<decimesh_nested, Destroy> handle_;
};

/// What was taken from a `Hierarchy`.
struct Taken {
    Mesh mesh;               ///< east, north, up; with texture coordinates
    double rms;              ///< root of the mean squared vertical error of all samples
    double max_error;        ///< largest vertical error of a sample; NaN for a surface
    double certified_gap;    ///< decibels that the squared error can be above the least of as many vertices
};

/// Heights over a grid, or a semi-regular surface, decomposed: all rates from one run. Move-only.
class Hierarchy {
public:
    /// Decomposes `columns` times as many rows of heights as there are, the northernmost row first. Throws `Error`
    /// if they do not make whole rows, as for all that is wrong with them.
    static Hierarchy build(Span<const float> heights, std::size_t columns, const HierarchyOptions &options = {});

    /// Remeshes an oriented manifold to a semi-regular surface, of about `base_quads` quads halved `depth` times, and
    /// decomposes that. `at` then knows vertices, ratios and RMS; there are no files and no `tin`.
    static Hierarchy remesh(MeshView mesh, std::uint32_t depth, std::size_t base_quads = 400,
                            const HierarchyOptions &options = {});

    /// The hierarchy in a file that `write` made. `path` is UTF-8.
    static Hierarchy read(const std::string &path);
    /// Writes a file as docs/hierarchy-format.md describes it, whole or not at all.
    void write(const std::string &path) const;

    /// How many samples are not void, or vertices the surface has.
    std::size_t samples() const noexcept { return decimesh_hierarchy_samples(get()); }

    /// The mesh with as much detail as is wanted, and more where a sample would be farther from it than `max_error`.
    Taken at(const Detail &wanted, double max_error = std::numeric_limits<double>::infinity()) const;

    /// A free triangulation of at most so many vertices: closer to the heights than what `at` gives with as many, but
    /// not nested in finer ones. With `least_squares` its heights are fitted to all samples.
    Taken tin(std::size_t vertices, bool least_squares = false, const Progress &progress = {}) const;

    /// The handle of the C interface.
    const decimesh_hierarchy *get() const noexcept { return handle_.get(); }

private:
    struct Destroy {
        void operator()(decimesh_hierarchy *handle) const noexcept { decimesh_hierarchy_destroy(handle); }
    };
    std::unique_ptr<decimesh_hierarchy, Destroy> handle_;
};

/// A mesh as its coarsest level and the splits that refine it, one after the other. A step is the number of
/// splits done: 0 is the coarsest level, `steps()` the finest, and a step beyond it is taken for it.
/// Immutable, move-only.
class Progressive {
public:
    /// A level that a target was met at.
    struct Mark {
        std::size_t step;   ///< at which step it is
        float error;        ///< estimated largest distance from the finest
    };

    /// Of a file, all of it.
    static constexpr std::size_t whole = SIZE_MAX;

    /// Simplifies to each of `targets` in turn, from fine to coarse, all of one kind, and keeps all levels in
    /// between. The topology is kept, so that the coarsest level may be larger than asked for. `Options::target`,
    /// `Options::placement`, `Options::topology` and `Options::track_origins` are not looked at.
    static Progressive build(MeshView mesh, const std::vector<Target> &targets, const Options &options = {});

    /// Reads a file, up to the finest level of at most `max_triangles`, or the coarsest. `path` is UTF-8.
    static Progressive read(const std::string &path, std::size_t max_triangles = whole);

    /// The same from the bytes of such a file, or of its beginning.
    static Progressive from_memory(const void *bytes, std::size_t size, std::size_t max_triangles = whole);

    /// Writes a file: whole, or not at all. `path` is UTF-8.
    void write(const std::string &path) const;

    /// How many splits lead from the coarsest level to the finest.
    std::size_t steps() const noexcept { return decimesh_progressive_steps(get()); }
    std::size_t vertex_count(std::size_t step) const noexcept {
        return decimesh_progressive_vertex_count(get(), step);
    }
    std::size_t triangle_count(std::size_t step) const noexcept {
        return decimesh_progressive_triangle_count(get(), step);
    }
    /// The step of the finest level with at most so many triangles; 0 if none has so few.
    std::size_t step_within(std::size_t triangles) const noexcept {
        return decimesh_progressive_step_within(get(), triangles);
    }

    /// The vertices of all levels, the last to go first; a mesh without triangles. Borrowed, as the next is: it
    /// lives as long as this.
    MeshView vertices() const & noexcept { return MeshView(decimesh_progressive_vertices(get())); }
    MeshView vertices() const && = delete;

    /// For each vertex the one of the input that it is. Empty if this comes from a file.
    Span<const std::uint32_t> order() const & noexcept;
    Span<const std::uint32_t> order() const && = delete;

    /// Copies the indices of the level at `step` to the beginning of `destination`, and answers how many there
    /// are. Throws `Error` if they do not fit: more than there is room for, or vertices that 16 bits cannot name.
    std::size_t copy_indices(std::size_t step, Span<std::uint32_t> destination) const;
    std::size_t copy_indices(std::size_t step, Span<std::uint16_t> destination) const;

    /// The level at `step` as a mesh of its own.
    Mesh mesh(std::size_t step) const;

    /// Where the targets were met, from fine to coarse.
    std::vector<Mark> marks() const;

    /// The handle of the C interface.
    const decimesh_progressive *get() const noexcept { return handle_.get(); }

private:
    static Progressive adopt(decimesh_progressive *handle) noexcept {
        Progressive progressive;
        progressive.handle_.reset(handle);
        return progressive;
    }

    struct Destroy {
        void operator()(decimesh_progressive *handle) const noexcept { decimesh_progressive_destroy(handle); }
    };
    std::unique_ptr<decimesh_progressive, Destroy> handle_;
};

/// A level of a `Progressive`, and the way to those next to it: a step costs as much as it changes. It has a share
/// of the progressive mesh, and may outlive it. Move-only.
class Player {
public:
    /// A player of nothing, to assign to.
    Player() noexcept = default;

    /// A player at the coarsest level.
    explicit Player(const Progressive &progressive);

    std::size_t step() const noexcept { return decimesh_player_step(get()); }
    std::size_t vertex_count() const noexcept { return decimesh_player_vertex_count(get()); }
    std::size_t triangle_count() const noexcept { return decimesh_player_triangle_count(get()); }

    /// The indices of the level. Borrowed: they live until the player goes to another step.
    Span<const std::uint32_t> indices() const & noexcept {
        return {decimesh_player_indices(get()), 3 * triangle_count()};
    }
    Span<const std::uint32_t> indices() const && = delete;

    /// As `Progressive::copy_indices`.
    std::size_t copy_indices(Span<std::uint32_t> destination) const;
    std::size_t copy_indices(Span<std::uint16_t> destination) const;

    /// Does the next split; false if this was the finest level.
    bool finer();
    /// Undoes the last split; false if this was the coarsest level.
    bool coarser();
    /// Goes to `step`, or to the finest level where it is beyond that.
    void go_to(std::size_t step);

    /// The handle of the C interface.
    const decimesh_player *get() const noexcept { return handle_.get(); }

private:
    struct Destroy {
        void operator()(decimesh_player *handle) const noexcept { decimesh_player_destroy(handle); }
    };
    std::unique_ptr<decimesh_player, Destroy> handle_;
};

/// Bounds the two-sided Hausdorff distance between the surfaces of `a` and `b`, over all points. n log n time,
/// and some microseconds a piece; about 130 bytes a triangle of both, and the pieces.
Bound bound(MeshView a, MeshView b, const BoundOptions &options = {});

/// Measures how far the surfaces of `a` and `b` are apart, in both directions. n log n time; about 110 bytes a
/// triangle of both.
Deviation deviation(MeshView a, MeshView b, const DeviationOptions &options = {});

/// Measures how far each vertex of `from` is from the surface of `to`, in the order of the vertices: for heat maps.
/// Vertices that no triangle uses are measured as well. `DeviationOptions::samples` and `seed` are not looked at.
/// n log n time; about 110 bytes a triangle of `to`.
std::vector<float> vertex_distances(MeshView from, MeshView to, const DeviationOptions &options = {});

// ---- how it is done ----

namespace detail {

inline void check(decimesh_status status) {
    if (status == DECIMESH_OK) {
        return;
    }
    const std::string message = decimesh_last_error_message();
    if (status == DECIMESH_ERROR_CANCELLED) {
        throw Cancelled(Status::cancelled, message);
    }
    throw Error(static_cast<Status>(status), message);
}

/// A struct of the C interface with its size in it and all else zero. Its `_init` function would do as well for
/// C; here every field is set from defaults of our own, and a function of another version of the library need
/// not agree with this header about the size.
template <class Raw>
Raw sized() noexcept {
    Raw raw{};
    raw.struct_size = static_cast<std::uint32_t>(sizeof(Raw));
    return raw;
}

/// Stands between the library and a `Progress`: no exception passes through the library; it waits here.
class Watcher {
public:
    explicit Watcher(const Progress &progress) noexcept : progress_(progress) {}
    Watcher(const Watcher &) = delete;
    Watcher &operator=(const Watcher &) = delete;

    template <class Raw>
    void attach(Raw &raw) noexcept {
        if (progress_) {
            raw.progress = report;
            raw.progress_user = this;
        }
    }

    /// To be called once everything the library gave out has an owner.
    void check(decimesh_status status) const {
        if (thrown_) {
            std::rethrow_exception(thrown_);
        }
        detail::check(status);
    }

private:
    static std::int32_t report(void *user, float fraction) noexcept {
        Watcher &self = *static_cast<Watcher *>(user);
        try {
            return self.progress_(fraction) ? 0 : 1;
        } catch (...) {
            self.thrown_ = std::current_exception();
            return 1;
        }
    }

    const Progress &progress_;
    std::exception_ptr thrown_;
};

inline Report from_raw(const decimesh_simplify_report &raw) noexcept {
    return {static_cast<StoppedBy>(raw.stopped_by), raw.triangles, raw.vertices, raw.locked_vertices, raw.error,
            raw.topology_changed != 0, raw.passes, raw.attribute_error};
}

/// A pointer to the elements of `given`, one for each of `count`, or NULL where there are none.
template <class T>
const T *element_each(const std::vector<T> &given, const char *name, std::size_t count, const char *of) {
    if (given.empty()) {
        return nullptr;
    }
    if (given.size() != count) {
        throw std::invalid_argument("decimesh: " + std::to_string(given.size()) + " " + name + " for " +
                                    std::to_string(count) + " " + of);
    }
    return given.data();
}

/// The structs of a call that simplifies, and what they point to. `options` must outlive it.
class SimplifyCall {
public:
    SimplifyCall(const Options &options, std::size_t vertices, std::size_t triangles) : watcher_(options.progress) {
        raw.target = static_cast<decimesh_target>(options.target.kind());
        raw.target_value = options.target.value();
        raw.selection = static_cast<decimesh_selection>(options.selection);
        raw.heap_records = options.heap_records;
        raw.topology = static_cast<decimesh_topology>(options.topology);
        raw.placement = static_cast<decimesh_placement>(options.placement);
        raw.lock_boundary = options.lock_boundary;
        raw.keep_seams = options.keep_seams;
        raw.threads = options.threads;
        raw.locked_vertices = options.locked_vertices.data();
        raw.locked_count = options.locked_vertices.size();
        raw.cross_seams = options.cross_seams;
        raw.refine = options.refine;
        raw.normal_weight = options.attribute_weights.normals;
        raw.uv_weight = options.attribute_weights.uvs;
        raw.color_weight = options.attribute_weights.colors;
        raw.triangle_groups = element_each(options.triangle_groups, "groups", triangles, "triangles");
        raw.vertex_flags = element_each(options.vertex_flags, "flags", vertices, "vertices");
        raw.level_origins = options.track_origins;
        watcher_.attach(raw);
    }

    /// To be called before one mesh is made.
    void ask_for_elements(std::size_t vertices, std::size_t triangles) {
        if (raw.level_origins != 0) {
            origins.resize(vertices);
            raw.origins = origins.data();
        }
        if (raw.triangle_groups != nullptr) {
            groups.resize(triangles);
            raw.result_groups = groups.data();
        }
    }

    void check(decimesh_status status) {
        watcher_.check(status);
        if (!groups.empty()) {
            groups.resize(static_cast<std::size_t>(report.triangles));
        }
    }

    /// Takes the kind of the targets, and gives their values.
    std::vector<double> set_targets(const std::vector<Target> &targets) {
        std::vector<double> values;
        values.reserve(targets.size());
        for (const Target &target : targets) {
            if (target.kind() != targets.front().kind()) {
                throw std::invalid_argument("decimesh: the targets of levels must all be of one kind");
            }
            values.push_back(target.value());
        }
        if (!targets.empty()) {
            raw.target = static_cast<decimesh_target>(targets.front().kind());
            raw.target_value = targets.front().value();
        }
        return values;
    }

    decimesh_simplify_options raw = sized<decimesh_simplify_options>();
    decimesh_simplify_report report = sized<decimesh_simplify_report>();
    std::vector<std::uint32_t> origins;
    std::vector<std::uint32_t> groups;

private:
    Watcher watcher_;
};

/// The struct of a call that bounds a distance. `options` must outlive it.
class BoundCall {
public:
    explicit BoundCall(const BoundOptions &options) : watcher_(options.progress) {
        raw.threads = options.threads;
        raw.tolerance = options.tolerance;
        raw.pieces = options.pieces;
        watcher_.attach(raw);
    }

    void check(decimesh_status status) const { watcher_.check(status); }

    decimesh_bound_options raw = sized<decimesh_bound_options>();

private:
    Watcher watcher_;
};

/// The struct of a call that measures distances. `options` must outlive it.
class DeviationCall {
public:
    explicit DeviationCall(const DeviationOptions &options) : watcher_(options.progress) {
        raw.threads = options.threads;
        raw.samples = options.samples;
        raw.seed = options.seed;
        watcher_.attach(raw);
    }

    void check(decimesh_status status) const { watcher_.check(status); }

    decimesh_deviation_options raw = sized<decimesh_deviation_options>();

private:
    Watcher watcher_;
};

/// The struct of a call that decomposes. `options` must outlive it.
class HierarchyCall {
public:
    explicit HierarchyCall(const HierarchyOptions &options) : watcher_(options.progress) {
        raw.has_no_data = options.no_data ? 1 : 0;
        raw.no_data = options.no_data.value_or(0.0F);
        raw.column_spacing = options.column_spacing;
        raw.row_spacing = options.row_spacing;
        raw.importance = options.importance.empty() ? nullptr : options.importance.data();
        raw.sweeps = options.sweeps;
        raw.max_sweeps = options.max_sweeps;
        raw.gap = options.gap;
        raw.threads = options.threads;
        watcher_.attach(raw);
    }

    void check(decimesh_status status) const { watcher_.check(status); }

    decimesh_hierarchy_options raw = sized<decimesh_hierarchy_options>();

private:
    Watcher watcher_;
};

/// Where `destination` begins. Room for nothing may be nowhere, which to C would be a pointer forgotten.
template <class Index>
void *room_of(Span<Index> destination) noexcept {
    static Index nothing;
    return destination.data() == nullptr ? &nothing : destination.data();
}

template <class Index>
constexpr decimesh_index_type index_type() noexcept {
    static_assert(std::is_same_v<Index, std::uint16_t> || std::is_same_v<Index, std::uint32_t>,
                  "indices have 16 or 32 bits, without a sign");
    return sizeof(Index) == 2 ? DECIMESH_INDEX_U16 : DECIMESH_INDEX_U32;
}

template <class T, std::size_t Components>
void set_attribute(T *&first, std::size_t &stride, const Stream<T, Components> &stream, std::size_t vertices,
                   const char *name) {
    if (stream.count() == 0) {
        return;
    }
    if (stream.count() != vertices) {
        throw std::invalid_argument("decimesh: " + std::to_string(stream.count()) + " " + name + " for " +
                                    std::to_string(vertices) + " positions");
    }
    first = stream.first();
    stride = stream.stride();
}

/// The C struct of `buffers`, mutable or not.
template <class Raw, class Index, template <class> class Kind>
Raw to_raw(const Kind<Index> &buffers) {
    const std::size_t vertices = buffers.positions.count();
    Raw raw = sized<Raw>();
    raw.index_type = index_type<Index>();
    raw.positions = buffers.positions.first();
    raw.positions_stride = buffers.positions.stride();
    raw.vertex_count = vertices;
    raw.indices = buffers.indices.data();
    raw.index_count = buffers.indices.size();
    set_attribute(raw.normals, raw.normals_stride, buffers.normals, vertices, "normals");
    set_attribute(raw.uvs, raw.uvs_stride, buffers.uvs, vertices, "texture coordinates");
    set_attribute(raw.colors, raw.colors_stride, buffers.colors, vertices, "colours");
    return raw;
}

template <class Self>
Statistics MeshQueries<Self>::statistics() const {
    auto raw = sized<decimesh_statistics>();
    check(decimesh_mesh_statistics(this->raw(), &raw));
    const auto point = [](const float *x) { return std::array<float, 3>{x[0], x[1], x[2]}; };
    Statistics statistics{};
    statistics.is_closed = raw.is_closed != 0;
    statistics.is_oriented_manifold = raw.is_oriented_manifold != 0;
    statistics.vertices = raw.vertices;
    statistics.triangles = raw.triangles;
    statistics.unreferenced_vertices = raw.unreferenced_vertices;
    statistics.duplicate_positions = raw.duplicate_positions;
    statistics.degenerate_triangles = raw.degenerate_triangles;
    statistics.zero_area_triangles = raw.zero_area_triangles;
    statistics.duplicate_triangles = raw.duplicate_triangles;
    statistics.edges = raw.edges;
    statistics.border_edges = raw.border_edges;
    statistics.boundary_loops = raw.boundary_loops;
    statistics.non_manifold_edges = raw.non_manifold_edges;
    statistics.inconsistent_edges = raw.inconsistent_edges;
    statistics.non_manifold_vertices = raw.non_manifold_vertices;
    statistics.components = raw.components;
    statistics.euler_characteristic = raw.euler_characteristic;
    statistics.bounds_min = point(raw.bounds_min);
    statistics.bounds_max = point(raw.bounds_max);
    statistics.diagonal = raw.diagonal;
    statistics.surface_area = raw.surface_area;
    return statistics;
}

template <class Self>
void MeshQueries<Self>::write(const std::string &path, Encoding encoding) const {
    check(decimesh_mesh_write(raw(), path.c_str(), static_cast<decimesh_encoding>(encoding)));
}

template <class Self>
Mesh MeshQueries<Self>::weld(float tolerance) const {
    decimesh_mesh *welded = nullptr;
    check(decimesh_mesh_weld(raw(), tolerance, &welded));
    return Mesh::adopt(welded);
}

}   // namespace detail

template <class Index>
Mesh Mesh::from_buffers(const Buffers<Index> &buffers) {
    const auto raw = detail::to_raw<decimesh_buffers>(buffers);
    decimesh_mesh *mesh = nullptr;
    detail::check(decimesh_mesh_from_buffers(&raw, &mesh));
    return adopt(mesh);
}

inline Mesh Mesh::read(const std::string &path) {
    decimesh_mesh *mesh = nullptr;
    detail::check(decimesh_mesh_read(path.c_str(), &mesh));
    return adopt(mesh);
}

inline Simplified simplify(MeshView mesh, const Options &options) {
    detail::SimplifyCall call(options, mesh.vertex_count(), mesh.triangle_count());
    call.ask_for_elements(mesh.vertex_count(), mesh.triangle_count());
    decimesh_mesh *simplified = nullptr;
    const decimesh_status status = decimesh_simplify(mesh.get(), &call.raw, &simplified, &call.report);
    Mesh result = Mesh::adopt(simplified);
    call.check(status);
    return {std::move(result), detail::from_raw(call.report), std::move(call.origins), std::move(call.groups)};
}

inline Decimated multiple_choice(MeshView mesh, std::size_t triangles, const MultipleChoiceOptions &options) {
    auto raw = detail::sized<decimesh_multiple_choice_options>();
    raw.candidates = options.candidates;
    raw.seed = options.seed;
    raw.locked_vertices = options.locked_vertices.data();
    raw.locked_count = options.locked_vertices.size();
    detail::Watcher watcher(options.progress);
    watcher.attach(raw);
    std::vector<std::uint32_t> sources(mesh.vertex_count());
    raw.sources = sources.data();
    decimesh_mesh *simplified = nullptr;
    decimesh_stopped_by stopped_by = DECIMESH_STOPPED_BY_TARGET;
    const decimesh_status status = decimesh_multiple_choice(mesh.get(), triangles, &raw, &simplified, &stopped_by);
    Mesh result = Mesh::adopt(simplified);
    watcher.check(status);
    sources.resize(result.vertex_count());
    return {std::move(result), static_cast<StoppedBy>(stopped_by), std::move(sources)};
}

inline Certified simplify_within(MeshView mesh, double max_error, const Options &options) {
    detail::SimplifyCall call(options, mesh.vertex_count(), mesh.triangle_count());
    call.ask_for_elements(mesh.vertex_count(), mesh.triangle_count());
    decimesh_mesh *simplified = nullptr;
    auto bound = detail::sized<decimesh_bound_result>();
    const decimesh_status status =
        decimesh_simplify_within(mesh.get(), max_error, &call.raw, &simplified, &call.report, &bound);
    Mesh result = Mesh::adopt(simplified);
    call.check(status);
    return {{std::move(result), detail::from_raw(call.report), std::move(call.origins), std::move(call.groups)},
            {bound.lower, bound.upper, bound.diagonal, bound.pieces}};
}

template <class Index>
SimplifiedIndices simplify_indices(std::common_type_t<Span<Index>> destination, const Buffers<Index> &buffers,
                                   const Options &options) {
    if (destination.size() < buffers.indices.size()) {
        throw std::invalid_argument("decimesh: room for " + std::to_string(destination.size()) +
                                    " indices, but there are " + std::to_string(buffers.indices.size()));
    }
    const auto raw = detail::to_raw<decimesh_buffers>(buffers);
    detail::SimplifyCall call(options, raw.vertex_count, raw.index_count / 3);
    call.ask_for_elements(raw.vertex_count, raw.index_count / 3);
    std::size_t count = 0;
    call.check(decimesh_simplify_indices(destination.data(), &raw, &call.raw, &count, &call.report));
    return {count, detail::from_raw(call.report), std::move(call.origins), std::move(call.groups)};
}

template <class Index>
SimplifiedIndices simplify_in_place(const MutableBuffers<Index> &buffers, const Options &options) {
    const auto raw = detail::to_raw<decimesh_mutable_buffers>(buffers);
    detail::SimplifyCall call(options, raw.vertex_count, raw.index_count / 3);
    call.ask_for_elements(raw.vertex_count, raw.index_count / 3);
    std::size_t count = 0;
    call.check(decimesh_simplify_in_place(&raw, &call.raw, &count, &call.report));
    return {count, detail::from_raw(call.report), std::move(call.origins), std::move(call.groups)};
}

inline Levels Levels::build(MeshView mesh, const std::vector<Target> &targets, const Options &options) {
    detail::SimplifyCall call(options, mesh.vertex_count(), mesh.triangle_count());
    const std::vector<double> values = call.set_targets(targets);
    Levels levels;
    decimesh_levels *handle = nullptr;
    const decimesh_status status =
        decimesh_levels_build(mesh.get(), &call.raw, values.data(), values.size(), &handle);
    levels.handle_.reset(handle);
    levels.input_vertices_ = mesh.vertex_count();
    call.check(status);
    return levels;
}

inline MeshView Levels::mesh(std::size_t level) const & {
    const decimesh_mesh *mesh = nullptr;
    detail::check(decimesh_levels_mesh(get(), level, &mesh));
    return MeshView(mesh);
}

inline Report Levels::report(std::size_t level) const {
    auto raw = detail::sized<decimesh_simplify_report>();
    detail::check(decimesh_levels_report(get(), level, &raw));
    return detail::from_raw(raw);
}

inline Span<const std::uint32_t> Levels::groups(std::size_t level) const & {
    const std::uint32_t *first = nullptr;
    detail::check(decimesh_levels_groups(get(), level, &first));
    return {first, first == nullptr ? 0 : mesh(level).triangle_count()};
}

inline Span<const std::uint32_t> Levels::origins(std::size_t level) const & {
    const std::uint32_t *first = nullptr;
    detail::check(decimesh_levels_origins(get(), level, &first));
    return {first, first == nullptr ? 0 : input_vertices_};
}

inline std::optional<std::size_t> Levels::select(float max_error) const {
    std::size_t level = 0;
    detail::check(decimesh_levels_select(get(), max_error, &level));
    return level < size() ? std::optional<std::size_t>(level) : std::nullopt;
}

inline NestedLevels NestedLevels::build(MeshView mesh, const std::vector<Target> &targets, const Options &options) {
    detail::SimplifyCall call(options, mesh.vertex_count(), mesh.triangle_count());
    const std::vector<double> values = call.set_targets(targets);
    NestedLevels levels;
    decimesh_nested *handle = nullptr;
    const decimesh_status status =
        decimesh_nested_build(mesh.get(), &call.raw, values.data(), values.size(), &handle);
    levels.handle_.reset(handle);
    call.check(status);
    return levels;
}

inline NestedLevel NestedLevels::level(std::size_t level) const {
    auto raw = detail::sized<decimesh_nested_level>();
    detail::check(decimesh_nested_describe(get(), level, &raw));
    return {static_cast<StoppedBy>(raw.stopped_by), static_cast<std::size_t>(raw.vertices),
            static_cast<std::size_t>(raw.indices), raw.error, raw.topology_changed != 0};
}

inline Span<const std::uint32_t> NestedLevels::indices(std::size_t level) const & {
    const std::uint32_t *first = nullptr;
    detail::check(decimesh_nested_indices(get(), level, &first));
    return {first, this->level(level).index_count};
}

inline std::size_t NestedLevels::copy_indices(std::size_t level, Span<std::uint32_t> destination) const {
    detail::check(decimesh_nested_copy_indices(get(), level, DECIMESH_INDEX_U32, detail::room_of(destination),
                                               destination.size()));
    return this->level(level).index_count;
}

inline std::size_t NestedLevels::copy_indices(std::size_t level, Span<std::uint16_t> destination) const {
    detail::check(decimesh_nested_copy_indices(get(), level, DECIMESH_INDEX_U16, detail::room_of(destination),
                                               destination.size()));
    return this->level(level).index_count;
}

inline Span<const std::uint32_t> NestedLevels::groups(std::size_t level) const & {
    const std::uint32_t *first = nullptr;
    detail::check(decimesh_nested_groups(get(), level, &first));
    return {first, first == nullptr ? 0 : this->level(level).index_count / 3};
}

inline Span<const std::uint32_t> NestedLevels::morphs(std::size_t level) const & {
    const std::uint32_t *first = nullptr;
    detail::check(decimesh_nested_morphs(get(), level, &first));
    return {first, first == nullptr ? 0 : this->level(level).vertices};
}

inline std::size_t NestedLevels::select(float max_error) const {
    std::size_t level = 0;
    detail::check(decimesh_nested_select(get(), max_error, &level));
    return level;
}

inline void NestedLevels::certify(const BoundOptions &options) {
    detail::BoundCall call(options);
    call.check(decimesh_nested_certify(handle_.get(), &call.raw));
}

inline void NestedLevels::write_glb(const std::string &path) const {
    detail::check(decimesh_nested_write_glb(get(), path.c_str()));
}

inline Hierarchy Hierarchy::build(Span<const float> heights, std::size_t columns, const HierarchyOptions &options) {
    const std::size_t rows = columns == 0 ? 0 : heights.size() / columns;
    if (rows * columns != heights.size()) {
        throw Error(Status::option, std::to_string(heights.size()) + " heights do not make whole rows of " +
                                        std::to_string(columns));
    }
    if (!options.importance.empty() && options.importance.size() != heights.size()) {
        throw Error(Status::option, std::to_string(options.importance.size()) + " weights for " +
                                        std::to_string(heights.size()) + " heights");
    }
    detail::HierarchyCall call(options);
    Hierarchy hierarchy;
    decimesh_hierarchy *handle = nullptr;
    const decimesh_status status = decimesh_hierarchy_create(heights.data(), columns, rows, &call.raw, &handle);
    hierarchy.handle_.reset(handle);
    call.check(status);
    return hierarchy;
}

inline Hierarchy Hierarchy::remesh(MeshView mesh, std::uint32_t depth, std::size_t base_quads,
                                   const HierarchyOptions &options) {
    detail::HierarchyCall call(options);
    Hierarchy hierarchy;
    decimesh_hierarchy *handle = nullptr;
    const decimesh_status status = decimesh_hierarchy_remesh(mesh.get(), depth, base_quads, &call.raw, &handle);
    hierarchy.handle_.reset(handle);
    call.check(status);
    return hierarchy;
}

inline Taken Hierarchy::at(const Detail &wanted, double max_error) const {
    auto report = detail::sized<decimesh_hierarchy_report>();
    decimesh_mesh *mesh = nullptr;
    detail::check(decimesh_hierarchy_at(get(), static_cast<decimesh_detail>(wanted.kind()), wanted.value(), max_error,
                                        &mesh, &report));
    return {Mesh::adopt(mesh), report.rms, report.max_error, report.certified_gap};
}

inline Taken Hierarchy::tin(std::size_t vertices, bool least_squares, const Progress &progress) const {
    auto report = detail::sized<decimesh_hierarchy_report>();
    decimesh_hierarchy_options raw{};
    detail::Watcher watcher(progress);
    watcher.attach(raw);
    decimesh_mesh *mesh = nullptr;
    const decimesh_status status = decimesh_hierarchy_tin(get(), vertices, least_squares ? 1 : 0, raw.progress,
                                                          raw.progress_user, &mesh, &report);
    Mesh owned = Mesh::adopt(mesh);
    watcher.check(status);
    return {std::move(owned), report.rms, report.max_error, report.certified_gap};
}

inline Hierarchy Hierarchy::read(const std::string &path) {
    Hierarchy hierarchy;
    decimesh_hierarchy *handle = nullptr;
    detail::check(decimesh_hierarchy_read(path.c_str(), &handle));
    hierarchy.handle_.reset(handle);
    return hierarchy;
}

inline void Hierarchy::write(const std::string &path) const {
    detail::check(decimesh_hierarchy_write(get(), path.c_str()));
}

inline Progressive Progressive::build(MeshView mesh, const std::vector<Target> &targets, const Options &options) {
    detail::SimplifyCall call(options, mesh.vertex_count(), mesh.triangle_count());
    const std::vector<double> values = call.set_targets(targets);
    decimesh_progressive *handle = nullptr;
    const decimesh_status status =
        decimesh_progressive_build(mesh.get(), &call.raw, values.data(), values.size(), &handle);
    Progressive progressive = adopt(handle);
    call.check(status);
    return progressive;
}

inline Progressive Progressive::read(const std::string &path, std::size_t max_triangles) {
    decimesh_progressive *handle = nullptr;
    detail::check(decimesh_progressive_read(path.c_str(), max_triangles, &handle));
    return adopt(handle);
}

inline Progressive Progressive::from_memory(const void *bytes, std::size_t size, std::size_t max_triangles) {
    decimesh_progressive *handle = nullptr;
    detail::check(decimesh_progressive_from_memory(bytes, size, max_triangles, &handle));
    return adopt(handle);
}

inline void Progressive::write(const std::string &path) const {
    detail::check(decimesh_progressive_write(get(), path.c_str()));
}

inline Span<const std::uint32_t> Progressive::order() const & noexcept {
    const std::uint32_t *first = decimesh_progressive_order(get());
    return {first, first == nullptr ? 0 : vertex_count(steps())};
}

inline std::size_t Progressive::copy_indices(std::size_t step, Span<std::uint32_t> destination) const {
    detail::check(decimesh_progressive_copy_indices(get(), step, DECIMESH_INDEX_U32, detail::room_of(destination),
                                                    destination.size()));
    return 3 * triangle_count(step);
}

inline std::size_t Progressive::copy_indices(std::size_t step, Span<std::uint16_t> destination) const {
    detail::check(decimesh_progressive_copy_indices(get(), step, DECIMESH_INDEX_U16, detail::room_of(destination),
                                                    destination.size()));
    return 3 * triangle_count(step);
}

inline Mesh Progressive::mesh(std::size_t step) const {
    decimesh_mesh *mesh = nullptr;
    detail::check(decimesh_progressive_mesh(get(), step, &mesh));
    return Mesh::adopt(mesh);
}

inline std::vector<Progressive::Mark> Progressive::marks() const {
    std::vector<Mark> marks(decimesh_progressive_mark_count(get()));
    for (std::size_t mark = 0; mark < marks.size(); ++mark) {
        detail::check(decimesh_progressive_mark(get(), mark, &marks[mark].step, &marks[mark].error));
    }
    return marks;
}

inline Player::Player(const Progressive &progressive) {
    decimesh_player *handle = nullptr;
    detail::check(decimesh_player_create(progressive.get(), &handle));
    handle_.reset(handle);
}

inline std::size_t Player::copy_indices(Span<std::uint32_t> destination) const {
    detail::check(decimesh_player_copy_indices(get(), DECIMESH_INDEX_U32, detail::room_of(destination),
                                               destination.size()));
    return 3 * triangle_count();
}

inline std::size_t Player::copy_indices(Span<std::uint16_t> destination) const {
    detail::check(decimesh_player_copy_indices(get(), DECIMESH_INDEX_U16, detail::room_of(destination),
                                               destination.size()));
    return 3 * triangle_count();
}

inline bool Player::finer() {
    const std::size_t before = step();
    detail::check(decimesh_player_finer(handle_.get()));
    return step() != before;
}

inline bool Player::coarser() {
    const std::size_t before = step();
    detail::check(decimesh_player_coarser(handle_.get()));
    return step() != before;
}

inline void Player::go_to(std::size_t step) {
    detail::check(decimesh_player_go_to(handle_.get(), step));
}

inline Bound bound(MeshView a, MeshView b, const BoundOptions &options) {
    detail::BoundCall call(options);
    auto raw = detail::sized<decimesh_bound_result>();
    call.check(decimesh_bound(a.get(), b.get(), &call.raw, &raw));
    return {raw.lower, raw.upper, raw.diagonal, raw.pieces};
}

inline Deviation deviation(MeshView a, MeshView b, const DeviationOptions &options) {
    detail::DeviationCall call(options);
    auto raw = detail::sized<decimesh_deviation_result>();
    call.check(decimesh_deviation(a.get(), b.get(), &call.raw, &raw));
    return {raw.rms,
            raw.mean,
            raw.max,
            {raw.forward_rms, raw.forward_mean, raw.forward_max},
            {raw.backward_rms, raw.backward_mean, raw.backward_max},
            raw.diagonal,
            raw.normal_rms_degrees};
}

inline std::vector<float> vertex_distances(MeshView from, MeshView to, const DeviationOptions &options) {
    detail::DeviationCall call(options);
    // Room for nothing may be nowhere, which to C would be a pointer forgotten.
    std::vector<float> distances(from.vertex_count() + 1);
    call.check(decimesh_vertex_distances(from.get(), to.get(), &call.raw, distances.data()));
    distances.pop_back();
    return distances;
}

}   // namespace decimesh

#ifdef __cpp_lib_ranges
template <class T>
inline constexpr bool std::ranges::enable_borrowed_range<decimesh::Span<T>> = true;
#endif

#endif
