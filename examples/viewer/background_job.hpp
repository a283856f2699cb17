/// Work that a window does not wait for.

#ifndef VIEWER_BACKGROUND_JOB_HPP
#define VIEWER_BACKGROUND_JOB_HPP

#include <atomic>
#include <chrono>
#include <functional>
#include <future>
#include <thread>
#include <utility>

#include <decimesh.hpp>

namespace viewer {

/// Does its work in a thread of its own, which tells how far it has come and can be cancelled. Whoever destroys it
/// before it is done cancels it, and waits until it has heard.
template <class Result>
class BackgroundJob {
public:
    /// Is handed what to tell of its progress, and ends when that says so: as decimesh's calls do.
    using Work = std::function<Result(const decimesh::Progress &)>;

    explicit BackgroundJob(Work work)
        : thread_([this, work = std::move(work)](const std::stop_token &stop) {
              try {
                  promise_.set_value(work([this, &stop](float fraction) {
                      fraction_ = fraction;
                      return !stop.stop_requested();
                  }));
              } catch (...) {
                  promise_.set_exception(std::current_exception());
              }
          }) {}

    /// From 0 to 1.
    float progress() const noexcept { return fraction_; }

    /// Asks the work to end; it may yet be done first.
    void cancel() noexcept { thread_.request_stop(); }

    bool is_done() const { return future_.wait_for(std::chrono::seconds(0)) == std::future_status::ready; }

    /// What came of the work, or what it threw: `decimesh::Cancelled` after `cancel`. Waits until it is done; to be
    /// called once.
    Result take() { return future_.get(); }

private:
    std::atomic<float> fraction_{0};
    std::promise<Result> promise_;
    std::future<Result> future_ = promise_.get_future();
    // The last, so that it ends first: the others are in its use.
    std::jthread thread_;
};

}   // namespace viewer

#endif
