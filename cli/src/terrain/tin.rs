//! `decimesh terrain --tin`: a mesh of the hierarchy, set free.

use decimesh::rate_distortion::tin::{Tin, reduce};
use decimesh::rate_distortion::{Decomposition, Detail};
use decimesh::{Attributes, Mesh, Monitor};

use super::Terrain;
use crate::failure::Failure;

/// How many times the vertices asked for are taken from the hierarchy to choose from.
const SUPPLY: usize = 2;

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
    let supply = decomposition.at(Detail::Vertices(wanted.saturating_mul(SUPPLY)))?;
    let field = decomposition.field();
    let columns = field.columns() as u32;
    let places: Vec<_> = supply.samples.iter().map(|&sample| [sample % columns, sample / columns]).collect();
    let tin = reduce(field, &places, supply.mesh.triangles(), wanted, least_squares, monitor)?;
    let Tin { samples, heights, triangles, error } = tin;
    let places = || samples.iter().map(|place| place.map(|part| part as usize));
    let positions =
        places().zip(heights).map(|([column, row], height)| field.position(column, row, height)).collect();
    let uvs = places().map(|[column, row]| field.uv(column, row)).collect();
    let attributes = Attributes { uvs: Some(uvs), ..Attributes::default() };
    let mesh = Mesh::with_attributes(positions, triangles, attributes)
        .map_err(|error| Failure::Unexpected(error.to_string()))?;
    Ok(Terrain { mesh, error, certified_gap: None })
}
