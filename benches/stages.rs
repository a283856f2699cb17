//! The stages of a run one by one: where the time of a simplification goes.
//!
//! `cargo bench --features bench-internals --bench stages`

use std::time::Duration;

use criterion::measurement::WallTime;
use criterion::{
    BatchSize, BenchmarkGroup, Criterion, SamplingMode, Throughput, criterion_group, criterion_main,
};
use decimesh::Mesh;
use decimesh::internals::Stages;
use decimesh::mesh::shapes::bumpy_sphere;

const THREADS: [usize; 2] = [1, 2];
/// Of the replacement-selection heap: the paper's.
const RECORDS: usize = 15;

fn passes(criterion: &mut Criterion) {
    // 1.1 million triangles: larger than the caches.
    let mesh = bumpy_sphere(304, 1);
    let load = |ratio, threads| Stages::load(&mesh, ratio, threads).expect("threads start");
    let classified = |ratio, threads| {
        let mut stages = load(ratio, threads);
        stages.classify();
        stages
    };
    let passed = |ratio, threads| {
        let mut stages = classified(ratio, threads);
        // Nobody cancels.
        let _ = stages.threshold_pass();
        stages
    };

    let mut group = group(criterion, "pass", &mesh);
    for threads in THREADS {
        let id = |name: &str| format!("{name}/{threads} threads");
        group.bench_function(id("load"), |bencher| {
            bencher.iter_batched(|| (), |()| load(0.1, threads), BatchSize::PerIteration);
        });
        stage(&mut group, id("classify"), || load(0.1, threads), Stages::classify);
        stage(&mut group, id("threshold pass"), || classified(0.1, threads), Stages::threshold_pass);
        stage(&mut group, id("ranked pass"), || classified(0.97, threads), Stages::ranked_pass);
        stage(&mut group, id("compact"), || passed(0.1, threads), Stages::compact);
    }
    let replacement = |stages: &mut Stages| stages.replacement_pass(RECORDS);
    stage(&mut group, "replacement pass", || classified(0.1, 1), replacement);
    stage(&mut group, "to mesh", || passed(0.1, 1), |stages| stages.to_mesh());
    group.finish();
}

fn finish(criterion: &mut Criterion) {
    // As large as what a run leaves to the finish, and as far from the goal.
    let mesh = bumpy_sphere(76, 1);
    let ringed = || {
        let mut stages = Stages::load(&mesh, 0.7, 1).expect("a thread is there");
        stages.classify();
        stages
    };
    let mut group = group(criterion, "finish", &mesh);
    stage(&mut group, "finish", ringed, Stages::finish);
    group.finish();
}

fn group<'a>(criterion: &'a mut Criterion, name: &str, mesh: &Mesh) -> BenchmarkGroup<'a, WallTime> {
    let mut group = criterion.benchmark_group(name);
    group
        .sample_size(20)
        .sampling_mode(SamplingMode::Flat)
        .warm_up_time(Duration::from_millis(500))
        .measurement_time(Duration::from_secs(4))
        .throughput(Throughput::Elements(mesh.triangles().len() as u64));
    group
}

fn stage<T>(
    group: &mut BenchmarkGroup<WallTime>,
    id: impl Into<String>,
    before: impl Fn() -> Stages,
    stage: impl Fn(&mut Stages) -> T,
) {
    group.bench_function(id.into(), |bencher| {
        bencher.iter_batched_ref(&before, &stage, BatchSize::PerIteration)
    });
}

criterion_group!(stages, passes, finish);
criterion_main!(stages);
