/* decimesh: triangle-mesh simplification. The C ABI.
 *
 * Generated from src/capi/ by cbindgen; `UPDATE_HEADER=1 cargo test --test header` writes it anew.
 *
 * A call that can fail returns a decimesh_status. Where that is not DECIMESH_OK, nothing was written through
 * any out-parameter, and decimesh_last_error_message() says what is wrong and where. What a call lists as
 * "Fails with _NULL" is DECIMESH_ERROR_NULL; any may also fail with DECIMESH_ERROR_PANIC, a bug in decimesh.
 *
 * A const handle may be used from many threads at once. A call that takes one that is not const changes it, or
 * ends it, and needs it for itself. Who makes a handle ends it with its _destroy function; pointers into it end
 * with it.
 *
 * Structs begin with struct_size, which their _init functions set: programs keep working with newer and
 * older libraries. Enumerations are integers, and checked. Buffers need no alignment.
 *
 * Results depend on the input and the options alone: not on the number of threads, nor the language.
 */

#ifndef DECIMESH_H
#define DECIMESH_H

#include <stddef.h>
#include <stdint.h>

/**
 * Changes when a call changes its meaning or goes away; with it the name of the shared library.
 */
#define DECIMESH_VERSION_MAJOR 0

/**
 * Changes when calls come to it.
 */
#define DECIMESH_VERSION_MINOR 1

/**
 * Changes with every release.
 */
#define DECIMESH_VERSION_PATCH 0

/**
 * A vertex that stays, bit for bit: a bit of decimesh_simplify_options.vertex_flags, as the next two are.
 */
#define DECIMESH_VERTEX_LOCK 1

/**
 * A vertex that goes along seams only, whatever cross_seams says.
 */
#define DECIMESH_VERTEX_PROTECT 2

/**
 * A vertex that is kept as long as others can go: it costs a hundred times as much.
 */
#define DECIMESH_VERTEX_PRIORITIZE 4

/**
 * Heights over a grid, or a semi-regular surface, decomposed: the order in which vertices go, from all of them to
 * a few, such that whatever is left has about the least squared error of all conforming 4-8 meshes of as many
 * vertices. Immutable.
 *
 * A const decimesh_hierarchy* may be used from many threads at once.
 */
typedef struct decimesh_hierarchy decimesh_hierarchy;

/**
 * Levels of detail of one mesh, from fine to coarse: immutable.
 *
 * A const decimesh_levels* may be used from many threads at once.
 */
typedef struct decimesh_levels decimesh_levels;

/**
 * A triangle mesh: positions, triangles and attributes, validated when it was made and immutable since.
 *
 * A const decimesh_mesh* may be used from many threads at once. It is ended by decimesh_mesh_destroy(),
 * unless it belongs to another handle, such as a decimesh_levels.
 */
typedef struct decimesh_mesh decimesh_mesh;

/**
 * Levels of detail, from fine to coarse, that share one vertex buffer: level 0 is the mesh that they were
 * made of, and each level names vertices below a number that falls from level to level.
 *
 * A const decimesh_nested* may be used from many threads at once. decimesh_nested_certify() alone changes
 * it, and needs it for itself.
 */
typedef struct decimesh_nested decimesh_nested;

/**
 * A level of a progressive mesh, and the way to those next to it: a step costs as much as it changes, so
 * that a program that follows a camera need not make a level anew.
 *
 * Any number of players may play one progressive mesh, each in a thread of its own. A const
 * decimesh_player* may be used from many threads at once, as long as none makes a call that takes one that
 * is not const.
 */
typedef struct decimesh_player decimesh_player;

/**
 * A mesh as its coarsest level and the splits that refine it, one after the other: immutable.
 *
 * A step is the number of splits done: 0 is the coarsest level, decimesh_progressive_steps() the finest. The
 * level at a step uses the first of the vertices and the first of the triangles; which vertex a corner of a
 * triangle names depends on the step. Triangles with two corners at one place, and vertices that are in no
 * other triangle, are left out of all levels.
 *
 * A const decimesh_progressive* may be used from many threads at once. It is played by a decimesh_player.
 */
typedef struct decimesh_progressive decimesh_progressive;

/**
 * What became of a call: DECIMESH_OK, or why it failed. A value is never given a second meaning.
 *
 * Where it is not DECIMESH_OK, nothing was written through any out-parameter, and
 * decimesh_last_error_message() says what is wrong and where.
 */
typedef int32_t decimesh_status;

/**
 * The type of an index.
 */
typedef int32_t decimesh_index_type;

/**
 * A mesh in buffers of the caller's, which a call only reads.
 *
 * Strides are the bytes from one vertex to the next, so that interleaved buffers serve as they are;
 * 0 means that elements follow each other without a gap. No alignment is asked for.
 * Attributes are NULL where there are none.
 */
typedef struct decimesh_buffers {
    /**
     * sizeof(decimesh_buffers), as decimesh_buffers_init sets it.
     */
    uint32_t struct_size;
    /**
     * DECIMESH_INDEX_U16 or DECIMESH_INDEX_U32.
     */
    decimesh_index_type index_type;
    /**
     * x, y and z of each vertex: finite.
     */
    const float *positions;
    /**
     * 0, or at least 12.
     */
    size_t positions_stride;
    /**
     * Vertices: at least 1, fewer than 2^32.
     */
    size_t vertex_count;
    /**
     * Three indices a triangle, counter-clockwise from outside: each below vertex_count.
     */
    const void *indices;
    /**
     * Indices: at least 3, a multiple of 3, fewer than 3 * 2^30.
     */
    size_t index_count;
    /**
     * Unit normals, x, y and z: finite; or NULL.
     */
    const float *normals;
    /**
     * 0, or at least 12.
     */
    size_t normals_stride;
    /**
     * Texture coordinates, u and v: finite; or NULL.
     */
    const float *uvs;
    /**
     * 0, or at least 8.
     */
    size_t uvs_stride;
    /**
     * Colours: red, green, blue and alpha, 0 to 255; or NULL.
     */
    const uint8_t *colors;
    /**
     * 0, or at least 4.
     */
    size_t colors_stride;
} decimesh_buffers;

/**
 * A mesh in buffers of the caller's, which a call may overwrite. Otherwise as decimesh_buffers.
 */
typedef struct decimesh_mutable_buffers {
    /**
     * sizeof(decimesh_mutable_buffers), as decimesh_mutable_buffers_init sets it.
     */
    uint32_t struct_size;
    /**
     * DECIMESH_INDEX_U16 or DECIMESH_INDEX_U32.
     */
    decimesh_index_type index_type;
    /**
     * x, y and z of each vertex: finite.
     */
    float *positions;
    /**
     * 0, or at least 12.
     */
    size_t positions_stride;
    /**
     * Vertices: at least 1, fewer than 2^32.
     */
    size_t vertex_count;
    /**
     * Three indices a triangle, counter-clockwise from outside: each below vertex_count.
     */
    void *indices;
    /**
     * Indices: at least 3, a multiple of 3, fewer than 3 * 2^30.
     */
    size_t index_count;
    /**
     * Unit normals, x, y and z: finite; or NULL.
     */
    float *normals;
    /**
     * 0, or at least 12.
     */
    size_t normals_stride;
    /**
     * Texture coordinates, u and v: finite; or NULL.
     */
    float *uvs;
    /**
     * 0, or at least 8.
     */
    size_t uvs_stride;
    /**
     * Colours: red, green, blue and alpha, 0 to 255; or NULL.
     */
    uint8_t *colors;
    /**
     * 0, or at least 4.
     */
    size_t colors_stride;
} decimesh_mutable_buffers;

/**
 * How numbers are written to a file, where its format leaves the choice.
 */
typedef int32_t decimesh_encoding;

/**
 * What a mesh is made of and what is wrong with it. A face is a triangle with three different vertices.
 */
typedef struct decimesh_statistics {
    /**
     * sizeof(decimesh_statistics), as decimesh_statistics_init sets it.
     */
    uint32_t struct_size;
    /**
     * 1 if every edge has at least two faces.
     */
    int32_t is_closed;
    /**
     * 1 if there is no non-manifold edge or vertex and no inconsistent edge.
     */
    int32_t is_oriented_manifold;
    /**
     * Always 0.
     */
    uint32_t reserved;
    /**
     * Vertices, used or not.
     */
    uint64_t vertices;
    /**
     * Triangles, proper or not.
     */
    uint64_t triangles;
    /**
     * Vertices that no triangle uses.
     */
    uint64_t unreferenced_vertices;
    /**
     * Vertices at the position of an earlier one.
     */
    uint64_t duplicate_positions;
    /**
     * Triangles that name a vertex twice.
     */
    uint64_t degenerate_triangles;
    /**
     * Faces without area.
     */
    uint64_t zero_area_triangles;
    /**
     * Faces on the same three vertices as an earlier one.
     */
    uint64_t duplicate_triangles;
    /**
     * Edges, however many faces they have.
     */
    uint64_t edges;
    /**
     * Edges with one face.
     */
    uint64_t border_edges;
    /**
     * Closed chains of border edges: the holes of a surface.
     */
    uint64_t boundary_loops;
    /**
     * Edges with more than two faces.
     */
    uint64_t non_manifold_edges;
    /**
     * Edges with two faces that run the same way along it.
     */
    uint64_t inconsistent_edges;
    /**
     * Vertices at which several fans of faces touch.
     */
    uint64_t non_manifold_vertices;
    /**
     * Pieces of the surface.
     */
    uint64_t components;
    /**
     * Vertices that a face uses, minus edges, plus faces: 2 for a sphere, 0 for a torus.
     */
    int64_t euler_characteristic;
    /**
     * Least coordinates over the vertices that a triangle uses; 0 without triangles.
     */
    float bounds_min[3];
    /**
     * Greatest coordinates over the vertices that a triangle uses; 0 without triangles.
     */
    float bounds_max[3];
    /**
     * Length of the diagonal of the bounds, in units of the positions.
     */
    double diagonal;
    /**
     * Sum of the areas of the triangles, in squared units of the positions.
     */
    double surface_area;
} decimesh_statistics;

