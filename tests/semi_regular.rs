//! Semi-regular surfaces over base complexes of all kinds: how quads are joined, and that what is tracked while
//! vertices go is what is measured on the mesh that is left.

use std::collections::{HashMap, HashSet};

use decimesh::rate_distortion::{
    BaseComplex, DecompositionOptions, SemiRegularError, SemiRegularMesh, SurfaceDecomposition,
};
use decimesh::{Mesh, Monitor};
use proptest::prelude::*;

const CUBE: [[u32; 4]; 6] =
    [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];

/// Where the corners of a complex are, and its quads.
type Base = (Vec<[f32; 3]>, Vec<[u32; 4]>);

/// Eight corners at which three quads meet.
fn cube() -> Base {
    let corners = (0..8).map(|k| [0, 1, 2].map(|axis| ((k >> axis) & 1) as f32)).collect();
    (corners, CUBE.to_vec())
}

fn torus() -> Base {
    let (rows, columns) = (4, 5);
    let at = |i: u32, j: u32| (i % rows) * columns + j % columns;
    let corners = (0..rows * columns).map(|k| {
        let around = (k / columns) as f32 / rows as f32 * std::f32::consts::TAU;
        let along = (k % columns) as f32 / columns as f32 * std::f32::consts::TAU;
        [(3.0 + around.cos()) * along.cos(), (3.0 + around.cos()) * along.sin(), around.sin()]
    });
    let quads = (0..rows).flat_map(|i| (0..columns).map(move |j| (i, j)));
    let quads = quads.map(|(i, j)| [at(i, j), at(i, j + 1), at(i + 1, j + 1), at(i + 1, j)]);
    (corners.collect(), quads.collect())
}

/// Five quads around a corner, two of them turned; a border all around.
fn fan() -> Base {
    let rim = (0..10).map(|k| {
        let angle = k as f32 / 10.0 * std::f32::consts::TAU;
        [angle.cos(), angle.sin(), 0.0]
    });
    let corners = std::iter::once([0.0; 3]).chain(rim).collect();
    let quads = (0..5).map(|k| {
        let mut quad = [0, 1 + 2 * k, 2 + 2 * k, 1 + (2 * k + 2) % 10];
        quad.rotate_left(2 * (k as usize % 2));
        quad
    });
    (corners, quads.collect())
}

fn grid() -> Base {
    let corners = (0..12).map(|k| [(k % 4) as f32, (k / 4) as f32, 0.0]).collect();
    let quads = (0..6).map(|k| k / 3 * 4 + k % 3).map(|k| [k, k + 1, k + 5, k + 4]);
    (corners, quads.collect())
}

fn bases() -> [Base; 4] {
    [cube(), torus(), fan(), grid()]
}

/// A surface over the quads, bent a little by a function of the place in space alone, so that quads agree.
fn surface((corners, quads): &Base, depth: u32, roughness: f32) -> SemiRegularMesh {
    let complex = BaseComplex::new(corners.len(), quads.clone()).unwrap();
    let side = (1 << depth) as f32;
    let position = |quad: usize, [x, y]: [u32; 2]| {
        let (u, v) = (x as f32 / side, y as f32 / side);
        let weights = [(1.0 - u) * (1.0 - v), u * (1.0 - v), u * v, (1.0 - u) * v];
        // Summed in the order of the corners, so that quads agree to the last digit.
        let mut parts: Vec<_> = quads[quad].iter().zip(weights).filter(|part| part.1 != 0.0).collect();
        parts.sort_by_key(|part| part.0);
        let flat = [0, 1, 2]
            .map(|axis| parts.iter().map(|part| corners[*part.0 as usize][axis] * part.1).sum::<f32>());
        let [a, b, c] = flat;
        let waves = (7.0 * a + 3.0 * b).sin() + (5.0 * b - 4.0 * c).cos() + 0.3 * (23.0 * a + 31.0 * c).sin();
        [a + roughness * waves, b - 0.5 * roughness * waves, c + roughness * waves]
    };
    SemiRegularMesh::of_places(complex, depth, position).unwrap()
}

