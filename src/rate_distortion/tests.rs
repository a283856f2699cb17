//! The room's promises, held against what is measured on the extracted meshes and against all meshes there are.

use std::collections::{HashMap, HashSet};

use proptest::prelude::*;

use super::brute_force::exhaustive;
use super::decomposition::{Decomposition, DecompositionOptions, Detail};
use super::distortion::{Half, Place};
use super::extract::{Extract, extract};
use super::height_field::HeightField;
use super::lattice::Lattice;
use super::layout::{Layout, Site};
use super::max_error;
use super::tiles::{InMemory, TileMesh, TileOptions, Tiles};
use crate::mesh::Mesh;
use crate::monitor::Monitor;
use crate::workers::Workers;

/// Fields of all sizes up to 12 rows and columns; heights of few values, so that there are ties and flat places.
fn fields() -> impl Strategy<Value = HeightField> {
    let size = prop_oneof![Just((5, 5)), Just((9, 9)), (2usize..12, 2usize..12)];
    let void = prop_oneof![3 => Just(0.0), 1 => Just(0.1), 1 => Just(0.5)];
    (size, void, any::<bool>()).prop_flat_map(|((columns, rows), void, weighted)| {
        let samples = columns * rows;
        let height = prop_oneof![(-3i8..4).prop_map(f32::from), -10.0f32..10.0];
        let heights = prop::collection::vec((height, prop::bool::weighted(void)), samples);
        let weights = prop::collection::vec(prop_oneof![Just(0.0f32), 0.1f32..4.0], samples);
        (heights, weights).prop_filter_map("not all void", move |(heights, weights)| {
            let heights =
                heights.into_iter().map(|(height, void)| if void { -99.0 } else { height }).collect();
            let field = HeightField::new(columns, rows, heights, Some(-99.0)).ok()?;
            Some(if weighted { field.with_importance(weights).unwrap() } else { field })
        })
    })
}

fn decompose(field: HeightField, threads: usize) -> Decomposition {
    let options = DecompositionOptions { threads, ..DecompositionOptions::default() };
    Decomposition::new(field, &options, &mut Monitor::silent()).unwrap()
}

fn deltas(lattice: &Lattice) -> Vec<f32> {
    lattice.deltas(&Workers::Caller, &mut Monitor::silent(), 0.0..1.0).unwrap()
}

