//! Meshes with seams, where no vertex moves: nothing comes apart, and what belongs to one chart or group stays
//! with it.

mod assets;

use std::collections::{BTreeMap, BTreeSet};
use std::fmt;

use decimesh::hqms::{AttributeWeights, build_levels};
use decimesh::lod::{NestedLevels, Progressive};
use decimesh::{Mesh, Monitor, Options, Placement, Selection, Simplified, Target, Topology, simplify};
use proptest::prelude::*;

use crate::check::check;
use crate::meshes::{attributed, dirty_mesh, joined, noise, signed_noise, torn_mesh};
use crate::places::{Places, replayed};

/// A mesh, and how to simplify it.
struct Case {
    mesh: Mesh,
    options: Options,
}

impl fmt::Debug for Case {
    fn fmt(&self, formatter: &mut fmt::Formatter) -> fmt::Result {
        let (positions, triangles) = (self.mesh.positions(), self.mesh.triangles());
        let attributes = self.mesh.attributes().normals.is_some();
        write!(formatter, "{positions:?}\n{triangles:?}\nattributes: {attributes}\n{:?}", self.options)
    }
}

fn existing(target: Target) -> Options {
    Options { placement: Placement::Existing, track_collapses: true, ..Options::new(target) }
}

/// All that there is to say about attributes, with a weight.
const WEIGHTS: AttributeWeights = AttributeWeights { normals: 0.5, uvs: 1.0, colors: 0.25 };

fn run(mesh: &Mesh, options: &Options) -> Simplified {
    let result = simplify(mesh, options, &mut Monitor::silent()).unwrap();
    check(mesh, options, &result);
    result
}

/// The mesh with a vertex of its own for each chart that has triangles at it.
fn cut(mesh: &Mesh, chart: impl Fn(usize) -> u64) -> Mesh {
    let mut names = BTreeMap::new();
    let mut positions = Vec::new();
    let triangles = mesh.triangles().iter().enumerate().map(|(index, triangle)| {
        triangle.map(|vertex| {
            *names.entry((vertex, chart(index))).or_insert_with(|| {
                positions.push(mesh.positions()[vertex as usize]);
                positions.len() as u32 - 1
            })
        })
    });
    let triangles = triangles.collect();
    Mesh::new(positions, triangles).unwrap()
}

/// The middle of a triangle.
fn middle(mesh: &Mesh, triangle: usize) -> glam::Vec3 {
    mesh.triangles()[triangle]
        .iter()
        .map(|&v| glam::Vec3::from(mesh.positions()[v as usize]))
        .sum::<glam::Vec3>()
        / 3.0
}

/// Which of the `count` cells around points drawn at random a triangle lies in.
fn cell(mesh: &Mesh, triangle: usize, count: u64, seed: u64) -> u64 {
    let site = |cell: u64| {
        let draw = |axis| 1.5 * signed_noise(seed, 3 * cell as usize + axis);
        glam::Vec3::new(draw(0), draw(1), draw(2))
    };
    let at = middle(mesh, triangle);
    let nearer = |&a: &u64, &b: &u64| at.distance(site(a)).total_cmp(&at.distance(site(b)));
    (0..count).min_by(nearer).unwrap_or(0)
}

/// The mesh, and under it the same seen from the other side.
fn double_sided(mesh: &Mesh) -> Mesh {
    let back = mesh.triangles().iter().map(|&[a, b, c]| [a, c, b]).collect();
    joined(&[mesh.clone(), Mesh::new(mesh.positions().to_vec(), back).unwrap()])
}