/// For each vertex that is no corner the ends of the edge that it splits, coarser levels first: worked out here
/// from places alone.
fn edges(surface: &SemiRegularMesh) -> Vec<(usize, [usize; 2])> {
    let side = 1u32 << surface.depth();
    let mut all = Vec::new();
    for halving in 0..surface.depth() {
        let (square, half) = (side >> halving, side >> (halving + 1));
        for quad in 0..surface.complex().quads().len() {
            let at = |x: u32, y: u32| surface.vertex(quad, [x, y]);
            for (i, j) in (0..1 << halving).flat_map(|i| (0..1 << halving).map(move |j| (i, j))) {
                let (x, y) = (i * square, j * square);
                let ends = match (i + j) % 2 {
                    0 => [at(x, y), at(x + square, y + square)],
                    _ => [at(x + square, y), at(x, y + square)],
                };
                all.push((at(x + half, y + half), ends));
            }
        }
        for quad in 0..surface.complex().quads().len() {
            let at = |x: u32, y: u32| surface.vertex(quad, [x, y]);
            for (i, j) in (0..=1 << halving).flat_map(|i| (0..1 << halving).map(move |j| (i, j))) {
                let (across, along) = (i * square, j * square);
                all.push((at(along + half, across), [at(along, across), at(along + square, across)]));
                all.push((at(across, along + half), [at(across, along), at(across, along + square)]));
            }
        }
    }
    all
}

/// The squared error with some vertices kept: a vertex that is gone lies, in the triangles that stay, in the middle
/// between the ends of the edge that it would split.
fn measured(
    surface: &SemiRegularMesh,
    edges: &[(usize, [usize; 2])],
    is_kept: impl Fn(usize) -> bool,
) -> f64 {
    let positions: Vec<[f64; 3]> = surface.positions().iter().map(|at| at.map(f64::from)).collect();
    let mut left = positions.clone();
    for &(vertex, [from, to]) in edges.iter().filter(|edge| !is_kept(edge.0)) {
        left[vertex] = [0, 1, 2].map(|axis| 0.5 * (left[from][axis] + left[to][axis]));
    }
    let pairs = positions.as_flattened().iter().zip(left.as_flattened());
    pairs.map(|(a, b)| (a - b) * (a - b)).sum()
}

fn decompose(surface: SemiRegularMesh) -> SurfaceDecomposition {
    SurfaceDecomposition::new(surface, &DecompositionOptions::default(), &mut Monitor::silent()).unwrap()
}

/// Some counts of vertices between the least and all, with both.
fn counts(decomposition: &SurfaceDecomposition) -> Vec<usize> {
    let (least, all) = (decomposition.least_vertices(), decomposition.surface().positions().len());
    (0..=24).map(|k| least + (all - least) * k / 24).chain(least..least + 4).collect()
}

#[test]
fn quads_are_joined_as_their_complex_says() {
    for base in bases() {
        let coarse = surface(&base, 1, 0.0).complex().clone();
        for depth in 1..=4 {
            let surface = surface(&base, depth, 0.05);
            let (quads, side) = (coarse.quads().len(), 1usize << depth);
            let expected = coarse.corners() + coarse.edges() * (side - 1) + quads * (side - 1) * (side - 1);
            assert_eq!(surface.positions().len(), expected);
            let full = surface.to_mesh();
            assert_eq!(full.triangles().len(), 2 * quads * side * side);
            let topology = full.topology();
            assert!(topology.is_oriented_manifold());
            assert_eq!(topology.vertices, expected);
            let euler = coarse.corners() as i64 - coarse.edges() as i64 + quads as i64;
            assert_eq!(topology.euler_characteristic(), euler);
            // Four or eight neighbours, but at corners and borders.
            let mut neighbours: HashMap<u32, usize> = HashMap::new();
            full.triangles().as_flattened().iter().for_each(|&v| *neighbours.entry(v).or_default() += 1);
            let odd = neighbours
                .iter()
                .filter(|&(&v, count)| v as usize >= coarse.corners() && ![4, 8].contains(count));
            assert_eq!(odd.count() > 0, !topology.is_closed());
        }
    }
}

