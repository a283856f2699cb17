/// The command line.

#ifndef VIEWER_ARGUMENTS_HPP
#define VIEWER_ARGUMENTS_HPP

#include <cstddef>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "reduction.hpp"
#include "view_settings.hpp"

namespace viewer {

/// A command line that makes no sense; `what()` says why.
class UsageError : public std::invalid_argument {
public:
    using std::invalid_argument::invalid_argument;
};

struct Arguments {
    bool help = false;
    std::string path;                       ///< the mesh to open; empty: none
    Engine engine = Engine::hqms;
    std::optional<std::size_t> triangles;   ///< simplify to so many
    std::optional<std::size_t> levels;      ///< or build so many nested levels
    std::string save_path;                  ///< save the result there; empty: do not
    ViewSettings view;
    bool play = false;                      ///< each frame shows the next level
    float orbit_right = 0;                  ///< degrees
    float orbit_up = 0;
    float zoom = 0;                         ///< steps of the wheel
    int width = 1280;
    int height = 800;
    std::optional<std::size_t> frames;      ///< end after so many
    bool no_wait = false;                   ///< frames count while work is going on
    std::string screenshot_path;            ///< a picture of the last frame; empty: none

    /// Whether the program ends by itself.
    bool ends() const noexcept { return frames.has_value(); }
};

/// What the command line says, without the program's name. Throws `UsageError`.
Arguments parse(const std::vector<std::string_view> &words);

/// What `--help` prints.
const char *usage();

}   // namespace viewer

#endif
