/// Calls of the C interface with their outputs watched: what fails must not have written anything.

#ifndef DECIMESH_TESTS_CALLS_HPP
#define DECIMESH_TESTS_CALLS_HPP

#include <algorithm>
#include <array>
#include <cstring>
#include <initializer_list>

#include <decimesh.h>
#include <doctest/doctest.h>

#include "checks.hpp"
#include "shapes.hpp"

namespace calls {

/// Makes the call on a mesh in buffers, checks that its outputs changed on success alone, and gives the status.
using Call = decimesh_status (*)(const decimesh_buffers *buffers, const decimesh_simplify_options *options);

struct Named {
    std::string name;
    Call call;
};

/// Those that take buffers. The first, which makes a mesh, takes no options.
extern const std::array<Named, 3> on_buffers;
/// Those that take options. Those that make handles make a mesh of the buffers, which must be good, before.
extern const std::array<Named, 6> on_options;

inline decimesh_simplify_options default_options() {
    decimesh_simplify_options options;
    decimesh_simplify_options_init(&options, sizeof options);
    return options;
}

/// What no call writes.
constexpr unsigned char untouched = 0x5A;

/// A struct of the interface that nothing has been written to but its size.
template <class Raw>
Raw untouched_struct() {
    Raw raw;
    std::memset(&raw, untouched, sizeof raw);
    raw.struct_size = static_cast<std::uint32_t>(sizeof raw);
    return raw;
}

template <class Raw>
bool is_untouched(const Raw &raw) {
    const Raw expected = untouched_struct<Raw>();
    return std::memcmp(&raw, &expected, sizeof raw) == 0;
}

/// A handle that is none: what an out-parameter holds before the call.
template <class Handle>
Handle *nobody() {
    static char place;
    return reinterpret_cast<Handle *>(&place);
}

inline void check_refused(decimesh_status status, decimesh_status expected, std::initializer_list<const char *> words) {
    CHECK(std::string(decimesh_status_name(status)) == decimesh_status_name(expected));
    if (status != DECIMESH_OK) {
        const std::string message = decimesh_last_error_message();
        CAPTURE(message);
        CHECK(checks::says(message, words));
    }
}

}   // namespace calls

#endif
