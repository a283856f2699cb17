//! The memory that calls of the C ABI take is what their comments say.

#![cfg(feature = "capi")]

use std::alloc::System;
use std::mem::MaybeUninit;
use std::ptr;

use decimesh::capi::*;
use decimesh::mesh::{Attributes, Mesh, shapes};
use peakmem_alloc::{PeakMemAlloc, PeakMemAllocTrait};

mod c_calls;
use c_calls::succeeded;

#[global_allocator]
static ALLOCATOR: PeakMemAlloc<System> = PeakMemAlloc::system();

/// What `call` takes at its peak, for each of so many `triangles`: at most `said` bytes, and not far less.
fn check(call_name: &str, said: f64, triangles: usize, call: impl FnOnce() -> decimesh_status) {
    ALLOCATOR.reset_peak_memory();
    succeeded(call());
    let taken = ALLOCATOR.get_peak_memory() as f64 / triangles as f64;
    println!("{call_name}: {taken:.1} bytes a triangle");
    assert!(
        taken <= said && taken >= 0.85 * said,
        "{call_name}: {taken:.1} bytes a triangle, not about {said}"
    );
}

/// One test, as all count in one place.
#[test]
fn calls_take_as_much_memory_as_they_say() {
    let stone = shapes::bumpy_sphere(200, 1);
    let triangles = stone.triangles().len();
    let mut options = c_calls::options();
    options.target_value = 0.25;
    let mut indices = stone.triangles().as_flattened().to_vec();
    let destination = indices.as_mut_ptr();
    let mut count = 0;

    let buffers = c_calls::buffers(&stone);
    check("indices", 49.0, triangles, || {
        // SAFETY: the pointers point to what the call's comment says; so they do below.
        unsafe {
            decimesh_simplify_indices(destination.cast(), &buffers, &options, &mut count, ptr::null_mut())
        }
    });
    let (mut positions, mut corners, _) = stone.clone().into_parts();
    let mut own = MaybeUninit::uninit();
    // SAFETY: there is room for the buffers, and the call sets them all.
    let mut own: decimesh_mutable_buffers = unsafe {
        decimesh_mutable_buffers_init(own.as_mut_ptr(), size_of::<decimesh_mutable_buffers>());
        own.assume_init()
    };
    own.positions = positions.as_mut_ptr().cast();
    own.vertex_count = positions.len();
    own.indices = corners.as_mut_ptr().cast();
    own.index_count = 3 * triangles;
    check("in place", 30.0, triangles, || {
        // SAFETY: as above.
        unsafe { decimesh_simplify_in_place(&own, &options, &mut count, ptr::null_mut()) }
    });
    let normals = Attributes { normals: Some(stone.positions().to_vec()), ..Attributes::default() };
    let dressed = Mesh::with_attributes(stone.positions().to_vec(), stone.triangles().to_vec(), normals)
        .expect("positions are as good as normals");
    let dressed = c_calls::buffers(&dressed);
    options.normal_weight = 0.5;
    check("indices with normals", 66.0, triangles, || {
        // SAFETY: as above.
        unsafe {
            decimesh_simplify_indices(destination.cast(), &dressed, &options, &mut count, ptr::null_mut())
        }
    });

    let side = 513;
    let heights: Vec<f32> = (0..side * side).map(|sample| (sample % 97) as f32).collect();
    let mut hierarchy = ptr::null_mut();
    // By samples instead of triangles; two million bytes are for no number of them.
    check("hierarchy", 24.0 + 2.1e6 / heights.len() as f64, heights.len(), || {
        // SAFETY: as above.
        unsafe { decimesh_hierarchy_create(heights.as_ptr(), side, side, ptr::null(), &mut hierarchy) }
    });
    // SAFETY: as above, and it is not used any more.
    unsafe { decimesh_hierarchy_destroy(hierarchy) };

    let mut mesh = ptr::null_mut();
    // SAFETY: as above.
    succeeded(unsafe { decimesh_mesh_from_buffers(&buffers, &mut mesh) });
    let values = [0.5, 0.25, 0.125];
    let mut nested = ptr::null_mut();
    check("nested", 62.0, triangles, || {
        // SAFETY: as above.
        unsafe { decimesh_nested_build(mesh, &options, values.as_ptr(), values.len(), &mut nested) }
    });
    let mut progressive = ptr::null_mut();
    check("progressive", 130.0, triangles, || {
        // SAFETY: as above.
        unsafe { decimesh_progressive_build(mesh, &options, values.as_ptr(), values.len(), &mut progressive) }
    });
    // SAFETY: as above, and none is used any more.
    unsafe {
        decimesh_progressive_destroy(progressive);
        decimesh_nested_destroy(nested);
        decimesh_mesh_destroy(mesh);
    }
}
