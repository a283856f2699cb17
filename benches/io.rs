//! Reading and writing each format, from and to memory: what the parsers take, without the disk.

use criterion::{BenchmarkId, Criterion, SamplingMode, Throughput, criterion_group, criterion_main};
use decimesh::io::{Encoding, Format, WriteOptions, read_from_slice, write_to};
use decimesh::mesh::shapes::bumpy_sphere;

const CASES: [(&str, Format, Encoding); 7] = [
    ("PLY", Format::Ply, Encoding::Binary),
    ("PLY text", Format::Ply, Encoding::Ascii),
    ("OBJ", Format::Obj, Encoding::Binary),
    ("STL", Format::Stl, Encoding::Binary),
    ("STL text", Format::Stl, Encoding::Ascii),
    ("OFF", Format::Off, Encoding::Binary),
    ("GLB", Format::Glb, Encoding::Binary),
];

fn formats(criterion: &mut Criterion) {
    let mesh = bumpy_sphere(153, 1);
    let mut group = criterion.benchmark_group("io");
    group.sample_size(10).sampling_mode(SamplingMode::Flat);
    for (name, format, encoding) in CASES {
        let options = WriteOptions { encoding };
        let mut bytes = Vec::new();
        write_to(&mesh, format, &options, &mut bytes).expect("memory takes what is written");
        group.throughput(Throughput::Bytes(bytes.len() as u64));
        group.bench_function(BenchmarkId::new("read", name), |bencher| {
            bencher.iter_with_large_drop(|| read_from_slice(&bytes, format));
        });
        let mut written = Vec::with_capacity(bytes.len());
        group.bench_function(BenchmarkId::new("write", name), |bencher| {
            bencher.iter(|| {
                written.clear();
                write_to(&mesh, format, &options, &mut written)
            });
        });
    }
    group.finish();
}

criterion_group!(io, formats);
criterion_main!(io);
