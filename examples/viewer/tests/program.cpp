#include "program.hpp"

#include <array>
#include <cstdio>
#include <cstdlib>
#include <stdexcept>

#include <sys/wait.h>

Ended run(const std::string &command) {
    std::FILE *stream = popen(("{ " + command + "; } 2>&1").c_str(), "r");
    if (stream == nullptr) {
        throw std::runtime_error("cannot run " + command);
    }
    Ended ended{0, ""};
    std::array<char, 4096> bytes{};
    for (std::size_t count = 0; (count = std::fread(bytes.data(), 1, bytes.size(), stream)) > 0;) {
        ended.output.append(bytes.data(), count);
    }
    const int status = pclose(stream);
    ended.status = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    return ended;
}

Ended view(const std::string &arguments) {
    const char *program = std::getenv("VIEWER");
    if (program == nullptr) {
        throw std::runtime_error("VIEWER does not say which program to run");
    }
    return run("'" + std::string(program) + "' " + arguments);
}
