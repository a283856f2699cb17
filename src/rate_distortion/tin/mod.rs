//! A triangulated irregular network in place of the nested right triangles of a 4-8 mesh.
//!
//! The 4-8 hierarchy pays for its regularity: a free triangulation of as many vertices is closer to the field.
//! But it knows best which samples to begin with. So a mesh of somewhat more vertices than asked for is taken from
//! it, and is then set free:
//!
//! 1. edges are flipped while that lowers the squared error (`flips`);
//! 2. vertices are taken away, the cheapest first, edges around each flipped (`collapses`);
//! 3. vertices move to samples next to theirs while that lowers the error, edges around each flipped (`moves`);
//! 4. where wished for, the heights are fitted by least squares (`fit`).
//!
//! All of this is about vertical distances at samples, weighted by their importance; the spacing of the grid
//! plays no part. The paper that the hierarchy is after has nothing of the kind: this hybrid of hierarchy and free
//! triangulation is decimesh's own. Beginning with twice as many vertices as asked for is good: three times as many
//! gain another 0.3 dB in half as much time again.

mod collapses;
mod fit;
mod flips;
mod moves;
mod order;
mod residual;
mod surface;
#[cfg(test)]
mod tests;
mod triangulation;

use super::decomposition::Decomposition;
use super::error::Error;
use super::extract::mesh_over;
use super::height_field::HeightField;
use super::vertical::{VerticalError, measure};
use crate::mesh::Mesh;
use crate::monitor::Monitor;
use residual::Samples;
use surface::Surface;
use triangulation::{Triangulation, Vertex};

/// A free triangulation over a height field.
#[derive(Debug, Clone, PartialEq)]
pub struct Tin {
    /// The column and the row of the sample over which each vertex stands.
    pub samples: Vec<[u32; 2]>,
    /// The height of each vertex: that of its sample, unless heights were fitted.
    pub heights: Vec<f32>,
    /// Three vertices each, counter-clockwise from above.
    pub triangles: Vec<[u32; 3]>,
    /// How far it is from the field, measured at all samples.
    pub error: VerticalError,
}

impl Decomposition {
    /// A free triangulation of at most so many vertices, made of the mesh of twice as many: closer to the field than
    /// the mesh of as many that [`Decomposition::at`] gives, by 5 decibels or more, but not nested in finer ones. With
    /// `least_squares` heights are fitted to the samples, and are no longer those of samples themselves.
    ///
    /// The rim of what is known is covered exactly, which may take more vertices than asked for. About linear in the
    /// samples, and `n log n` in the vertices: 1 to 1.5 s for a million samples.
    pub fn tin(&self, vertices: usize, least_squares: bool, monitor: &mut Monitor) -> Result<Tin, Error> {
        let start = self.places(vertices.saturating_mul(START));
        reduce(self.field(), &start.places, &start.triangles, vertices, least_squares, monitor)
    }
}

/// How many times the vertices asked for a triangulation begins with.
const START: usize = 2;

impl Tin {
    /// As a mesh over its field: east, north, up, with texture coordinates.
    pub fn to_mesh(&self, field: &HeightField) -> Mesh {
        mesh_over(field.grid(), &self.samples, &self.heights, self.triangles.clone())
    }
}

/// Reduces a triangulation to `target` vertices, or to as few as it can, and lowers its squared error.
///
/// `vertices` are columns and rows of samples that are not void, each once; `triangles` are counter-clockwise
/// from above, conforming, and no two over each other. What they cover stays covered, exactly: vertices on the rim
/// go along straight lines only and its corners stay, which is what can keep it above `target`. With
/// `least_squares` heights are fitted to the samples at the end and need no longer be those of samples.
/// The error is never above that of the triangulation with as many vertices or fewer; where a fit does not lower
/// it in the precision of the heights, there is none.
///
/// There may be fewer than 2^30 triangles to begin with. About linear in the samples covered, and `n log n` in the
/// vertices.
pub(crate) fn reduce(
    field: &HeightField,
    vertices: &[[u32; 2]],
    triangles: &[[u32; 3]],
    target: usize,
    least_squares: bool,
    monitor: &mut Monitor,
) -> Result<Tin, Error> {
    let at = |&[column, row]: &[u32; 2]| {
        let height = field.heights()[row as usize * field.columns() + column as usize];
        Vertex::new([column as i32, row as i32], height)
    };
    let (vertices, triangles) = order::arrange(vertices, triangles);
    let mesh = Triangulation::new(vertices.iter().map(at).collect(), &triangles);
    let mut surface = Surface::new(mesh, Samples::new(field));
    flips::settle_all(&mut surface, monitor, |part| 0.15 * part)?;
    collapses::collapse_to(&mut surface, target, monitor, |part| 0.15 + 0.5 * part)?;
    moves::improve(&mut surface, monitor, |part| 0.65 + 0.25 * part)?;
    let Surface { mut mesh, samples, .. } = surface;
    let sampled = tin(field, mesh.clone());
    if !least_squares {
        return Ok(sampled);
    }
    fit::fit(&mut mesh, &samples, monitor, |part| 0.9 + 0.1 * part)?;
    let fitted = tin(field, mesh);
    Ok(if fitted.error.squared < sampled.error.squared { fitted } else { sampled })
}

fn tin(field: &HeightField, mesh: Triangulation) -> Tin {
    let (vertices, triangles) = mesh.into_parts();
    let samples: Vec<_> = vertices.iter().map(|vertex| vertex.place.map(|part| part as u32)).collect();
    let heights: Vec<_> = vertices.iter().map(|vertex| vertex.height).collect();
    let error = measure(field, &samples, &heights, &triangles);
    Tin { samples, heights, triangles, error }
}