/**
 * What a simplification shall arrive at.
 */
typedef int32_t decimesh_target;

/**
 * Which collapses a pass takes.
 */
typedef int32_t decimesh_selection;

/**
 * What may happen to holes, handles and components.
 */
typedef int32_t decimesh_topology;

/**
 * Where the vertex of a collapsed edge goes.
 */
typedef int32_t decimesh_placement;

/**
 * Is told how far a call has come: a fraction from 0 to 1 that never falls. What it returns ends the
 * call, unless it is 0: the call then fails with DECIMESH_ERROR_CANCELLED, and nothing of the
 * caller's has changed.
 *
 * It is called on the thread that made the call, from a few times to some thousands, and may itself call
 * decimesh. It must not throw or jump out of the call: decimesh.hpp shows how to carry an
 * exception through.
 */
typedef int32_t (*decimesh_progress)(void *user,
                                     float fraction);

/**
 * How to simplify. decimesh_simplify_options_init() sets the defaults.
 */
typedef struct decimesh_simplify_options {
    /**
     * sizeof(decimesh_simplify_options), as decimesh_simplify_options_init sets it.
     */
    uint32_t struct_size;
    /**
     * What to arrive at: a DECIMESH_TARGET_ value; by default _RATIO.
     */
    decimesh_target target;
    /**
     * How many or how much of it, as target says: a whole number, a fraction or a distance; by default 0.5.
     */
    double target_value;
    /**
     * Which collapses a pass takes: a DECIMESH_SELECTION_ value; by default _SAMPLED_THRESHOLD.
     */
    decimesh_selection selection;
    /**
     * Records of the heap of DECIMESH_SELECTION_REPLACEMENT, at least 1; by default 15, as in the paper.
     */
    uint32_t heap_records;
    /**
     * What may happen to the topology: a DECIMESH_TOPOLOGY_ value; by default _RELAX_IF_STUCK.
     */
    decimesh_topology topology;
    /**
     * Where vertices go: a DECIMESH_PLACEMENT_ value; by default _OPTIMAL.
     */
    decimesh_placement placement;
    /**
     * 1: vertices of the border stay, bit for bit; by default 0.
     */
    int32_t lock_boundary;
    /**
     * 1: where several vertices are at one place, as along the seams of textures and the creases of normals,
     * no crack opens; 0: the sides of a seam are borders, and part. By default 1.
     *
     * With DECIMESH_PLACEMENT_EXISTING such vertices go along their seam together, and are known by their
     * places, with attributes or without. With DECIMESH_PLACEMENT_OPTIMAL they stay, bit for bit, where the
     * mesh has attributes and in decimesh_simplify_in_place(); what is all seams, such as a faceted mesh,
     * then gets stuck.
     */
    int32_t keep_seams;
    /**
     * Threads to use, 0: all that the machine has. The result is the same, byte for byte; by default 0.
     */
    uint32_t threads;
    /**
     * Must be 0.
     */
    uint32_t reserved;
    /**
     * Indices of vertices that stay, bit for bit; NULL where there are none.
     */
    const uint32_t *locked_vertices;
    /**
     * How many locked_vertices there are.
     */
    size_t locked_count;
    /**
     * NULL, or room for one index a vertex of the input. It receives the vertex of the result that each
     * went into, UINT32_MAX where it vanished. Levels have a call of their own for theirs.
     */
    uint32_t *origins;
    /**
     * Is told of progress, and can cancel; NULL for none.
     */
    decimesh_progress progress;
    /**
     * Handed to progress as it is.
     */
    void *progress_user;
    /**
     * What a difference of 1 in a coordinate of a normal weighs, beside a distance as long as the longest
     * side of the bounding box: finite, not negative; by default 0, no say. The three weights are for
     * DECIMESH_PLACEMENT_EXISTING; otherwise they change nothing.
     */
    float normal_weight;
    /**
     * The same for a texture coordinate.
     */
    float uv_weight;
    /**
     * The same for a channel of a colour, from none (0) to full (255).
     */
    float color_weight;
    /**
     * 1: with DECIMESH_PLACEMENT_EXISTING vertices may go across seams too, at the cost of the attributes by
     * their weights: what was on one side then takes the nearest attributes of the other. The surface stays
     * closed. It is for meshes of many small charts, and for faceted ones, which otherwise get stuck.
     * By default 0.
     */
    int32_t cross_seams;
    /**
     * The group of each triangle of the input, such as its material, or NULL: where groups meet, their
     * border stays a border. For DECIMESH_PLACEMENT_EXISTING only.
     */
    const uint32_t *triangle_groups;
    /**
     * NULL, or room for one group a triangle of the input, where triangle_groups is not NULL. It receives
     * the group of each triangle of the result. Levels have calls of their own for theirs.
     */
    uint32_t *result_groups;
    /**
     * For each vertex of the input what it may do, DECIMESH_VERTEX_ bits or 0; or NULL.
     * locked_vertices count as well. The last two bits are for DECIMESH_PLACEMENT_EXISTING; otherwise they
     * change nothing.
     */
    const uint8_t *vertex_flags;
    /**
     * 1: vertices are moved and edges turned in the end, so that the surface is nearer to the input's: its RMS
     * distance falls by 6 to 10 %; the largest one may rise. All takes 1.2 times as long at a hundredth of the
     * triangles, 1.6 at a tenth, and up to 4 at a half. Vertices that are locked or on a border stay. For
     * DECIMESH_PLACEMENT_OPTIMAL only; otherwise 1 is DECIMESH_ERROR_OPTION. By default 0.
     */
    int32_t refine;
    /**
     * 1: levels remember what became of each vertex of the input, for decimesh_levels_origins(). For
     * decimesh_levels_build(); elsewhere it changes nothing. By default 0.
     */
    int32_t level_origins;
} decimesh_simplify_options;

/**
 * Why a simplification ended.
 */
typedef int32_t decimesh_stopped_by;

/**
 * How a simplification came about. decimesh_simplify_report_init() sets it up.
 */
typedef struct decimesh_simplify_report {
    /**
     * sizeof(decimesh_simplify_report), as decimesh_simplify_report_init sets it.
     */
    uint32_t struct_size;
    /**
     * Why it ended: a DECIMESH_STOPPED_BY_ value.
     */
    decimesh_stopped_by stopped_by;
    /**
     * Triangles of the result.
     */
    uint64_t triangles;
    /**
     * Vertices of the result.
     */
    uint64_t vertices;
    /**
     * Vertices of the input that were locked: by index, as borders, or as seams.
     */
    uint64_t locked_vertices;
    /**
     * Estimated largest distance from the input, in units of the positions.
     */
    float error;
    /**
     * 1 if holes, handles or components had to be given up to meet the target.
     */
    int32_t topology_changed;
    /**
     * Passes over the mesh: the levels of approximation of the paper.
     */
    uint32_t passes;
    /**
     * Always 0.
     */
    uint32_t reserved;
    /**
     * Estimated largest difference of the attributes from the input's, by their weights: in units of the
     * positions, a difference of 1 being the weight times the longest side of the bounding box. 0 where no
     * attribute has a weight.
     */
    float attribute_error;
    /**
     * Always 0.
     */
    uint32_t reserved_padding;
} decimesh_simplify_report;

/**
 * How to choose. decimesh_multiple_choice_options_init() sets the defaults.
 */
typedef struct decimesh_multiple_choice_options {
    /**
     * sizeof(decimesh_multiple_choice_options), as decimesh_multiple_choice_options_init sets it.
     */
    uint32_t struct_size;
    /**
     * Of how many vertices drawn at random the cheapest goes: at least 1; by default 6.
     */
    uint32_t candidates;
    /**
     * Where the random numbers start; by default 0.
     */
    uint64_t seed;
    /**
     * Indices of input vertices that stay; NULL for none.
     */
    const uint32_t *locked_vertices;
    /**
     * How many locked_vertices there are.
     */
    size_t locked_count;
    /**
     * Is told of progress, and can cancel; NULL for none.
     */
    decimesh_progress progress;
    /**
     * Handed to progress as it is.
     */
    void *progress_user;
    /**
     * NULL, or room for one index a vertex of the input. It receives, for each vertex of the result, the one of the
     * input that it is, ascending; nothing is written beyond.
     */
    uint32_t *sources;
} decimesh_multiple_choice_options;

/**
 * How to measure. decimesh_deviation_options_init() sets the defaults.
 */
typedef struct decimesh_deviation_options {
    /**
     * sizeof(decimesh_deviation_options), as decimesh_deviation_options_init sets it.
     */
    uint32_t struct_size;
    /**
     * Threads to use, 0: all that the machine has. The result is the same, bit for bit; by default 0.
     */
    uint32_t threads;
    /**
     * Points spread evenly over the area of each surface; by default 500000. The vertices are measured
     * besides, for the maximum.
     */
    uint64_t samples;
    /**
     * Chooses the points; by default 0.
     */
    uint64_t seed;
    /**
     * Is told of progress, and can cancel; NULL for none.
     */
    decimesh_progress progress;
    /**
     * Handed to progress as it is.
     */
    void *progress_user;
} decimesh_deviation_options;