#[test]
fn a_place_is_the_same_vertex_in_each_quad_that_has_it() {
    for base in bases() {
        let rough = surface(&base, 3, 0.05);
        let mut seen: HashMap<usize, [f32; 3]> = HashMap::new();
        let complex = rough.complex().clone();
        for (quad, corners) in complex.quads().iter().enumerate() {
            for (&corner, place) in corners.iter().zip([[0, 0], [8, 0], [8, 8], [0, 8]]) {
                assert_eq!(rough.vertex(quad, place), corner as usize);
            }
            let places = (0..=8).flat_map(|x| (0..=8).map(move |y| [x, y]));
            for place in places {
                let vertex = rough.vertex(quad, place);
                // Its position, as this quad would have it.
                let alone = base.1[quad].map(|corner| base.0[corner as usize]).to_vec();
                let alone = (alone, vec![[0, 1, 2, 3]]);
                let alone = surface(&alone, 3, 0.05);
                let here = alone.positions()[alone.vertex(0, place)];
                let distance = (0..3).map(|axis| (here[axis] - rough.positions()[vertex][axis]).abs());
                assert!(distance.fold(0.0, f32::max) < 1e-5, "{quad} {place:?}");
                seen.insert(vertex, here);
            }
        }
        assert_eq!(seen.len(), rough.positions().len());
    }
}

#[test]
fn what_is_tracked_is_what_is_measured_and_every_mesh_is_as_whole_as_the_surface() {
    for base in bases() {
        let surface = surface(&base, 4, 0.05);
        let (edges, full) = (edges(&surface), surface.to_mesh());
        let topology = full.topology();
        for decomposition in
            [decompose(surface.clone()), SurfaceDecomposition::by_greedy_insertion(surface.clone())]
        {
            let total = decomposition.squared_error(0);
            let finest = decomposition.at_vertices(usize::MAX).vertices;
            for count in counts(&decomposition) {
                let left = decomposition.at_vertices(count);
                assert_eq!((left.vertices.len(), left.mesh.positions().len()), (count, count));
                assert!(finest.starts_with(&left.vertices), "meshes are nested");
                let has = left.mesh.topology();
                assert!(has.is_oriented_manifold() && has.vertices == count);
                assert_eq!(has.is_closed(), topology.is_closed());
                assert_eq!(has.euler_characteristic(), topology.euler_characteristic());
                assert_eq!(has.boundary_loops, topology.boundary_loops);
                let kept: HashSet<u32> = left.vertices.iter().copied().collect();
                let error = measured(&surface, &edges, |vertex| kept.contains(&(vertex as u32)));
                assert!((error - left.squared_error).abs() <= 1e-6 * total, "{error} {}", left.squared_error);
                assert_eq!(left.squared_error, decomposition.squared_error(count));
                for (&vertex, position) in left.vertices.iter().zip(left.mesh.positions()) {
                    assert_eq!(surface.positions()[vertex as usize], *position);
                }
            }
        }
    }
}

#[test]
fn decimation_is_better_than_insertion_and_certified() {
    for base in bases() {
        let surface = surface(&base, 5, 0.05);
        let ours = decompose(surface.clone());
        let greedy = SurfaceDecomposition::by_greedy_insertion(surface);
        for count in counts(&ours) {
            let total = ours.squared_error(0);
            assert!(ours.squared_error(count) <= greedy.squared_error(count) + 1e-3 * total);
            assert!(greedy.certified_gap(count).is_infinite());
            // No conforming mesh is below the bound: that of greedy insertion is not.
            let bound = ours.squared_error(count) / 10f64.powf(ours.certified_gap(count) / 10.0);
            assert!(greedy.squared_error(count) >= bound - 1e-6 * total);
        }
        let tenth = ours.surface().positions().len() / 10;
        assert!(ours.certified_gap(tenth.max(ours.least_vertices())) < 0.5);
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(8))]
    /// All conforming meshes of a cube halved once: 18 vertices may go.
    #[test]
    fn no_conforming_mesh_of_a_small_cube_is_below_the_bound(
        heights in prop::collection::vec([-1f32..1.0, -1f32..1.0, -1f32..1.0], 26)
    ) {
        let complex = BaseComplex::new(8, CUBE.to_vec()).unwrap();
        let surface = SemiRegularMesh::new(complex, 1, heights).unwrap();
        let edges = edges(&surface);
        let mut parents = [0u32; 26];
        for quad in 0..6 {
            let centre = surface.vertex(quad, [1, 1]);
            for place in [[1, 0], [2, 1], [1, 2], [0, 1]] {
                parents[surface.vertex(quad, place)] |= 1 << (centre - 8);
            }
        }
        let mut best = [f64::INFINITY; 19];
        for kept in 0u32..1 << 18 {
            let conforms = (0..18).all(|k| kept >> k & 1 == 0 || parents[8 + k] & kept == parents[8 + k]);
            // Few of the many sets conform: those that do are measured.
            if conforms {
                let error = measured(&surface, &edges, |vertex| vertex < 8 || kept >> (vertex - 8) & 1 == 1);
                let least = &mut best[kept.count_ones() as usize];
                *least = least.min(error);
            }
        }
        let ours = decompose(surface);
        for (kept, best) in best.into_iter().enumerate() {
            let error = ours.squared_error(8 + kept);
            let gap = ours.certified_gap(8 + kept);
            prop_assert!(error >= best - 1e-4, "{kept}: {error} is less than the least, {best}");
            let bound = if gap.is_finite() { error / 10f64.powf(gap / 10.0) } else { 0.0 };
            prop_assert!(best >= bound - 1e-4, "{kept}: {best} is below the bound {bound}");
        }
        // Where vertices go one after the other at rising slopes, ends of the hull are met exactly.
        prop_assert!((ours.squared_error(8) - best[0]).abs() < 1e-4);
    }
}