/// Meshes with seams of every kind, and some without.
fn seamed_mesh() -> impl Strategy<Value = Mesh> {
    let kinds = (0..6u64, 1..9u64, any::<u64>(), any::<bool>());
    let mesh = (prop_oneof![3 => torn_mesh().boxed(), 1 => dirty_mesh().boxed()], kinds);
    mesh.prop_map(|(mesh, (kind, count, seed, bare))| {
        let mesh = match kind {
            0 => mesh,
            1 => double_sided(&mesh),
            // Faceted.
            2 => cut(&mesh, |triangle| triangle as u64),
            // Small charts at random.
            3 => cut(&mesh, |triangle| noise(seed, triangle) % count),
            _ => cut(&mesh, |triangle| cell(&mesh, triangle, count, seed)),
        };
        if bare { mesh } else { attributed(mesh, seed) }
    })
}

/// Options that matter at seams; the topology is kept.
fn case() -> impl Strategy<Value = Case> {
    seamed_mesh().prop_flat_map(|mesh| {
        let target = prop_oneof![
            3 => (0..mesh.triangles().len() + 2).prop_map(Target::Triangles),
            1 => (0..mesh.positions().len() + 2).prop_map(Target::Vertices),
            1 => (0.0f32..0.3).prop_map(Target::MaxError),
        ];
        let marks = prop_oneof![3 => Just(0u64), 1 => 0u64..60];
        let choices =
            (0..4u64, any::<[bool; 4]>(), 1usize..3, [marks.clone(), marks.clone(), marks], any::<u64>());
        (Just(mesh), target, choices).prop_map(|(mesh, target, choices)| {
            let (groups, [weighted, cross_seams, replacement, track_origins], threads, marks, seed) = choices;
            let triangles = 0..mesh.triangles().len();
            let groups = match groups {
                0 => Some(triangles.map(|triangle| noise(seed, triangle) as u32 % 3).collect()),
                1 => Some(triangles.map(|triangle| cell(&mesh, triangle, 3, seed) as u32 * 1000).collect()),
                _ => None,
            };
            let marked = |salt: usize| {
                let is_marked = |v: &u32| noise(seed ^ salt as u64, *v as usize) % 100 < marks[salt];
                (0..mesh.positions().len() as u32).filter(is_marked).collect()
            };
            let selection = if replacement {
                Selection::ReplacementSelection { records: 15 }
            } else {
                Selection::SampledThreshold
            };
            let options = Options {
                topology: Topology::Keep,
                attribute_weights: if weighted { WEIGHTS } else { AttributeWeights::default() },
                selection,
                cross_seams,
                groups,
                threads,
                track_origins,
                locked: marked(0),
                protected: marked(1),
                prioritized: marked(2),
                ..existing(target)
            };
            Case { mesh, options }
        })
    })
}

/// The result's triangles in the names of the input's vertices.
fn named(result: &Simplified) -> Vec<[u32; 3]> {
    let sources = result.sources.as_ref().unwrap();
    result.mesh.triangles().iter().map(|triangle| triangle.map(|vertex| sources[vertex as usize])).collect()
}

fn sorted(mut triangles: Vec<[u32; 3]>) -> Vec<[u32; 3]> {
    for triangle in &mut triangles {
        let least = (0..3).min_by_key(|&corner| triangle[corner]).unwrap();
        triangle.rotate_left(least);
    }
    triangles.sort_unstable();
    triangles
}

/// Edges of which one side alone has a face, in the names that `place` gives.
fn open_edges(triangles: &[[u32; 3]], place: impl Fn(u32) -> u32) -> BTreeSet<[u32; 2]> {
    let mut sides: BTreeMap<[u32; 2], i32> = BTreeMap::new();
    for triangle in triangles {
        for corner in 0..3 {
            let [from, to] = [triangle[corner], triangle[(corner + 1) % 3]].map(&place);
            *sides.entry([from.min(to), from.max(to)]).or_default() += 1;
        }
    }
    sides.into_iter().filter(|(_, count)| *count == 1).map(|(edge, _)| edge).collect()
}

