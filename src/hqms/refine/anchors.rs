//! What holds vertices to the input where no sample does.

use super::samples::Sample;
use crate::collapse::surface::Surface;
use crate::workers::Workers;
use glam::{Vec3A, Vec4};

/// A plane of the input, near a vertex.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Anchor {
    pub(super) point: Vec3A,
    /// Of length 1, or 0 where there is no plane.
    pub(super) normal: Vec3A,
}

/// For each vertex that is not `fixed` the plane of the input at the sample that is nearest to it, of those
/// that belong to its faces. `samples` are in the order of their faces, those of each beginning at its of
/// `starts`.
pub(super) fn anchors(
    surface: &Surface,
    samples: &[Sample],
    starts: &[u32],
    fixed: &[bool],
    workers: &Workers,
) -> Vec<Anchor> {
    let anchor = |vertex: u32, point: &Vec4| {
        let point = Vec3A::from_vec4(*point);
        let mut nearest = Anchor::default();
        let mut least = f32::INFINITY;
        for corner in surface.ring(vertex) {
            let face = (corner >> 2) as usize;
            for sample in &samples[starts[face] as usize..starts[face + 1] as usize] {
                let distance_squared = sample.point().distance_squared(point);
                if distance_squared < least {
                    least = distance_squared;
                    nearest = Anchor { point: sample.point(), normal: sample.normal() };
                }
            }
        }
        nearest
    };
    workers.list(fixed.len(), |vertex| {
        if fixed[vertex] { Anchor::default() } else { anchor(vertex as u32, &surface.points[vertex]) }
    })
}
