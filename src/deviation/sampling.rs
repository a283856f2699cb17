//! Points spread evenly over the area of a surface, the same for a seed wherever the work is cut.

use std::ops::Range;

use glam::DVec3;

use super::surface::Surface;
use super::triangle;
use crate::random::SplitMix64;

/// A point on a surface, and the normal of its triangle (of any length).
pub(super) struct Sample {
    pub(super) point: DVec3,
    pub(super) normal: DVec3,
}

/// Stratified samples: the surface is cut into as many pieces of equal area as samples are asked
/// for, in the order of the triangles, and each piece gets one point at random.
pub(super) struct Strata<'a> {
    surface: &'a Surface<'a>,
    /// Area of all triangles up to and with this one.
    areas: Vec<f64>,
    samples: u64,
    seed: u64,
}

impl<'a> Strata<'a> {
    /// Numbers a sample takes from the stream.
    const DRAWS: u64 = 3;

    /// Strata of `surface`, or `None` where there are no samples to draw: none are asked for, or no
    /// triangle has an area.
    pub(super) fn new(surface: &'a Surface<'a>, samples: usize, seed: u64) -> Option<Self> {
        let mut total = 0.0;
        let areas: Vec<_> = (0..surface.triangles().len() as u32)
            .map(|index| {
                total += triangle::normal(surface.corners(index)).map_or(0.0, |normal| 0.5 * normal.length());
                total
            })
            .collect();
        (samples > 0 && total > 0.0).then_some(Self { surface, areas, samples: samples as u64, seed })
    }

    /// The samples of a range out of all, one after the other along the triangles.
    pub(super) fn samples(&self, range: Range<usize>) -> impl Iterator<Item = Sample> {
        let total = self.areas.last().copied().unwrap_or_default();
        let mut random = SplitMix64::at(self.seed, (range.start as u64).wrapping_mul(Self::DRAWS));
        let mut next = None;
        range.map(move |index| {
            // Below the total also when rounded: the triangle found then has an area.
            let share = (index as f64 + random.unit()) / self.samples as f64;
            let area = (share * total).min(total.next_down());
            let mut at = next.unwrap_or_else(|| self.areas.partition_point(|&sum| sum <= area));
            while self.areas[at] <= area {
                at += 1;
            }
            next = Some(at);
            let [a, b, c] = self.surface.corners(at as u32);
            let across = random.unit().sqrt();
            let along = random.unit();
            let point = a * (1.0 - across) + b * (across * (1.0 - along)) + c * (across * along);
            Sample { point, normal: (b - a).cross(c - a) }
        })
    }
}
