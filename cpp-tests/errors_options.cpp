/// Options out of their range, values that do not exist, structs of other sizes.

#include <cmath>
#include <functional>
#include <limits>

#include "calls.hpp"

using calls::check_refused;

TEST_SUITE_BEGIN("quick");

namespace {

struct Defect {
    std::string name;
    decimesh_status status;
    std::vector<const char *> words;
    std::function<void(decimesh_simplify_options &)> make;
};

std::function<void(decimesh_simplify_options &)> target(decimesh_target kind, double value) {
    return [=](decimesh_simplify_options &options) {
        options.target = kind;
        options.target_value = value;
    };
}

const std::uint32_t no_such_vertex[] = {3, 25};
/// Those of the 25 vertices of a plane of four by four cells.
const std::uint8_t unknown_flags[25] = {0, 1, 2, 3, 4, 5, 6, 7, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0xFF};
std::uint32_t unused_room[32];
const double infinity = std::numeric_limits<double>::infinity();

const std::vector<Defect> defects = {
    {"a ratio above 1", DECIMESH_ERROR_OPTION, {"ratio", "1.5"}, target(DECIMESH_TARGET_RATIO, 1.5)},
    {"a negative ratio", DECIMESH_ERROR_OPTION, {"ratio", "-0.5"}, target(DECIMESH_TARGET_RATIO, -0.5)},
    {"a ratio that is no number", DECIMESH_ERROR_OPTION, {"ratio", "NaN"}, target(DECIMESH_TARGET_RATIO, NAN)},
    {"half a triangle", DECIMESH_ERROR_OPTION, {"2.5"}, target(DECIMESH_TARGET_TRIANGLES, 2.5)},
    {"fewer triangles than none", DECIMESH_ERROR_OPTION, {"-4"}, target(DECIMESH_TARGET_TRIANGLES, -4)},
    {"no number of triangles", DECIMESH_ERROR_OPTION, {"NaN"}, target(DECIMESH_TARGET_TRIANGLES, NAN)},
    {"infinitely many triangles", DECIMESH_ERROR_OPTION, {"inf"}, target(DECIMESH_TARGET_TRIANGLES, infinity)},
    {"half a vertex", DECIMESH_ERROR_OPTION, {"0.5"}, target(DECIMESH_TARGET_VERTICES, 0.5)},
    {"a negative error", DECIMESH_ERROR_OPTION, {"-1"}, target(DECIMESH_TARGET_MAX_ERROR, -1)},
    {"an infinite error", DECIMESH_ERROR_OPTION, {"inf"}, target(DECIMESH_TARGET_MAX_ERROR, infinity)},
    {"an error that is no number", DECIMESH_ERROR_OPTION, {"NaN"}, target(DECIMESH_TARGET_MAX_ERROR, NAN)},
    {"a target that does not exist", DECIMESH_ERROR_ENUM, {"target is 4"}, target(4, 0.5)},
    {"a negative target", DECIMESH_ERROR_ENUM, {"target is -1"}, target(-1, 0.5)},
    {"a selection that does not exist", DECIMESH_ERROR_ENUM, {"selection is 2"},
     [](auto &options) { options.selection = 2; }},
    {"a topology that does not exist", DECIMESH_ERROR_ENUM, {"topology is 99"},
     [](auto &options) { options.topology = 99; }},
    {"a placement that does not exist", DECIMESH_ERROR_ENUM, {"placement is -7"},
     [](auto &options) { options.placement = -7; }},
    {"a switch that is neither on nor off", DECIMESH_ERROR_OPTION, {"lock_boundary is 2"},
     [](auto &options) { options.lock_boundary = 2; }},
    {"another", DECIMESH_ERROR_OPTION, {"keep_seams is -1"}, [](auto &options) { options.keep_seams = -1; }},
    {"a third", DECIMESH_ERROR_OPTION, {"cross_seams is 7"}, [](auto &options) { options.cross_seams = 7; }},
    {"a fourth", DECIMESH_ERROR_OPTION, {"refine is 2"}, [](auto &options) { options.refine = 2; }},
    {"refined vertices that stay", DECIMESH_ERROR_OPTION, {"refine"},
     [](auto &options) {
         options.refine = 1;
         options.placement = DECIMESH_PLACEMENT_EXISTING;
     }},
    {"a negative weight", DECIMESH_ERROR_OPTION, {"normals", "-1"},
     [](auto &options) { options.normal_weight = -1; }},
    {"an infinite weight", DECIMESH_ERROR_OPTION, {"uvs", "inf"},
     [](auto &options) { options.uv_weight = std::numeric_limits<float>::infinity(); }},
    {"a weight that is no number", DECIMESH_ERROR_OPTION, {"colors", "NaN"},
     [](auto &options) { options.color_weight = NAN; }},
    {"flags of the future", DECIMESH_ERROR_OPTION, {"vertex 24", "248"},
     [](auto &options) { options.vertex_flags = unknown_flags; }},
    {"room for groups that there are not", DECIMESH_ERROR_OPTION, {"result_groups", "triangle_groups"},
     [](auto &options) { options.result_groups = unused_room; }},
    {"a heap without records", DECIMESH_ERROR_OPTION, {"record"},
     [](auto &options) {
         options.selection = DECIMESH_SELECTION_REPLACEMENT;
         options.heap_records = 0;
     }},
    {"a locked vertex that does not exist", DECIMESH_ERROR_OPTION, {"locked vertex 25", "25 vertices"},
     [](auto &options) {
         options.locked_vertices = no_such_vertex;
         options.locked_count = 2;
     }},
    {"more locked vertices than there can be", DECIMESH_ERROR_OPTION, {"locked_count"},
     [](auto &options) {
         options.locked_vertices = no_such_vertex;
         options.locked_count = SIZE_MAX;
     }},
    {"a switch that is neither on nor off", DECIMESH_ERROR_OPTION, {"level_origins is 2"},
     [](auto &options) { options.level_origins = 2; }},
    {"an option of the future", DECIMESH_ERROR_UNKNOWN_OPTION, {"reserved is 1"},
     [](auto &options) { options.reserved = 1; }},
};

/// Memory for a struct of any version.
struct alignas(8) Room {
    unsigned char bytes[4096];
};

/// A struct that says it is `size` bytes long, with all behind its own fields `filling`.
template <class Raw>
Room resized(const Raw &raw, std::size_t size, unsigned char filling) {
    Room room;
    std::memset(room.bytes, filling, sizeof room.bytes);
    std::memcpy(room.bytes, &raw, std::min(size, sizeof raw));
    const auto struct_size = static_cast<std::uint32_t>(size);
    std::memcpy(room.bytes, &struct_size, sizeof struct_size);
    return room;
}

template <class Raw>
const Raw *as(const Room &room) {
    return reinterpret_cast<const Raw *>(room.bytes);
}

template <class Raw>
Raw *as(Room &room) {
    return reinterpret_cast<Raw *>(room.bytes);
}

/// What must hold of a struct that the library reads, whatever it is: `call` makes a call with it.
template <class Raw, class Call>
void check_sizes(const Raw &good, const char *name, Call call) {
    CAPTURE(std::string(name));
    // Whatever these say they hold, no more than the size may be looked at.
    for (const std::size_t size : {std::size_t{0}, std::size_t{4}, std::size_t{8}, std::size_t{15},
                                   sizeof(Raw) - 4, sizeof(Raw) + 1, std::size_t{1} << 30}) {
        CAPTURE(size);
        const Room room = resized(good, size, 0xFF);
        check_refused(call(as<Raw>(room)), DECIMESH_ERROR_STRUCT_SIZE, {"struct_size", name});
    }
    const Room longer = resized(good, 4096, 0);
    check_refused(call(as<Raw>(longer)), DECIMESH_OK, {});
    for (const std::size_t place : {sizeof(Raw), std::size_t{4095}}) {
        Room newer = longer;
        newer.bytes[place] = 1;
        check_refused(call(as<Raw>(newer)), DECIMESH_ERROR_UNKNOWN_OPTION, {name, std::to_string(place).c_str()});
    }
}

/// What must hold of a struct that the library writes: `call` makes a call that succeeds with it.
template <class Raw, class Call>
void check_written_sizes(const char *name, Call call) {
    CAPTURE(std::string(name));
    const auto untouched = calls::untouched_struct<Raw>();
    for (const std::size_t size : {std::size_t{0}, std::size_t{4}, sizeof(Raw) - 4, std::size_t{1} << 30}) {
        CAPTURE(size);
        Room room = resized(untouched, size, calls::untouched);
        const Room before = room;
        check_refused(call(as<Raw>(room)), DECIMESH_ERROR_STRUCT_SIZE, {"struct_size", name});
        CHECK(std::memcmp(&room, &before, sizeof room) == 0);
    }
    Room full = resized(untouched, sizeof(Raw), calls::untouched);
    check_refused(call(as<Raw>(full)), DECIMESH_OK, {});
    for (const std::size_t size : {std::size_t{16}, std::size_t{24}, sizeof(Raw), std::size_t{4096}}) {
        CAPTURE(size);
        Room room = resized(untouched, size, calls::untouched);
        check_refused(call(as<Raw>(room)), DECIMESH_OK, {});
        const std::size_t written = std::min(size, sizeof(Raw));
        CHECK(std::memcmp(room.bytes + 4, full.bytes + 4, written - 4) == 0);
        CHECK(std::all_of(room.bytes + written, room.bytes + sizeof room.bytes,
                          [](unsigned char byte) { return byte == calls::untouched; }));
        std::uint32_t struct_size = 0;
        std::memcpy(&struct_size, room.bytes, sizeof struct_size);
        CHECK(struct_size == size);
    }
}

}   // namespace

