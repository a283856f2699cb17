//! Decompositions by the methods of the paper, for comparison.

use super::baselines::{self, Criterion, interpolation_errors};
use super::decomposition::Decomposition;
use super::flow::{Certificate, NEVER};
use super::height_field::HeightField;
use super::lattice::Lattice;
use super::{Error, merging};
use crate::monitor::Monitor;
use crate::workers::Workers;

/// What [`Decomposition::new`] is held against: all that Balmelli, Vetterli and Liebling have, "Mesh Optimization
/// Using Global Error with Application to Geometry Simplification". All keep the same hierarchy.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Baseline {
    /// The paper's own algorithm: the vertex goes, with all of its descendants, that adds the least distortion for
    /// each of them. About as good as [`Decomposition::new`], in some forty times the time.
    GeneralizedDecimation,
    /// One vertex at a time from all of them down: the one of least error without descendants.
    Decimation(Criterion),
    /// From the corners up: the vertex of largest error whose triangle is there, with the ancestors it needs.
    Insertion(Criterion),
}

/// The part of the time, about, that all deltas take.
const DELTAS: f32 = 0.05;

impl Decomposition {
    /// Decomposes a field by one of the methods of the paper. Nothing is proven of it: its
    /// [gap](super::Approximation::certified_gap) is infinite. O(n log n) on one thread, about 130 bytes a sample.
    pub fn by_baseline(field: HeightField, baseline: Baseline, monitor: &mut Monitor) -> Result<Self, Error> {
        let workers = Workers::new(1)?;
        monitor.report(0.0)?;
        let lattice = Lattice::new(field);
        let layout = lattice.layout();
        let deltas = lattice.deltas(&workers, monitor, 0.0..DELTAS)?;
        let errors = |criterion| match criterion {
            Criterion::Global => deltas.iter().map(|&delta| f64::from(delta)).collect(),
            Criterion::Local => {
                let mut errors = interpolation_errors(layout, |x, y| lattice.height([x as u32, y as u32]));
                let stay = errors.iter_mut().zip(&deltas).filter(|(_, delta)| delta.is_infinite());
                stay.for_each(|(error, _)| *error = f64::INFINITY);
                errors
            }
        };
        let removals = match baseline {
            Baseline::GeneralizedDecimation => {
                let report = |part: f32| monitor.report(DELTAS + (1.0 - DELTAS) * part);
                merging::decimate(layout, &deltas, report)?
            }
            Baseline::Decimation(criterion) => baselines::decimation(layout, &errors(criterion)),
            Baseline::Insertion(criterion) => baselines::insertion(layout, &errors(criterion)),
        };
        // Where vertices stand in the order serves as slopes; of those that round to the same the finer go first, as
        // they must.
        let mut slopes = vec![NEVER; deltas.len()];
        for (place, &vertex) in removals.order.iter().enumerate() {
            slopes[vertex as usize] = place as f32;
        }
        let decomposition = Self::of_slopes(lattice, deltas, slopes, Certificate::none(), &workers);
        monitor.report(1.0)?;
        Ok(decomposition)
    }
}

#[cfg(test)]
mod tests {
    use super::{Baseline, Criterion};
    use crate::monitor::{Cancelled, Monitor};
    use crate::rate_distortion::brute_force::{Terrain, above_hull, exhaustive, lower_hull};
    use crate::rate_distortion::graph::Graph;
    use crate::rate_distortion::layout::Layout;
    use crate::rate_distortion::{Decomposition, DecompositionOptions, Error, HeightField};
    use std::ops::ControlFlow;

    const BASELINES: [Baseline; 5] = [
        Baseline::GeneralizedDecimation,
        Baseline::Decimation(Criterion::Global),
        Baseline::Decimation(Criterion::Local),
        Baseline::Insertion(Criterion::Global),
        Baseline::Insertion(Criterion::Local),
    ];

    fn field(terrain: &Terrain) -> HeightField {
        let [right, bottom] = terrain.layout.extent();
        let places = (0..=bottom).flat_map(|y| (0..=right).map(move |x| (x, y)));
        let heights = places.map(|(x, y)| terrain.height(x, y)).collect();
        HeightField::new(right + 1, bottom + 1, heights, None).unwrap()
    }

    fn by(field: HeightField, baseline: Baseline) -> Decomposition {
        Decomposition::by_baseline(field, baseline, &mut Monitor::silent()).unwrap()
    }

