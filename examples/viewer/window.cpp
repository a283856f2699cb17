#include "window.hpp"

#include <stdexcept>

#include <epoxy/gl.h>
// After epoxy, which brings OpenGL.
#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <imgui.h>

namespace viewer {

namespace {

[[noreturn]] void fail(const std::string &what) {
    const char *reason = nullptr;
    glfwGetError(&reason);
    throw std::runtime_error(what + (reason == nullptr ? "" : std::string(": ") + reason));
}

}   // namespace

Window::Library::Library() {
    if (glfwInit() == GLFW_FALSE) {
        fail("cannot reach a display");
    }
}

Window::Library::~Library() {
    glfwTerminate();
}

void Window::Destroy::operator()(GLFWwindow *window) const {
    glfwDestroyWindow(window);
}

Window::Window(int width, int height, const char *title) {
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
    glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
    glfwWindowHint(GLFW_OPENGL_FORWARD_COMPAT, GLFW_TRUE);
    window_.reset(glfwCreateWindow(width, height, title, nullptr, nullptr));
    if (!window_) {
        fail("cannot open a window with OpenGL 3.3");
    }
    glfwMakeContextCurrent(window_.get());
    glfwSwapInterval(1);
    glfwSetWindowUserPointer(window_.get(), this);
    glfwSetDropCallback(window_.get(), [](GLFWwindow *raw, int count, const char **paths) {
        const auto &window = *static_cast<const Window *>(glfwGetWindowUserPointer(raw));
        if (count > 0 && window.drop_) {
            window.drop_(paths[count - 1]);
        }
    });

    ImGui::CreateContext();
    // No file beside the program that remembers where windows were.
    ImGui::GetIO().IniFilename = nullptr;
    ImGui::StyleColorsDark();
    ImGui_ImplGlfw_InitForOpenGL(window_.get(), true);
    ImGui_ImplOpenGL3_Init("#version 330 core");
}

Window::~Window() {
    ImGui_ImplOpenGL3_Shutdown();
    ImGui_ImplGlfw_Shutdown();
    ImGui::DestroyContext();
}

bool Window::should_close() const {
    return glfwWindowShouldClose(window_.get()) == GLFW_TRUE;
}

void Window::begin_frame(double patience) {
    if (patience > 0) {
        glfwWaitEventsTimeout(patience);
    } else {
        glfwPollEvents();
    }
    ImGui_ImplOpenGL3_NewFrame();
    ImGui_ImplGlfw_NewFrame();
    ImGui::NewFrame();
}

void Window::end_frame() {
    ImGui::Render();
    glViewport(0, 0, width(), height());
    ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
}

void Window::present() {
    glfwSwapBuffers(window_.get());
}

int Window::width() const {
    int width = 0;
    glfwGetFramebufferSize(window_.get(), &width, nullptr);
    return width;
}

int Window::height() const {
    int height = 0;
    glfwGetFramebufferSize(window_.get(), nullptr, &height);
    return height;
}

}   // namespace viewer