TEST_CASE("errors: options out of range are refused by every call that takes them") {
    for (const calls::Named &named : calls::on_options) {
        for (const Defect &defect : defects) {
            CAPTURE(named.name);
            CAPTURE(defect.name);
            shapes::Dressed dressed(shapes::plane(4));
            const decimesh_buffers buffers = dressed.raw();
            const Bytes before = dressed.bytes();
            decimesh_simplify_options options = calls::default_options();
            defect.make(options);
            check_refused(named.call(&buffers, &options), defect.status, {});
            const std::string message = decimesh_last_error_message();
            CAPTURE(message);
            for (const char *word : defect.words) {
                CHECK(checks::says(message, {word}));
            }
            CHECK(dressed.bytes() == before);
        }
    }
}

TEST_CASE("errors: origins are written on success alone") {
    shapes::Dressed dressed(shapes::plane(4));
    const decimesh_buffers buffers = dressed.raw();
    const std::vector<std::uint32_t> unset(dressed.shape.positions.size(), 0xABABABAB);
    for (const calls::Named &named : calls::on_options) {
        CAPTURE(named.name);
        const bool has_none = named.name.find("_build") != std::string::npos;
        std::vector<std::uint32_t> origins = unset;
        decimesh_simplify_options options = calls::default_options();
        options.origins = origins.data();
        options.target_value = 2;
        check_refused(named.call(&buffers, &options), DECIMESH_ERROR_OPTION, {});
        CHECK(origins == unset);
        options.target_value = 0.5;
        if (has_none) {
            check_refused(named.call(&buffers, &options), DECIMESH_ERROR_OPTION, {"origins"});
            CHECK(origins == unset);
        } else {
            check_refused(named.call(&buffers, &options), DECIMESH_OK, {});
            CHECK(std::count(origins.begin(), origins.end(), 0xABABABAB) == 0);
        }
    }
}