/**
 * The distance between two surfaces, in units of the positions; forward is from the first mesh to the
 * second.
 */
typedef struct decimesh_deviation_result {
    /**
     * sizeof(decimesh_deviation_result), as decimesh_deviation_result_init sets it.
     */
    uint32_t struct_size;
    /**
     * Always 0.
     */
    uint32_t reserved;
    /**
     * Root of the mean squared distance: the larger of the two directions.
     */
    double rms;
    /**
     * Mean distance: the larger of the two directions.
     */
    double mean;
    /**
     * Largest distance found: the larger of the two directions.
     */
    double max;
    /**
     * Root of the mean squared distance from the first mesh to the second.
     */
    double forward_rms;
    /**
     * Mean distance from the first mesh to the second.
     */
    double forward_mean;
    /**
     * Largest distance found from the first mesh to the second.
     */
    double forward_max;
    /**
     * Root of the mean squared distance from the second mesh to the first.
     */
    double backward_rms;
    /**
     * Mean distance from the second mesh to the first.
     */
    double backward_mean;
    /**
     * Largest distance found from the second mesh to the first.
     */
    double backward_max;
    /**
     * Diagonal of the box around the triangles of the first mesh.
     */
    double diagonal;
    /**
     * RMS angle between the normals of the surfaces, in degrees: the larger of the two directions.
     */
    double normal_rms_degrees;
} decimesh_deviation_result;

/**
 * How close bounds shall come, and how much work that may be. decimesh_bound_options_init() sets the
 * defaults.
 */
typedef struct decimesh_bound_options {
    /**
     * sizeof(decimesh_bound_options), as decimesh_bound_options_init sets it.
     */
    uint32_t struct_size;
    /**
     * Threads to use, 0: all that the machine has. The result is the same, bit for bit; by default 0.
     */
    uint32_t threads;
    /**
     * How far above the lower bound the upper may be, as a share of it: finite, not negative; by default
     * 0.01. A millionth of the larger diagonal is allowed in any case.
     */
    double tolerance;
    /**
     * Pieces of triangles to look at before giving up on the tolerance: some microseconds each, and at most
     * about 120 bytes; by default 5000000.
     */
    uint64_t pieces;
    /**
     * Is told of progress, and can cancel; NULL for none.
     */
    decimesh_progress progress;
    /**
     * Handed to progress as it is.
     */
    void *progress_user;
} decimesh_bound_options;

/**
 * What the two-sided Hausdorff distance lies between, in units of the positions.
 */
typedef struct decimesh_bound_result {
    /**
     * sizeof(decimesh_bound_result), as decimesh_bound_result_init sets it.
     */
    uint32_t struct_size;
    /**
     * Always 0.
     */
    uint32_t reserved;
    /**
     * The largest distance found, at corners and inside of triangles.
     */
    double lower;
    /**
     * No point of either surface is farther from the other than this.
     */
    double upper;
    /**
     * Diagonal of the box around the triangles of the first mesh.
     */
    double diagonal;
    /**
     * Pieces that were looked at, other than the triangles themselves.
     */
    uint64_t pieces;
} decimesh_bound_result;

/**
 * A level. decimesh_nested_level_init() sets it up.
 */
typedef struct decimesh_nested_level {
    /**
     * sizeof(decimesh_nested_level), as decimesh_nested_level_init sets it.
     */
    uint32_t struct_size;
    /**
     * Why it is as large as it is: a DECIMESH_STOPPED_BY_ value; for level 0 always _TARGET.
     */
    decimesh_stopped_by stopped_by;
    /**
     * Its vertices are so many, the first of the buffer: every index is below.
     */
    uint64_t vertices;
    /**
     * Its indices: three a triangle.
     */
    uint64_t indices;
    /**
     * Largest distance from level 0, in units of the positions: estimated, or guaranteed once
     * decimesh_nested_certify() has said so. Never less than that of the level before.
     */
    float error;
    /**
     * 1 if holes, handles or components had to be given up, here or on a finer level.
     */
    int32_t topology_changed;
} decimesh_nested_level;

/**
 * What heights are, and how they are decomposed. decimesh_hierarchy_options_init() sets the defaults.
 */
typedef struct decimesh_hierarchy_options {
    /**
     * sizeof(decimesh_hierarchy_options), as decimesh_hierarchy_options_init sets it.
     */
    uint32_t struct_size;
    /**
     * Threads to use, 0: all that the machine has. The result is the same; by default 0.
     */
    uint32_t threads;
    /**
     * 1: samples that are no_data are void: nothing is known there, and no triangle covers them. By default 0.
     */
    int32_t has_no_data;
    /**
     * What void samples have; may be no number, and is then that of all samples that are none.
     */
    float no_data;
    /**
     * How far columns are apart, in the unit of the heights: positive; by default 1.
     */
    float column_spacing;
    /**
     * How far rows are apart; by default 1.
     */
    float row_spacing;
    /**
     * For each sample how much its squared error counts: finite, not negative; NULL: 1 for all.
     */
    const float *importance;
    /**
     * Sweeps before the gap is looked at, and between two looks; by default 8.
     */
    uint32_t sweeps;
    /**
     * Sweeps at most; by default 64.
     */
    uint32_t max_sweeps;
    /**
     * How far the squared error may be above the least possible one, in decibels, where a fifth of the
     * vertices is left, to be good enough; by default 0.03.
     */
    double gap;
    /**
     * Is told of progress, and can cancel; NULL for none.
     */
    decimesh_progress progress;
    /**
     * Handed to progress as it is.
     */
    void *progress_user;
} decimesh_hierarchy_options;

/**
 * What was taken from a hierarchy. decimesh_hierarchy_report_init() sets it up.
 */
typedef struct decimesh_hierarchy_report {
    /**
     * sizeof(decimesh_hierarchy_report), as decimesh_hierarchy_report_init sets it.
     */
    uint32_t struct_size;
    /**
     * Always 0.
     */
    uint32_t reserved;
    /**
     * Vertices of the mesh.
     */
    uint64_t vertices;
    /**
     * Triangles of the mesh.
     */
    uint64_t triangles;
    /**
     * Root of the mean squared vertical error of all samples, weighted where they have an importance.
     */
    double rms;
    /**
     * Largest vertical error of a sample; not a number for a surface.
     */
    double max_error;
    /**
     * How far, in decibels, the squared error can be above that of the best conforming mesh of as many
     * vertices: proven for these heights. Infinite if nothing is known.
     */
    double certified_gap;
} decimesh_hierarchy_report;

/**
 * How much of a hierarchy is wanted.
 */
typedef int32_t decimesh_detail;

/**
 * The call did what it says.
 */
#define DECIMESH_OK 0

/**
 * A pointer that must not be NULL is NULL.
 */
#define DECIMESH_ERROR_NULL 1

/**
 * A struct_size is 0 (the init function was not called), too small, no multiple of 8, or absurdly large.
 */
#define DECIMESH_ERROR_STRUCT_SIZE 2

/**
 * A struct of a newer decimesh sets something that this one does not know.
 */
#define DECIMESH_ERROR_UNKNOWN_OPTION 3

/**
 * An enumerated option has a value that does not exist.
 */
#define DECIMESH_ERROR_ENUM 4

/**
 * An option is out of its range, such as a ratio of 1.5 or a locked vertex that does not exist.
 */
#define DECIMESH_ERROR_OPTION 5

/**
 * There are no vertices, no indices, or no triangles where there must be some.
 */
#define DECIMESH_ERROR_EMPTY 6

/**
 * A stride is shorter than an element.
 */
#define DECIMESH_ERROR_STRIDE 7

/**
 * Count times stride exceeds the address space, or a count exceeds what a mesh can hold.
 */
#define DECIMESH_ERROR_OVERFLOW 8

/**
 * The number of indices is no multiple of three.
 */
#define DECIMESH_ERROR_INDEX_COUNT 9

/**
 * An index names a vertex that does not exist.
 */
#define DECIMESH_ERROR_INDEX_RANGE 10

/**
 * A coordinate or an attribute is infinite or not a number.
 */
#define DECIMESH_ERROR_NOT_FINITE 11

/**
 * A level, or a mark, that does not exist was asked for.
 */
#define DECIMESH_ERROR_OUT_OF_RANGE 12

/**
 * The system refused to read or to write a file.
 */
#define DECIMESH_ERROR_IO 13

/**
 * A file breaks the rules of its format, uses a part of it that is not read, or has an extension that names none.
 */
#define DECIMESH_ERROR_FORMAT 14

/**
 * The progress callback ended the call.
 */
#define DECIMESH_ERROR_CANCELLED 15

/**
 * The threads asked for could not be started.
 */
#define DECIMESH_ERROR_THREADS 16

/**
 * A path is not UTF-8.
 */
#define DECIMESH_ERROR_UTF8 17

/**
 * The result does not fit where it is to go, such as a mesh of more than 4 GiB into a glTF file, or indices
 * into less room than they take.
 */
#define DECIMESH_ERROR_TOO_LARGE 18

/**
 * There is not enough memory for a copy of the buffers or lists.
 */
#define DECIMESH_ERROR_OUT_OF_MEMORY 19

/**
 * A bug in decimesh. The handles that the call was given must only be destroyed after that.
 */
#define DECIMESH_ERROR_PANIC 100

/**
 * 16-bit unsigned integers.
 */
#define DECIMESH_INDEX_U16 1

/**
 * 32-bit unsigned integers.
 */
#define DECIMESH_INDEX_U32 2

/**
 * Binary, little endian.
 */
#define DECIMESH_ENCODING_BINARY 0