#[test]
fn a_flat_surface_costs_nothing() {
    let flat = decompose(surface(&grid(), 5, 0.0));
    assert!(flat.rms(0) < 1e-6);
    assert_eq!(flat.at_rms(1e-6).vertices.len(), flat.least_vertices());
    let rough = decompose(surface(&cube(), 4, 0.05));
    let some = rough.at_rms(0.01);
    assert!(some.rms <= 0.01 && rough.rms(some.vertices.len() - 1) > 0.01);
    assert_eq!(rough.at_rms(f64::NAN).vertices.len(), rough.surface().positions().len());
}

#[test]
fn threads_change_nothing() {
    let surface = surface(&torus(), 5, 0.05);
    let with = |threads: usize| {
        let options = DecompositionOptions { threads, ..DecompositionOptions::default() };
        let decomposition =
            SurfaceDecomposition::new(surface.clone(), &options, &mut Monitor::silent()).unwrap();
        decomposition.at_vertices(3000)
    };
    let one = with(1);
    assert_eq!(one, with(2));
    assert_eq!(one, with(3));
}

#[test]
fn what_cannot_be_a_surface_is_refused() {
    let complex = || BaseComplex::new(8, CUBE.to_vec()).unwrap();
    let flat = |depth| SemiRegularMesh::of_places(complex(), depth, |_, _| [0.0; 3]).unwrap_err();
    assert_eq!(flat(0), SemiRegularError::Depth { depth: 0, quads: 6, limit: 13 });
    assert_eq!(flat(14), SemiRegularError::Depth { depth: 14, quads: 6, limit: 13 });
    assert_eq!(flat(u32::MAX), SemiRegularError::Depth { depth: u32::MAX, quads: 6, limit: 13 });
    // 12 times 4^13 triangles can be held, 12 times 4^14 cannot.
    let triangles = |depth: u32| 12 << (2 * depth);
    assert!((triangles(13)..triangles(14)).contains(&Mesh::MAX_TRIANGLES));
    let new = |positions| SemiRegularMesh::new(complex(), 1, positions).unwrap_err();
    assert_eq!(new(vec![[0.0; 3]; 25]), SemiRegularError::PositionCount { count: 25, vertices: 26 });
    let mut positions = vec![[0.0; 3]; 26];
    positions[20][1] = f32::INFINITY;
    assert_eq!(new(positions), SemiRegularError::NotFinite { vertex: 20 });
    assert_eq!(flat(0).to_string(), "6 quads cannot be subdivided 0 times: 1 to 13 times are possible");
}

#[test]
fn a_decomposition_can_be_cancelled() {
    let mut monitor = Monitor::new(|_| std::ops::ControlFlow::Break(()));
    let rough = surface(&cube(), 3, 0.05);
    let cancelled = SurfaceDecomposition::new(rough, &DecompositionOptions::default(), &mut monitor);
    assert!(matches!(cancelled, Err(SemiRegularError::Cancelled(_))));
}
