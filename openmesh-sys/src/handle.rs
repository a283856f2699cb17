//! A mesh that the shim holds. The functions are those of `shim/openmesh.cpp`.

use std::ffi::c_void;
use std::ptr::{self, NonNull};

use crate::{Decimation, Error, Method};

/// Statuses of the shim's; anything else is an exception.
const OK: i32 = 0;
const OUT_OF_MEMORY: i32 = 1;

/// Methods as the shim numbers them.
const QUADRIC: i32 = 0;
const MULTIPLE_CHOICE: i32 = 1;

unsafe extern "C" {
    safe fn openmesh_shim_version() -> u32;
    fn openmesh_shim_build(
        positions: *const f32,
        vertices: usize,
        indices: *const u32,
        triangles: usize,
        out: *mut *mut c_void,
    ) -> i32;
    fn openmesh_shim_decimate(
        mesh: *mut c_void,
        method: i32,
        triangles: usize,
        prevent_flips: bool,
        max_distance: f32,
    ) -> i32;
    fn openmesh_shim_vertices(mesh: *const c_void) -> usize;
    fn openmesh_shim_triangles(mesh: *const c_void) -> usize;
    fn openmesh_shim_left_out(mesh: *const c_void) -> usize;
    fn openmesh_shim_copy(mesh: *const c_void, positions: *mut f32, indices: *mut u32);
    fn openmesh_shim_destroy(mesh: *mut c_void);
}

/// The only owner of a mesh of the shim's.
#[derive(Debug)]
pub(crate) struct Handle(NonNull<c_void>);

// SAFETY: the mesh is memory that nothing else refers to; the shim keeps nothing of a thread's.
unsafe impl Send for Handle {}

pub(crate) fn version() -> Option<(u32, u32)> {
    let version = openmesh_shim_version();
    Some(((version >> 16) & 0xf, (version >> 8) & 0xff))
}

impl Handle {
    /// Indices must be in range, positions finite, and 6 times the triangles, as the vertices, fit an
    /// `i32`.
    pub(crate) fn build(positions: &[[f32; 3]], triangles: &[[u32; 3]]) -> Result<Self, Error> {
        let mut mesh = ptr::null_mut();
        // SAFETY: the pointers are of slices of three values for each of the counts, which the shim
        // reads only, and `mesh` is there to be written to.
        let status = unsafe {
            openmesh_shim_build(
                positions.as_flattened().as_ptr(),
                positions.len(),
                triangles.as_flattened().as_ptr(),
                triangles.len(),
                &mut mesh,
            )
        };
        succeeded(status)?;
        NonNull::new(mesh).map(Self).ok_or(Error::Exception)
    }

    pub(crate) fn decimate(self, decimation: &Decimation) -> Result<Self, Error> {
        let method = match decimation.method {
            Method::Quadric => QUADRIC,
            Method::MultipleChoice => MULTIPLE_CHOICE,
        };
        // The shim takes a negative distance for none.
        let max_distance = decimation.max_distance.unwrap_or(-1.0);
        // SAFETY: the mesh is the shim's own and no one else's. Where this fails, it goes with `self`.
        let status = unsafe {
            openmesh_shim_decimate(
                self.0.as_ptr(),
                method,
                decimation.triangles,
                decimation.prevent_flips,
                max_distance,
            )
        };
        succeeded(status).map(|()| self)
    }

    pub(crate) fn vertices(&self) -> usize {
        // SAFETY: the mesh is the shim's, and nothing changes it meanwhile.
        unsafe { openmesh_shim_vertices(self.0.as_ptr()) }
    }

    pub(crate) fn triangles(&self) -> usize {
        // SAFETY: the mesh is the shim's, and nothing changes it meanwhile.
        unsafe { openmesh_shim_triangles(self.0.as_ptr()) }
    }

    pub(crate) fn left_out(&self) -> usize {
        // SAFETY: the mesh is the shim's, and nothing changes it meanwhile.
        unsafe { openmesh_shim_left_out(self.0.as_ptr()) }
    }

    pub(crate) fn buffers(&self) -> (Vec<[f32; 3]>, Vec<[u32; 3]>) {
        let mut positions = vec![[0.0; 3]; self.vertices()];
        let mut triangles = vec![[0; 3]; self.triangles()];
        // SAFETY: the mesh is the shim's, and the buffers have room for three values for each of its
        // vertices and triangles, which is what is written.
        unsafe {
            openmesh_shim_copy(
                self.0.as_ptr(),
                positions.as_flattened_mut().as_mut_ptr(),
                triangles.as_flattened_mut().as_mut_ptr(),
            );
        }
        (positions, triangles)
    }
}

impl Drop for Handle {
    fn drop(&mut self) {
        // SAFETY: the shim gave the mesh away, and this is its only owner, once.
        unsafe { openmesh_shim_destroy(self.0.as_ptr()) };
    }
}

fn succeeded(status: i32) -> Result<(), Error> {
    match status {
        OK => Ok(()),
        OUT_OF_MEMORY => Err(Error::OutOfMemory),
        _ => Err(Error::Exception),
    }
}