TEST_CASE("errors: other options that are out of range") {
    const decimesh::Mesh owner = shapes::plane(4).mesh();
    decimesh_mesh *made = calls::nobody<decimesh_mesh>();
    for (const float tolerance : {-1.0F, NAN, std::numeric_limits<float>::infinity()}) {
        check_refused(decimesh_mesh_weld(owner.get(), tolerance, &made), DECIMESH_ERROR_OPTION, {"tolerance"});
    }
    check_refused(decimesh_mesh_write(owner.get(), "mesh.ply", 9), DECIMESH_ERROR_ENUM, {"encoding is 9"});
    CHECK(made == calls::nobody<decimesh_mesh>());

    const decimesh_simplify_options options = calls::default_options();
    const double values[] = {0.5, 0.25, -3};
    decimesh_levels *levels = calls::nobody<decimesh_levels>();
    const auto build = [&](std::size_t count) {
        return decimesh_levels_build(owner.get(), &options, values, count, &levels);
    };
    check_refused(build(0), DECIMESH_ERROR_EMPTY, {"count is 0"});
    check_refused(build(SIZE_MAX), DECIMESH_ERROR_OVERFLOW, {"target_values"});
    check_refused(build(3), DECIMESH_ERROR_OPTION, {"-3"});
    CHECK(levels == calls::nobody<decimesh_levels>());
}

