//! `decimesh_hierarchy`: every rate of a field of heights from one run.

use super::entry::entry;
use super::mesh::{decimesh_mesh, text};
use super::progress::{decimesh_progress, monitor};
use super::simplify::{foreign, switch};
use super::status::{
    DECIMESH_ERROR_CANCELLED, DECIMESH_ERROR_EMPTY, DECIMESH_ERROR_IO, DECIMESH_ERROR_NOT_FINITE,
    DECIMESH_ERROR_OPTION, DECIMESH_ERROR_OUT_OF_MEMORY, DECIMESH_ERROR_OVERFLOW, DECIMESH_ERROR_THREADS,
    Failure, decimesh_status,
};
use super::structs::{self, Versioned};
use crate::mesh::Mesh;
use crate::monitor::Monitor;
use crate::rate_distortion::{
    self, Decomposition, DecompositionOptions, Detail, HeightField, RemeshError, RemeshOptions,
    SemiRegularError, SurfaceDecomposition, remesh,
};
use std::ffi::{c_char, c_void};
use std::ptr;

/// How much of a hierarchy is wanted.
pub type decimesh_detail = i32;
/// At most so many vertices, and as many as there can be below.
pub const DECIMESH_DETAIL_VERTICES: decimesh_detail = 0;
/// So large a part of the samples that are not void, above 0 and at most 1.
pub const DECIMESH_DETAIL_RATIO: decimesh_detail = 1;
/// As few vertices as there are with this root mean square of the vertical error over all samples.
pub const DECIMESH_DETAIL_RMS: decimesh_detail = 2;
/// As few vertices as there can be with no sample farther from the surface, vertically.
pub const DECIMESH_DETAIL_MAX_ERROR: decimesh_detail = 3;

/// Heights over a grid, or a semi-regular surface, decomposed: the order in which vertices go, from all of them to
/// a few, such that whatever is left has about the least squared error of all conforming 4-8 meshes of as many
/// vertices. Immutable.
///
/// A const decimesh_hierarchy* may be used from many threads at once.
pub struct decimesh_hierarchy {
    decomposed: Decomposed,
}

enum Decomposed {
    Heights(Decomposition),
    Surface(SurfaceDecomposition),
}

impl decimesh_hierarchy {
    /// Hands a hierarchy to the caller.
    ///
    /// # Safety
    /// `place` is the caller's to write to.
    unsafe fn give(decomposed: Decomposed, place: *mut *mut Self) {
        // SAFETY: as the caller of this function promises.
        unsafe { place.write(Box::into_raw(Box::new(Self { decomposed }))) };
    }

    /// The decomposition of heights, which alone can do `what`.
    fn heights(&self, what: &str) -> Result<&Decomposition, Failure> {
        match &self.decomposed {
            Decomposed::Heights(decomposition) => Ok(decomposition),
            Decomposed::Surface(_) => {
                let message = format!("{what} is for heights, and the hierarchy is one of a surface");
                Err(Failure::new(DECIMESH_ERROR_OPTION, message))
            }
        }
    }
}

/// What heights are, and how they are decomposed. decimesh_hierarchy_options_init() sets the defaults.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct decimesh_hierarchy_options {
    /// sizeof(decimesh_hierarchy_options), as decimesh_hierarchy_options_init sets it.
    pub struct_size: u32,
    /// Threads to use, 0: all that the machine has. The result is the same; by default 0.
    pub threads: u32,
    /// 1: samples that are no_data are void: nothing is known there, and no triangle covers them. By default 0.
    pub has_no_data: i32,
    /// What void samples have; may be no number, and is then that of all samples that are none.
    pub no_data: f32,
    /// How far columns are apart, in the unit of the heights: positive; by default 1.
    pub column_spacing: f32,
    /// How far rows are apart; by default 1.
    pub row_spacing: f32,
    /// For each sample how much its squared error counts: finite, not negative; NULL: 1 for all.
    pub importance: *const f32,
    /// Sweeps before the gap is looked at, and between two looks; by default 8.
    pub sweeps: u32,
    /// Sweeps at most; by default 64.
    pub max_sweeps: u32,
    /// How far the squared error may be above the least possible one, in decibels, where a fifth of the
    /// vertices is left, to be good enough; by default 0.03.
    pub gap: f64,
    /// Is told of progress, and can cancel; NULL for none.
    pub progress: decimesh_progress,
    /// Handed to progress as it is.
    pub progress_user: *mut c_void,
}

