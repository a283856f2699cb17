use super::tree::Tree;
use super::{
    Approximations, Choice, Criterion, Method, Optimum, Polyline, PolylineError, approximate, optimum,
};
use crate::random::SplitMix64;
use crate::rate_distortion::brute_force::{above_hull, exhaustive, lower_hull};
use crate::rate_distortion::graph::Graph;

const METHODS: [Method; 9] = [
    Method::RateDistortion,
    Method::Decimation(Choice::Tree, Criterion::Local),
    Method::Decimation(Choice::Tree, Criterion::Global),
    Method::Decimation(Choice::Free, Criterion::Local),
    Method::Decimation(Choice::Free, Criterion::Global),
    Method::Insertion(Choice::Tree, Criterion::Local),
    Method::Insertion(Choice::Tree, Criterion::Global),
    Method::Insertion(Choice::Free, Criterion::Local),
    Method::Insertion(Choice::Free, Criterion::Global),
];

/// A walk at random, in steps of whole numbers.
fn walk(samples: usize, seed: u64) -> Polyline {
    let mut random = SplitMix64::at(seed, 0);
    let mut height = 0.0;
    let mut next = || {
        height += random.below(65) as f32 - 32.0;
        height
    };
    Polyline::new((0..samples).map(|_| next()).collect()).unwrap()
}

/// The distortion of a line through `samples`, by the equation of a line.
fn distortion(polyline: &Polyline, samples: &[u32]) -> f64 {
    let height = |sample: u32| f64::from(polyline.heights()[sample as usize]);
    let segment = |from: u32, to: u32| {
        let slope = (height(to) - height(from)) / f64::from(to - from);
        let offset = height(from) - slope * f64::from(from);
        (from..to).map(|sample| (height(sample) - slope * f64::from(sample) - offset).powi(2)).sum::<f64>()
    };
    samples.windows(2).map(|ends| segment(ends[0], ends[1])).sum()
}

/// The least distortion of all subsets of samples, by number of segments from 1 on.
fn least(polyline: &Polyline) -> Vec<f64> {
    let last = polyline.segments() as u32;
    let mut least = vec![f64::INFINITY; last as usize];
    for set in 0u32..1 << (last - 1) {
        let between = (1..last).filter(|sample| set >> (sample - 1) & 1 == 1);
        let samples: Vec<_> = std::iter::once(0).chain(between).chain([last]).collect();
        let least = &mut least[samples.len() - 2];
        *least = least.min(distortion(polyline, &samples));
    }
    least
}

fn close(a: f64, b: f64, polyline: &Polyline) -> bool {
    (a - b).abs() <= 1e-10 * (1.0 + distortion(polyline, &[0, polyline.segments() as u32]))
}

#[test]
fn the_optimum_is_that_of_all_subsets_and_is_never_beaten() {
    for seed in 0..40 {
        let polyline = walk(2 + seed as usize % 8, seed);
        let best = optimum(&polyline, usize::MAX).unwrap();
        for (segments, least) in (1..).zip(least(&polyline)) {
            assert!(close(best.distortion(segments).unwrap(), least, &polyline));
        }
    }
    for (samples, seed) in [(33, 1), (64, 2), (129, 3)] {
        let polyline = walk(samples, seed);
        let best = optimum(&polyline, samples).unwrap();
        for segments in 1..samples {
            let optimal = best.distortion(segments).unwrap();
            let through = best.samples(segments).unwrap();
            assert_eq!(through.len(), segments + 1);
            assert!(through.is_sorted_by(|a, b| a < b) && through[0] == 0);
            assert!(close(distortion(&polyline, &through), optimal, &polyline));
            for method in METHODS {
                let own = approximate(&polyline, method).distortion(segments).unwrap();
                assert!(own >= optimal || close(own, optimal, &polyline), "{method:?} {segments}");
            }
        }
    }
}

