//! Simplification within a guaranteed error.

use super::bound::decimesh_bound_result;
use super::entry::entry;
use super::mesh::decimesh_mesh;
use super::simplify::{ReportPlace, decimesh_simplify_options, decimesh_simplify_report};
use super::status::decimesh_status;
use super::structs;
use crate::certified::simplify_within;
use crate::hqms::Target;

/// Simplifies a mesh to few triangles whose two-sided Hausdorff distance from it is proven to be at most
/// max_error, in units of the positions: no point of either surface is farther from the other.
///
/// The target and the target_value of the options are not looked at; all else is as for decimesh_simplify(), and
/// the topology is kept. Where nothing smaller can be shown to be so close, the input comes back, without the vertices
/// that no triangle uses, at distance 0: so it is for a max_error below 2^-42 of the largest coordinate. A degenerate
/// triangle that sticks out of the rest by more than max_error cannot go, and nothing else does then.
///
/// *simplified receives a new mesh, which the caller ends with decimesh_mesh_destroy(). *report and *bound, if they
/// are not NULL, have been set up by their init functions; report->stopped_by is DECIMESH_STOPPED_BY_ERROR,
/// bound->upper is at most max_error, and report->error is that, rounded upwards. Fails with _NULL, _STRUCT_SIZE,
/// _UNKNOWN_OPTION, _ENUM, _OPTION (also for a max_error that is negative, infinite or not a number), _CANCELLED,
/// _THREADS or _OUT_OF_MEMORY.
///
/// At most nine times the time of decimesh_bound(): some ten to 200 microseconds a triangle. About 280 bytes of
/// memory a triangle, and at most 120 for each of 32 parts a triangle that have to be looked at. The result is the
/// same, byte for byte, for any number of threads. Any thread; progress is told on the calling one.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn decimesh_simplify_within(
    mesh: *const decimesh_mesh,
    max_error: f64,
    options: *const decimesh_simplify_options,
    simplified: *mut *mut decimesh_mesh,
    report: *mut decimesh_simplify_report,
    bound: *mut decimesh_bound_result,
) -> decimesh_status {
    entry!([mesh, options, simplified] {
        // SAFETY: none is NULL but perhaps the report and the bound, and the caller vouches for what they point to.
        unsafe {
            let mesh = (*mesh).mesh();
            let own = structs::read(options)?;
            let options = own.complete(own.with_target(Target::MaxError(0.0))?, mesh)?;
            let report = ReportPlace::new(report)?;
            let bound_size = if bound.is_null() { 0 } else { structs::size(bound)? };
            let result = simplify_within(mesh, max_error, &options, &mut own.monitor())?;
            let simple = result.simplified;
            report.write(&(&simple).into());
            if !bound.is_null() {
                structs::write(bound, bound_size, &result.bound.into());
            }
            own.write_elements(simple.origins.as_deref(), simple.groups.as_deref());
            decimesh_mesh::give(simple.mesh, simplified);
        }
        Ok(())
    })
}