// SAFETY: repr(C); integers, floats, a double and pointers that leave no gap between them; a function pointer
// may have any bits but those of no function, which the caller vouches for.
unsafe impl Versioned for decimesh_hierarchy_options {
    const NAME: &'static str = "decimesh_hierarchy_options";

    fn initial() -> Self {
        let DecompositionOptions { sweeps, gap, max_sweeps, threads } = DecompositionOptions::default();
        Self {
            struct_size: size_of::<Self>() as u32,
            threads: threads as u32,
            has_no_data: 0,
            no_data: 0.0,
            column_spacing: 1.0,
            row_spacing: 1.0,
            importance: ptr::null(),
            sweeps,
            max_sweeps,
            gap,
            progress: None,
            progress_user: ptr::null_mut(),
        }
    }
}

impl decimesh_hierarchy_options {
    /// The options of `pointer`, or the defaults where it is NULL.
    ///
    /// # Safety
    /// `pointer` is NULL or points to a struct as long as its first field says.
    unsafe fn read(pointer: *const Self) -> Result<Self, Failure> {
        // SAFETY: as the caller of this function promises.
        unsafe { if pointer.is_null() { Ok(Self::initial()) } else { structs::read(pointer) } }
    }

    /// The field of some heights; `importance` has as many.
    ///
    /// # Safety
    /// The pointers are good.
    unsafe fn field(&self, heights: *const f32, columns: usize, rows: usize) -> Result<HeightField, Failure> {
        let no_data = switch("has_no_data", self.has_no_data)?.then_some(self.no_data);
        let samples = columns.checked_mul(rows).filter(|&samples| samples <= HeightField::MAX_SAMPLES);
        let samples = samples.ok_or_else(|| {
            let message =
                format!("{columns} columns times {rows} rows are more samples than decimesh can hold");
            Failure::new(DECIMESH_ERROR_OVERFLOW, message)
        })?;
        // SAFETY: as the caller of this function promises.
        let heights = unsafe { copy("heights", heights, samples)? };
        let field = HeightField::new(columns, rows, heights, no_data)?;
        let field = field.with_spacing([self.column_spacing, self.row_spacing])?;
        if self.importance.is_null() {
            return Ok(field);
        }
        // SAFETY: as the caller of this function promises.
        let importance = unsafe { copy("importance", self.importance, samples)? };
        Ok(field.with_importance(importance)?)
    }

    fn decomposition(&self) -> DecompositionOptions {
        let Self { sweeps, max_sweeps, gap, threads, .. } = *self;
        DecompositionOptions { sweeps, max_sweeps, gap, threads: threads as usize }
    }

    /// # Safety
    /// progress may be called on this thread with its user's pointer.
    unsafe fn monitor(&self) -> Monitor<'static> {
        // SAFETY: as the caller of this function promises.
        unsafe { monitor(self.progress, self.progress_user) }
    }
}

/// What was taken from a hierarchy. decimesh_hierarchy_report_init() sets it up.
#[repr(C)]
#[derive(Debug, Clone, Copy, Default)]
pub struct decimesh_hierarchy_report {
    /// sizeof(decimesh_hierarchy_report), as decimesh_hierarchy_report_init sets it.
    pub struct_size: u32,
    /// Always 0.
    pub reserved: u32,
    /// Vertices of the mesh.
    pub vertices: u64,
    /// Triangles of the mesh.
    pub triangles: u64,
    /// Root of the mean squared vertical error of all samples, weighted where they have an importance.
    pub rms: f64,
    /// Largest vertical error of a sample; not a number for a surface.
    pub max_error: f64,
    /// How far, in decibels, the squared error can be above that of the best conforming mesh of as many
    /// vertices: proven for these heights. Infinite if nothing is known.
    pub certified_gap: f64,
}

