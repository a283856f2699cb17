/// What is open, what came of it, and what is being done: everything but the window.

#ifndef VIEWER_SESSION_HPP
#define VIEWER_SESSION_HPP

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <variant>

#include "background_job.hpp"
#include "reduction.hpp"

namespace viewer {

/// Does one thing at a time, in the background: `poll` takes over what it has come to. Nothing is lost by what fails:
/// it leaves a message and all else as it was. Not for several threads.
class Session {
public:
    /// What there is beside the original.
    using Result = std::variant<std::monostate, Reduced, LevelSet>;

    /// Each of these begins work in the place of any that is going on.
    void open(const std::string &path);
    void simplify(Engine engine, std::size_t triangles);
    void build_levels(std::size_t count);

    /// Writes the result, or that level of it, at once; nested levels to a .glb all together.
    void save(const std::string &path, std::size_t level);

    /// Asks the work to end.
    void cancel();

    bool is_busy() const noexcept { return job_ != nullptr; }
    /// What is being done, such as "simplifying"; and how far it is, from 0 to 1.
    const std::string &activity() const noexcept { return activity_; }
    float progress() const noexcept { return job_ ? job_->progress() : 0; }

    /// To be called once a frame: takes over work that is done.
    void poll();

    /// Null until a mesh has been opened.
    const Original *original() const noexcept { return original_.get(); }
    const Result &result() const noexcept { return result_; }
    /// How many levels there are to step through: 1 where the result is a single mesh, 0 where there is none.
    std::size_t level_count() const noexcept;
    /// How far the original is from the result, or from that level of it; null where there is none.
    const Distances *distances(std::size_t level) const noexcept;

    /// Rise when the original, or the result, becomes another.
    std::uint64_t original_version() const noexcept { return original_version_; }
    std::uint64_t result_version() const noexcept { return result_version_; }

    /// What the last work came to, in a sentence for people.
    const std::string &message() const noexcept { return message_; }
    bool has_failed() const noexcept { return has_failed_; }

private:
    // The original is shared with the work, which may outlive its being shown.
    using Outcome = std::variant<std::shared_ptr<const Original>, Reduced, LevelSet>;
    using Job = BackgroundJob<Outcome>;

    void begin(std::string activity, Job::Work work);
    void accept(Outcome outcome);
    void say(std::string message);
    void fail(std::string message);

    std::shared_ptr<const Original> original_;
    Result result_;
    std::uint64_t original_version_ = 0;
    std::uint64_t result_version_ = 0;
    std::string message_;
    bool has_failed_ = false;
    std::string activity_;
    std::unique_ptr<Job> job_;
};

}   // namespace viewer

#endif