/// Panics if an open edge of `triangles`, in the names that `place` gives, ends where the mesh had none.
fn check_cracks(mesh: &Mesh, places: &Places, triangles: &[[u32; 3]], place: impl Fn(u32) -> u32) {
    let whole = mesh.triangles().iter().filter(|triangle| places.is_whole(triangle));
    let before: Vec<[u32; 3]> = whole.copied().collect();
    let open: BTreeSet<u32> = open_edges(&before, &place).into_iter().flatten().collect();
    for edge in open_edges(triangles, place) {
        assert!(edge.iter().all(|end| open.contains(end)), "a crack at {edge:?}");
    }
}

/// The groups that have triangles at each vertex, and the charts: what hangs together by vertices and, where
/// there are groups, is of one.
struct Charts {
    of: BTreeMap<(u32, u32), usize>,
}

impl Charts {
    fn new(mesh: &Mesh, places: &Places, groups: Option<&[u32]>) -> Self {
        let mut of: BTreeMap<(u32, u32), usize> = BTreeMap::new();
        for (index, triangle) in mesh.triangles().iter().enumerate() {
            if places.is_whole(triangle) {
                let group = groups.map_or(0, |groups| groups[index]);
                let joined: BTreeSet<usize> =
                    triangle.iter().filter_map(|&vertex| of.get(&(vertex, group)).copied()).collect();
                let chart = joined.first().copied().unwrap_or(index);
                of.values_mut().filter(|other| joined.contains(other)).for_each(|other| *other = chart);
                of.extend(triangle.map(|vertex| ((vertex, group), chart)));
            }
        }
        Self { of }
    }

