//! `decimesh terrain --tin`: a mesh of the hierarchy, set free.

use decimesh::Monitor;
use decimesh::rate_distortion::{Approximation, Decomposition, Detail};

use crate::failure::Failure;

/// Fails where a number of vertices is not what was asked for.
pub(super) fn check(detail: Detail) -> Result<(), Failure> {
    match detail {
        Detail::Vertices(_) | Detail::Ratio(_) => Ok(()),
        _ => Err(Failure::Options("--tin is for --vertices and --ratio".into())),
    }
}

/// A triangulation of as many vertices as a detail means. No bound on other triangulations is known.
pub(super) fn take(
    decomposition: &Decomposition,
    detail: Detail,
    least_squares: bool,
    monitor: &mut Monitor,
) -> Result<Approximation, Failure> {
    let wanted = match detail {
        Detail::Vertices(vertices) => vertices,
        // The hierarchy knows what a ratio is, and refuses what is none.
        other => decomposition.at(other)?.samples.len(),
    };
    let tin = decomposition.tin(wanted, least_squares, monitor)?;
    let field = decomposition.field();
    let columns = field.columns() as u32;
    Ok(Approximation {
        mesh: tin.to_mesh(field),
        samples: tin.samples.iter().map(|[column, row]| row * columns + column).collect(),
        squared_error: tin.error.squared,
        rms: tin.error.rms(),
        certified_gap: f64::INFINITY,
    })
}
