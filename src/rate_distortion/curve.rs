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

#[cfg(test)]
mod tests {
    use crate::monitor::Monitor;
    use crate::rate_distortion::{Decomposition, DecompositionOptions, Detail, HeightField};

    #[test]
    fn a_curve_is_of_meshes_that_can_be_taken() {
        for (columns, rows, void) in [(33, 33, None), (30, 17, None), (30, 17, Some(3.0)), (2, 2, None)] {
            let heights = (0..columns * rows).map(|i| (i * i % 61) as f32).collect();
            let field = HeightField::new(columns, rows, heights, void).unwrap();
            let options = DecompositionOptions::default();
            let decomposition = Decomposition::new(field, &options, &mut Monitor::silent()).unwrap();
            let curve = decomposition.curve(20);
            assert!(curve.len() <= 20 && curve.is_sorted_by(|a, b| a.vertices < b.vertices));
            for point in &curve {
                let taken = decomposition.at(Detail::Vertices(point.vertices)).unwrap();
                assert_eq!(taken.mesh.positions().len(), point.vertices);
                // Further vertices that the cut at the field's edges takes away may count for the error.
                assert!(taken.rms <= point.rms * (1.0 + 1e-6));
            }
            let [first, .., last] = &curve[..] else {
                assert_eq!((columns, rows, curve.len()), (2, 2, 1));
                continue;
            };
            let all = decomposition.at(Detail::Ratio(1.0)).unwrap();
            assert_eq!((last.vertices, last.rms), (all.mesh.positions().len(), all.rms));
            let none = decomposition.at(Detail::Vertices(0)).unwrap();
            assert_eq!(first.vertices, none.mesh.positions().len());
            assert!(decomposition.curve(0).is_empty() && decomposition.curve(1).len() == 1);
        }
    }
}
