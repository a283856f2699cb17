//! The distance of each vertex of one mesh from the surface of another: what a heat map shows.

use super::directed::{BATCH, BLOCK, NOISE, pieces};
use super::surface::Surface;
use super::{BUILT, DeviationError};
use crate::workers::Workers;
use crate::{Mesh, Monitor};

/// The distance of each vertex of `from` to the exactly nearest point of the surface of `to`, in units of the
/// positions, in the order of the vertices; of those that no triangle uses as well. `from` may be without triangles.
///
/// As in [`deviation`](super::deviation()), what is rounding counts as 0. `threads` is how many to work with, or 0 for
/// those of the global rayon pool; the result does not depend on it.
///
/// Building takes O(n log n), and a vertex about O(log n). About 110 bytes a triangle of `to` are held in memory, and
/// more while building; and 4 a vertex.
///
/// The monitor is told of progress on the calling thread, and may cancel.
pub fn vertex_distances(
    from: &Mesh,
    to: &Mesh,
    threads: usize,
    monitor: &mut Monitor,
) -> Result<Vec<f32>, DeviationError> {
    if to.triangles().is_empty() {
        return Err(DeviationError::Empty { mesh: "second" });
    }
    let workers = Workers::new(threads)?;
    monitor.report(0.0)?;
    let surface = Surface::new(to);
    monitor.report(BUILT)?;

    let positions = from.positions();
    let mut distances = Vec::with_capacity(positions.len());
    for batch in pieces(0..positions.len(), BLOCK * BATCH) {
        let blocks = workers.map(pieces(batch, BLOCK).collect(), |block| {
            // Neighbours often follow each other, so that what is nearest to one is a good guess for the next.
            let mut guess = 0;
            let distance = |&position: &[f32; 3]| {
                let point = glam::Vec3::from(position).as_dvec3();
                let nearest = surface.nearest(point, guess, 0.0);
                guess = nearest.triangle;
                // The point's own coordinates: a vertex far out does not make rounding of its neighbours' distances.
                let noise = NOISE * surface.reach().max(point.abs().max_element());
                if nearest.squared > noise * noise { nearest.squared.sqrt() as f32 } else { 0.0 }
            };
            positions[block].iter().map(distance).collect::<Vec<_>>()
        });
        distances.extend(blocks.into_iter().flatten());
        monitor.report(BUILT + (1.0 - BUILT) * (distances.len() as f64 / positions.len() as f64) as f32)?;
    }
    Ok(distances)
}