/**
 * Binary, big endian: PLY alone; elsewhere the same as DECIMESH_ENCODING_BINARY.
 */
#define DECIMESH_ENCODING_BINARY_BIG_ENDIAN 1

/**
 * Text, with as few digits as bring every number back bit for bit: PLY and STL.
 */
#define DECIMESH_ENCODING_ASCII 2

/**
 * At most target_value triangles: that many, or one fewer.
 */
#define DECIMESH_TARGET_TRIANGLES 0

/**
 * At most target_value vertices that a triangle uses.
 */
#define DECIMESH_TARGET_VERTICES 1

/**
 * The fraction target_value, 0 to 1, of the input's triangles, rounded down.
 */
#define DECIMESH_TARGET_RATIO 2

/**
 * As few triangles as an estimated distance of target_value, in units of the positions, allows.
 */
#define DECIMESH_TARGET_MAX_ERROR 3

/**
 * All that cost less than a sampled quantile: the best and fastest.
 */
#define DECIMESH_SELECTION_SAMPLED_THRESHOLD 0

/**
 * The paper's: a replacement-selection heap of heap_records records.
 */
#define DECIMESH_SELECTION_REPLACEMENT 1

/**
 * They are kept as long as the target can be reached so, and given up where it cannot.
 */
#define DECIMESH_TOPOLOGY_RELAX_IF_STUCK 0

/**
 * They are kept, even if the target is missed.
 */
#define DECIMESH_TOPOLOGY_KEEP 1

/**
 * Where the error is least: a new vertex.
 */
#define DECIMESH_PLACEMENT_OPTIMAL 0

/**
 * To one of the edge's ends: every vertex of the result is a vertex of the input, bit for bit.
 */
#define DECIMESH_PLACEMENT_EXISTING 1

/**
 * The target is met.
 */
#define DECIMESH_STOPPED_BY_TARGET 0

/**
 * Every further collapse would exceed the error asked for.
 */
#define DECIMESH_STOPPED_BY_ERROR 1

/**
 * Every further collapse would change the topology, fold a face over, or move a locked vertex.
 */
#define DECIMESH_STOPPED_BY_STUCK 2

/**
 * At most so many vertices, and as many as there can be below.
 */
#define DECIMESH_DETAIL_VERTICES 0

/**
 * So large a part of the samples that are not void, above 0 and at most 1.
 */
#define DECIMESH_DETAIL_RATIO 1

/**
 * As few vertices as there are with this root mean square of the vertical error over all samples.
 */
#define DECIMESH_DETAIL_RMS 2

/**
 * As few vertices as there can be with no sample farther from the surface, vertically.
 */
#define DECIMESH_DETAIL_MAX_ERROR 3

