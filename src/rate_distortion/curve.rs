//! How error and rate belong together, from a few vertices to all of them.

use super::decomposition::Decomposition;

/// A mesh on the way from all vertices to the fewest.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RatePoint {
    /// How many vertices it has.
    pub vertices: usize,
    /// Its RMS, as tracked.
    pub rms: f64,
}

impl Decomposition {
    /// Up to `points` meshes from the fewest vertices to all, each with about the same factor more than the one
    /// before. Takes about as long as extracting all of them.
    pub fn curve(&self, points: usize) -> Vec<RatePoint> {
        let removable = self.removable();
        let places = (0..points).map(|point| {
            let part = point as f64 / (points.max(2) - 1) as f64;
            let left = (removable as f64 + 1.0).powf(part).round() as usize - 1;
            removable - left.min(removable)
        });
        let mut curve: Vec<RatePoint> = Vec::with_capacity(points);
        for removed in places {
            let vertices = self.extract(removed).places.len();
            if curve.last().is_none_or(|last| vertices > last.vertices) {
                curve.push(RatePoint { vertices, rms: self.root_mean(self.squared_error(removed)) });
            }
        }
        curve
    }
}
