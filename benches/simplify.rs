//! Whole simplifications to a tenth, from 70 thousand to 16 million triangles, beside meshoptimizer's
//! and, where it is installed, OpenMesh's.
//!
//! `cargo bench --bench simplify -- 70k` keeps to the smallest size. Where the ratio to a peer is what
//! counts, `cargo run --release --example bench` says it better: it runs the contenders in turns.

mod peers;

use std::hint::black_box;
use std::time::Duration;

use criterion::measurement::WallTime;
use criterion::{
    BatchSize, BenchmarkGroup, BenchmarkId, Criterion, SamplingMode, Throughput, criterion_group,
    criterion_main,
};
use decimesh::mesh::shapes::bumpy_sphere;
use decimesh::{Mesh, Monitor, Options, Selection, Target, simplify};

use peers::{MESHOPTIMIZER, OPENMESH, Peer};

/// Cells along an edge: a mesh has `12n²` triangles.
const SIZES: [(&str, usize); 5] = [("70k", 76), ("280k", 153), ("1M", 304), ("4M", 577), ("16M", 1155)];
const SHARE: f64 = 0.1;
const THREADS: [usize; 2] = [1, 2];
/// OpenMesh is asked no more than this: it takes up to twenty seconds a million triangles, mostly for the
/// assertions that Debian leaves in it.
const OPENMESH_CELLS: usize = 76;

fn benches(criterion: &mut Criterion) {
    for (name, cells) in SIZES {
        let mesh = bumpy_sphere(cells, 1);
        let mut group = criterion.benchmark_group(format!("simplify/{name}"));
        group
            .sample_size(10)
            .sampling_mode(SamplingMode::Flat)
            .warm_up_time(Duration::from_millis(500))
            .measurement_time(Duration::from_secs(3))
            .throughput(Throughput::Elements(mesh.triangles().len() as u64));
        for threads in THREADS {
            decimesh(&mut group, "threshold", &mesh, Selection::SampledThreshold, threads);
        }
        let replacement = Selection::ReplacementSelection { records: 15 };
        decimesh(&mut group, "replacement", &mesh, replacement, 1);
        for other in MESHOPTIMIZER {
            peer(&mut group, other, &mesh);
        }
        if openmesh_sys::AVAILABLE && cells <= OPENMESH_CELLS {
            for other in OPENMESH {
                peer(&mut group, other, &mesh);
            }
        }
        group.finish();
    }
}

fn decimesh(
    group: &mut BenchmarkGroup<WallTime>,
    name: &str,
    mesh: &Mesh,
    selection: Selection,
    threads: usize,
) {
    let options = Options { selection, threads, ..Options::new(Target::Ratio(SHARE)) };
    group.bench_function(BenchmarkId::new(name, format!("{threads} threads")), |bencher| {
        bencher.iter_batched(
            || (),
            |()| simplify(black_box(mesh), &options, &mut Monitor::silent()),
            BatchSize::PerIteration,
        );
    });
}

fn peer(group: &mut BenchmarkGroup<WallTime>, peer: Peer, mesh: &Mesh) {
    let triangles = (mesh.triangles().len() as f64 * SHARE) as usize;
    group.bench_function(peer.name(), |bencher| {
        bencher.iter_batched(
            || peer.hold(mesh),
            |held| black_box(held).simplify(triangles),
            BatchSize::PerIteration,
        );
    });
}

criterion_group!(simplifications, benches);
criterion_main!(simplifications);