// SAFETY: repr(C); two 32-bit integers, then integers of 8 bytes and doubles.
unsafe impl Versioned for decimesh_hierarchy_report {
    const NAME: &'static str = "decimesh_hierarchy_report";

    fn initial() -> Self {
        Self { struct_size: size_of::<Self>() as u32, ..Self::default() }
    }
}

/// A copy of a list of the caller's.
///
/// # Safety
/// `list` points to `count` values, if it is not NULL.
unsafe fn copy(name: &str, list: *const f32, count: usize) -> Result<Vec<f32>, Failure> {
    let mut copied = Vec::new();
    copied.try_reserve_exact(count).map_err(|_| {
        Failure::new(
            DECIMESH_ERROR_OUT_OF_MEMORY,
            format!("no memory for a copy of {count} values of {name}"),
        )
    })?;
    // SAFETY: as the caller of this function promises; the caller's list need not be aligned.
    copied.extend((0..count).map(|place| unsafe { list.add(place).read_unaligned() }));
    Ok(copied)
}

impl From<rate_distortion::Error> for Failure {
    fn from(error: rate_distortion::Error) -> Self {
        use rate_distortion::Error;
        let status = match error {
            Error::TooSmall { .. } | Error::AllVoid { .. } => DECIMESH_ERROR_EMPTY,
            Error::TooLarge { .. } => DECIMESH_ERROR_OVERFLOW,
            Error::NotFinite { .. } => DECIMESH_ERROR_NOT_FINITE,
            Error::Cancelled(_) => DECIMESH_ERROR_CANCELLED,
            Error::Threads(_) => DECIMESH_ERROR_THREADS,
            Error::Tile { .. } => DECIMESH_ERROR_IO,
            Error::SampleCount { .. } | Error::Spacing { .. } | Error::Target { .. } => DECIMESH_ERROR_OPTION,
        };
        Self::new(status, error.to_string())
    }
}

impl From<RemeshError> for Failure {
    fn from(error: RemeshError) -> Self {
        let status = match error {
            RemeshError::Simplify(error) => return error.into(),
            RemeshError::Surface(error) => return error.into(),
            RemeshError::Empty => DECIMESH_ERROR_EMPTY,
            RemeshError::Cancelled(_) => DECIMESH_ERROR_CANCELLED,
            RemeshError::Threads(_) => DECIMESH_ERROR_THREADS,
            _ => DECIMESH_ERROR_OPTION,
        };
        Self::new(status, error.to_string())
    }
}

impl From<SemiRegularError> for Failure {
    fn from(error: SemiRegularError) -> Self {
        let status = match error {
            SemiRegularError::Cancelled(_) => DECIMESH_ERROR_CANCELLED,
            SemiRegularError::Threads(_) => DECIMESH_ERROR_THREADS,
            _ => DECIMESH_ERROR_OPTION,
        };
        Self::new(status, error.to_string())
    }
}

/// Sets the defaults. NULL is left alone.
///
/// struct_size is sizeof(decimesh_hierarchy_options), as the caller was compiled: no more is written.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn decimesh_hierarchy_options_init(
    options: *mut decimesh_hierarchy_options,
    struct_size: usize,
) {
    // SAFETY: the caller's pointer is NULL or points to a struct of that size.
    unsafe { structs::initialize(options, struct_size) }
}

/// Sets struct_size and makes all else 0. NULL is left alone.
///
/// struct_size is sizeof(decimesh_hierarchy_report), as the caller was compiled: no more is written.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn decimesh_hierarchy_report_init(
    report: *mut decimesh_hierarchy_report,
    struct_size: usize,
) {
    // SAFETY: the caller's pointer is NULL or points to a struct of that size.
    unsafe { structs::initialize(report, struct_size) }
}

