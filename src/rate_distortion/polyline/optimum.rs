//! The least distortion for each number of segments, by dynamic programming (section 4.1 of the paper): the best
//! line of `k` segments to a sample is the best of `k - 1` to one before, and a segment.

use super::{Polyline, PolylineError};

/// The longest line whose optimum can be asked for: some seconds, and 50 MB for all rates.
const MAX_SAMPLES: usize = 2049;

/// The best approximations of a polyline, one for each number of segments. Other than those of
/// [`approximate`](super::approximate), they need have nothing in common.
#[derive(Debug, Clone, PartialEq)]
pub struct Optimum {
    segments: usize,
    /// For each sample, the distortion up to it of the best line of 1, 2, ... segments; infinite where they are
    /// more than samples.
    distortions: Vec<f64>,
    /// Where the last of these segments starts.
    starts: Vec<u32>,
}

/// Finds the best approximations of 1 to `segments` segments (or those of the polyline, if they are fewer).
///
/// O(n³) for a line of n samples, at most 2049; memory O(n `segments`).
pub fn optimum(polyline: &Polyline, segments: usize) -> Result<Optimum, PolylineError> {
    let samples = polyline.heights.len();
    if samples > MAX_SAMPLES {
        return Err(PolylineError::TooLong { samples, limit: MAX_SAMPLES });
    }
    let segments = segments.min(polyline.segments());
    let mut distortions = vec![f64::INFINITY; samples * segments];
    let mut starts = vec![0; samples * segments];
    for to in 1..samples {
        let (before, after) = distortions.split_at_mut(to * segments);
        let best = &mut after[..segments];
        let starts = &mut starts[to * segments..][..segments];
        for from in 0..to {
            let error = polyline.error(from, to);
            if from == 0 {
                best.iter_mut().take(1).for_each(|first| *first = error);
            }
            // One segment more than up to where this one starts.
            let longer = best.iter_mut().zip(starts.iter_mut()).skip(1);
            for ((best, start), shorter) in longer.zip(&before[from * segments..][..segments]) {
                if shorter + error < *best {
                    (*best, *start) = (shorter + error, from as u32);
                }
            }
        }
    }
    Ok(Optimum { segments, distortions, starts })
}

impl Optimum {
    /// The distortion with `segments` segments; `None` for 0, or more than were asked for.
    pub fn distortion(&self, segments: usize) -> Option<f64> {
        self.entry(segments).map(|entry| self.distortions[entry])
    }

    /// The samples that `segments` segments join, ascending; `None` for 0, or more than were asked for.
    pub fn samples(&self, segments: usize) -> Option<Vec<u32>> {
        let mut entry = self.entry(segments)?;
        let mut samples = vec![(self.starts.len() / self.segments) as u32 - 1];
        for left in (0..segments).rev() {
            let start = self.starts[entry];
            samples.push(start);
            entry = start as usize * self.segments + left.saturating_sub(1);
        }
        samples.reverse();
        Some(samples)
    }

    /// Where the line of `segments` segments to the last sample is.
    fn entry(&self, segments: usize) -> Option<usize> {
        let last = self.distortions.len().checked_sub(self.segments)?;
        (1..=self.segments).contains(&segments).then(|| last + segments - 1)
    }
}
