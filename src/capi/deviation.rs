//! The measured distance between two surfaces.

use super::entry::entry;
use super::mesh::decimesh_mesh;
use super::progress::{decimesh_progress, monitor};
use super::status::decimesh_status;
use super::structs::{self, Versioned};
use crate::deviation::{Deviation, Sampling, deviation, vertex_distances};
use std::ffi::c_void;
use std::ptr;

/// How to measure. decimesh_deviation_options_init() sets the defaults.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct decimesh_deviation_options {
    /// sizeof(decimesh_deviation_options), as decimesh_deviation_options_init sets it.
    pub struct_size: u32,
    /// Threads to use, 0: all that the machine has. The result is the same, bit for bit; by default 0.
    pub threads: u32,
    /// Points spread evenly over the area of each surface; by default 500000. The vertices are measured
    /// besides, for the maximum.
    pub samples: u64,
    /// Chooses the points; by default 0.
    pub seed: u64,
    /// Is told of progress, and can cancel; NULL for none.
    pub progress: decimesh_progress,
    /// Handed to progress as it is.
    pub progress_user: *mut c_void,
}

// SAFETY: repr(C); integers and pointers that leave no gap between them; a function pointer may have any
// bits but those of no function, which the caller vouches for.
unsafe impl Versioned for decimesh_deviation_options {
    const NAME: &'static str = "decimesh_deviation_options";

    fn initial() -> Self {
        let Sampling { samples, seed, threads } = Sampling::default();
        Self {
            struct_size: size_of::<Self>() as u32,
            threads: threads as u32,
            samples: samples as u64,
            seed,
            progress: None,
            progress_user: ptr::null_mut(),
        }
    }
}

/// The distance between two surfaces, in units of the positions; forward is from the first mesh to the
/// second.
#[repr(C)]
#[derive(Debug, Clone, Copy, Default)]
pub struct decimesh_deviation_result {
    /// sizeof(decimesh_deviation_result), as decimesh_deviation_result_init sets it.
    pub struct_size: u32,
    /// Always 0.
    pub reserved: u32,
    /// Root of the mean squared distance: the larger of the two directions.
    pub rms: f64,
    /// Mean distance: the larger of the two directions.
    pub mean: f64,
    /// Largest distance found: the larger of the two directions.
    pub max: f64,
    /// Root of the mean squared distance from the first mesh to the second.
    pub forward_rms: f64,
    /// Mean distance from the first mesh to the second.
    pub forward_mean: f64,
    /// Largest distance found from the first mesh to the second.
    pub forward_max: f64,
    /// Root of the mean squared distance from the second mesh to the first.
    pub backward_rms: f64,
    /// Mean distance from the second mesh to the first.
    pub backward_mean: f64,
    /// Largest distance found from the second mesh to the first.
    pub backward_max: f64,
    /// Diagonal of the box around the triangles of the first mesh.
    pub diagonal: f64,
    /// RMS angle between the normals of the surfaces, in degrees: the larger of the two directions.
    pub normal_rms_degrees: f64,
}

// SAFETY: repr(C); two 32-bit integers and doubles.
unsafe impl Versioned for decimesh_deviation_result {
    const NAME: &'static str = "decimesh_deviation_result";

    fn initial() -> Self {
        Self { struct_size: size_of::<Self>() as u32, ..Self::default() }
    }
}

impl From<Deviation> for decimesh_deviation_result {
    fn from(deviation: Deviation) -> Self {
        let Deviation { rms, mean, max, forward, backward, diagonal, normal_rms_degrees } = deviation;
        Self {
            rms,
            mean,
            max,
            forward_rms: forward.rms,
            forward_mean: forward.mean,
            forward_max: forward.max,
            backward_rms: backward.rms,
            backward_mean: backward.mean,
            backward_max: backward.max,
            diagonal,
            normal_rms_degrees,
            ..Self::initial()
        }
    }
}

