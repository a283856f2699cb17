/// \file
/// One contender on one mesh, in a process of its own. What it took is printed as one line of JSON, the row
/// that the contenders of Python print too; `scripts/benchmarks.sh` runs them all.
///
///     peers CONTENDER IN OUT TRIANGLES RUNS SECONDS
///     peers --weld IN OUT
///
/// Runs `CONTENDER` at most `RUNS` times, but not once more after `SECONDS`. The second form makes of a file of
/// any kind one that the first takes. Fails only where it cannot say anything: a contender that fails is a row.

#include "contender.hpp"
#include "files.hpp"
#include "memory.hpp"
#include "meshes.hpp"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace {

using namespace comparison;
using Clock = std::chrono::steady_clock;

/// Of the mesh on which each contender warms up: 2 x 16² triangles.
constexpr int warming_cells = 16;

double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

std::vector<Contender> contenders() {
    return {
        decimesh_default(1),
        decimesh_default(2),
        meshoptimizer_simplify(),
        meshoptimizer_update(),
        meshoptimizer_sloppy(),
#ifdef COMPARISON_CGAL
        cgal_lindstrom_turk(),
        cgal_garland_heckbert(),
#endif
#ifdef COMPARISON_OPENMESH
        openmesh_quadric(),
        openmesh_multiple_choice(),
#endif
    };
}

Contender find(const std::string &name) {
    for (Contender &contender : contenders())
        if (contender.name == name)
            return std::move(contender);
    throw std::runtime_error("not built: its library was not found");
}

/// What a contender did, step by step.
struct Run {
    double load_seconds;
    double simplify_seconds;
    double unload_seconds;
    /// Added by loading and the call, at their highest.
    std::optional<std::size_t> peak_bytes;
    Mesh result;
};

Run run(const Contender &contender, const Mesh &mesh, std::size_t triangles) {
    Run run{};
    const auto before = begin_peak();
    auto start = Clock::now();
    const auto task = contender.load(mesh);
    run.load_seconds = seconds_since(start);
    start = Clock::now();
    task->simplify(triangles);
    run.simplify_seconds = seconds_since(start);
    // The pages of libraries and of threads come and go beside the counter: it may end below where it began.
    if (before)
        run.peak_bytes = std::max(peak_bytes(), *before) - *before;
    start = Clock::now();
    run.result = task->result();
    run.unload_seconds = seconds_since(start);
    return run;
}

std::string quoted(const std::string &text) {
    std::string quoted = "\"";
    for (const char character : text) {
        if (character == '"' || character == '\\')
            quoted += '\\';
        // Messages of several lines, too, become one.
        quoted += static_cast<unsigned char>(character) < ' ' ? ' ' : character;
    }
    return quoted + '"';
}

std::string list(const std::vector<Run> &runs, double Run::*seconds) {
    std::string list;
    for (const Run &run : runs) {
        char text[32];
        std::snprintf(text, sizeof text, "%s%.9f", list.empty() ? "" : ", ", run.*seconds);
        list += text;
    }
    return '[' + list + ']';
}

void measure(const Contender &contender, const std::string &input, const std::string &output, std::size_t triangles,
             std::size_t most, double seconds) {
    // Code and tables come into memory when they are first used; that is nobody's price for this mesh.
    run(contender, wavy_field(warming_cells), static_cast<std::size_t>(warming_cells * warming_cells));
    const Mesh mesh = read(input);
    const auto start = Clock::now();
    std::vector<Run> runs;
    do
        runs.push_back(run(contender, mesh, triangles));
    while (runs.size() < most && seconds_since(start) < seconds);
    // The first run's bytes: later ones find free memory that the first has left.
    const Run &first = runs.front();
    write(first.result, output);
    std::printf("{\"library\": %s, \"load_seconds\": %s, \"simplify_seconds\": %s, \"unload_seconds\": %s, "
                "\"peak_bytes\": %s, \"triangles\": %zu}\n",
                quoted(contender.library).c_str(), list(runs, &Run::load_seconds).c_str(),
                list(runs, &Run::simplify_seconds).c_str(), list(runs, &Run::unload_seconds).c_str(),
                first.peak_bytes ? std::to_string(*first.peak_bytes).c_str() : "null", first.result.triangles.size());
}

} // namespace

int main(int count, char **arguments) {
    const std::vector<std::string> words(arguments + 1, arguments + count);
    try {
        if (words.size() == 3 && words[0] == "--weld") {
            write(read_welded(words[1]), words[2]);
        } else if (words.size() == 6) {
            measure(find(words[0]), words[1], words[2], std::stoull(words[3]), std::stoull(words[4]),
                    std::stod(words[5]));
        } else {
            std::fputs("usage: peers CONTENDER IN OUT TRIANGLES RUNS SECONDS | peers --weld IN OUT\n", stderr);
            return EXIT_FAILURE;
        }
    } catch (const std::exception &error) {
        std::printf("{\"failure\": %s}\n", quoted(error.what()).c_str());
        return words.front() == "--weld" ? EXIT_FAILURE : EXIT_SUCCESS;
    }
    return EXIT_SUCCESS;
}
