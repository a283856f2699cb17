/// Programs that are started and waited for.

#ifndef VIEWER_TESTS_PROGRAM_HPP
#define VIEWER_TESTS_PROGRAM_HPP

#include <string>

/// How a program ended.
struct Ended {
    int status;           ///< what it exited with; above 128 if a signal ended it
    std::string output;   ///< what it wrote to both streams

    bool says(const std::string &words) const { return output.find(words) != std::string::npos; }
};

/// Runs a command by the shell, and waits until it has ended.
Ended run(const std::string &command);

/// Runs the viewer with these arguments, as the shell takes them apart. It is the program that the environment variable
/// VIEWER names.
Ended view(const std::string &arguments);

#endif
