#include "arguments.hpp"

#include <charconv>
#include <cstdint>

namespace viewer {

namespace {

/// Frames before a picture, if nobody says how many: ImGui lays its windows out in the first.
constexpr std::size_t frames_of_a_screenshot = 3;
/// Pixels of a side. OpenGL 3.3 draws no larger for certain.
constexpr int most_pixels = 8192;

template <class Number>
Number number(std::string_view option, std::string_view text, Number least, Number most) {
    Number value{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || !(value >= least && value <= most)) {
        throw UsageError(std::string(option) + " is no such number: '" + std::string(text) + "'");
    }
    return value;
}

std::size_t count(std::string_view option, std::string_view text) {
    return number<std::size_t>(option, text, 0, SIZE_MAX);
}

Engine engine(std::string_view name) {
    for (const Engine engine : all_engines) {
        if (name == name_of(engine)) {
            return engine;
        }
    }
    throw UsageError("--engine is hqms, indices or multiple-choice, not '" + std::string(name) + "'");
}

Layout layout(std::string_view name) {
    if (name == "original") {
        return Layout::original;
    }
    if (name == "result") {
        return Layout::result;
    }
    if (name == "side-by-side") {
        return Layout::side_by_side;
    }
    if (name == "deviation") {
        return Layout::deviation;
    }
    throw UsageError("--view is original, result, side-by-side or deviation, not '" + std::string(name) + "'");
}

}   // namespace

Arguments parse(const std::vector<std::string_view> &words) {
    Arguments arguments;
    for (std::size_t at = 0; at < words.size(); ++at) {
        const std::string_view word = words[at];
        const auto value = [&] {
            if (at + 1 == words.size()) {
                throw UsageError(std::string(word) + " wants a value");
            }
            return words[++at];
        };
        if (word == "--help" || word == "-h") {
            arguments.help = true;
        } else if (word == "--engine") {
            arguments.engine = engine(value());
        } else if (word == "--triangles") {
            arguments.triangles = count(word, value());
        } else if (word == "--levels") {
            arguments.levels = count(word, value());
        } else if (word == "--save") {
            arguments.save_path = value();
        } else if (word == "--view") {
            arguments.view.layout = layout(value());
        } else if (word == "--level") {
            arguments.view.level = count(word, value());
        } else if (word == "--play") {
            arguments.play = true;
        } else if (word == "--wireframe") {
            arguments.view.wireframe = true;
        } else if (word == "--facets") {
            arguments.view.facets = true;
        } else if (word == "--scale") {
            arguments.view.scale = number(word, value(), 0.01F, 1.0F);
        } else if (word == "--orbit") {
            arguments.orbit_right = number(word, value(), -360.0F, 360.0F);
            arguments.orbit_up = number(word, value(), -180.0F, 180.0F);
        } else if (word == "--zoom") {
            arguments.zoom = number(word, value(), -100.0F, 100.0F);
        } else if (word == "--size") {
            arguments.width = number(word, value(), 1, most_pixels);
            arguments.height = number(word, value(), 1, most_pixels);
        } else if (word == "--frames") {
            arguments.frames = number<std::size_t>(word, value(), 1, SIZE_MAX);
        } else if (word == "--no-wait") {
            arguments.no_wait = true;
        } else if (word == "--screenshot") {
            arguments.screenshot_path = value();
        } else if (word.starts_with("-") && word != "-") {
            throw UsageError("there is no option " + std::string(word));
        } else if (!arguments.path.empty()) {
            throw UsageError("one mesh at a time: " + arguments.path + ", or " + std::string(word));
        } else {
            arguments.path = word;
        }
    }
    if (arguments.triangles && arguments.levels) {
        throw UsageError("--triangles or --levels, not both");
    }
    if (arguments.path.empty() && (arguments.triangles || arguments.levels || !arguments.save_path.empty())) {
        throw UsageError("there is no mesh to simplify: name one");
    }
    if (!arguments.save_path.empty() && !arguments.triangles && !arguments.levels) {
        throw UsageError("there would be no result to save: give --triangles or --levels");
    }
    if (!arguments.screenshot_path.empty() && !arguments.frames) {
        arguments.frames = frames_of_a_screenshot;
    }
    return arguments;
}

const char *usage() {
    return R"(decimesh-viewer [MESH] [OPTION...]

Shows a mesh (PLY, OBJ, STL, OFF, glTF, GLB) and what decimesh makes of it.

  --triangles N            simplify to N triangles
  --engine NAME            hqms, by new vertices (the default); indices, by those that there are; multiple-choice, the
                           same as Jia, Tang and Pan do it
  --levels N               build N nested levels instead, each of half as many triangles as the one before
  --save FILE              save the result, or the level shown; nested levels to a .glb all together

  --view original|result|side-by-side|deviation
  --level N                which of the nested levels to show; 0 is the original
  --wireframe              draw edges too
  --facets                 show flat triangles
  --scale S                end the scale of the deviation at this share of the largest, 0.01 to 1
  --orbit RIGHT UP         go around the mesh, in degrees
  --zoom STEPS             go nearer by so many steps of the wheel
  --size WIDTH HEIGHT      of the window, in pixels

  --frames N               end after N frames with all work done; 1 is the exit status if something failed
  --no-wait                count frames while work is going on, too, and cancel it in the end
  --play                   each frame shows the next level
  --screenshot FILE.png    write the last frame; of three, if --frames says nothing
)";
}

}   // namespace viewer
