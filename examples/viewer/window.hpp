/// The window, its OpenGL, and ImGui in it.

#ifndef VIEWER_WINDOW_HPP
#define VIEWER_WINDOW_HPP

#include <functional>
#include <memory>
#include <string>

struct GLFWwindow;

namespace viewer {

/// A window with OpenGL 3.3 core, current on the thread that made it, and ImGui. One at a time.
class Window {
public:
    /// Throws `std::runtime_error` where there is no display, or no such OpenGL.
    Window(int width, int height, const char *title);
    ~Window();
    Window(const Window &) = delete;
    Window &operator=(const Window &) = delete;

    /// To be called with each file that is dropped onto the window: with the last, if there are several.
    void on_drop(std::function<void(const std::string &path)> handler) { drop_ = std::move(handler); }

    bool should_close() const;

    /// Takes events, waiting up to so many seconds for one, and begins ImGui's frame.
    void begin_frame(double patience);
    /// Draws what ImGui has. It is in the back buffer until `present`.
    void end_frame();
    /// Shows what was drawn.
    void present();

    /// Size of the framebuffer in pixels.
    int width() const;
    int height() const;

private:
    /// GLFW, as long as it is in use.
    struct Library {
        Library();
        ~Library();
        Library(const Library &) = delete;
        Library &operator=(const Library &) = delete;
    };
    struct Destroy {
        void operator()(GLFWwindow *window) const;
    };

    Library library_;
    std::unique_ptr<GLFWwindow, Destroy> window_;
    std::function<void(const std::string &path)> drop_;
};

}   // namespace viewer

#endif