/// Decomposes heights: columns times rows of them, row by row, the northernmost row first.
///
/// Each has two at least; all heights are finite but those that options->no_data makes void, and one at least is
/// not void. options may be NULL: the defaults. heights and options->importance are copied.
///
/// *hierarchy receives the hierarchy, which the caller ends with decimesh_hierarchy_destroy(). Fails with _NULL,
/// _EMPTY (fewer than two columns or rows, or all void), _OVERFLOW, _NOT_FINITE (the text says where), _OPTION,
/// _STRUCT_SIZE, _UNKNOWN_OPTION, _CANCELLED, _THREADS or _OUT_OF_MEMORY.
///
/// About 0.1 s for a million samples; 24 bytes of memory a sample and two million, and up to half as much again for a grid that
/// is not of 2^d + 1 columns and rows or has voids; the hierarchy keeps 16. Any thread; progress is told on the
/// calling one.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn decimesh_hierarchy_create(
    heights: *const f32,
    columns: usize,
    rows: usize,
    options: *const decimesh_hierarchy_options,
    hierarchy: *mut *mut decimesh_hierarchy,
) -> decimesh_status {
    entry!([heights, hierarchy] {
        // SAFETY: neither is NULL, and the caller vouches for what the pointers point to.
        unsafe {
            let options = decimesh_hierarchy_options::read(options)?;
            let field = options.field(heights, columns, rows)?;
            let decomposition = Decomposition::new(field, &options.decomposition(), &mut options.monitor())?;
            decimesh_hierarchy::give(Decomposed::Heights(decomposition), hierarchy);
        }
        Ok(())
    })
}

/// Writes a hierarchy to a file, as docs/hierarchy-format.md describes it. The usual extension is .drd.
///
/// The file appears whole or not at all, as by decimesh_mesh_write(). path is UTF-8. Fails with _NULL, _UTF8, _IO
/// or _OPTION (the hierarchy is one of a surface). Linear in the samples; any thread.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn decimesh_hierarchy_write(
    hierarchy: *const decimesh_hierarchy,
    path: *const c_char,
) -> decimesh_status {
    entry!([hierarchy, path] {
        // SAFETY: neither is NULL, and the caller vouches for what they point to.
        unsafe { (*hierarchy).heights("a file")?.write(text(path)?)? };
        Ok(())
    })
}

/// Reads a hierarchy from such a file. path is UTF-8.
///
/// *hierarchy receives the hierarchy, which the caller ends with decimesh_hierarchy_destroy(). Fails with _NULL,
/// _UTF8, _IO or _FORMAT (the text says at which byte). Time and memory are in proportion to what is read, and about
/// half of what decimesh_hierarchy_create() takes; any thread.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn decimesh_hierarchy_read(
    path: *const c_char,
    hierarchy: *mut *mut decimesh_hierarchy,
) -> decimesh_status {
    entry!([path, hierarchy] {
        // SAFETY: neither is NULL, and the caller vouches for what they point to.
        unsafe {
            let read = Decomposition::read(text(path)?)?;
            decimesh_hierarchy::give(Decomposed::Heights(read), hierarchy);
        }
        Ok(())
    })
}

/// Remeshes a mesh, an oriented manifold with or without borders, to a semi-regular surface, and decomposes that: a
/// base of about base_quads quads (at least 1; 400 is a good number), each halved depth times (at least once) to
/// 4^depth squares whose corners lie on the mesh.
///
/// Errors are then distances in space between the vertices of the surface and where they are in the result. options
/// may be NULL; what it says of heights is not looked at.
///
/// *hierarchy receives the hierarchy, which the caller ends with decimesh_hierarchy_destroy(). Fails with _NULL,
/// _EMPTY, _OPTION (the mesh is no such manifold, and the text says where; or the base cannot be halved so often),
/// _STRUCT_SIZE, _UNKNOWN_OPTION, _CANCELLED or _THREADS. About 20 microseconds a vertex of the surface, and 120
/// bytes. Any thread; progress is told on the calling one.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn decimesh_hierarchy_remesh(
    mesh: *const decimesh_mesh,
    depth: u32,
    base_quads: usize,
    options: *const decimesh_hierarchy_options,
    hierarchy: *mut *mut decimesh_hierarchy,
) -> decimesh_status {
    entry!([mesh, hierarchy] {
        // SAFETY: neither is NULL, and the caller vouches for what the pointers point to.
        unsafe {
            let options = decimesh_hierarchy_options::read(options)?;
            let monitor = &mut options.monitor();
            let remeshing = RemeshOptions { depth, base_quads, threads: options.threads as usize };
            let surface = remesh((*mesh).mesh(), &remeshing, monitor)?.surface;
            let decomposition = SurfaceDecomposition::new(surface, &options.decomposition(), monitor)?;
            decimesh_hierarchy::give(Decomposed::Surface(decomposition), hierarchy);
        }
        Ok(())
    })
}