#[test]
fn the_distortion_that_is_tracked_is_that_of_the_line() {
    for (samples, seed) in [(2, 0), (3, 1), (9, 2), (57, 3), (129, 4)] {
        let polyline = walk(samples, seed);
        for method in METHODS {
            let approximations = approximate(&polyline, method);
            let mut gone = approximations.order().to_vec();
            gone.sort_unstable();
            assert!(gone.into_iter().eq(1..samples as u32 - 1), "{method:?}");
            for segments in 1..samples {
                let through = approximations.samples(segments).unwrap();
                assert_eq!(through.len(), segments + 1);
                let tracked = approximations.distortion(segments).unwrap();
                assert!(close(tracked, distortion(&polyline, &through), &polyline), "{method:?} {segments}");
            }
            assert_eq!(approximations.steps().next(), Some(polyline.segments()));
            assert_eq!(approximations.steps().last(), Some(1));
            assert!(approximations.steps().is_sorted_by(|a, b| a > b));
        }
    }
}

#[test]
fn generalized_decimation_finds_the_exact_hull_of_a_tree() {
    for seed in 0..12 {
        // Halves as equal as can be: whole numbers of parts make whole deltas, exact in either arithmetic.
        let polyline = walk(17, seed);
        let tree = Tree::new(17);
        let deltas: Vec<_> = tree.spans().map(|span| polyline.growth(span) * 256.0).collect();
        assert!(deltas.iter().all(|delta| delta.fract() == 0.0));
        let hull = lower_hull(&tree, &deltas.iter().map(|&delta| delta as i64).collect::<Vec<_>>());
        let (least, sets) = exhaustive(&tree, &deltas);
        assert_eq!(sets, 677, "subtrees of a tree of 15 vertices");
        let approximations = approximate(&polyline, Method::RateDistortion);
        let curve: Vec<_> = approximations
            .steps()
            .map(|segments| (16 - segments, approximations.distortion(segments).unwrap() * 256.0))
            .collect();
        for &(gone, distortion) in &curve {
            assert_eq!(distortion, least[gone]);
            assert_eq!(above_hull(&hull, gone, distortion), 0.0);
        }
        assert!(hull.iter().all(|&(gone, distortion)| curve.contains(&(gone, distortion as f64))));
    }
}

#[test]
fn generalized_decimation_is_monotone_and_one_at_a_time_is_not() {
    let falls = |approximations: &Approximations| {
        let curve: Vec<_> =
            approximations.steps().map(|segments| approximations.distortion(segments).unwrap()).collect();
        curve.windows(2).filter(|pair| pair[1] < pair[0] * (1.0 - 1e-12)).count()
    };
    let polyline = walk(1025, 5);
    assert_eq!(falls(&approximate(&polyline, Method::RateDistortion)), 0);
    assert!(falls(&approximate(&polyline, Method::Decimation(Choice::Tree, Criterion::Global))) > 0);
}

#[test]
fn a_greedy_step_takes_the_best_of_all_that_it_may() {
    for (samples, seed) in [(9, 10), (24, 11), (33, 12)] {
        let polyline = walk(samples, seed);
        let tree = Tree::new(samples);
        let allowed = |samples: &[u32], sample: u32, leaving: bool| {
            let vertex = sample as usize - 1;
            let stands = |relative: usize| samples.contains(&(relative as u32 + 1));
            match leaving {
                true => !tree.children(vertex).any(stands),
                false => tree.parents(vertex).all(stands),
            }
        };
        for method in &METHODS[1..] {
            let (Method::Decimation(choice, criterion) | Method::Insertion(choice, criterion)) = *method
            else {
                unreachable!()
            };
            let leaving = matches!(method, Method::Decimation(..));
            let approximations = approximate(&polyline, *method);
            for segments in 2..samples {
                let (fine, coarse) = (
                    approximations.samples(segments).unwrap(),
                    approximations.samples(segments - 1).unwrap(),
                );
                let before = if leaving { &fine } else { &coarse };
                let error = |sample: u32| {
                    let place = before.partition_point(|&other| other < sample);
                    let (from, to) = (before[place - 1], before[place + usize::from(leaving)]);
                    let with = distortion(&polyline, &[from, sample, to]);
                    let height = |sample: u32| f64::from(polyline.heights()[sample as usize]);
                    let part = f64::from(sample - from) / f64::from(to - from);
                    match criterion {
                        Criterion::Global => distortion(&polyline, &[from, to]) - with,
                        Criterion::Local => {
                            (height(sample) - height(from) * (1.0 - part) - height(to) * part).abs()
                        }
                    }
                };
                let candidates = (1..samples as u32 - 1).filter(|sample| before.contains(sample) == leaving);
                let candidates =
                    candidates.filter(|&sample| choice == Choice::Free || allowed(before, sample, leaving));
                let taken = fine.iter().find(|sample| !coarse.contains(sample)).unwrap();
                let errors: Vec<_> = candidates.map(error).collect();
                let best = match leaving {
                    true => errors.iter().copied().fold(f64::INFINITY, f64::min),
                    false => errors.iter().copied().fold(f64::NEG_INFINITY, f64::max),
                };
                assert!(close(error(*taken), best, &polyline), "{method:?} {segments}");
            }
        }
    }
}

