/// \file
/// decimesh, CGAL, OpenMesh and meshoptimizer on the same meshes in one run: time, memory and error, as
/// Markdown. `scripts/peers.sh` builds and runs it.

#include "contender.hpp"
#include "distance.hpp"
#include "memory.hpp"
#include "meshes.hpp"

#include <CGAL/version.h>
#include <OpenMesh/Core/System/config.h>
#include <decimesh.h>
#include <meshoptimizer.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <fstream>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

using namespace comparison;

struct Settings {
    int rounds = 5;
    double share = 0.1;
    std::size_t samples = 500'000;
    std::vector<std::string> files;
};

/// What one contender did in all rounds.
struct Measurement {
    std::vector<double> load_seconds;
    std::vector<double> simplify_seconds;
    /// Its own form of the input, and the most that it held at once, that form included.
    std::size_t loaded_bytes = 0;
    std::size_t peak_bytes = 0;
    std::optional<Mesh> result;
    std::string failure;
};

double seconds_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

double median(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    const std::size_t middle = values.size() / 2;
    return values.size() % 2 == 1 ? values[middle] : 0.5 * (values[middle - 1] + values[middle]);
}

void run(const Contender &contender, const Mesh &mesh, std::size_t triangles, Measurement &measurement) {
    const std::size_t before = allocated_bytes();
    reset_peak_bytes();
    auto start = std::chrono::steady_clock::now();
    const auto task = contender.load(mesh);
    measurement.load_seconds.push_back(seconds_since(start));
    measurement.loaded_bytes = allocated_bytes() - before;
    start = std::chrono::steady_clock::now();
    task->simplify(triangles);
    measurement.simplify_seconds.push_back(seconds_since(start));
    measurement.peak_bytes = std::max(measurement.peak_bytes, peak_bytes() - before);
    if (!measurement.result)
        measurement.result = task->result();
}

/// Each contender once, then each once more: a machine that slows down meanwhile does so for all.
std::vector<Measurement> play(const std::vector<Contender> &contenders, const Mesh &mesh,
                              std::size_t triangles, int rounds) {
    std::vector<Measurement> measurements(contenders.size());
    for (int round = 0; round < rounds; ++round)
        for (std::size_t place = 0; place < contenders.size(); ++place) {
            if (!measurements[place].failure.empty())
                continue;
            try {
                run(contenders[place], mesh, triangles, measurements[place]);
            } catch (const std::exception &error) {
                measurements[place].failure = error.what();
            }
        }
    return measurements;
}

void print_row(const std::string &name, const Measurement &measurement, const Surface &original,
               const Mesh &mesh, std::size_t samples) {
    if (!measurement.failure.empty()) {
        std::printf("| %s | %s | | | | | | |\n", name.c_str(), measurement.failure.c_str());
        return;
    }
    const Distance apart = distance(original, Surface(*measurement.result), samples);
    const auto triangles = static_cast<double>(mesh.triangles.size());
    std::printf("| %s | %zu | %.1f | %.1f | %.0f | %.0f | %.2e | %.2e |\n", name.c_str(),
                measurement.result->triangles.size(), 1e3 * median(measurement.load_seconds),
                1e3 * median(measurement.simplify_seconds),
                static_cast<double>(measurement.loaded_bytes) / triangles,
                static_cast<double>(measurement.peak_bytes) / triangles, apart.rms, apart.maximum);
}

void print_table(const std::string &path, const std::vector<Contender> &contenders, const Settings &settings) {
    const Mesh mesh = read(path);
    const Surface original(mesh);
    const auto triangles =
        static_cast<std::size_t>(settings.share * static_cast<double>(mesh.triangles.size()));
    const auto name = std::filesystem::path(path).stem().string();
    std::printf("\n| %s, %zu to %zu | triangles | load ms | simplify ms | loaded B/tri | peak B/tri | RMS | "
                "maximum |\n| --- | --: | --: | --: | --: | --: | --: | --: |\n",
                name.c_str(), mesh.triangles.size(), triangles);
    const auto measurements = play(contenders, mesh, triangles, settings.rounds);
    for (std::size_t place = 0; place < contenders.size(); ++place)
        print_row(contenders[place].name, measurements[place], original, mesh, settings.samples);
    std::fflush(stdout);
}

std::string processor() {
    std::ifstream file("/proc/cpuinfo");
    const std::string key = "model name";
    for (std::string line; std::getline(file, line);)
        if (line.compare(0, key.size(), key) == 0 && line.find(": ") != std::string::npos)
            return line.substr(line.find(": ") + 2);
    return "unknown processor";
}

void print_setting(const Settings &settings) {
    std::printf("decimesh %s, CGAL %s, OpenMesh %d.%d, meshoptimizer %d.%d; %s.\n\n", decimesh_version_string(),
                CGAL_VERSION_STR, (OM_VERSION & 0xf0000) >> 16, (OM_VERSION & 0x0ff00) >> 8,
                MESHOPTIMIZER_VERSION / 1000, MESHOPTIMIZER_VERSION / 10 % 100, processor().c_str());
    std::printf("Medians of %d rounds, contenders in turns; one thread each but where it says two. load: from\n"
                "indexed buffers to the mesh that the library works on; simplify: from there to its result in\n"
                "that form. B/tri: bytes allocated for each triangle of the input, beyond the input's buffers:\n"
                "that mesh, and the peak of both steps, that mesh included. RMS, maximum: two-sided distance by\n"
                "CGAL's AABB tree, %zu samples a side and the vertices, over the diagonal.\n",
                settings.rounds, settings.samples);
}

Settings parse(int count, char **arguments) {
    Settings settings;
    bool quick = false;
    for (int index = 1; index < count; ++index) {
        const std::string argument = arguments[index];
        const auto value = [&] {
            if (++index == count)
                throw std::runtime_error(argument + " takes a number");
            return std::stod(arguments[index]);
        };
        if (argument == "--quick")
            quick = true;
        else if (argument == "--rounds")
            settings.rounds = std::max(1, static_cast<int>(value()));
        else if (argument == "--share")
            settings.share = value();
        else if (argument.rfind("--", 0) == 0)
            throw std::runtime_error("unknown option " + argument);
        else
            settings.files.push_back(argument);
    }
    if (quick) {
        settings.rounds = 1;
        settings.samples = 20'000;
    }
    const auto archived = [](const char *name) { return std::string(COMPARISON_MESHES) + "/" + name; };
    std::vector<std::string> files;
    if (quick)
        files = {archived("mannequin-devil.off")};
    else
        for (const char *name : {"refined_elephant.off", "bunny00.off", "armadillo.off", "fandisk_large.off",
                                 "mannequin-devil.off"})
            files.push_back(archived(name));
    settings.files.insert(settings.files.begin(), files.begin(), files.end());
    return settings;
}

} // namespace

int main(int count, char **arguments) {
    try {
        const Settings settings = parse(count, arguments);
        const std::vector<Contender> contenders{
            decimesh_default(1),      decimesh_default(2), cgal_lindstrom_turk(),
            cgal_garland_heckbert(),  openmesh_quadric(),  openmesh_multiple_choice(),
            meshoptimizer_simplify(), meshoptimizer_update()};
        print_setting(settings);
        for (const std::string &file : settings.files)
            print_table(file, contenders, settings);
    } catch (const std::exception &error) {
        std::fprintf(stderr, "error: %s\n", error.what());
        return EXIT_FAILURE;
    }
    return EXIT_SUCCESS;
}