TEST_CASE("errors: levels have target values of their own") {
    const decimesh::Mesh owner = shapes::plane(4).mesh();
    decimesh_simplify_options options = calls::default_options();
    options.target = DECIMESH_TARGET_TRIANGLES;
    const double values[] = {20, 10};
    decimesh_levels *levels = nullptr;
    check_refused(decimesh_levels_build(owner.get(), &options, values, 2, &levels), DECIMESH_OK, {});
    CHECK(decimesh_levels_count(levels) == 2);
    decimesh_levels_destroy(levels);
}

TEST_CASE("errors: structs that are read may be newer if nothing in them is unknown") {
    shapes::Dressed dressed(shapes::plane(4));
    const decimesh_buffers buffers = dressed.raw();
    const decimesh_mutable_buffers writable = dressed.raw_mutable();
    const decimesh_simplify_options options = calls::default_options();
    const decimesh::Mesh mesh = dressed.mesh();
    check_sizes(buffers, "decimesh_buffers", [](const decimesh_buffers *raw) {
        decimesh_mesh *made = nullptr;
        const decimesh_status status = decimesh_mesh_from_buffers(raw, &made);
        decimesh_mesh_destroy(made);
        return status;
    });
    check_sizes(options, "decimesh_simplify_options", [&](const decimesh_simplify_options *raw) {
        decimesh_mesh *made = nullptr;
        const decimesh_status status = decimesh_simplify(mesh.get(), raw, &made, nullptr);
        decimesh_mesh_destroy(made);
        return status;
    });
    decimesh_deviation_options measuring;
    decimesh_deviation_options_init(&measuring, sizeof measuring);
    measuring.samples = 100;
    check_sizes(measuring, "decimesh_deviation_options", [&](const decimesh_deviation_options *raw) {
        auto result = calls::untouched_struct<decimesh_deviation_result>();
        return decimesh_deviation(mesh.get(), mesh.get(), raw, &result);
    });
    check_sizes(measuring, "decimesh_deviation_options", [&](const decimesh_deviation_options *raw) {
        std::vector<float> distances(mesh.vertex_count());
        return decimesh_vertex_distances(mesh.get(), mesh.get(), raw, distances.data());
    });
    decimesh_multiple_choice_options choosing;
    decimesh_multiple_choice_options_init(&choosing, sizeof choosing);
    check_sizes(choosing, "decimesh_multiple_choice_options", [&](const decimesh_multiple_choice_options *raw) {
        decimesh_mesh *made = nullptr;
        const decimesh_status status = decimesh_multiple_choice(mesh.get(), 2, raw, &made, nullptr);
        decimesh_mesh_destroy(made);
        return status;
    });
    decimesh_bound_options bounding;
    decimesh_bound_options_init(&bounding, sizeof bounding);
    check_sizes(bounding, "decimesh_bound_options", [&](const decimesh_bound_options *raw) {
        auto result = calls::untouched_struct<decimesh_bound_result>();
        return decimesh_bound(mesh.get(), mesh.get(), raw, &result);
    });
    // Last, because it changes the buffers; a mesh of few triangles stays one.
    check_sizes(writable, "decimesh_mutable_buffers", [&](const decimesh_mutable_buffers *raw) {
        std::size_t count = 0;
        return decimesh_simplify_in_place(raw, &options, &count, nullptr);
    });
}

