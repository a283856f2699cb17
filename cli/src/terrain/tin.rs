//! `decimesh terrain --tin`: a mesh of the hierarchy, set free.

use decimesh::Monitor;
use decimesh::rate_distortion::{Decomposition, Detail};

use super::Terrain;
use crate::failure::Failure;

/// Fails where a number of vertices is not what was asked for.
pub(super) fn check(detail: Detail) -> Result<(), Failure> {
    match detail {
        Detail::Vertices(_) | Detail::Ratio(_) => Ok(()),
        _ => Err(Failure::Options("--tin is for --vertices and --ratio".into())),
    }
}

pub(super) fn terrain(
    decomposition: &Decomposition,
    detail: Detail,
    least_squares: bool,
    monitor: &mut Monitor,
) -> Result<Terrain, Failure> {
    let wanted = match detail {
        Detail::Vertices(vertices) => vertices,
        // The hierarchy knows what a ratio is, and refuses what is none.
        other => decomposition.at(other)?.samples.len(),
    };
    let tin = decomposition.tin(wanted, least_squares, monitor)?;
    let mesh = tin.to_mesh(decomposition.field());
    Ok(Terrain { mesh, error: tin.error, certified_gap: None })
}
