/// Callbacks that cancel or throw, at every step there is: nothing is lost, nothing has changed.

#include <memory>

#include "calls.hpp"

TEST_SUITE_BEGIN("quick");

namespace {

/// Lets `allowed` reports pass.
struct Countdown {
    int allowed;
    int reports = 0;
    float last = 0;

    static std::int32_t report(void *user, float fraction) {
        auto &self = *static_cast<Countdown *>(user);
        CHECK(fraction >= self.last);
        CHECK(fraction <= 1);
        self.last = fraction;
        return self.reports++ < self.allowed ? 0 : 1;
    }
};

/// Something thrown that must arrive as itself, and be destroyed once.
struct Thrown {
    explicit Thrown(int step) : number(step), life(std::make_shared<int>(step)) {}

    int number;
    std::shared_ptr<int> life;
};

/// Makes `call` with a progress that throws at its first report, its second and so on, until one gets through.
template <class Call>
void throw_at_every_step(Call call) {
    int step = 0;
    for (bool has_ended = false; !has_ended; ++step) {
        std::weak_ptr<int> life;
        int reports = 0;
        const decimesh::Progress progress = [&](float) {
            if (reports++ == step) {
                const Thrown thrown(step);
                life = thrown.life;
                throw thrown;
            }
            return true;
        };
        try {
            call(progress);
            has_ended = true;
        } catch (const Thrown &thrown) {
            CHECK(thrown.number == step);
            CHECK(reports == step + 1);
        }
        CHECK(life.expired());
    }
    CHECK(step > 2);
}

const shapes::Dressed &stone() {
    static const shapes::Dressed stone(shapes::stone(48, 32));
    return stone;
}

}   // namespace

TEST_CASE("callbacks: cancelling at every step from C") {
    for (const calls::Named &named : calls::on_options) {
        CAPTURE(named.name);
        int steps = 0;
        for (decimesh_status status = DECIMESH_ERROR_CANCELLED; status != DECIMESH_OK; ++steps) {
            shapes::Dressed dressed = stone();
            const Bytes before = dressed.bytes();
            const decimesh_buffers buffers = dressed.raw();
            Countdown countdown{steps};
            decimesh_simplify_options options = calls::default_options();
            options.target_value = 0.1;
            options.progress = Countdown::report;
            options.progress_user = &countdown;
            status = named.call(&buffers, &options);
            if (status == DECIMESH_OK) {
                CHECK(countdown.last == 1);
                break;
            }
            calls::check_refused(status, DECIMESH_ERROR_CANCELLED, {"cancelled"});
            CHECK(countdown.reports == steps + 1);
            CHECK(dressed.bytes() == before);
        }
        CHECK(steps > 2);
    }
}

TEST_CASE("callbacks: cancelling a measurement at every step from C") {
    const decimesh::Mesh mesh = stone().mesh();
    decimesh_deviation_options options;
    decimesh_deviation_options_init(&options, sizeof options);
    options.samples = 500;
    options.progress = Countdown::report;
    int steps = 0;
    for (;; ++steps) {
        Countdown countdown{steps};
        options.progress_user = &countdown;
        auto result = calls::untouched_struct<decimesh_deviation_result>();
        const decimesh_status status = decimesh_deviation(mesh.get(), mesh.get(), &options, &result);
        if (status == DECIMESH_OK) {
            break;
        }
        calls::check_refused(status, DECIMESH_ERROR_CANCELLED, {"cancelled"});
        CHECK(calls::is_untouched(result));
    }
    CHECK(steps > 2);
}