#ifdef __cplusplus
extern "C" {
#endif // __cplusplus

/**
 * The version of the library, major << 16 | minor << 8 | patch: a program that was compiled with one
 * header and runs with another library can tell by comparing it with the macros.
 *
 * Any thread; never fails.
 */
uint32_t decimesh_version(void);

/**
 * The version of the library as a text, such as "0.1.0". Static. Any thread; never fails.
 */
const char *decimesh_version_string(void);

/**
 * What was wrong in this thread's last call that failed, in English, without a line end; "" before the first.
 *
 * The text is UTF-8 and belongs to decimesh: it is valid until this thread's next call that fails,
 * or its end. Each thread has its own. Constant time; never fails.
 */
const char *decimesh_last_error_message(void);

/**
 * The name of a status, such as "DECIMESH_ERROR_NULL"; "unknown status" for a value that is none.
 *
 * The text is static. Any thread; never fails.
 */
const char *decimesh_status_name(decimesh_status status);

/**
 * Makes *buffers empty: struct_size is set, indices are 32 bits wide, all else is 0. NULL is left alone.
 *
 * struct_size is sizeof(decimesh_buffers), as the caller was compiled: no more is written.
 */
void decimesh_buffers_init(struct decimesh_buffers *buffers,
                           size_t struct_size);

/**
 * Makes *buffers empty: struct_size is set, indices are 32 bits wide, all else is 0. NULL is left alone.
 *
 * struct_size is sizeof(decimesh_mutable_buffers), as the caller was compiled: no more is written.
 */
void decimesh_mutable_buffers_init(struct decimesh_mutable_buffers *buffers,
                                   size_t struct_size);

/**
 * Makes a mesh of a copy of the caller's buffers, which are not needed any more afterwards.
 *
 * Nothing is welded, dropped or moved: duplicate and degenerate triangles, vertices that no triangle
 * uses, non-manifold edges and any number of components are welcome.
 *
 * *mesh receives the mesh, which the caller ends with decimesh_mesh_destroy().
 * Fails with _NULL, _STRUCT_SIZE, _UNKNOWN_OPTION, _ENUM, _EMPTY, _STRIDE, _OVERFLOW, _INDEX_COUNT,
 * _INDEX_RANGE, _NOT_FINITE or _OUT_OF_MEMORY. Linear in the mesh; any thread.
 */
decimesh_status decimesh_mesh_from_buffers(const struct decimesh_buffers *buffers,
                                           struct decimesh_mesh **mesh);

/**
 * Reads a mesh from a file: PLY, OBJ, STL, OFF, glTF or GLB, as the extension of the path says.
 *
 * Polygons become fans of triangles; the corners of an STL file that lie at one place become one
 * vertex; vertices of an OBJ file are as many as there are pairs of position, normal and texture
 * coordinate; a glTF scene becomes one mesh, its nodes' transforms applied.
 *
 * path is UTF-8. *mesh receives the mesh, which the caller ends with decimesh_mesh_destroy(); one without
 * triangles is possible. Fails with _NULL, _UTF8, _IO, _FORMAT (the text says at which line or byte),
 * _INDEX_RANGE, _NOT_FINITE or _OVERFLOW. Time and memory are in proportion to the file; any thread.
 */
decimesh_status decimesh_mesh_read(const char *path,
                                   struct decimesh_mesh **mesh);

/**
 * Writes a mesh to a file: PLY, OBJ, STL, OFF, glTF or GLB, as the extension of the path says.
 *
 * The file appears whole or not at all: it is written under another name beside its place and renamed
 * at the end. path is UTF-8; encoding is a DECIMESH_ENCODING_ value.
 * Fails with _NULL, _UTF8, _ENUM, _IO, _FORMAT (no such extension) or _TOO_LARGE (glTF ends at 4 GiB).
 * Linear in the mesh; any thread.
 */
decimesh_status decimesh_mesh_write(const struct decimesh_mesh *mesh,
                                    const char *path,
                                    decimesh_encoding encoding);

/**
 * Makes one vertex of all that lie at one place, or within a tolerance of an earlier one: the seams of
 * a game asset become one surface, whose attributes are those of the first vertex of each place.
 *
 * tolerance is a distance in the units of the positions: finite, not negative; 0 takes equal positions
 * alone. Triangles left with fewer than three vertices are dropped.
 *
 * *welded receives a new mesh, which the caller ends with decimesh_mesh_destroy(). Fails with _NULL or
 * _OPTION. n log n time; any thread.
 */
decimesh_status decimesh_mesh_weld(const struct decimesh_mesh *mesh,
                                   float tolerance,
                                   struct decimesh_mesh **welded);

/**
 * Ends a mesh: its memory is given back, and pointers into it are void. NULL is left alone, as is a mesh
 * that belongs to another handle.
 *
 * No other thread may use the mesh any more.
 */
void decimesh_mesh_destroy(struct decimesh_mesh *mesh);

/**
 * How many vertices a mesh has; 0 for NULL. Constant time; any thread; never fails.
 */
size_t decimesh_mesh_vertex_count(const struct decimesh_mesh *mesh);

/**
 * How many triangles a mesh has; 0 for NULL. Constant time; any thread; never fails.
 */
size_t decimesh_mesh_triangle_count(const struct decimesh_mesh *mesh);

/**
 * The positions: x, y and z of each vertex, without a gap; NULL for NULL.
 *
 * They belong to the mesh and are valid until it ends. Without vertices there is nothing to read.
 * Constant time; any thread; never fails.
 */
const float *decimesh_mesh_positions(const struct decimesh_mesh *mesh);

/**
 * The indices: three a triangle, counter-clockwise from outside; NULL for NULL.
 *
 * They belong to the mesh and are valid until it ends. Without triangles there is nothing to read.
 * Constant time; any thread; never fails.
 */
const uint32_t *decimesh_mesh_indices(const struct decimesh_mesh *mesh);

/**
 * The normals: x, y and z of each vertex, without a gap; NULL where there are none, and for NULL.
 *
 * They belong to the mesh and are valid until it ends. Constant time; any thread; never fails.
 */
const float *decimesh_mesh_normals(const struct decimesh_mesh *mesh);

/**
 * The texture coordinates: u and v of each vertex, without a gap; NULL where there are none, and for NULL.
 *
 * They belong to the mesh and are valid until it ends. Constant time; any thread; never fails.
 */
const float *decimesh_mesh_uvs(const struct decimesh_mesh *mesh);

/**
 * The colours: red, green, blue and alpha of each vertex, without a gap; NULL where there are none, and for
 * NULL.
 *
 * They belong to the mesh and are valid until it ends. Constant time; any thread; never fails.
 */
const uint8_t *decimesh_mesh_colors(const struct decimesh_mesh *mesh);

/**
 * Sets struct_size and makes all else 0. NULL is left alone.
 *
 * struct_size is sizeof(decimesh_statistics), as the caller was compiled: no more is written.
 */
void decimesh_statistics_init(struct decimesh_statistics *statistics,
                              size_t struct_size);

/**
 * Counts what a mesh is made of, into *statistics, which decimesh_statistics_init has set up.
 *
 * Fails with _NULL or _STRUCT_SIZE. n log n time, about 20 bytes of memory a triangle and 20 a vertex;
 * any thread, and all cores.
 */
decimesh_status decimesh_mesh_statistics(const struct decimesh_mesh *mesh,
                                         struct decimesh_statistics *statistics);

/**
 * Sets the defaults: half of the triangles, new vertices, all threads. NULL is left alone.
 *
 * struct_size is sizeof(decimesh_simplify_options), as the caller was compiled: no more is written.
 */
void decimesh_simplify_options_init(struct decimesh_simplify_options *options,
                                    size_t struct_size);

/**
 * Sets struct_size and makes all else 0. NULL is left alone.
 *
 * struct_size is sizeof(decimesh_simplify_report), as the caller was compiled: no more is written.
 */
void decimesh_simplify_report_init(struct decimesh_simplify_report *report,
                                   size_t struct_size);

/**
 * Simplifies a mesh by quadric edge collapses, in linear time (HQMS: Chen, Fahn, Tsai, Chen and Lin, "A
 * Linear Time Algorithm for High Quality Mesh Simplification").
 *
 * A target that cannot be met is no failure: the result is then as small as the options allow, and the
 * report says why it stopped. With DECIMESH_PLACEMENT_OPTIMAL attributes are interpolated, and do not count
 * as error; with _EXISTING they count by their weights. The input is not changed. The result depends on the
 * mesh and the options alone: not on the threads, nor on the language of the caller.
 *
 * *simplified receives a new mesh, which the caller ends with decimesh_mesh_destroy(). *report, if it is
 * not NULL, has been set up by decimesh_simplify_report_init. Fails with _NULL, _STRUCT_SIZE,
 * _UNKNOWN_OPTION, _ENUM, _OPTION, _CANCELLED, _THREADS or _OUT_OF_MEMORY.
 *
 * Linear time; about 24 bytes of memory a triangle, and the result. Any thread; progress is told on the
 * calling one.
 */
decimesh_status decimesh_simplify(const struct decimesh_mesh *mesh,
                                  const struct decimesh_simplify_options *options,
                                  struct decimesh_mesh **simplified,
                                  struct decimesh_simplify_report *report);

/**
 * Simplifies to indices alone: all levels of detail share the caller's vertices, which are not changed.
 *
 * destination has room for buffers->index_count indices of buffers->index_type, and may be
 * buffers->indices itself. It receives *index_count indices. The placement is
 * DECIMESH_PLACEMENT_EXISTING, whatever the options say. With options->keep_seams, vertices that share a
 * place are found by their positions, and go along their seams together. Attributes may be left NULL; only
 * those that are given and have a weight count as error. options->origins, if asked for, names the caller's
 * vertices.
 *
 * Where the topology had to be given up (report->topology_changed), a vertex at which the surface was
 * parted serves both parts.
 *
 * *report, if it is not NULL, has been set up by decimesh_simplify_report_init. Fails as
 * decimesh_mesh_from_buffers() and decimesh_simplify() do; then nothing was written.
 *
 * Linear time; about 48 bytes of memory a triangle, the copy of the buffers included, and 66 if normals have
 * a weight. Any thread; progress is told on the calling one.
 */
decimesh_status decimesh_simplify_indices(void *destination,
                                          const struct decimesh_buffers *buffers,
                                          const struct decimesh_simplify_options *options,
                                          size_t *index_count,
                                          struct decimesh_simplify_report *report);

/**
 * Simplifies in the caller's buffers: indices, positions and attributes are overwritten.
 *
 * A vertex of the result takes the place of one that went into it, so that further streams of the
 * vertex buffer stay where they are and nothing moves; vertices that no index names any more keep what
 * they had. buffers->indices receives *index_count indices; with DECIMESH_PLACEMENT_EXISTING that is
 * all that changes, as by decimesh_simplify_indices(). options->origins, if asked for, names the caller's
 * vertices. With options->keep_seams, vertices that share a place are found by their positions, whether
 * there are attributes or not.
 *
 * *report, if it is not NULL, has been set up by decimesh_simplify_report_init. Fails as
 * decimesh_mesh_from_buffers() and decimesh_simplify() do; then nothing was written.
 *
 * Linear time; about 30 bytes of memory a triangle, the copy of the buffers included. No other thread may
 * use the buffers meanwhile; progress is told on the calling thread.
 */
decimesh_status decimesh_simplify_in_place(const struct decimesh_mutable_buffers *buffers,
                                           const struct decimesh_simplify_options *options,
                                           size_t *index_count,
                                           struct decimesh_simplify_report *report);

/**
 * Sets the defaults: the cheapest of six, seed 0. NULL is left alone.
 *
 * struct_size is sizeof(decimesh_multiple_choice_options), as the caller was compiled: no more is written.
 */
void decimesh_multiple_choice_options_init(struct decimesh_multiple_choice_options *options,
                                           size_t struct_size);

/**
 * Simplifies a mesh as Jia, Tang and Pan do: time and again some vertices are drawn at random, and the one with the
 * least visual cost goes into a neighbour. No vertex is made or moved.
 *
 * It is there to compare with: decimesh_simplify() with DECIMESH_PLACEMENT_EXISTING is faster and closer. At most
 * triangles are left, this many or one fewer, unless nothing more can go before that: topology is kept, no face turns
 * by a right angle, and where there are attributes, vertices that share their place with another stay.
 *
 * *simplified receives a new mesh, which the caller ends with decimesh_mesh_destroy(), without the vertices that no
 * triangle uses. *stopped_by, if it is not NULL, receives DECIMESH_STOPPED_BY_TARGET or _STUCK. options may be NULL: the
 * defaults. Fails with _NULL, _STRUCT_SIZE, _UNKNOWN_OPTION, _OPTION (no candidates, or a locked vertex that does not
 * exist) or _CANCELLED.
 *
 * Linear time, on one thread; about 115 bytes of memory a vertex. The same mesh and options give the same bytes on
 * every machine. Any thread; progress is told on the calling one.
 */
decimesh_status decimesh_multiple_choice(const struct decimesh_mesh *mesh,
                                         size_t triangles,
                                         const struct decimesh_multiple_choice_options *options,
                                         struct decimesh_mesh **simplified,
                                         decimesh_stopped_by *stopped_by);

/**
 * Makes levels of a mesh, each from the one before: a chain costs little more than its coarsest level.
 *
 * target_values has count values, at least 1, from fine to coarse; each is what options->target_value is
 * for one simplification, which is not looked at here. options->origins and options->result_groups must be
 * NULL. A level that cannot be met is the same mesh as the one before, and its report says why.
 *
 * *levels receives the chain, which the caller ends with decimesh_levels_destroy(). Fails with _NULL,
 * _EMPTY, _OVERFLOW, _STRUCT_SIZE, _UNKNOWN_OPTION, _ENUM, _OPTION, _CANCELLED, _THREADS or _OUT_OF_MEMORY.
 *
 * Linear time; about 24 bytes of memory a triangle, and the levels; with options->level_origins 4 bytes more for
 * each vertex of the input and each level. Any thread; progress is told on the
 * calling one.
 */
decimesh_status decimesh_levels_build(const struct decimesh_mesh *mesh,
                                      const struct decimesh_simplify_options *options,
                                      const double *target_values,
                                      size_t count,
                                      struct decimesh_levels **levels);

/**
 * Ends a chain of levels and all of its meshes. NULL is left alone.
 *
 * No other thread may use the chain or a mesh of it any more.
 */
void decimesh_levels_destroy(struct decimesh_levels *levels);

/**
 * How many levels there are; 0 for NULL. Constant time; any thread; never fails.
 */
size_t decimesh_levels_count(const struct decimesh_levels *levels);

/**
 * The mesh of a level, 0 being the finest. It belongs to the chain and ends with it:
 * decimesh_mesh_destroy() leaves it alone.
 *
 * Fails with _NULL or _OUT_OF_RANGE. Constant time; any thread.
 */
decimesh_status decimesh_levels_mesh(const struct decimesh_levels *levels,
                                     size_t level,
                                     const struct decimesh_mesh **mesh);

/**
 * How a level came about, 0 being the finest: into *report, which decimesh_simplify_report_init has set up.
 * Errors are those of the whole chain up to the level.
 *
 * Fails with _NULL, _OUT_OF_RANGE or _STRUCT_SIZE. Constant time; any thread.
 */
decimesh_status decimesh_levels_report(const struct decimesh_levels *levels,
                                       size_t level,
                                       struct decimesh_simplify_report *report);

/**
 * The group of each triangle of a level, 0 being the finest, if options->triangle_groups were given: into
 * *groups, which becomes NULL if not.
 *
 * They belong to the chain and are valid until it ends. Fails with _NULL or _OUT_OF_RANGE. Constant time;
 * any thread.
 */
decimesh_status decimesh_levels_groups(const struct decimesh_levels *levels,
                                       size_t level,
                                       const uint32_t **groups);

/**
 * For each vertex of the input the vertex of a level, 0 being the finest, that it went into, UINT32_MAX where it
 * vanished, if options->level_origins was 1: into *origins, which becomes NULL if not. By it go what attributes
 * decimesh does not know.
 *
 * They belong to the chain and are valid until it ends. Fails with _NULL or _OUT_OF_RANGE. Constant time;
 * any thread.
 */
decimesh_status decimesh_levels_origins(const struct decimesh_levels *levels,
                                        size_t level,
                                        const uint32_t **origins);

/**
 * The coarsest level whose error is at most max_error, in units of the positions: into *level, which
 * becomes the number of levels where none is so good and the original is to be drawn.
 *
 * Seen by a perspective camera from a distance d, with a vertical field of view of f radians on a screen
 * h pixels high, an error of p pixels on the screen is one of p * d * 2 * tan(f / 2) / h.
 *
 * Fails with _NULL, or _NOT_FINITE if max_error is not a number. Linear in the levels; any thread.
 */
decimesh_status decimesh_levels_select(const struct decimesh_levels *levels,
                                       float max_error,
                                       size_t *level);

/**
 * Sets the defaults: 500000 samples a direction, all threads. NULL is left alone.
 *
 * struct_size is sizeof(decimesh_deviation_options), as the caller was compiled: no more is written.
 */
void decimesh_deviation_options_init(struct decimesh_deviation_options *options,
                                     size_t struct_size);

/**
 * Sets struct_size and makes all else 0. NULL is left alone.
 *
 * struct_size is sizeof(decimesh_deviation_result), as the caller was compiled: no more is written.
 */
void decimesh_deviation_result_init(struct decimesh_deviation_result *result,
                                    size_t struct_size);

/**
 * Measures the distance between the surfaces of two meshes, in both directions, as Metro does: points on
 * one surface, each to the nearest point of the other, which is found exactly, in double precision.
 *
 * options may be NULL: the defaults. *result has been set up by decimesh_deviation_result_init. Fails with
 * _NULL, _STRUCT_SIZE, _UNKNOWN_OPTION, _EMPTY (a mesh without triangles), _CANCELLED or _THREADS.
 *
 * O((n + samples) log n) time, about 110 bytes of memory a triangle and more while the trees are built.
 * Any thread; progress is told on the calling one.
 */
decimesh_status decimesh_deviation(const struct decimesh_mesh *a,
                                   const struct decimesh_mesh *b,
                                   const struct decimesh_deviation_options *options,
                                   struct decimesh_deviation_result *result);

/**
 * Measures how far each vertex of one mesh is from the surface of another: the nearest point is found exactly,
 * in double precision.
 *
 * distances has room for as many as from has vertices, and receives them in their order, in units of the
 * positions; vertices that no triangle uses are measured as well. options may be NULL: the defaults; their samples and
 * seed are not looked at. Fails with _NULL, _STRUCT_SIZE, _UNKNOWN_OPTION, _EMPTY (to is without triangles),
 * _CANCELLED or _THREADS.
 *
 * O(n log n) time, about 110 bytes of memory a triangle of to, more while the tree is built, and 4 a vertex of from.
 * Any thread; progress is told on the calling one.
 */
decimesh_status decimesh_vertex_distances(const struct decimesh_mesh *from,
                                          const struct decimesh_mesh *to,
                                          const struct decimesh_deviation_options *options,
                                          float *distances);

/**
 * Sets the defaults: a tolerance of 1 %, 5000000 pieces, all threads. NULL is left alone.
 *
 * struct_size is sizeof(decimesh_bound_options), as the caller was compiled: no more is written.
 */
void decimesh_bound_options_init(struct decimesh_bound_options *options,
                                 size_t struct_size);

/**
 * Sets struct_size and makes all else 0. NULL is left alone.
 *
 * struct_size is sizeof(decimesh_bound_result), as the caller was compiled: no more is written.
 */
void decimesh_bound_result_init(struct decimesh_bound_result *result,
                                size_t struct_size);

/**
 * Bounds the two-sided Hausdorff distance between the surfaces of two meshes: over all points, where
 * decimesh_deviation() looks at samples.
 *
 * result->upper holds whatever the options. Whether it is as close to result->lower as asked for is for the
 * caller to see: if not, the pieces did not suffice.
 *
 * options may be NULL: the defaults. *result has been set up by decimesh_bound_result_init. Fails with
 * _NULL, _STRUCT_SIZE, _UNKNOWN_OPTION, _OPTION (the tolerance), _EMPTY (a mesh without triangles),
 * _CANCELLED or _THREADS.
 *
 * n log n time for the trees and the triangles, and then some microseconds a piece: a scan beside its tenth
 * takes about seven a triangle. About 130 bytes of memory a triangle, and the pieces. Any thread; progress is
 * told on the calling one.
 */
decimesh_status decimesh_bound(const struct decimesh_mesh *a,
                               const struct decimesh_mesh *b,
                               const struct decimesh_bound_options *options,
                               struct decimesh_bound_result *result);

/**
 * Simplifies a mesh to few triangles whose two-sided Hausdorff distance from it is proven to be at most
 * max_error, in units of the positions: no point of either surface is farther from the other.
 *
 * The target and the target_value of the options are not looked at; all else is as for decimesh_simplify(), and
 * the topology is kept. Where nothing smaller can be shown to be so close, the input comes back, without the vertices
 * that no triangle uses, at distance 0: so it is for a max_error below 2^-42 of the largest coordinate. A degenerate
 * triangle that sticks out of the rest by more than max_error cannot go, and nothing else does then.
 *
 * *simplified receives a new mesh, which the caller ends with decimesh_mesh_destroy(). *report and *bound, if they
 * are not NULL, have been set up by their init functions; report->stopped_by is DECIMESH_STOPPED_BY_ERROR,
 * bound->upper is at most max_error, and report->error is that, rounded upwards. Fails with _NULL, _STRUCT_SIZE,
 * _UNKNOWN_OPTION, _ENUM, _OPTION (also for a max_error that is negative, infinite or not a number), _CANCELLED,
 * _THREADS or _OUT_OF_MEMORY.
 *
 * At most nine times the time of decimesh_bound(): some ten to 200 microseconds a triangle. About 280 bytes of
 * memory a triangle, and at most 120 for each of 32 parts a triangle that have to be looked at. The result is the
 * same, byte for byte, for any number of threads. Any thread; progress is told on the calling one.
 */
decimesh_status decimesh_simplify_within(const struct decimesh_mesh *mesh,
                                         double max_error,
                                         const struct decimesh_simplify_options *options,
                                         struct decimesh_mesh **simplified,
                                         struct decimesh_simplify_report *report,
                                         struct decimesh_bound_result *bound);

/**
 * Sets struct_size and makes all else 0. NULL is left alone.
 *
 * struct_size is sizeof(decimesh_nested_level), as the caller was compiled: no more is written.
 */
void decimesh_nested_level_init(struct decimesh_nested_level *level,
                                size_t struct_size);

/**
 * Makes levels of a mesh by collapses that make no vertex and move none, and puts its vertices in order:
 * those of the coarsest level first, in the order they had, then what each finer level adds, then those
 * that no triangle uses. So one vertex buffer serves all levels, and a program that draws a coarse one need
 * have loaded the beginning of it alone.
 *
 * target_values has count values, at least 1, from fine to coarse, and becomes the levels after 0; each is
 * what options->target_value is for one simplification, which is not looked at here, as options->placement
 * is not. options->origins and options->result_groups must be NULL. A level that cannot be met is the same
 * as the one before, and says why.
 *
 * *nested receives the levels, which the caller ends with decimesh_nested_destroy(). Fails with _NULL,
 * _EMPTY, _OVERFLOW, _STRUCT_SIZE, _UNKNOWN_OPTION, _ENUM, _OPTION, _CANCELLED, _THREADS or _OUT_OF_MEMORY.
 *
 * Linear time; about 62 bytes of memory a triangle for three levels that halve, what they hold included. Any
 * thread; progress is told on the calling one.
 */
decimesh_status decimesh_nested_build(const struct decimesh_mesh *mesh,
                                      const struct decimesh_simplify_options *options,
                                      const double *target_values,
                                      size_t count,
                                      struct decimesh_nested **nested);

/**
 * Ends levels and their mesh. NULL is left alone.
 *
 * No other thread may use them or their mesh any more.
 */
void decimesh_nested_destroy(struct decimesh_nested *nested);

/**
 * How many levels there are, level 0 included; 0 for NULL. Constant time; any thread; never fails.
 */
size_t decimesh_nested_count(const struct decimesh_nested *nested);

/**
 * The vertex buffer of all levels, as a mesh whose triangles are those of level 0; NULL for NULL.
 *
 * It belongs to the levels and ends with them: decimesh_mesh_destroy() leaves it alone. Constant time; any
 * thread; never fails.
 */
const struct decimesh_mesh *decimesh_nested_mesh(const struct decimesh_nested *nested);

/**
 * For each vertex of the buffer the vertex of the input that it is, every one once: further streams of the
 * input's vertices go to the same order by it. NULL for NULL.
 *
 * It belongs to the levels and is valid until they end. Constant time; any thread; never fails.
 */
const uint32_t *decimesh_nested_order(const struct decimesh_nested *nested);

/**
 * What a level is, 0 being the finest: into *description, which decimesh_nested_level_init has set up.
 *
 * Fails with _NULL, _OUT_OF_RANGE or _STRUCT_SIZE. Constant time; any thread.
 */
decimesh_status decimesh_nested_describe(const struct decimesh_nested *nested,
                                         size_t level,
                                         struct decimesh_nested_level *description);

/**
 * The indices of a level, three a triangle; how many there are decimesh_nested_describe() says.
 *
 * They belong to the levels and are valid until these end. Fails with _NULL or _OUT_OF_RANGE. Constant time;
 * any thread.
 */
decimesh_status decimesh_nested_indices(const struct decimesh_nested *nested,
                                        size_t level,
                                        const uint32_t **indices);

/**
 * Copies the indices of a level to destination, which has room for so many indices of index_type, at least
 * as many as the level has.
 *
 * Fails with _NULL, _OUT_OF_RANGE, _ENUM, or _TOO_LARGE: there are more indices than there is room for, or
 * more vertices than indices of 16 bits can name. Linear in the level; any thread.
 */
decimesh_status decimesh_nested_copy_indices(const struct decimesh_nested *nested,
                                             size_t level,
                                             decimesh_index_type index_type,
                                             void *destination,
                                             size_t room);

/**
 * The group of each triangle of a level, if options->triangle_groups were given: into *groups, which becomes
 * NULL if not, and for level 0. The triangles of that are those of the input, in their order, and its groups
 * are those given.
 *
 * They belong to the levels and are valid until these end. Fails with _NULL or _OUT_OF_RANGE. Constant time;
 * any thread.
 */
decimesh_status decimesh_nested_groups(const struct decimesh_nested *nested,
                                       size_t level,
                                       const uint32_t **groups);

/**
 * For each vertex of a level the one that it goes into on the next coarser level: itself where it stays, and
 * where what surrounds it vanishes. A vertex drawn on the way from its own place to that one's hides the
 * change of levels. *morphs becomes NULL on the coarsest level.
 *
 * They belong to the levels and are valid until these end. Fails with _NULL or _OUT_OF_RANGE. Constant time;
 * any thread.
 */
decimesh_status decimesh_nested_morphs(const struct decimesh_nested *nested,
                                       size_t level,
                                       const uint32_t **morphs);

/**
 * The coarsest level whose error is at most max_error, in units of the positions: into *level, which becomes
 * 0 where none but the input is so good. decimesh_levels_select() says which error can be seen.
 *
 * Fails with _NULL, or _NOT_FINITE if max_error is not a number. Linear in the levels; any thread.
 */
decimesh_status decimesh_nested_select(const struct decimesh_nested *nested,
                                       float max_error,
                                       size_t *level);

/**
 * Puts a guaranteed bound in the place of each level's estimated error: no point of the level is farther
 * from level 0 than that, and none of level 0 from the level.
 *
 * options may be NULL: the defaults. Fails as decimesh_bound() does, also for a level without triangles;
 * then nothing has changed. As long as that for each level, which is far longer than
 * decimesh_nested_build(). No other thread may use the levels meanwhile; progress is told on the calling
 * thread.
 */
decimesh_status decimesh_nested_certify(struct decimesh_nested *nested,
                                        const struct decimesh_bound_options *options);

/**
 * Writes all levels to a GLB file, with the vertex buffer there once.
 *
 * Each level is a node and a mesh, whose accessors end where the level's vertices do; the node's extras hold
 * its error. The scene shows the first, which names the others by the extension MSFT_lod. Levels without
 * triangles and vertices that no triangle uses are left out.
 *
 * The file appears whole or not at all, as by decimesh_mesh_write(). path is UTF-8; its extension is not
 * looked at. Fails with _NULL, _UTF8, _IO or _TOO_LARGE (GLB ends at 4 GiB). Linear in the levels; any
 * thread.
 */
decimesh_status decimesh_nested_write_glb(const struct decimesh_nested *nested,
                                          const char *path);

/**
 * Simplifies a mesh by collapses that make no vertex and move none, to each of the targets in turn, from
 * fine to coarse, keeps all levels in between, and marks where each target is met.
 *
 * target_values has count values, at least 1; each is what options->target_value is for one simplification,
 * which is not looked at here, as options->placement and options->topology are not: the topology is kept, so
 * that the coarsest level may be larger than asked for. options->origins and options->result_groups must be
 * NULL.
 *
 * *progressive receives the progressive mesh, which the caller ends with decimesh_progressive_destroy().
 * Fails with _NULL, _EMPTY, _OVERFLOW, _STRUCT_SIZE, _UNKNOWN_OPTION, _ENUM, _OPTION, _CANCELLED, _THREADS
 * or _OUT_OF_MEMORY.
 *
 * n log n time in the vertices, otherwise linear; about 130 bytes of memory a triangle for three targets
 * that halve. The progressive mesh itself takes about 34, and the vertices. Any thread; progress is told on
 * the calling one.
 */
decimesh_status decimesh_progressive_build(const struct decimesh_mesh *mesh,
                                           const struct decimesh_simplify_options *options,
                                           const double *target_values,
                                           size_t count,
                                           struct decimesh_progressive **progressive);

/**
 * Reads a progressive mesh from a file, as docs/progressive-format.md describes it, up to the finest level
 * with at most max_triangles triangles, or the coarsest if even that has more; SIZE_MAX: all of it. What
 * follows in the file is not looked at, and need not be there.
 *
 * What was read is checked split by split, so that every level is a mesh. path is UTF-8. *progressive
 * receives the progressive mesh, which the caller ends with decimesh_progressive_destroy(). Fails with
 * _NULL, _UTF8, _IO, _FORMAT (the text says at which byte), _INDEX_RANGE, _NOT_FINITE or _OVERFLOW. Time
 * and memory are in proportion to what is read; any thread.
 */
decimesh_status decimesh_progressive_read(const char *path,
                                          size_t max_triangles,
                                          struct decimesh_progressive **progressive);

/**
 * The same from the bytes of such a file, which may be the beginning of it. They are not needed any more
 * afterwards.
 *
 * *progressive receives the progressive mesh, which the caller ends with decimesh_progressive_destroy().
 * Fails with _NULL, _FORMAT (the text says at which byte), _INDEX_RANGE, _NOT_FINITE or _OVERFLOW. Time and
 * memory are in proportion to what is read; any thread.
 */
decimesh_status decimesh_progressive_from_memory(const void *bytes,
                                                 size_t size,
                                                 size_t max_triangles,
                                                 struct decimesh_progressive **progressive);

/**
 * Writes a progressive mesh to a file, as docs/progressive-format.md describes it. The usual extension is
 * .dpm.
 *
 * The file appears whole or not at all, as by decimesh_mesh_write(). path is UTF-8. Fails with _NULL, _UTF8
 * or _IO. Linear in the mesh; any thread.
 */
decimesh_status decimesh_progressive_write(const struct decimesh_progressive *progressive,
                                           const char *path);

/**
 * Ends a progressive mesh and the mesh of its vertices; players of it go on. NULL is left alone.
 *
 * No other thread may use it any more, but for its players.
 */
void decimesh_progressive_destroy(struct decimesh_progressive *progressive);

/**
 * How many splits lead from the coarsest level to the finest; 0 for NULL. Constant time; any thread; never
 * fails.
 */
size_t decimesh_progressive_steps(const struct decimesh_progressive *progressive);

/**
 * How many vertices the level at a step has, or the finest where step is beyond that; 0 for NULL. Constant
 * time; any thread; never fails.
 */
size_t decimesh_progressive_vertex_count(const struct decimesh_progressive *progressive,
                                         size_t step);

/**
 * How many triangles the level at a step has, or the finest where step is beyond that; 0 for NULL. Constant
 * time; any thread; never fails.
 */
size_t decimesh_progressive_triangle_count(const struct decimesh_progressive *progressive,
                                           size_t step);

/**
 * The step of the finest level with at most so many triangles: 0, the coarsest, if none has so few, and for
 * NULL. Logarithmic time; any thread; never fails.
 */
size_t decimesh_progressive_step_within(const struct decimesh_progressive *progressive,
                                        size_t triangles);

/**
 * The vertices of all levels, the last to go first, as a mesh without triangles; NULL for NULL.
 *
 * It belongs to the progressive mesh and ends with it: decimesh_mesh_destroy() leaves it alone. Constant
 * time; any thread; never fails.
 */
const struct decimesh_mesh *decimesh_progressive_vertices(const struct decimesh_progressive *progressive);

/**
 * For each vertex the one of the input that it is; NULL where the progressive mesh comes from a file, and
 * for NULL.
 *
 * It belongs to the progressive mesh and is valid until it ends. Constant time; any thread; never fails.
 */
const uint32_t *decimesh_progressive_order(const struct decimesh_progressive *progressive);

/**
 * Copies the indices of the level at a step, or of the finest where step is beyond that, to destination,
 * which has room for so many indices of index_type, at least three for each of its triangles.
 *
 * Fails with _NULL, _ENUM, or _TOO_LARGE: there are more indices than there is room for, or more vertices
 * than indices of 16 bits can name. Linear in the level and the corners changed on the way, whose memory it
 * takes once more meanwhile; a decimesh_player goes from level to level for less. Any thread.
 */
decimesh_status decimesh_progressive_copy_indices(const struct decimesh_progressive *progressive,
                                                  size_t step,
                                                  decimesh_index_type index_type,
                                                  void *destination,
                                                  size_t room);

/**
 * The level at a step, or the finest where step is beyond that, as a mesh of its own.
 *
 * *mesh receives a new mesh, which the caller ends with decimesh_mesh_destroy(). Fails with _NULL. Linear in
 * the level and the corners changed on the way; any thread.
 */
decimesh_status decimesh_progressive_mesh(const struct decimesh_progressive *progressive,
                                          size_t step,
                                          struct decimesh_mesh **mesh);

/**
 * How many levels have a mark: each target of decimesh_progressive_build() that could be met without a
 * change of the topology; 0 for NULL. Constant time; any thread; never fails.
 */
size_t decimesh_progressive_mark_count(const struct decimesh_progressive *progressive);

/**
 * A level that has a mark, 0 being the finest: at which step it is, into *step, and its estimated error, in
 * units of the positions, into *error. Errors do not fall from mark to mark.
 *
 * Fails with _NULL or _OUT_OF_RANGE. Constant time; any thread.
 */
decimesh_status decimesh_progressive_mark(const struct decimesh_progressive *progressive,
                                          size_t mark,
                                          size_t *step,
                                          float *error);

/**
 * A player at the coarsest level. It has a share of the progressive mesh, which lives on for it when its own
 * handle is ended.
 *
 * *player receives the player, which the caller ends with decimesh_player_destroy(). Fails with _NULL.
 * Linear in the coarsest level; 12 bytes of memory a triangle of the finest level it goes to. Any thread.
 */
decimesh_status decimesh_player_create(const struct decimesh_progressive *progressive,
                                       struct decimesh_player **player);

/**
 * Ends a player. NULL is left alone.
 *
 * No other thread may use it any more.
 */
void decimesh_player_destroy(struct decimesh_player *player);

/**
 * At which step a player is; 0 for NULL. Constant time; any thread; never fails.
 */
size_t decimesh_player_step(const struct decimesh_player *player);

/**
 * How many vertices the player's level has, the first of decimesh_progressive_vertices(); 0 for NULL.
 * Constant time; any thread; never fails.
 */
size_t decimesh_player_vertex_count(const struct decimesh_player *player);

/**
 * How many triangles the player's level has; 0 for NULL. Constant time; any thread; never fails.
 */
size_t decimesh_player_triangle_count(const struct decimesh_player *player);

/**
 * The indices of the player's level, three a triangle; NULL for NULL. They are what
 * decimesh_progressive_copy_indices() gives for the step.
 *
 * They belong to the player and are valid until it goes to another step or ends. Without triangles there is
 * nothing to read. Constant time; any thread; never fails.
 */
const uint32_t *decimesh_player_indices(const struct decimesh_player *player);

/**
 * Copies the indices of the player's level to destination, which has room for so many indices of
 * index_type, at least three for each of its triangles.
 *
 * Fails with _NULL, _ENUM, or _TOO_LARGE: there are more indices than there is room for, or more vertices
 * than indices of 16 bits can name. Linear in the level; any thread.
 */
decimesh_status decimesh_player_copy_indices(const struct decimesh_player *player,
                                             decimesh_index_type index_type,
                                             void *destination,
                                             size_t room);

/**
 * Does the next split; at the finest level nothing changes.
 *
 * Fails with _NULL. In proportion to what changes. No other thread may use the player meanwhile.
 */
decimesh_status decimesh_player_finer(struct decimesh_player *player);

/**
 * Undoes the last split; at the coarsest level nothing changes.
 *
 * Fails with _NULL. In proportion to what changes. No other thread may use the player meanwhile.
 */
decimesh_status decimesh_player_coarser(struct decimesh_player *player);

/**
 * Goes to a step, or to the finest level where step is beyond that.
 *
 * Fails with _NULL. In proportion to the splits in between. No other thread may use the player meanwhile.
 */
decimesh_status decimesh_player_go_to(struct decimesh_player *player,
                                      size_t step);

/**
 * Sets the defaults. NULL is left alone.
 *
 * struct_size is sizeof(decimesh_hierarchy_options), as the caller was compiled: no more is written.
 */
void decimesh_hierarchy_options_init(struct decimesh_hierarchy_options *options,
                                     size_t struct_size);

/**
 * Sets struct_size and makes all else 0. NULL is left alone.
 *
 * struct_size is sizeof(decimesh_hierarchy_report), as the caller was compiled: no more is written.
 */
void decimesh_hierarchy_report_init(struct decimesh_hierarchy_report *report,
                                    size_t struct_size);

/**
 * Decomposes heights: columns times rows of them, row by row, the northernmost row first.
 *
 * Each has two at least; all heights are finite but those that options->no_data makes void, and one at least is
 * not void. options may be NULL: the defaults. heights and options->importance are copied.
 *
 * *hierarchy receives the hierarchy, which the caller ends with decimesh_hierarchy_destroy(). Fails with _NULL,
 * _EMPTY (fewer than two columns or rows, or all void), _OVERFLOW, _NOT_FINITE (the text says where), _OPTION,
 * _STRUCT_SIZE, _UNKNOWN_OPTION, _CANCELLED, _THREADS or _OUT_OF_MEMORY.
 *
 * About 0.1 s for a million samples; 24 bytes of memory a sample and two million, and up to half as much again for a grid that
 * is not of 2^d + 1 columns and rows or has voids; the hierarchy keeps 16. Any thread; progress is told on the
 * calling one.
 */
decimesh_status decimesh_hierarchy_create(const float *heights,
                                          size_t columns,
                                          size_t rows,
                                          const struct decimesh_hierarchy_options *options,
                                          struct decimesh_hierarchy **hierarchy);

/**
 * Writes a hierarchy to a file, as docs/hierarchy-format.md describes it. The usual extension is .drd.
 *
 * The file appears whole or not at all, as by decimesh_mesh_write(). path is UTF-8. Fails with _NULL, _UTF8, _IO
 * or _OPTION (the hierarchy is one of a surface). Linear in the samples; any thread.
 */
decimesh_status decimesh_hierarchy_write(const struct decimesh_hierarchy *hierarchy,
                                         const char *path);

/**
 * Reads a hierarchy from such a file. path is UTF-8.
 *
 * *hierarchy receives the hierarchy, which the caller ends with decimesh_hierarchy_destroy(). Fails with _NULL,
 * _UTF8, _IO or _FORMAT (the text says at which byte). Time and memory are in proportion to what is read, and about
 * half of what decimesh_hierarchy_create() takes; any thread.
 */
decimesh_status decimesh_hierarchy_read(const char *path,
                                        struct decimesh_hierarchy **hierarchy);

/**
 * Remeshes a mesh, an oriented manifold with or without borders, to a semi-regular surface, and decomposes that: a
 * base of about base_quads quads (at least 1; 400 is a good number), each halved depth times (at least once) to
 * 4^depth squares whose corners lie on the mesh.
 *
 * Errors are then distances in space between the vertices of the surface and where they are in the result. options
 * may be NULL; what it says of heights is not looked at.
 *
 * *hierarchy receives the hierarchy, which the caller ends with decimesh_hierarchy_destroy(). Fails with _NULL,
 * _EMPTY, _OPTION (the mesh is no such manifold, and the text says where; or the base cannot be halved so often),
 * _STRUCT_SIZE, _UNKNOWN_OPTION, _CANCELLED or _THREADS. About 20 microseconds a vertex of the surface, and 120
 * bytes. Any thread; progress is told on the calling one.
 */
decimesh_status decimesh_hierarchy_remesh(const struct decimesh_mesh *mesh,
                                          uint32_t depth,
                                          size_t base_quads,
                                          const struct decimesh_hierarchy_options *options,
                                          struct decimesh_hierarchy **hierarchy);

/**
 * Ends a hierarchy. NULL is left alone.
 *
 * No other thread may use it any more. Meshes taken from it live on.
 */
void decimesh_hierarchy_destroy(struct decimesh_hierarchy *hierarchy);

/**
 * How many samples are not void, or how many vertices the surface has; 0 for NULL. Constant time; any thread; never
 * fails.
 */
size_t decimesh_hierarchy_samples(const struct decimesh_hierarchy *hierarchy);

/**
 * The mesh with as much detail as is wanted: detail is a DECIMESH_DETAIL_ value, and value how much of it.
 *
 * x grows with the column, y falls with the row, z is the height; triangles are counter-clockwise from above, and
 * texture coordinates those of an image with a pixel a sample. The mesh is conforming, and its vertices are among
 * those of every finer one; but for a grid that is not of 2^d + 1 columns and rows, which is cut off at its
 * edges: vertices there may lie between heights. No triangle covers a void.
 *
 * No sample is farther than max_error from the surface, vertically: there are more vertices if it takes more.
 * INFINITY for no such bound.
 *
 * *mesh receives the mesh, which the caller ends with decimesh_mesh_destroy(). report may be NULL; with it, the
 * largest error is measured, in time linear in the samples. Of a surface there are vertices, ratios and RMS alone, in
 * time linear in what comes out. Fails with _NULL, _ENUM, _OPTION or _STRUCT_SIZE.
 * Otherwise the time is linear in what comes out for vertices and ratios of a grid of 2^d + 1 columns and rows
 * without voids, times the logarithm of the samples for others; and n log n in the samples where errors are
 * bounded. Any thread.
 */
decimesh_status decimesh_hierarchy_at(const struct decimesh_hierarchy *hierarchy,
                                      decimesh_detail detail,
                                      double value,
                                      double max_error,
                                      struct decimesh_mesh **mesh,
                                      struct decimesh_hierarchy_report *report);

/**
 * A free triangulation of at most so many vertices: 5 decibels or more closer to the heights than what
 * decimesh_hierarchy_at() gives with as many, but not nested in finer ones. With least_squares 1 its heights are
 * fitted to all samples, and are no longer those of samples themselves; with 0 they are.
 *
 * The rim of what is known is covered exactly, which may take more vertices than asked for. progress may be NULL.
 * *mesh receives the mesh, which the caller ends with decimesh_mesh_destroy(). report may be NULL; its
 * certified_gap becomes infinite. Fails with _NULL, _OPTION (also for a surface), _STRUCT_SIZE or _CANCELLED. About linear in the
 * samples, and n log n in the vertices. Any thread; progress is told on the calling one.
 */
decimesh_status decimesh_hierarchy_tin(const struct decimesh_hierarchy *hierarchy,
                                       size_t vertices,
                                       int32_t least_squares,
                                       decimesh_progress progress,
                                       void *progress_user,
                                       struct decimesh_mesh **mesh,
                                       struct decimesh_hierarchy_report *report);

#ifdef __cplusplus
}  // extern "C"
#endif  // __cplusplus

#endif  /* DECIMESH_H */