/// Ends a hierarchy. NULL is left alone.
///
/// No other thread may use it any more. Meshes taken from it live on.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn decimesh_hierarchy_destroy(hierarchy: *mut decimesh_hierarchy) {
    if !hierarchy.is_null() {
        // SAFETY: a handle that came from a box and has not been destroyed.
        drop(unsafe { Box::from_raw(hierarchy) });
    }
}

/// How many samples are not void, or how many vertices the surface has; 0 for NULL. Constant time; any thread; never
/// fails.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn decimesh_hierarchy_samples(hierarchy: *const decimesh_hierarchy) -> usize {
    // SAFETY: NULL or a living handle.
    unsafe { hierarchy.as_ref() }.map_or(0, |hierarchy| match &hierarchy.decomposed {
        Decomposed::Heights(decomposition) => decomposition.samples(),
        Decomposed::Surface(decomposition) => decomposition.surface().positions().len(),
    })
}

/// The mesh with as much detail as is wanted: detail is a DECIMESH_DETAIL_ value, and value how much of it.
///
/// x grows with the column, y falls with the row, z is the height; triangles are counter-clockwise from above, and
/// texture coordinates those of an image with a pixel a sample. The mesh is conforming, and its vertices are among
/// those of every finer one; but for a grid that is not of 2^d + 1 columns and rows, which is cut off at its
/// edges: vertices there may lie between heights. No triangle covers a void.
///
/// No sample is farther than max_error from the surface, vertically: there are more vertices if it takes more.
/// INFINITY for no such bound.
///
/// *mesh receives the mesh, which the caller ends with decimesh_mesh_destroy(). report may be NULL; with it, the
/// largest error is measured, in time linear in the samples. Of a surface there are vertices, ratios and RMS alone, in
/// time linear in what comes out. Fails with _NULL, _ENUM, _OPTION or _STRUCT_SIZE.
/// Otherwise the time is linear in what comes out for vertices and ratios of a grid of 2^d + 1 columns and rows
/// without voids, times the logarithm of the samples for others; and n log n in the samples where errors are
/// bounded. Any thread.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn decimesh_hierarchy_at(
    hierarchy: *const decimesh_hierarchy,
    detail: decimesh_detail,
    value: f64,
    max_error: f64,
    mesh: *mut *mut decimesh_mesh,
    report: *mut decimesh_hierarchy_report,
) -> decimesh_status {
    entry!([hierarchy, mesh] {
        let detail = match detail {
            DECIMESH_DETAIL_VERTICES => Detail::Vertices(whole(value)?),
            DECIMESH_DETAIL_RATIO => Detail::Ratio(value),
            DECIMESH_DETAIL_RMS => Detail::Rms(value),
            DECIMESH_DETAIL_MAX_ERROR => Detail::MaxError(value),
            other => return Err(foreign("detail", other)),
        };
        // SAFETY: neither is NULL, and the caller vouches for what the pointers point to.
        unsafe {
            let size = if report.is_null() { 0 } else { structs::size(report)? };
            let (taken, own) = match &(*hierarchy).decomposed {
                Decomposed::Heights(heights) => of_heights(heights, detail, max_error, !report.is_null())?,
                Decomposed::Surface(surface) => of_surface(surface, detail, max_error)?,
            };
            if !report.is_null() {
                structs::write(report, size, &own);
            }
            decimesh_mesh::give(taken, mesh);
        }
        Ok(())
    })
}

