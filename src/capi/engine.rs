//! Simplification of the caller's own buffers, without handles: for engines.

use super::buffers::{
    DECIMESH_INDEX_U16, decimesh_buffers, decimesh_index_type, decimesh_mutable_buffers, read_mesh,
    write_indices,
};
use super::entry::entry;
use super::simplify::{ReportPlace, decimesh_simplify_options, decimesh_simplify_report};
use super::status::{DECIMESH_ERROR_TOO_LARGE, Failure, decimesh_status};
use super::structs;
use crate::hqms::{Options, Placement, Simplified, simplify_owned};
use crate::mesh::weld::shared_places;
use std::ffi::c_void;

/// Simplifies to indices alone: all levels of detail share the caller's vertices, which are not changed.
///
/// destination has room for buffers->index_count indices of buffers->index_type, and may be
/// buffers->indices itself. It receives *index_count indices. The placement is
/// DECIMESH_PLACEMENT_EXISTING, whatever the options say. With options->keep_seams, vertices that share a
/// place are found by their positions, and go along their seams together. Attributes may be left NULL; only
/// those that are given and have a weight count as error. options->origins, if asked for, names the caller's
/// vertices.
///
/// Where the topology had to be given up (report->topology_changed), a vertex at which the surface was
/// parted serves both parts.
///
/// *report, if it is not NULL, has been set up by decimesh_simplify_report_init. Fails as
/// decimesh_mesh_from_buffers() and decimesh_simplify() do; then nothing was written.
///
/// Linear time; about 48 bytes of memory a triangle, the copy of the buffers included, and 66 if normals have
/// a weight. Any thread; progress is told on the calling one.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn decimesh_simplify_indices(
    destination: *mut c_void,
    buffers: *const decimesh_buffers,
    options: *const decimesh_simplify_options,
    index_count: *mut usize,
    report: *mut decimesh_simplify_report,
) -> decimesh_status {
    entry!([destination, buffers, options, index_count] {
        // SAFETY: none is NULL but perhaps the report, and the caller vouches for what they point to.
        unsafe {
            let buffers = structs::read(buffers)?;
            let (own, options) = decimesh_simplify_options::read(options)?;
            let options = Options { placement: Placement::Existing, ..options };
            let report = ReportPlace::new(report)?;
            let (result, places) = simplify_buffers(&buffers, &own, options)?;
            report.write(&(&result).into());
            hand_over(&result, &places, destination, buffers.index_type, index_count, &own);
        }
        Ok(())
    })
}

/// Simplifies in the caller's buffers: indices, positions and attributes are overwritten.
///
/// A vertex of the result takes the place of one that went into it, so that further streams of the
/// vertex buffer stay where they are and nothing moves; vertices that no index names any more keep what
/// they had. buffers->indices receives *index_count indices; with DECIMESH_PLACEMENT_EXISTING that is
/// all that changes, as by decimesh_simplify_indices(). options->origins, if asked for, names the caller's
/// vertices. With options->keep_seams, vertices that share a place are found by their positions, whether
/// there are attributes or not.
///
/// *report, if it is not NULL, has been set up by decimesh_simplify_report_init. Fails as
/// decimesh_mesh_from_buffers() and decimesh_simplify() do; then nothing was written.
///
/// Linear time; about 30 bytes of memory a triangle, the copy of the buffers included. No other thread may
/// use the buffers meanwhile; progress is told on the calling thread.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn decimesh_simplify_in_place(
    buffers: *const decimesh_mutable_buffers,
    options: *const decimesh_simplify_options,
    index_count: *mut usize,
    report: *mut decimesh_simplify_report,
) -> decimesh_status {
    entry!([buffers, options, index_count] {
        // SAFETY: none is NULL but perhaps the report, and the caller vouches for what they point to.
        unsafe {
            let buffers = structs::read(buffers)?;
            let (own, options) = decimesh_simplify_options::read(options)?;
            let report = ReportPlace::new(report)?;
            let moves = options.placement == Placement::Optimal;
            let (result, mut places) = simplify_buffers(&buffers.shared(), &own, options)?;
            if moves {
                part(&mut places, buffers.vertex_count, buffers.index_type)?;
                buffers.write_vertices(&result.mesh, &places);
            }
            report.write(&(&result).into());
            hand_over(&result, &places, buffers.indices, buffers.index_type, index_count, &own);
        }
        Ok(())
    })
}

/// The simplified mesh of `buffers`, and for each of its vertices the caller's whose place it takes.
///
/// # Safety
/// As for [`read_mesh`], and the pointers of `own` are good.
unsafe fn simplify_buffers(
    buffers: &decimesh_buffers,
    own: &decimesh_simplify_options,
    options: Options,
) -> Result<(Simplified, Vec<u32>), Failure> {
    // SAFETY: as the caller of this function promises.
    let (mesh, mut options, mut monitor) = unsafe {
        let mesh = read_mesh(buffers)?;
        let options = own.complete(options, &mesh)?;
        (mesh, options, own.monitor())
    };
    if options.keep_seams && options.placement == Placement::Optimal {
        // The vertex buffer may have attributes that this call is not shown.
        options.locked.extend(shared_places(&mesh));
    }
    options.track_sources = true;
    let mut result = simplify_owned(mesh, &options, &mut monitor)?;
    let places = result.sources.take().unwrap_or_default();
    Ok((result, places))
}

/// Gives each vertex a place of its own, where several came from one: those that no vertex has.
fn part(places: &mut [u32], count: usize, index_type: decimesh_index_type) -> Result<(), Failure> {
    let mut taken = vec![false; count];
    let mut homeless = Vec::new();
    for (vertex, &place) in places.iter().enumerate() {
        if std::mem::replace(&mut taken[place as usize], true) {
            homeless.push(vertex);
        }
    }
    let limit = if index_type == DECIMESH_INDEX_U16 { count.min(1 << 16) } else { count };
    let mut free = (0..limit).filter(|&place| !taken[place]);
    for vertex in homeless {
        let Some(place) = free.next() else {
            let message = format!("the result has {} vertices, more than the {limit} places", places.len());
            return Err(Failure::new(DECIMESH_ERROR_TOO_LARGE, message));
        };
        places[vertex] = place as u32;
    }
    Ok(())
}

/// Writes the indices, how many there are, the origins, all in the caller's names for vertices, and the
/// groups.
///
/// # Safety
/// There is room for as many of each as the input had.
unsafe fn hand_over(
    result: &Simplified,
    places: &[u32],
    destination: *mut c_void,
    index_type: decimesh_index_type,
    index_count: *mut usize,
    options: &decimesh_simplify_options,
) {
    let place = |vertex: &u32| places[*vertex as usize];
    let indices = result.mesh.triangles().as_flattened();
    let origins = result.origins.as_ref().map(|origins| {
        let named = |vertex: &u32| if *vertex == u32::MAX { u32::MAX } else { place(vertex) };
        origins.iter().map(named).collect::<Vec<_>>()
    });
    // SAFETY: as the caller of this function promises; a result has no more indices than its input, and
    // places are the caller's own indices or, of 16 bits, were chosen to fit.
    unsafe {
        write_indices(destination, index_type, indices.iter().map(place));
        index_count.write(indices.len());
        options.write_elements(origins.as_deref(), result.groups.as_deref());
    }
}