/// A triangle of places with heights, from which barycentric coordinates are taken in the plainest way.
fn over(corners: [(Place, f64); 3], place: Place) -> Option<f64> {
    let at = |(place, _): (Place, f64)| place.map(i64::from);
    let cross =
        |a: [i64; 2], b: [i64; 2], c: [i64; 2]| (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
    let [a, b, c] = corners.map(at);
    let p = place.map(i64::from);
    let area = cross(a, b, c);
    let parts = [cross(p, b, c), cross(a, p, c), cross(a, b, p)].map(|part| part * area.signum());
    let height = |(part, (_, height)): (i64, (Place, f64))| part as f64 * height;
    parts
        .iter()
        .all(|&part| part >= 0)
        .then(|| parts.into_iter().zip(corners).map(height).sum::<f64>() / area.abs() as f64)
}

/// The error at each sample that a mesh covers.
fn errors(lattice: &Lattice, mesh: &Extract) -> HashMap<Place, f64> {
    let mut errors = HashMap::new();
    let field = lattice.field();
    for triangle in &mesh.triangles {
        let corners =
            triangle.map(|vertex| (mesh.places[vertex as usize], f64::from(mesh.heights[vertex as usize])));
        for y in 0..field.rows() as u32 {
            for x in 0..field.columns() as u32 {
                if let Some(height) = over(corners, [x, y]) {
                    let error = height - f64::from(lattice.height([x, y]));
                    let other = *errors.entry([x, y]).or_insert(error);
                    assert!((other - error).abs() < 1e-3, "edges of neighbours differ");
                }
            }
        }
    }
    errors
}

fn weight(lattice: &Lattice, [x, y]: Place) -> f64 {
    let field = lattice.field();
    let (column, row) = (x as usize, y as usize);
    match column < field.columns() && row < field.rows() && !field.is_void(column, row) {
        true => field.importance().map_or(1.0, |weights| f64::from(weights[row * field.columns() + column])),
        false => 0.0,
    }
}

fn squared_error(lattice: &Lattice, mesh: &Extract) -> f64 {
    let weighted = |(place, error): (Place, f64)| weight(lattice, place) * error * error;
    errors(lattice, mesh).into_iter().map(weighted).sum()
}

/// Whether a mesh covers just what the finest one does, each edge has a triangle on each side but at the rim of it,
/// and all of its triangles are counter-clockwise from above.
fn check_conforming(lattice: &Lattice, mesh: &Extract) {
    let field = lattice.field();
    let mut edges = HashSet::new();
    let mut area = 0;
    for triangle in &mesh.triangles {
        let [a, b, c] = triangle.map(|vertex| mesh.places[vertex as usize].map(i64::from));
        // Rows count downwards.
        let twice = (c[0] - a[0]) * (b[1] - a[1]) - (b[0] - a[0]) * (c[1] - a[1]);
        assert!(twice > 0, "turned over");
        area += twice;
        for i in 0..3 {
            assert!(edges.insert((triangle[i], triangle[(i + 1) % 3])), "an edge twice in one direction");
        }
    }
    let known = |x: usize, y: usize| !field.is_void(x, y);
    // What a square of four samples has triangles for, and whether an edge has something known on both sides, is
    // said by the finest mesh.
    let finest = extract(lattice, |_| true);
    let finest_area: i64 = finest
        .triangles
        .iter()
        .map(|triangle| {
            let [a, b, c] = triangle.map(|vertex| finest.places[vertex as usize].map(i64::from));
            (c[0] - a[0]) * (b[1] - a[1]) - (b[0] - a[0]) * (c[1] - a[1])
        })
        .sum();
    assert_eq!(area, finest_area, "does not cover what it should");
    let mut rim: HashSet<(Place, Place)> = HashSet::new();
    for triangle in &finest.triangles {
        for i in 0..3 {
            let [a, b] = [triangle[i], triangle[(i + 1) % 3]].map(|vertex| finest.places[vertex as usize]);
            if !rim.remove(&(b, a)) {
                rim.insert((a, b));
            }
        }
    }
    for &(a, b) in edges.iter().filter(|&&(a, b)| !edges.contains(&(b, a))) {
        // Each step along an edge of one side is one of the rim of the finest mesh.
        let [from, to] = [a, b].map(|vertex| mesh.places[vertex as usize].map(i64::from));
        let (dx, dy) = (to[0] - from[0], to[1] - from[1]);
        let steps = dx.abs().max(dy.abs());
        for step in 0..steps {
            let at = |step: i64| [(from[0] + dx / steps * step) as u32, (from[1] + dy / steps * step) as u32];
            assert!(rim.contains(&(at(step), at(step + 1))), "a crack");
        }
    }
    for place in &mesh.places {
        assert!(known(place[0] as usize, place[1] as usize), "a vertex on a void");
    }
}

/// Sum of the errors of the samples of triangles against their planes, each counted once.
fn error_of(lattice: &Lattice, triangles: &[Half]) -> f64 {
    let mut errors: HashMap<Place, f64> = HashMap::new();
    for triangle in triangles {
        let corners =
            [triangle.apex, triangle.from, triangle.to].map(|at| (at, f64::from(lattice.height(at))));
        let [right, bottom] = lattice.layout().extent();
        for y in 0..=bottom as u32 {
            for x in 0..=right as u32 {
                if let Some(height) = over(corners, [x, y]) {
                    let error = height - f64::from(lattice.height([x, y]));
                    errors.insert([x, y], weight(lattice, [x, y]) * error * error);
                }
            }
        }
    }
    errors.values().sum()
}

fn split(layout: &Layout, site: Site) -> Vec<Half> {
    let places = layout.split(site).map(|corners| corners.map(|(x, y)| [x as u32, y as u32]));
    places.map(|[apex, from, to]| Half { apex, from, to, level: site.level }).collect()
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 64, ..ProptestConfig::default() })]

    #[test]
    fn a_delta_is_the_error_of_two_triangles_less_that_of_their_halves(field in fields()) {
        let lattice = Lattice::new(field);
        let layout = lattice.layout();
        for (vertex, delta) in deltas(&lattice).into_iter().enumerate() {
            let merged = split(layout, layout.site(vertex));
            let halves: Vec<_> = merged.iter().flat_map(Half::halves).collect();
            let known: Vec<_> = (0..=layout.extent()[1] as u32)
                .flat_map(|y| (0..=layout.extent()[0] as u32).map(move |x| [x, y]))
                .collect();
            let mixed = merged.iter().any(|triangle| {
                let corners = [triangle.apex, triangle.from, triangle.to].map(|at| (at, 0.0));
                let covered = known.iter().filter(|&&place| over(corners, place).is_some());
                let seen = covered.fold(0, |seen, &place| seen | lattice.known(place));
                seen == 3
            });
            if mixed {
                prop_assert_eq!(delta, f32::INFINITY);
                continue;
            }
            let delta = f64::from(delta) * lattice.squared_unit();
            let expected = error_of(&lattice, &merged) - error_of(&lattice, &halves);
            prop_assert!((delta - expected).abs() <= 1e-4 * (1.0 + expected.abs()), "{delta} {expected}");
        }
    }

    /// Invariant 9: what is tracked is what is measured, at every step, and each mesh is conforming.
    #[test]
    fn every_rate_is_conforming_and_has_the_error_it_says(field in fields()) {
        let decomposition = decompose(field, 1);
        let lattice = decomposition.lattice();
        let mut coarser: Option<HashSet<Place>> = None;
        for removed in (0..=decomposition.removable()).rev() {
            let mesh = decomposition.extract(removed);
            check_conforming(lattice, &mesh);
            let (tracked, measured) = (decomposition.squared_error(removed), squared_error(lattice, &mesh));
            prop_assert!((tracked - measured).abs() <= 1e-3 * (1.0 + measured), "{tracked} {measured}");
            if lattice.fits() {
                let places: HashSet<_> = mesh.places.iter().copied().collect();
                if let Some(coarser) = coarser {
                    prop_assert!(coarser.is_subset(&places) && places.len() == coarser.len() + 1);
                }
                coarser = Some(places);
            }
        }
    }

    /// The mesh for a maximum error keeps it, and no conforming mesh of fewer vertices does: each vertex of it is
    /// in each that does.
    #[test]
    fn the_least_mesh_for_a_bound_keeps_it_and_is_in_all_that_do(field in fields(), bound in 0.0f64..8.0) {
        let decomposition = decompose(field, 1);
        let lattice = decomposition.lattice();
        let mesh = decomposition.at(Detail::MaxError(bound)).unwrap();
        let left = decomposition.within(decomposition.removable(), bound);
        let extracted = extract(lattice, |vertex| left.contains(vertex));
        check_conforming(lattice, &extracted);
        let largest = |mesh: &Extract| {
            let errors = errors(lattice, mesh);
            errors.iter().filter(|&(&place, _)| lattice.known(place) == 1).fold(0.0, |most, (_, error)| error.abs().max(most))
        };
        prop_assert!(largest(&extracted) <= bound + 1e-4);
        prop_assert_eq!(mesh.samples.len(), extracted.places.len());
        let measured = squared_error(lattice, &extracted);
        prop_assert!((mesh.squared_error - measured).abs() <= 1e-3 * (1.0 + measured));
        // Without a vertex and its descendants, some sample is farther: whatever else is there.
        let layout = lattice.layout();
        for vertex in (0..layout.vertices()).filter(|&vertex| left.contains(vertex)) {
            let mut gone = HashSet::from([vertex]);
            let mut stack = vec![layout.site(vertex)];
            while let Some(site) = stack.pop() {
                for child in layout.children(site) {
                    if gone.insert(layout.index(child)) {
                        stack.push(child);
                    }
                }
            }
            let without = extract(lattice, |vertex| !gone.contains(&vertex));
            let is_forced = decomposition.is_forced(vertex);
            prop_assert!(is_forced || largest(&without) > bound - 1e-4);
        }
    }

    /// A bound and a detail: the bound holds, and there are as many vertices as wanted, or as the bound needs.
    #[test]
    fn within_a_bound_no_sample_is_farther(field in fields(), bound in 0.5f64..8.0, part in 0.01f64..1.0) {
        let decomposition = decompose(field, 1);
        let wanted = (part * decomposition.samples() as f64) as usize;
        let least = decomposition.at(Detail::MaxError(bound)).unwrap();
        let mesh = decomposition.at_within(Detail::Vertices(wanted), bound).unwrap();
        prop_assert!(mesh.samples.len() <= wanted.max(least.samples.len()));
        prop_assert!(mesh.squared_error <= least.squared_error * 1.0001 + 1e-3);
        let close = decomposition.at_within(Detail::Rms(0.5), bound).unwrap();
        prop_assert!(close.rms <= 0.5 + 1e-6);
    }

    /// With so many vertices left, no conforming mesh has less error than the certificate says; also where a void
    /// keeps some of them.
    #[test]
    fn the_certificate_is_below_every_conforming_mesh(
        (mut heights, void) in (prop::collection::vec(-5.0f32..5.0, 25), prop::option::of(0usize..25)),
    ) {
        if let Some(void) = void {
            heights[void] = f32::NAN;
        }
        let field = HeightField::new(5, 5, heights, Some(f32::NAN)).unwrap();
        let decomposition = decompose(field, 1);
        let lattice = decomposition.lattice();
        let unit = lattice.squared_unit();
        let deltas: Vec<f64> = deltas(lattice).into_iter().map(|delta| f64::from(delta) * unit).collect();
        let best = exhaustive(lattice.layout(), &deltas).0;
        prop_assert_eq!(decomposition.removable() == best.len() - 1, void.is_none());
        for (removed, best) in best.into_iter().take(decomposition.removable() + 1).enumerate() {
            let (bound, made) = (decomposition.bound(removed), decomposition.squared_error(removed));
            prop_assert!(bound <= best + 1e-3, "{bound} {best}");
            prop_assert!(made >= best - 1e-3, "{made} {best}");
            // On the hull, where the slope changes, it is the best there is: never far above between.
            prop_assert!(bound <= made + 1e-3);
        }
    }

    /// Units and offsets are the caller's choice.
    #[test]
    fn heights_of_any_unit_give_the_same_mesh(
        (heights, exponent) in (prop::collection::vec(-4.0f32..4.0, 81), -60i32..60),
    ) {
        let scaled = heights.iter().map(|height| height * (exponent as f32).exp2()).collect();
        let plain = decompose(HeightField::new(9, 9, heights, None).unwrap(), 1);
        let scaled = decompose(HeightField::new(9, 9, scaled, None).unwrap(), 1);
        prop_assert_eq!(plain.order(), scaled.order());
        let rms = |of: &Decomposition| of.at(Detail::Vertices(20)).unwrap().rms;
        prop_assert_eq!(rms(&plain) * f64::from(exponent).exp2(), rms(&scaled));
    }

    /// What a file may hold, though no land is like that.
    #[test]
    fn the_largest_heights_are_no_trouble(heights in prop::collection::vec(prop_oneof![
        Just(f32::MAX), Just(f32::MIN), Just(f32::MIN_POSITIVE), Just(0.0)], 30)) {
        let decomposition = decompose(HeightField::new(5, 6, heights, None).unwrap(), 1);
        let mesh = decomposition.at(Detail::Ratio(0.4)).unwrap();
        prop_assert!(mesh.rms.is_finite() && mesh.mesh.positions().as_flattened().iter().all(|x| x.is_finite()));
    }

    /// Blocks of tiles fit each other and the whole, and the errors they say are what is measured.
    #[test]
    fn tiles_have_no_cracks(field in fields(), side in prop_oneof![Just(2usize), Just(4)], part in 0.0f64..1.0) {
        let field = HeightField::new(field.columns(), field.rows(), field.heights().to_vec(), Some(f32::NAN)).unwrap();
        let (store, other) = (InMemory::default(), InMemory::default());
        let options = TileOptions { side, threads: 1, ..TileOptions::default() };
        let tiles = Tiles::new(&field, &store, &options, &mut Monitor::silent()).unwrap();
        let parallel = TileOptions { threads: 3, ..options };
        let parallel = Tiles::new(&field, &other, &parallel, &mut Monitor::silent()).unwrap();
        prop_assert_eq!(tiles.samples(), field.heights().len() - field.voids());
        let wanted = (part * tiles.samples() as f64) as usize;
        let slope = tiles.slope_for(wanted);
        prop_assert_eq!(slope, parallel.slope_for(wanted));
        let whole = tiles.mesh([0, 0], tiles.size(), slope).unwrap();
        prop_assert_eq!(&whole, &parallel.mesh([0, 0], tiles.size(), slope).unwrap());
        let extract = |mesh: &Mesh| Extract {
            places: mesh.positions().iter().map(|&[x, y, _]| [x as u32, field.rows() as u32 - 1 - y as u32]).collect(),
            heights: mesh.positions().iter().map(|&[_, _, z]| z).collect(),
            triangles: mesh.triangles().to_vec(),
        };
        let lattice = Lattice::new(field.clone());
        let Some(whole) = whole else {
            prop_assert!(self::extract(&lattice, |_| true).triangles.is_empty());
            return Ok(());
        };
        let mesh = extract(&whole.mesh);
        check_conforming(&lattice, &mesh);
        let measured = squared_error(&lattice, &mesh);
        prop_assert!((whole.squared_error - measured).abs() <= 1e-3 * (1.0 + measured));
        let largest = errors(&lattice, &mesh).into_iter().filter(|&(place, _)| lattice.known(place) == 1);
        let largest = largest.fold(0.0, |most: f64, (_, error)| most.max(error.abs()));
        prop_assert!((whole.max_error - largest).abs() <= 1e-3);
        // Rows of tiles one by one are the whole.
        let rows = (0..tiles.size()[1]).filter_map(|row| {
            tiles.mesh([0, row], [tiles.size()[0], 1], slope).unwrap()
        });
        let rows: Vec<TileMesh> = rows.collect();
        let places = |mesh: &Mesh| extract(mesh).places.into_iter().collect::<HashSet<_>>();
        let together: HashSet<_> = rows.iter().flat_map(|row| places(&row.mesh)).collect();
        prop_assert_eq!(together, places(&whole.mesh));
        prop_assert_eq!(rows.iter().map(|row| row.mesh.triangles().len()).sum::<usize>(), mesh.triangles.len());
    }

    /// With costs, what is left at a slope has the least sum of error and slope times cost of all conforming meshes.
    #[test]
    fn costs_are_on_the_hull(heights in prop::collection::vec(-5.0f32..5.0, 25), costs in prop::collection::vec(0.2f32..4.0, 25)) {
        let field = HeightField::new(5, 5, heights, None).unwrap();
        let options = DecompositionOptions { max_sweeps: 200, ..DecompositionOptions::default() };
        let decomposition = Decomposition::with_costs(field, &costs, &options, &mut Monitor::silent()).unwrap();
        let lattice = decomposition.lattice();
        let layout = lattice.layout();
        let cost = |vertex: usize| {
            let Site { x, y, .. } = layout.site(vertex);
            f64::from(costs[y * 5 + x])
        };
        let unit = lattice.squared_unit();
        let deltas: Vec<f64> = deltas(lattice).into_iter().map(|delta| f64::from(delta) * unit).collect();
        for slope in [0.1, 1.0, 10.0] {
            let gain = |vertex: usize| deltas[vertex] - slope * cost(vertex);
            let gains: Vec<f64> = (0..layout.vertices()).map(gain).collect();
            let best = exhaustive(layout, &gains).0.into_iter().fold(f64::INFINITY, f64::min);
            let order = decomposition.order().iter().map(|&vertex| gains[vertex as usize]);
            let made = order.scan(0.0, |sum, gain| { *sum += gain; Some(*sum) }).fold(0.0, f64::min);
            prop_assert!(made <= best + 0.01 * (1.0 + best.abs()), "{made} {best}");
        }
        let half = costs.iter().map(|&cost| f64::from(cost)).sum::<f64>() / 2.0;
        let mesh = decomposition.at(Detail::Cost(half)).unwrap();
        let columns = mesh.samples.iter().map(|&sample| (sample % 5, sample / 5));
        let inner = columns.filter(|&(x, y)| layout.level_at(x as usize, y as usize) > 0);
        let left: f64 = inner.map(|(x, y)| f64::from(costs[(y * 5 + x) as usize])).sum();
        prop_assert!(left <= half + 1e-4);
    }

    #[test]
    fn threads_change_nothing(seed in any::<u64>()) {
        let mut random = crate::random::SplitMix64::at(seed, 0);
        let (columns, rows) = (150, 131);
        let heights = (0..columns * rows).map(|i| (i % columns) as f32 * 0.1 + random.below(1000) as f32 * 1e-3).collect();
        let field = HeightField::new(columns, rows, heights, None).unwrap();
        let (one, two) = (decompose(field.clone(), 1), decompose(field, 3));
        prop_assert_eq!(one.order(), two.order());
        prop_assert_eq!(one.at(Detail::Ratio(0.1)).unwrap(), two.at(Detail::Ratio(0.1)).unwrap());
    }

    /// What is asked for is what comes out, or as near as the field allows.
    #[test]
    fn wishes_are_met(field in fields(), part in 0.01f64..1.0) {
        let decomposition = decompose(field, 1);
        let mesh = decomposition.at(Detail::Ratio(part)).unwrap();
        let wanted = (part * decomposition.samples() as f64).round() as usize;
        let least = decomposition.at(Detail::Vertices(0)).unwrap().samples.len();
        prop_assert!(mesh.samples.len() <= wanted.max(least));
        if decomposition.lattice().fits() {
            prop_assert_eq!(mesh.samples.len(), wanted.max(least));
        }
        for rms in [0.0, 0.3, 2.0, 100.0] {
            let mesh = decomposition.at(Detail::Rms(rms)).unwrap();
            prop_assert!(mesh.rms <= rms + 1e-6);
        }
    }
}