/// Sets the defaults: 500000 samples a direction, all threads. NULL is left alone.
///
/// struct_size is sizeof(decimesh_deviation_options), as the caller was compiled: no more is written.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn decimesh_deviation_options_init(
    options: *mut decimesh_deviation_options,
    struct_size: usize,
) {
    // SAFETY: the caller\'s pointer is NULL or points to a struct of that size.
    unsafe { structs::initialize(options, struct_size) }
}

/// Sets struct_size and makes all else 0. NULL is left alone.
///
/// struct_size is sizeof(decimesh_deviation_result), as the caller was compiled: no more is written.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn decimesh_deviation_result_init(
    result: *mut decimesh_deviation_result,
    struct_size: usize,
) {
    // SAFETY: the caller\'s pointer is NULL or points to a struct of that size.
    unsafe { structs::initialize(result, struct_size) }
}

/// Measures the distance between the surfaces of two meshes, in both directions, as Metro does: points on
/// one surface, each to the nearest point of the other, which is found exactly, in double precision.
///
/// options may be NULL: the defaults. *result has been set up by decimesh_deviation_result_init. Fails with
/// _NULL, _STRUCT_SIZE, _UNKNOWN_OPTION, _EMPTY (a mesh without triangles), _CANCELLED or _THREADS.
///
/// O((n + samples) log n) time, about 110 bytes of memory a triangle and more while the trees are built.
/// Any thread; progress is told on the calling one.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn decimesh_deviation(
    a: *const decimesh_mesh,
    b: *const decimesh_mesh,
    options: *const decimesh_deviation_options,
    result: *mut decimesh_deviation_result,
) -> decimesh_status {
    entry!([a, b, result] {
        // SAFETY: none is NULL but perhaps the options, and the caller vouches for what they point to.
        unsafe {
            let options = match options.is_null() {
                true => decimesh_deviation_options::initial(),
                false => structs::read(options)?,
            };
            let size = structs::size(result)?;
            let sampling = Sampling {
                samples: usize::try_from(options.samples).unwrap_or(usize::MAX),
                seed: options.seed,
                threads: options.threads as usize,
            };
            let mut monitor = monitor(options.progress, options.progress_user);
            let measured = deviation((*a).mesh(), (*b).mesh(), &sampling, &mut monitor)?;
            structs::write(result, size, &measured.into());
        }
        Ok(())
    })
}

/// Measures how far each vertex of one mesh is from the surface of another: the nearest point is found exactly,
/// in double precision.
///
/// distances has room for as many as from has vertices, and receives them in their order, in units of the
/// positions; vertices that no triangle uses are measured as well. options may be NULL: the defaults; their samples and
/// seed are not looked at. Fails with _NULL, _STRUCT_SIZE, _UNKNOWN_OPTION, _EMPTY (to is without triangles),
/// _CANCELLED or _THREADS.
///
/// O(n log n) time, about 110 bytes of memory a triangle of to, more while the tree is built, and 4 a vertex of from.
/// Any thread; progress is told on the calling one.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn decimesh_vertex_distances(
    from: *const decimesh_mesh,
    to: *const decimesh_mesh,
    options: *const decimesh_deviation_options,
    distances: *mut f32,
) -> decimesh_status {
    entry!([from, to, distances] {
        // SAFETY: none is NULL but perhaps the options, and the caller vouches for what they point to.
        unsafe {
            let options = match options.is_null() {
                true => decimesh_deviation_options::initial(),
                false => structs::read(options)?,
            };
            let mut monitor = monitor(options.progress, options.progress_user);
            let threads = options.threads as usize;
            let measured = vertex_distances((*from).mesh(), (*to).mesh(), threads, &mut monitor)?;
            // As bytes: the caller's buffer needs no alignment.
            let bytes = measured.len() * size_of::<f32>();
            ptr::copy_nonoverlapping(measured.as_ptr().cast::<u8>(), distances.cast::<u8>(), bytes);
        }
        Ok(())
    })
}
