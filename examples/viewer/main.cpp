/// Opens a window, and does in it what the command line and the panel say.

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <deque>
#include <exception>
#include <functional>
#include <string>
#include <vector>

#include "arguments.hpp"
#include "panel.hpp"
#include "screenshot.hpp"
#include "session.hpp"
#include "stage.hpp"
#include "window.hpp"

namespace {

using namespace viewer;

constexpr int usage_status = 2;

/// Seconds between frames in which nothing happens, and while a bar of progress moves.
constexpr double idle_patience = 0.25;
constexpr double busy_patience = 0.03;

/// What the command line asks for, one after the other, each when the one before is done.
std::deque<std::function<void()>> steps_of(const Arguments &arguments, Session &session) {
    std::deque<std::function<void()>> steps;
    if (!arguments.path.empty()) {
        steps.push_back([&] { session.open(arguments.path); });
    }
    if (arguments.triangles) {
        steps.push_back([&] { session.simplify(arguments.engine, *arguments.triangles); });
    }
    if (arguments.levels) {
        steps.push_back([&] { session.build_levels(*arguments.levels); });
    }
    if (!arguments.save_path.empty()) {
        steps.push_back([&] { session.save(arguments.save_path, arguments.view.level); });
    }
    return steps;
}

PanelFields fields_of(const Arguments &arguments) {
    PanelFields fields;
    fields.engine = arguments.engine;
    fields.triangles = static_cast<int>(std::min<std::size_t>(arguments.triangles.value_or(0), INT32_MAX));
    fields.levels = static_cast<int>(std::min(arguments.levels.value_or(6), most_levels));
    if (!arguments.save_path.empty()) {
        fields.save_path = arguments.save_path;
    }
    return fields;
}

/// Says on the terminal what the panel says, once.
class Reporter {
public:
    void report(const Session &session) {
        if (session.message() != last_) {
            last_ = session.message();
            if (!last_.empty()) {
                std::fprintf(session.has_failed() ? stderr : stdout, "%s\n", last_.c_str());
            }
        }
    }

private:
    std::string last_;
};

int run(const Arguments &arguments) {
    Window window(arguments.width, arguments.height, "decimesh");
    Stage stage;
    stage.camera().orbit(arguments.orbit_right, arguments.orbit_up);
    stage.camera().zoom(arguments.zoom);
    Session session;
    ViewSettings view = arguments.view;
    PanelFields fields = fields_of(arguments);
    Reporter reporter;
    std::deque<std::function<void()>> steps = steps_of(arguments, session);
    window.on_drop([&](const std::string &path) {
        steps.clear();
        fields.triangles = 0;
        session.open(path);
    });

    std::size_t frames = 0;
    bool is_over = false;
    while (!is_over && !window.should_close()) {
        session.poll();
        reporter.report(session);
        if (session.has_failed()) {
            steps.clear();
        }
        while (!session.is_busy() && !steps.empty()) {
            const std::function<void()> step = std::move(steps.front());
            steps.pop_front();
            step();
            reporter.report(session);
        }

        const bool is_settled = !session.is_busy() && steps.empty();
        window.begin_frame(arguments.ends() ? 0 : is_settled ? idle_patience : busy_patience);
        stage.draw(session, view, panel_width);
        draw_panel(session, view, fields);
        window.end_frame();
        if (arguments.ends() && (is_settled || arguments.no_wait) && ++frames == *arguments.frames) {
            is_over = true;
            if (!arguments.screenshot_path.empty()) {
                write_screenshot(arguments.screenshot_path, window.width(), window.height());
            }
        }
        window.present();
        if (arguments.play && is_settled && session.level_count() > 0) {
            view.level = (view.level + 1) % session.level_count();
        }
    }
    reporter.report(session);
    if (arguments.ends()) {
        const Scene::Uploads &uploads = stage.scene().uploads();
        std::printf("%zu frames; uploaded %zu vertex buffers, %zu index buffers, %zu value buffers\n", frames,
                    uploads.vertices, uploads.indices, uploads.values);
    }
    return arguments.ends() && session.has_failed() ? EXIT_FAILURE : EXIT_SUCCESS;
}

}   // namespace

int main(int argc, char **argv) {
    try {
        const Arguments arguments = parse({argv + 1, argv + argc});
        if (arguments.help) {
            std::fputs(usage(), stdout);
            return EXIT_SUCCESS;
        }
        return run(arguments);
    } catch (const UsageError &error) {
        std::fprintf(stderr, "decimesh-viewer: %s\n\n%s", error.what(), usage());
        return usage_status;
    } catch (const std::exception &error) {
        std::fprintf(stderr, "decimesh-viewer: %s\n", error.what());
        return EXIT_FAILURE;
    }
}