TEST_CASE("callbacks: exceptions arrive from every step as they were thrown") {
    const decimesh::Mesh mesh = stone().mesh();
    const Bytes before = bytes_of(mesh);
    decimesh::Options options;
    options.target = decimesh::Target::ratio(0.1);
    options.track_origins = true;
    throw_at_every_step([&](const decimesh::Progress &progress) {
        options.progress = progress;
        decimesh::simplify(mesh, options);
    });
    throw_at_every_step([&](const decimesh::Progress &progress) {
        decimesh::Options chain;
        chain.progress = progress;
        decimesh::Levels::build(mesh, {decimesh::Target::ratio(0.3), decimesh::Target::ratio(0.1)}, chain);
    });
    throw_at_every_step([&](const decimesh::Progress &progress) {
        decimesh::DeviationOptions measuring;
        measuring.samples = 500;
        measuring.progress = progress;
        decimesh::deviation(mesh, mesh, measuring);
    });
    throw_at_every_step([&](const decimesh::Progress &progress) {
        decimesh::MultipleChoiceOptions choosing;
        choosing.progress = progress;
        decimesh::multiple_choice(mesh, 10, choosing);
    });
    throw_at_every_step([&](const decimesh::Progress &progress) {
        decimesh::DeviationOptions measuring;
        measuring.progress = progress;
        decimesh::vertex_distances(mesh, mesh, measuring);
    });
    const std::vector<decimesh::Target> targets = {decimesh::Target::ratio(0.3), decimesh::Target::ratio(0.1)};
    throw_at_every_step([&](const decimesh::Progress &progress) {
        options.progress = progress;
        options.track_origins = false;
        decimesh::NestedLevels::build(mesh, targets, options);
    });
    throw_at_every_step([&](const decimesh::Progress &progress) {
        options.progress = progress;
        decimesh::Progressive::build(mesh, targets, options);
    });
    decimesh::NestedLevels levels = decimesh::NestedLevels::build(mesh, targets);
    throw_at_every_step([&](const decimesh::Progress &progress) {
        decimesh::BoundOptions bounding;
        bounding.progress = progress;
        decimesh::bound(mesh, levels.mesh(), bounding);
        levels.certify(bounding);
    });
    throw_at_every_step([&](const decimesh::Progress &progress) {
        options.progress = progress;
        decimesh::simplify_within(mesh, 0.05, options);
    });
    CHECK(bytes_of(mesh) == before);
}

TEST_CASE("callbacks: exceptions leave the caller's buffers as they were") {
    shapes::Dressed dressed = stone();
    const Bytes before = dressed.bytes();
    decimesh::Options options;
    options.target = decimesh::Target::ratio(0.1);
    throw_at_every_step([&](const decimesh::Progress &progress) {
        CHECK(dressed.bytes() == before);
        std::vector<std::uint32_t> destination(dressed.shape.indices.size());
        options.progress = progress;
        const decimesh::Buffers<> buffers{dressed.shape.positions, dressed.shape.indices};
        decimesh::simplify_indices(destination, buffers, options);
    });
    throw_at_every_step([&](const decimesh::Progress &progress) {
        CHECK(dressed.bytes() == before);
        options.progress = progress;
        const decimesh::MutableBuffers<> buffers{dressed.shape.positions, dressed.shape.indices};
        decimesh::simplify_in_place(buffers, options);
    });
    CHECK(dressed.bytes() != before);
}

TEST_CASE("callbacks: answering false is an exception of its own") {
    const decimesh::Mesh mesh = stone().mesh();
    decimesh::Options options;
    options.progress = [](float) { return false; };
    CHECK_THROWS_AS(decimesh::simplify(mesh, options), decimesh::Cancelled);
    CHECK_THROWS_AS(decimesh::Levels::build(mesh, {options.target}, options), decimesh::Cancelled);
    decimesh::DeviationOptions measuring;
    measuring.progress = options.progress;
    CHECK_THROWS_AS(decimesh::deviation(mesh, mesh, measuring), decimesh::Cancelled);
    CHECK_THROWS_AS(decimesh::NestedLevels::build(mesh, {options.target}, options), decimesh::Cancelled);
    CHECK_THROWS_AS(decimesh::Progressive::build(mesh, {options.target}, options), decimesh::Cancelled);
    decimesh::BoundOptions bounding;
    bounding.progress = options.progress;
    CHECK_THROWS_AS(decimesh::bound(mesh, mesh, bounding), decimesh::Cancelled);
    try {
        decimesh::simplify(mesh, options);
    } catch (const decimesh::Error &error) {
        CHECK(error.status() == decimesh::Status::cancelled);
        CHECK(checks::says(error.what(), {"cancelled"}));
    }
}

TEST_CASE("callbacks: they may call decimesh themselves") {
    const decimesh::Mesh mesh = stone().mesh();
    decimesh::Options options;
    options.target = decimesh::Target::ratio(0.1);
    const Bytes alone = bytes_of(decimesh::simplify(mesh, options).mesh);
    decimesh::Options within = options;
    within.progress = [&](float) {
        CHECK(bytes_of(decimesh::simplify(mesh, options).mesh) == alone);
        return true;
    };
    CHECK(bytes_of(decimesh::simplify(mesh, within).mesh) == alone);
}

TEST_SUITE_END();