TEST_CASE("errors: what an older struct lacks is as the init function sets it") {
    const shapes::Dressed dressed(shapes::plane(4));
    const decimesh::Mesh mesh = dressed.mesh();
    decimesh_simplify_options options = calls::default_options();
    options.target_value = 0.25;
    for (std::size_t size = 16; size <= sizeof options; size += 8) {
        CAPTURE(size);
        // What lies behind would be refused, if it were read.
        const Room older = resized(options, size, 0xFF);
        decimesh_mesh *made = nullptr;
        check_refused(decimesh_simplify(mesh.get(), as<decimesh_simplify_options>(older), &made, nullptr),
                      DECIMESH_OK, {});
        checks::check_count(decimesh_mesh_triangle_count(made), 8);
        decimesh_mesh_destroy(made);
    }
    const Room without_colors = resized(dressed.raw(), offsetof(decimesh_buffers, colors), 0xFF);
    decimesh_mesh *made = nullptr;
    check_refused(decimesh_mesh_from_buffers(as<decimesh_buffers>(without_colors), &made), DECIMESH_OK, {});
    CHECK(decimesh_mesh_colors(made) == nullptr);
    CHECK(decimesh_mesh_uvs(made) != nullptr);
    decimesh_mesh_destroy(made);
}

TEST_CASE("errors: structs that are written may be older or newer") {
    const decimesh::Mesh mesh = shapes::plane(4).mesh();
    const decimesh::Levels levels = decimesh::Levels::build(mesh, {decimesh::Target::ratio(0.5)});
    const decimesh_simplify_options options = calls::default_options();
    check_written_sizes<decimesh_simplify_report>("decimesh_simplify_report", [&](decimesh_simplify_report *raw) {
        decimesh_mesh *made = nullptr;
        const decimesh_status status = decimesh_simplify(mesh.get(), &options, &made, raw);
        decimesh_mesh_destroy(made);
        return status;
    });
    check_written_sizes<decimesh_simplify_report>("decimesh_simplify_report", [&](decimesh_simplify_report *raw) {
        return decimesh_levels_report(levels.get(), 0, raw);
    });
    check_written_sizes<decimesh_statistics>("decimesh_statistics", [&](decimesh_statistics *raw) {
        return decimesh_mesh_statistics(mesh.get(), raw);
    });
    decimesh_deviation_options measuring;
    decimesh_deviation_options_init(&measuring, sizeof measuring);
    measuring.samples = 100;
    check_written_sizes<decimesh_deviation_result>("decimesh_deviation_result", [&](decimesh_deviation_result *raw) {
        return decimesh_deviation(mesh.get(), mesh.get(), &measuring, raw);
    });
    check_written_sizes<decimesh_bound_result>("decimesh_bound_result", [&](decimesh_bound_result *raw) {
        return decimesh_bound(mesh.get(), mesh.get(), nullptr, raw);
    });
    check_written_sizes<decimesh_bound_result>("decimesh_bound_result", [&](decimesh_bound_result *raw) {
        decimesh_mesh *made = nullptr;
        const decimesh_status status = decimesh_simplify_within(mesh.get(), 0.1, &options, &made, nullptr, raw);
        decimesh_mesh_destroy(made);
        return status;
    });
    const decimesh::NestedLevels nested = decimesh::NestedLevels::build(mesh, {decimesh::Target::ratio(0.5)});
    check_written_sizes<decimesh_nested_level>("decimesh_nested_level", [&](decimesh_nested_level *raw) {
        return decimesh_nested_describe(nested.get(), 1, raw);
    });
}

TEST_SUITE_END();