#[test]
fn straight_parts_go_first_and_cost_nothing() {
    let polyline = Polyline::new((0..4097).map(|sample| (sample as f32 - 2048.0).abs()).collect()).unwrap();
    for method in METHODS {
        let approximations = approximate(&polyline, method);
        assert_eq!(approximations.distortion(2), Some(0.0), "{method:?}");
        assert_eq!(approximations.samples(2), Some(vec![0, 2048, 4096]), "{method:?}");
    }
    let halves = approximate(&polyline, Method::RateDistortion).steps().collect::<Vec<_>>();
    assert_eq!(halves, [4096, 2049, 2, 1], "each half goes at once");
}

#[test]
fn ties_go_to_the_smaller_sample() {
    let polyline = Polyline::new(vec![0.0, 1.0, 0.0, 1.0, 0.0]).unwrap();
    for method in &METHODS[1..] {
        let order = approximate(&polyline, *method).order().to_vec();
        let place = |sample| order.iter().position(|&other| other == sample);
        let came_last = matches!(method, Method::Insertion(..));
        assert_eq!(place(1) > place(3), came_last, "{method:?} {order:?}");
    }
    // Once sample 1 is gone, sample 3 alone and with the middle have one slope: the middle is coarser.
    let polyline = Polyline::new(vec![0.0, 2.0, 2.0, 5.0, 0.0]).unwrap();
    let deltas: Vec<_> = Tree::new(5).spans().map(|span| polyline.growth(span)).collect();
    assert_eq!(deltas, [1.0, 16.0, 16.0]);
    assert_eq!(approximate(&polyline, Method::RateDistortion).steps().collect::<Vec<_>>(), [4, 3, 1]);
}

#[test]
fn what_is_asked_for_and_is_not_there_is_none() {
    let polyline = walk(6, 3);
    let approximations = approximate(&polyline, Method::RateDistortion);
    let best = optimum(&polyline, 3).unwrap();
    for segments in [0, 6, usize::MAX] {
        assert_eq!(approximations.samples(segments), None);
        assert_eq!(approximations.distortion(segments), None);
    }
    for segments in [0, 4, usize::MAX] {
        assert_eq!(best.samples(segments), None);
        assert_eq!(best.distortion(segments), None);
    }
    let none: Optimum = optimum(&polyline, 0).unwrap();
    assert_eq!((none.samples(1), none.distortion(1)), (None, None));
}

#[test]
fn what_is_no_polyline_is_refused() {
    for samples in [0, 1] {
        assert_eq!(Polyline::new(vec![1.0; samples]), Err(PolylineError::TooShort { samples }));
    }
    for height in [f32::INFINITY, f32::NEG_INFINITY] {
        let sample = 2;
        assert_eq!(Polyline::new(vec![1.0, 2.0, height]), Err(PolylineError::NotFinite { height, sample }));
    }
    let error = Polyline::new(vec![f32::NAN, 0.0]).unwrap_err();
    assert_eq!(error.to_string(), "height NaN of sample 0 is not finite");
    let long = Polyline::new(vec![0.0; 2050]).unwrap();
    assert_eq!(optimum(&long, 1), Err(PolylineError::TooLong { samples: 2050, limit: 2049 }));
    // The largest heights there are do not overflow.
    let steep =
        Polyline::new((0..9).map(|sample| if sample % 2 == 0 { f32::MAX } else { f32::MIN }).collect());
    for method in METHODS {
        assert!(approximate(&steep.clone().unwrap(), method).distortion(1).unwrap().is_finite());
    }
}
