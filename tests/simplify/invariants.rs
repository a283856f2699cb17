//! The promises on random meshes: filthy ones, and sound ones with holes.

use std::fmt;

use decimesh::{Mesh, Monitor, Options, Placement, Selection, Target, Topology, simplify};
use proptest::prelude::*;

use crate::check::check;
use crate::meshes::{attributed, dirty_mesh, noise, torn_mesh};

/// A mesh, and how to simplify it.
pub(crate) struct Case {
    pub(crate) mesh: Mesh,
    pub(crate) options: Options,
}

/// In few lines: attributes are made up and say nothing.
impl fmt::Debug for Case {
    fn fmt(&self, formatter: &mut fmt::Formatter) -> fmt::Result {
        let (positions, triangles) = (self.mesh.positions(), self.mesh.triangles());
        let attributes = self.mesh.attributes().normals.is_some();
        write!(formatter, "{positions:?}\n{triangles:?}\nattributes: {attributes}\n{:?}", self.options)
    }
}

/// Options of every kind for a mesh, its attributes included.
pub(crate) fn with_options(mesh: impl Strategy<Value = Mesh>) -> impl Strategy<Value = Case> {
    let mesh = (mesh, any::<bool>(), any::<u64>())
        .prop_map(|(mesh, attributes, seed)| if attributes { attributed(mesh, seed) } else { mesh });
    mesh.prop_flat_map(|mesh| {
        let target = prop_oneof![
            4 => (0..mesh.triangles().len() + 3).prop_map(Target::Triangles),
            2 => (0..mesh.positions().len() + 3).prop_map(Target::Vertices),
            1 => prop_oneof![Just(0.0), Just(1.0), 0.0f64..1.0].prop_map(Target::Ratio),
            1 => prop_oneof![Just(0.0f32), 0.0f32..0.1, 0.1f32..10.0].prop_map(Target::MaxError),
        ];
        let selection = prop_oneof![
            Just(Selection::SampledThreshold),
            (1usize..40).prop_map(|records| Selection::ReplacementSelection { records })
        ];
        let topology = prop_oneof![Just(Topology::RelaxIfStuck), Just(Topology::Keep)];
        let placement = prop_oneof![Just(Placement::Optimal), Just(Placement::Existing)];
        let locked = prop_oneof![3 => Just(0u64), 1 => 0u64..100];
        let switches =
            (prop::bool::weighted(0.25), any::<bool>(), any::<[bool; 3]>(), 1usize..3, any::<u64>());
        (Just(mesh), target, selection, (topology, placement), locked, switches).prop_map(
            |(mesh, target, selection, (topology, placement), locked, switches)| {
                let (lock_boundary, keep_seams, [track_origins, track_sources, refine], threads, seed) =
                    switches;
                let vertices = 0..mesh.positions().len() as u32;
                let locked = vertices.filter(|&vertex| noise(seed, vertex as usize) % 100 < locked).collect();
                let options = Options {
                    selection,
                    topology,
                    placement,
                    lock_boundary,
                    keep_seams,
                    locked,
                    threads,
                    refine: refine && placement == Placement::Optimal,
                    track_origins,
                    track_sources,
                    ..Options::new(target)
                };
                Case { mesh, options }
            },
        )
    })
}

fn check_run(Case { mesh, options }: &Case) {
    let result = simplify(mesh, options, &mut Monitor::silent()).unwrap();
    check(mesh, options, &result);
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 2000, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn dirty_meshes(case in with_options(dirty_mesh())) {
        check_run(&case);
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 600, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn torn_meshes(case in with_options(torn_mesh())) {
        check_run(&case);
    }

    /// To give up the topology helps, as the target counts, or is not done.
    #[test]
    fn to_relax_gets_no_less_far(case in with_options(dirty_mesh())) {
        let of = |topology| {
            let options = Options { topology, ..case.options.clone() };
            let mesh = simplify(&case.mesh, &options, &mut Monitor::silent()).unwrap().mesh;
            match options.target {
                Target::Vertices(count) => mesh.positions().len().saturating_sub(count),
                Target::Triangles(count) => mesh.triangles().len().saturating_sub(count),
                _ => mesh.triangles().len(),
            }
        };
        prop_assert!(of(Topology::RelaxIfStuck) <= of(Topology::Keep));
    }
}