    #[test]
    fn every_rate_of_every_baseline_has_the_error_it_says() {
        let terrain = Terrain::fractal(Layout::new([1, 1], 4), 11);
        for baseline in BASELINES {
            let decomposition = by(field(&terrain), baseline);
            assert_eq!(decomposition.lattice().layout(), &terrain.layout);
            let mut gone = vec![false; terrain.layout.vertices()];
            for removed in 0..=gone.len() {
                if removed % 7 == 0 {
                    let surface = terrain.surface(&gone);
                    terrain.assert_conforming(&surface);
                    let (tracked, measured) =
                        (decomposition.squared_error(removed), terrain.squared_error(&surface));
                    assert!((tracked - measured).abs() <= 1e-4 * (1.0 + measured), "{tracked} {measured}");
                }
                if let Some(&vertex) = decomposition.order().get(removed) {
                    gone[vertex as usize] = true;
                }
            }
        }
    }

    #[test]
    fn fields_of_any_size_with_voids_keep_their_order() {
        let heights = |columns: usize, rows: usize| {
            (0..columns * rows).map(|i| if i % 97 == 50 { -9.0 } else { (i * i % 61) as f32 }).collect()
        };
        for (columns, rows) in [(13, 10), (2, 2), (30, 17), (3, 2)] {
            let field = HeightField::new(columns, rows, heights(columns, rows), Some(-9.0)).unwrap();
            for baseline in BASELINES {
                let decomposition = by(field.clone(), baseline);
                let layout = decomposition.lattice().layout();
                let mut gone = vec![false; layout.vertices()];
                for (place, &vertex) in decomposition.order().iter().enumerate() {
                    let vertex = vertex as usize;
                    assert!(Graph::children(layout, vertex).all(|child| gone[child]));
                    assert!(!std::mem::replace(&mut gone[vertex], true));
                    assert_eq!(decomposition.is_forced(vertex), place >= decomposition.removable());
                }
                assert!(!gone.contains(&false));
                let sweeps = Decomposition::new(
                    field.clone(),
                    &DecompositionOptions::default(),
                    &mut Monitor::silent(),
                );
                assert_eq!(
                    sweeps.unwrap().removable(),
                    decomposition.removable(),
                    "what must stay is the same"
                );
            }
        }
    }

    /// Best is, with so many vertices removed, the least of all sets of 5 x 5, the exact hull of 9 x 9.
    #[test]
    fn sweeps_and_generalized_decimation_are_close_to_the_best() {
        let options = DecompositionOptions { sweeps: 64, gap: 0.0, max_sweeps: 256, threads: 1 };
        for (depth, seeds) in [(2, 6), (3, 3)] {
            let mut above_best = [Vec::new(), Vec::new()];
            for seed in 20..20 + seeds {
                let terrain = Terrain::fractal(Layout::new([1, 1], depth), seed);
                let deltas = terrain.deltas();
                let best: Vec<_> = if depth == 2 {
                    exhaustive(&terrain.layout, &deltas).0
                } else {
                    let units = 1024.0;
                    let whole: Vec<_> = deltas.iter().map(|delta| (delta * units).round() as i64).collect();
                    let hull = lower_hull(&terrain.layout, &whole);
                    (0..=deltas.len()).map(|removed| -above_hull(&hull, removed, 0.0) / units).collect()
                };
                let sweeps = Decomposition::new(field(&terrain), &options, &mut Monitor::silent()).unwrap();
                let paper = by(field(&terrain), Baseline::GeneralizedDecimation);
                for removed in (1..=deltas.len()).filter(|&removed| best[removed] > 1.0) {
                    for (all, decomposition) in above_best.iter_mut().zip([&sweeps, &paper]) {
                        let above = 10.0 * (decomposition.squared_error(removed) / best[removed]).log10();
                        assert!(above >= -1e-3, "{above}");
                        all.push(above);
                    }
                }
            }
            let means = above_best.map(|all| all.iter().sum::<f64>() / all.len() as f64);
            // Between two steps of the paper, and beside corners of the hull, both are a little above.
            assert!(means.iter().all(|&mean| mean <= 0.15), "{means:?} dB");
            assert!((means[0] - means[1]).abs() <= 0.02, "{means:?} dB");
        }
    }

    #[test]
    fn a_monitor_can_end_it() {
        let terrain = Terrain::fractal(Layout::new([1, 1], 3), 1);
        for baseline in BASELINES {
            let mut last = 0.0;
            let mut reports = 0;
            let mut monitor = Monitor::new(|part| {
                assert!(part >= last);
                (last, reports) = (part, reports + 1);
                ControlFlow::Continue(())
            });
            Decomposition::by_baseline(field(&terrain), baseline, &mut monitor).unwrap();
            drop(monitor);
            assert_eq!(last, 1.0);
            for allowed in 0..reports {
                let mut heard = 0;
                let mut monitor = Monitor::new(|_| {
                    heard += 1;
                    if heard > allowed { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
                });
                let result = Decomposition::by_baseline(field(&terrain), baseline, &mut monitor);
                assert_eq!(result.unwrap_err(), Error::Cancelled(Cancelled));
            }
        }
    }
}