/// The largest error is measured for a report alone.
fn of_heights(
    decomposition: &Decomposition,
    detail: Detail,
    max_error: f64,
    is_reported: bool,
) -> Result<(Mesh, decimesh_hierarchy_report), Failure> {
    let taken = match max_error == f64::INFINITY {
        true => decomposition.at(detail)?,
        false => decomposition.at_within(detail, max_error)?,
    };
    let report = decimesh_hierarchy_report {
        vertices: taken.samples.len() as u64,
        triangles: taken.mesh.triangles().len() as u64,
        rms: taken.rms,
        max_error: if is_reported { decomposition.measure(&taken).maximum } else { 0.0 },
        certified_gap: taken.certified_gap,
        ..decimesh_hierarchy_report::initial()
    };
    Ok((taken.mesh, report))
}

fn of_surface(
    decomposition: &SurfaceDecomposition,
    detail: Detail,
    max_error: f64,
) -> Result<(Mesh, decimesh_hierarchy_report), Failure> {
    let refused = |message: String| Err(Failure::new(DECIMESH_ERROR_OPTION, message));
    if max_error != f64::INFINITY {
        return refused(format!("max_error is {max_error}: the largest error of a surface is not known"));
    }
    let taken = match detail {
        Detail::Vertices(vertices) => decomposition.at_vertices(vertices),
        Detail::Ratio(ratio) if ratio > 0.0 && ratio <= 1.0 => {
            let vertices = decomposition.surface().positions().len() as f64;
            decomposition.at_vertices((ratio * vertices).round() as usize)
        }
        Detail::Rms(rms) if rms >= 0.0 && rms.is_finite() => decomposition.at_rms(rms),
        other => return refused(format!("{other:?} cannot be had of a surface")),
    };
    let report = decimesh_hierarchy_report {
        vertices: taken.vertices.len() as u64,
        triangles: taken.mesh.triangles().len() as u64,
        rms: taken.rms,
        max_error: f64::NAN,
        certified_gap: decomposition.certified_gap(taken.vertices.len()),
        ..decimesh_hierarchy_report::initial()
    };
    Ok((taken.mesh, report))
}

/// A free triangulation of at most so many vertices: 5 decibels or more closer to the heights than what
/// decimesh_hierarchy_at() gives with as many, but not nested in finer ones. With least_squares 1 its heights are
/// fitted to all samples, and are no longer those of samples themselves; with 0 they are.
///
/// The rim of what is known is covered exactly, which may take more vertices than asked for. progress may be NULL.
/// *mesh receives the mesh, which the caller ends with decimesh_mesh_destroy(). report may be NULL; its
/// certified_gap becomes infinite. Fails with _NULL, _OPTION (also for a surface), _STRUCT_SIZE or _CANCELLED. About linear in the
/// samples, and n log n in the vertices. Any thread; progress is told on the calling one.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn decimesh_hierarchy_tin(
    hierarchy: *const decimesh_hierarchy,
    vertices: usize,
    least_squares: i32,
    progress: decimesh_progress,
    progress_user: *mut c_void,
    mesh: *mut *mut decimesh_mesh,
    report: *mut decimesh_hierarchy_report,
) -> decimesh_status {
    entry!([hierarchy, mesh] {
        let least_squares = switch("least_squares", least_squares)?;
        // SAFETY: neither is NULL, and the caller vouches for what the pointers point to.
        unsafe {
            let decomposition = (*hierarchy).heights("a free triangulation")?;
            let size = if report.is_null() { 0 } else { structs::size(report)? };
            let tin = decomposition.tin(vertices, least_squares, &mut monitor(progress, progress_user))?;
            if !report.is_null() {
                let own = decimesh_hierarchy_report {
                    vertices: tin.samples.len() as u64,
                    triangles: tin.triangles.len() as u64,
                    rms: tin.error.rms(),
                    max_error: tin.error.maximum,
                    certified_gap: f64::INFINITY,
                    ..decimesh_hierarchy_report::initial()
                };
                structs::write(report, size, &own);
            }
            decimesh_mesh::give(tin.to_mesh(decomposition.field()), mesh);
        }
        Ok(())
    })
}

/// A number of vertices.
fn whole(value: f64) -> Result<usize, Failure> {
    match value >= 0.0 && value.fract() == 0.0 && value <= u32::MAX.into() {
        true => Ok(value as usize),
        false => {
            let message = format!("value {value} is no number of vertices");
            Err(Failure::new(DECIMESH_ERROR_OPTION, message))
        }
    }
}
