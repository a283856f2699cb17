//! Points spread evenly over the area of a surface, the same for a seed wherever the work is cut.

use std::ops::Range;

use glam::DVec3;

use super::surface::Surface;
use super::triangle;

/// SplitMix64 (Steele, Lea and Flood, 2014). Its state is a counter, so that a block of samples can
/// start anywhere in the one stream of a seed without drawing what comes before.
struct SplitMix64(u64);

impl SplitMix64 {
    const STEP: u64 = 0x9E37_79B9_7F4A_7C15;

    /// The stream of `seed`, after `drawn` numbers.
    fn at(seed: u64, drawn: u64) -> Self {
        // Seeds are mixed once: plain ones a step apart would give one stream shifted by one.
        Self(Self::mix(seed).wrapping_add(Self::STEP.wrapping_mul(drawn)))
    }

    fn mix(mut bits: u64) -> u64 {
        bits = (bits ^ (bits >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        bits = (bits ^ (bits >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        bits ^ (bits >> 31)
    }

    /// The next number in `0.0..1.0`.
    fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(Self::STEP);
        (Self::mix(self.0) >> 11) as f64 * (-53f64).exp2()
    }
}

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
