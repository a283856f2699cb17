//! The memory that a simplification takes is what its comments say.

use std::alloc::System;

use decimesh::mesh::shapes;
use decimesh::{Monitor, Options, Simplified, SimplifyError, Target, simplify, simplify_owned};
use peakmem_alloc::{PeakMemAlloc, PeakMemAllocTrait};

#[global_allocator]
static ALLOCATOR: PeakMemAlloc<System> = PeakMemAlloc::system();

/// What `call` takes at its peak, for each of so many `triangles`: at most `said` bytes, and not far less.
fn check(
    call_name: &str,
    said: f64,
    triangles: usize,
    call: impl FnOnce() -> Result<Simplified, SimplifyError>,
) {
    ALLOCATOR.reset_peak_memory();
    let result = call().expect("nobody cancels");
    let taken = ALLOCATOR.get_peak_memory() as f64 / triangles as f64;
    println!("{call_name}: {taken:.1} bytes a triangle");
    assert!(
        taken <= said && taken >= 0.8 * said,
        "{call_name}: {taken:.1} bytes a triangle, not about {said}"
    );
    assert!(result.mesh.triangles().len() <= triangles / 10);
}

/// One test, as all count in one place.
#[test]
fn calls_take_as_much_memory_as_they_say() {
    let stone = shapes::bumpy_sphere(300, 1);
    let triangles = stone.triangles().len();
    let mut options = Options::new(Target::Ratio(0.1));
    options.threads = 2;
    let monitor = &mut Monitor::silent();
    check("simplify", 25.0, triangles, || simplify(&stone, &options, monitor));
    // Its triangles lie side by side of a cube, in another order than the vertices.
    let own = stone.clone();
    check("simplify_owned", 16.0, triangles, || simplify_owned(own, &options, monitor));
    let ring = shapes::torus(700, 700);
    check("simplify_owned, in order", 10.0, ring.triangles().len(), || {
        simplify_owned(ring, &options, monitor)
    });

    // The same surface, its vertices in no order: they are put into one.
    let count = stone.positions().len();
    let place = |vertex: usize| vertex * 611_953 % count;
    let mut positions = vec![[0.0; 3]; count];
    stone.positions().iter().enumerate().for_each(|(vertex, &position)| positions[place(vertex)] = position);
    let renamed = |triangle: &[u32; 3]| triangle.map(|vertex| place(vertex as usize) as u32);
    let shuffled = stone.triangles().iter().map(renamed).collect();
    let stone = decimesh::Mesh::new(positions, shuffled).expect("the names are those of vertices");
    check("simplify, shuffled", 25.0, triangles, || simplify(&stone, &options, monitor));
    check("simplify_owned, shuffled", 18.0, triangles, || simplify_owned(stone, &options, monitor));
}