    /// Panics unless the triangles are each of one chart, or at least of one group.
    fn check(&self, triangles: &[[u32; 3]], groups: Option<&[u32]>, same_chart: bool) {
        for (index, triangle) in triangles.iter().enumerate() {
            let group = groups.map_or(0, |groups| groups[index]);
            let charts = triangle.map(|vertex| self.of.get(&(vertex, group)));
            assert!(
                charts.iter().all(Option::is_some),
                "{triangle:?} has a corner of another group than {group}"
            );
            let one = charts.iter().all(|chart| *chart == charts[0]);
            assert!(one || !same_chart, "{triangle:?} lies on several charts");
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 1000, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn nothing_comes_apart(case in case()) {
        let Case { mesh, options } = &case;
        let result = run(mesh, options);
        let places = Places::new(mesh);
        let triangles = named(&result);
        check_cracks(mesh, &places, &triangles, |vertex| places.positions[vertex as usize]);
        check_cracks(mesh, &places, &triangles, |vertex| places.of[vertex as usize]);
        prop_assert!(result.attribute_error == 0.0 || options.attribute_weights == WEIGHTS);
    }

    #[test]
    fn wedges_keep_to_their_charts(case in case()) {
        let Case { mesh, options } = &case;
        let result = run(mesh, options);
        let charts = Charts::new(mesh, &Places::new(mesh), options.groups.as_deref());
        prop_assert_eq!(result.groups.is_some(), options.groups.is_some());
        if let Some(groups) = &result.groups {
            prop_assert_eq!(groups.len(), result.mesh.triangles().len());
        }
        charts.check(&named(&result), result.groups.as_deref(), !options.cross_seams);
    }

    /// What was collapsed says all: the result, where each vertex went, and the levels on the way.
    #[test]
    fn collapses_done_again_give_the_result(case in case()) {
        let Case { mesh, options } = &case;
        let result = run(mesh, options);
        let collapses = result.collapses.as_ref().unwrap();
        let expected = sorted(named(&result));
        prop_assert_eq!(&sorted(replayed(mesh, &Places::new(mesh), collapses)), &expected);
        let progressive = Progressive::new(mesh, collapses).unwrap();
        let order = progressive.order().unwrap();
        let coarsest: Vec<[u32; 3]> = progressive
            .triangles_at(0)
            .into_iter()
            .map(|triangle| triangle.map(|vertex| order[vertex as usize]))
            .collect();
        prop_assert_eq!(sorted(coarsest), expected);
        if let Some(origins) = &result.origins {
            let mut into: Vec<u32> = (0..mesh.positions().len() as u32).collect();
            for collapse in collapses.iter().rev() {
                into[collapse.source as usize] = into[collapse.target as usize];
            }
            let sources = result.sources.as_ref().unwrap();
            for (&into, &origin) in into.iter().zip(origins) {
                let vertex = sources.iter().position(|&source| source == into);
                prop_assert_eq!(vertex, (origin != u32::MAX).then_some(origin as usize));
            }
        }
    }

    #[test]
    fn threads_change_nothing(case in case()) {
        let of = |threads| {
            let options = Options { threads, ..case.options.clone() };
            let result = simplify(&case.mesh, &options, &mut Monitor::silent()).unwrap();
            (result.mesh, result.collapses, result.groups, result.attribute_error.to_bits())
        };
        prop_assert!(of(1) == of(2));
    }

    /// Without a weight, what the attributes are makes no difference.
    #[test]
    fn attributes_without_a_weight_have_no_say(case in case()) {
        let options = Options { attribute_weights: AttributeWeights::default(), ..case.options.clone() };
        let (positions, triangles, _) = case.mesh.clone().into_parts();
        let of = |mesh: &Mesh| {
            let result = simplify(mesh, &options, &mut Monitor::silent()).unwrap();
            (named(&result), result.collapses, result.error.to_bits())
        };
        let bare = Mesh::new(positions, triangles).unwrap();
        prop_assert!(of(&bare) == of(&attributed(bare.clone(), 7)));
    }

    /// Attributes are measured by the size of the mesh, whatever its unit is.
    #[test]
    fn scale_scales_the_error_of_attributes(case in case(), shift in -20i32..20) {
        let scale = (shift as f32).exp2();
        let target = match case.options.target {
            Target::MaxError(error) => Target::MaxError(error * scale),
            target => target,
        };
        let (positions, triangles, attributes) = case.mesh.clone().into_parts();
        let positions = positions.into_iter().map(|position| position.map(|x| x * scale)).collect();
        let scaled = Mesh::with_attributes(positions, triangles, attributes).unwrap();
        let small = simplify(&case.mesh, &case.options, &mut Monitor::silent()).unwrap();
        let options = Options { target, ..case.options.clone() };
        let large = simplify(&scaled, &options, &mut Monitor::silent()).unwrap();
        prop_assert_eq!(small.mesh.triangles(), large.mesh.triangles());
        prop_assert_eq!(small.attribute_error * scale, large.attribute_error);
    }

    /// Even where the topology is given up.
    #[test]
    fn nothing_comes_apart_at_a_loss_of_topology(case in case()) {
        let Case { mesh, options } = &case;
        let options = Options { topology: Topology::RelaxIfStuck, ..options.clone() };
        let result = run(mesh, &options);
        let places = Places::new(mesh);
        let triangles = named(&result);
        if places.surface(mesh).topology().is_oriented_manifold() {
            check_cracks(mesh, &places, &triangles, |vertex| places.positions[vertex as usize]);
        }
        Charts::new(mesh, &places, options.groups.as_deref()).check(&triangles, result.groups.as_deref(), false);
    }

    #[test]
    fn levels_are_prefixes(case in case()) {
        let Case { mesh, options } = &case;
        let targets = [0.6, 0.3, 0.1].map(Target::Ratio);
        let nested = NestedLevels::build(mesh, &targets, options, &mut Monitor::silent()).unwrap();
        let levels = build_levels(mesh, &targets, options, &mut Monitor::silent()).unwrap();
        for (number, level) in (1..).zip(&levels) {
            check(mesh, &Options { target: targets[number - 1], ..options.clone() }, level);
            let vertices = nested.levels()[number].vertices as u32;
            let triangles = nested.triangles(number);
            prop_assert!(triangles.as_flattened().iter().all(|&vertex| vertex < vertices));
            let in_names = |triangle: &[u32; 3]| triangle.map(|vertex| nested.order()[vertex as usize]);
            prop_assert_eq!(triangles.iter().map(in_names).collect::<Vec<_>>(), named(level));
        }
    }
}
