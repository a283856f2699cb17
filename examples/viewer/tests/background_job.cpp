#include "background_job.hpp"

#include <memory>
#include <stdexcept>
#include <string>

#include <doctest/doctest.h>

using viewer::BackgroundJob;

namespace {

void wait_until(const std::atomic<bool> &flag) {
    while (!flag) {
        std::this_thread::yield();
    }
}

/// Goes on until it is cancelled.
int endless(const decimesh::Progress &progress) {
    while (progress(0.5F)) {
        std::this_thread::yield();
    }
    throw decimesh::Cancelled(decimesh::Status::cancelled, "cancelled");
}

}   // namespace

TEST_CASE("background job: its result arrives, from another thread, whatever it is") {
    BackgroundJob<std::unique_ptr<std::thread::id>> job([](const decimesh::Progress &progress) {
        CHECK(progress(1));
        return std::make_unique<std::thread::id>(std::this_thread::get_id());
    });
    const std::unique_ptr<std::thread::id> id = job.take();
    CHECK(*id != std::this_thread::get_id());
    CHECK(job.progress() == 1);
}

TEST_CASE("background job: progress is seen, and it is not done before it is") {
    std::atomic<bool> has_begun = false;
    std::atomic<bool> may_end = false;
    BackgroundJob<int> job([&](const decimesh::Progress &progress) {
        progress(0.25F);
        has_begun = true;
        wait_until(may_end);
        return 7;
    });
    wait_until(has_begun);
    CHECK(job.progress() == 0.25F);
    CHECK_FALSE(job.is_done());
    may_end = true;
    CHECK(job.take() == 7);
}

TEST_CASE("background job: what is thrown arrives as it was thrown") {
    BackgroundJob<int> job([](const decimesh::Progress &) -> int { throw std::out_of_range("vertex 7"); });
    CHECK_THROWS_WITH_AS(job.take(), "vertex 7", std::out_of_range);
}

TEST_CASE("background job: cancelled, it ends") {
    BackgroundJob<int> job(endless);
    job.cancel();
    CHECK_THROWS_AS(job.take(), decimesh::Cancelled);
}

TEST_CASE("background job: destroyed, it is cancelled and waited for") {
    std::atomic<bool> has_ended = false;
    {
        BackgroundJob<int> job([&](const decimesh::Progress &progress) {
            while (progress(0)) {
                std::this_thread::yield();
            }
            has_ended = true;
            return 0;
        });
    }
    CHECK(has_ended);
}
