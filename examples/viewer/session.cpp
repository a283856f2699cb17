#include "session.hpp"

#include <cstdio>
#include <utility>

namespace viewer {

namespace {

std::string counts(std::size_t triangles, std::size_t vertices) {
    return std::to_string(triangles) + " triangles, " + std::to_string(vertices) + " vertices";
}

std::string in_seconds(double seconds) {
    char text[32];
    std::snprintf(text, sizeof text, " in %.2f s", seconds);
    return text;
}

bool ends_with(const std::string &text, const std::string &end) {
    return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

}   // namespace

void Session::open(const std::string &path) {
    begin("reading", [path](const decimesh::Progress &progress) -> Outcome {
        auto original = std::make_shared<const Original>(read(path));
        // Reading knows no progress, but who has cancelled it does not want what was read.
        if (!progress(1)) {
            throw decimesh::Cancelled(decimesh::Status::cancelled, "cancelled");
        }
        return original;
    });
}

void Session::simplify(Engine engine, std::size_t triangles) {
    if (!original_) {
        return fail("there is no mesh to simplify: open one");
    }
    begin("simplifying", [original = original_, engine, triangles](const decimesh::Progress &progress) -> Outcome {
        return reduce(*original, engine, triangles, progress);
    });
}

void Session::build_levels(std::size_t count) {
    if (!original_) {
        return fail("there is no mesh to make levels of: open one");
    }
    begin("building levels", [original = original_, count](const decimesh::Progress &progress) -> Outcome {
        return viewer::build_levels(*original, count, progress);
    });
}

void Session::save(const std::string &path, std::size_t level) {
    try {
        if (const auto *reduced = std::get_if<Reduced>(&result_)) {
            reduced->mesh.write(path);
        } else if (const auto *set = std::get_if<LevelSet>(&result_)) {
            if (ends_with(path, ".glb")) {
                set->levels.write_glb(path);
            } else {
                mesh_of(set->levels, level).write(path);
            }
        } else {
            return fail("there is no result to save: simplify first");
        }
        say("saved " + path);
    } catch (const std::exception &error) {
        fail(error.what());
    }
}

void Session::cancel() {
    if (job_) {
        job_->cancel();
    }
}

void Session::poll() {
    if (!job_ || !job_->is_done()) {
        return;
    }
    const std::unique_ptr<Job> job = std::move(job_);
    try {
        accept(job->take());
    } catch (const decimesh::Cancelled &) {
        say(activity_ + " was cancelled");
    } catch (const std::exception &error) {
        fail(error.what());
    }
}

std::size_t Session::level_count() const noexcept {
    if (const auto *set = std::get_if<LevelSet>(&result_)) {
        return set->levels.size();
    }
    return std::holds_alternative<Reduced>(result_) ? 1 : 0;
}

const Distances *Session::distances(std::size_t level) const noexcept {
    if (level >= level_count()) {
        return nullptr;
    }
    if (const auto *set = std::get_if<LevelSet>(&result_)) {
        return &set->distances[level];
    }
    return &std::get<Reduced>(result_).distances;
}

void Session::begin(std::string activity, Job::Work work) {
    // Cancels what is going on, and waits for its end.
    job_.reset();
    activity_ = std::move(activity);
    say("");
    job_ = std::make_unique<Job>(std::move(work));
}

void Session::accept(Outcome outcome) {
    if (auto *original = std::get_if<std::shared_ptr<const Original>>(&outcome)) {
        original_ = std::move(*original);
        ++original_version_;
        result_ = std::monostate{};
        say(original_->path + ": " + counts(original_->mesh.triangle_count(), original_->mesh.vertex_count()));
    } else if (auto *reduced = std::get_if<Reduced>(&outcome)) {
        const decimesh::Mesh &mesh = reduced->mesh;
        say(std::string(name_of(reduced->engine)) + ": " + counts(mesh.triangle_count(), mesh.vertex_count()) +
            in_seconds(reduced->seconds));
        result_ = std::move(*reduced);
    } else if (auto *set = std::get_if<LevelSet>(&outcome)) {
        std::string message = "levels" + in_seconds(set->seconds) + ":";
        for (std::size_t level = 0; level < set->levels.size(); ++level) {
            message += ' ';
            message += std::to_string(set->levels.level(level).index_count / 3);
        }
        say(message + " triangles");
        result_ = std::move(*set);
    }
    ++result_version_;
}

void Session::say(std::string message) {
    message_ = std::move(message);
    has_failed_ = false;
}

void Session::fail(std::string message) {
    message_ = std::move(message);
    has_failed_ = true;
}

}   // namespace viewer