#[test]
fn a_plane_goes_to_its_corners_without_error() {
    for (columns, rows) in [(65, 65), (33, 17), (40, 23)] {
        let heights =
            (0..columns * rows).map(|i| (i % columns) as f32 * 0.5 - (i / columns) as f32 * 2.0).collect();
        let decomposition = decompose(HeightField::new(columns, rows, heights, None).unwrap(), 0);
        let coarsest = decomposition.at(Detail::Vertices(0)).unwrap();
        assert!(coarsest.squared_error < 1e-6 && coarsest.samples.len() < 60, "{}", coarsest.samples.len());
        let exact = decomposition.at(Detail::MaxError(1e-4)).unwrap();
        assert_eq!(exact.samples.len(), coarsest.samples.len());
    }
}

#[test]
fn the_largest_error_of_a_bump_is_found() {
    let mut heights = vec![0.0; 17 * 17];
    heights[5 * 17 + 7] = 10.0;
    let decomposition = decompose(HeightField::new(17, 17, heights, None).unwrap(), 1);
    assert_eq!(decomposition.at(Detail::MaxError(10.0)).unwrap().samples.len(), 4);
    let left = max_error::least(decomposition.lattice(), 9.9, |_| false);
    let site = Site { x: 7, y: 5, level: decomposition.lattice().layout().level_at(7, 5) };
    assert!(left.contains(decomposition.lattice().layout().index(site)));
}
