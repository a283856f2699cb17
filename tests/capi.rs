//! What C is given is what Rust is given, index by index and bit by bit.

#![cfg(feature = "capi")]

use std::num::NonZeroU32;
use std::ptr;

use decimesh::capi::*;
use decimesh::deviation::vertex_distances;
use decimesh::lod::{NestedLevels, Progressive};
use decimesh::mesh::{Attributes, Mesh, shapes};
use decimesh::multiple_choice::{Cost, Decimation, Selection};
use decimesh::rate_distortion::{Decomposition, DecompositionOptions, Detail, HeightField};
use decimesh::{
    AttributeWeights, Monitor, Options, Placement, Target, build_levels, simplify, simplify_within,
};
use proptest::prelude::*;

mod c_calls;
use c_calls::succeeded;

/// What both languages are asked for.
#[derive(Debug, Clone)]
struct Request {
    ratio: f64,
    weights: AttributeWeights,
    cross_seams: bool,
    keep_seams: bool,
    grouped: bool,
    /// Every so many vertices have a flag.
    flagged_every: usize,
}

impl Request {
    fn groups(&self, mesh: &Mesh) -> Option<Vec<u32>> {
        self.grouped.then(|| (0..mesh.triangles().len() as u32).map(|triangle| triangle / 64 % 3).collect())
    }

    fn flags(&self, mesh: &Mesh) -> Vec<u8> {
        let flag = |vertex: usize| {
            let is_flagged = vertex.is_multiple_of(self.flagged_every);
            if is_flagged { (vertex / self.flagged_every % 8) as u8 } else { 0 }
        };
        (0..mesh.positions().len()).map(flag).collect()
    }

    fn in_rust(&self, mesh: &Mesh) -> Options {
        let flags = self.flags(mesh);
        let with = |flag: u8| -> Vec<u32> {
            (0..).zip(&flags).filter(|(_, flags)| **flags & flag != 0).map(|(vertex, _)| vertex).collect()
        };
        Options {
            placement: Placement::Existing,
            attribute_weights: self.weights,
            cross_seams: self.cross_seams,
            keep_seams: self.keep_seams,
            groups: self.groups(mesh),
            locked: with(DECIMESH_VERTEX_LOCK),
            protected: with(DECIMESH_VERTEX_PROTECT),
            prioritized: with(DECIMESH_VERTEX_PRIORITIZE),
            track_sources: true,
            ..Options::new(Target::Ratio(self.ratio))
        }
    }

    /// The same for C; `groups` and `flags` must outlive what is done with it.
    fn in_c(&self, groups: Option<&[u32]>, flags: &[u8]) -> decimesh_simplify_options {
        decimesh_simplify_options {
            target_value: self.ratio,
            placement: DECIMESH_PLACEMENT_EXISTING,
            keep_seams: self.keep_seams.into(),
            cross_seams: self.cross_seams.into(),
            normal_weight: self.weights.normals,
            uv_weight: self.weights.uvs,
            color_weight: self.weights.colors,
            triangle_groups: groups.map_or(ptr::null(), <[u32]>::as_ptr),
            vertex_flags: flags.as_ptr(),
            ..c_calls::options()
        }
    }
}

fn requests() -> impl Strategy<Value = Request> {
    let weight = || prop_oneof![Just(0.0f32), 0.0f32..1.0];
    (0.05f64..0.9, (weight(), weight(), weight()), any::<[bool; 3]>(), 5usize..60).prop_map(
        |(ratio, (normals, uvs, colors), [cross_seams, keep_seams, grouped], flagged_every)| Request {
            ratio,
            weights: AttributeWeights { normals, uvs, colors },
            cross_seams,
            keep_seams,
            grouped,
            flagged_every,
        },
    )
}

/// A stone whose vertices along a cut are there twice, with attributes of all kinds.
fn stone() -> Mesh {
    let plain = shapes::bumpy_sphere(12, 1);
    let mut positions = plain.positions().to_vec();
    let mut triangles = plain.triangles().to_vec();
    let count = positions.len() as u32;
    positions.extend_from_within(..);
    for triangle in &mut triangles {
        if triangle.iter().any(|&vertex| plain.positions()[vertex as usize][0] > 0.0) {
            *triangle = triangle.map(|vertex| vertex + count);
        }
    }
    let attributes = Attributes {
        normals: Some(positions.clone()),
        uvs: Some(positions.iter().map(|&[x, y, _]| [x, y]).collect()),
        colors: Some((0..positions.len()).map(|vertex| [(vertex % 251) as u8, 100, 7, 255]).collect()),
    };
    Mesh::with_attributes(positions, triangles, attributes).expect("it is a mesh")
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 32, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn simplified_indices_are_those_of_rust(request in requests()) {
        let mesh = stone();
        let expected =
            simplify(&mesh, &request.in_rust(&mesh), &mut Monitor::silent()).expect("the options are good");
        let sources = expected.sources.expect("they were asked for");
        let expected_indices: Vec<u32> =
            expected.mesh.triangles().as_flattened().iter().map(|&vertex| sources[vertex as usize]).collect();

        let (groups, flags) = (request.groups(&mesh), request.flags(&mesh));
        let mut result_groups = vec![u32::MAX; mesh.triangles().len()];
        let mut options = request.in_c(groups.as_deref(), &flags);
        if request.grouped {
            options.result_groups = result_groups.as_mut_ptr();
        }
        let buffers = c_calls::buffers(&mesh);
        let mut indices = vec![u32::MAX; buffers.index_count];
        let mut count = 0;
        let mut report = c_calls::report();
        // SAFETY: the pointers point to what the call's comment says.
        succeeded(unsafe {
            decimesh_simplify_indices(
                indices.as_mut_ptr().cast(), &buffers, &options, &mut count, &mut report,
            )
        });
        indices.truncate(count);
        prop_assert_eq!(indices, expected_indices);
        prop_assert_eq!(report.error.to_bits(), expected.error.to_bits());
        prop_assert_eq!(report.attribute_error.to_bits(), expected.attribute_error.to_bits());
        prop_assert_eq!(report.locked_vertices, expected.locked as u64);
        if request.grouped {
            result_groups.truncate(count / 3);
            prop_assert_eq!(Some(result_groups), expected.groups);
        }
    }

    #[test]
    fn levels_of_all_kinds_are_those_of_rust(request in requests()) {
        let mesh = stone();
        let values = [request.ratio, request.ratio / 2.0, request.ratio / 8.0];
        let targets = values.map(Target::Ratio);
        let rust = request.in_rust(&mesh);
        let quiet = &mut Monitor::silent();
        let tracked = Options { track_origins: true, ..rust.clone() };
        let chain = build_levels(&mesh, &targets, &tracked, quiet).expect("the options are good");
        let nested = NestedLevels::build(&mesh, &targets, &rust, quiet).expect("the options are good");
        let progressive = Progressive::build(&mesh, &targets, &rust, quiet).expect("the options are good");

        let (groups, flags) = (request.groups(&mesh), request.flags(&mesh));
        let mut options = request.in_c(groups.as_deref(), &flags);
        options.level_origins = 1;
        let buffers = c_calls::buffers(&mesh);
        let mut indices = vec![u32::MAX; buffers.index_count];
        let room = indices.len();
        let destination = indices.as_mut_ptr();
        // SAFETY: the pointers point to what the calls' comments say, and each handle is destroyed last.
        unsafe {
            let mut own = ptr::null_mut();
            succeeded(decimesh_mesh_from_buffers(&buffers, &mut own));

            let mut levels = ptr::null_mut();
            succeeded(decimesh_levels_build(own, &options, values.as_ptr(), values.len(), &mut levels));
            for (level, expected) in chain.iter().enumerate() {
                let mut found = ptr::null();
                succeeded(decimesh_levels_mesh(levels, level, &mut found));
                let count = 3 * decimesh_mesh_triangle_count(found);
                let found = std::slice::from_raw_parts(decimesh_mesh_indices(found), count);
                prop_assert_eq!(found, expected.mesh.triangles().as_flattened());
                let mut origins = ptr::null();
                succeeded(decimesh_levels_origins(levels, level, &mut origins));
                let origins = std::slice::from_raw_parts(origins, buffers.vertex_count);
                prop_assert_eq!(Some(origins), expected.origins.as_deref());
            }
            decimesh_levels_destroy(levels);

            let mut handle = ptr::null_mut();
            succeeded(decimesh_nested_build(own, &options, values.as_ptr(), values.len(), &mut handle));
            let order = std::slice::from_raw_parts(decimesh_nested_order(handle), buffers.vertex_count);
            prop_assert_eq!(order, nested.order());
            prop_assert_eq!(decimesh_nested_count(handle), nested.levels().len());
            for level in 0..nested.levels().len() {
                succeeded(decimesh_nested_copy_indices(
                    handle, level, DECIMESH_INDEX_U32, destination.cast(), room,
                ));
                let expected = nested.triangles(level).as_flattened();
                prop_assert_eq!(std::slice::from_raw_parts(destination, expected.len()), expected);
                let mut groups = ptr::null();
                succeeded(decimesh_nested_groups(handle, level, &mut groups));
                prop_assert_eq!(groups.is_null(), level == 0 || !request.grouped);
                if let Some(expected) = nested.groups(level) {
                    prop_assert_eq!(expected.len(), nested.triangles(level).len());
                    prop_assert_eq!(std::slice::from_raw_parts(groups, expected.len()), expected);
                }
            }
            decimesh_nested_destroy(handle);

            let mut handle = ptr::null_mut();
            succeeded(decimesh_progressive_build(own, &options, values.as_ptr(), values.len(), &mut handle));
            prop_assert_eq!(decimesh_progressive_steps(handle), progressive.steps());
            for step in [0, progressive.steps() / 2, progressive.steps()] {
                succeeded(decimesh_progressive_copy_indices(
                    handle, step, DECIMESH_INDEX_U32, destination.cast(), room,
                ));
                let triangles = progressive.triangles_at(step);
                let expected = triangles.as_flattened();
                prop_assert_eq!(std::slice::from_raw_parts(destination, expected.len()), expected);
            }
            decimesh_progressive_destroy(handle);
            decimesh_mesh_destroy(own);
        }
    }
}

#[test]
fn a_certified_error_is_that_of_rust() {
    let mesh = stone();
    for (placement, in_c) in
        [(Placement::Optimal, DECIMESH_PLACEMENT_OPTIMAL), (Placement::Existing, DECIMESH_PLACEMENT_EXISTING)]
    {
        let rust = Options { placement, track_origins: true, ..Options::new(Target::Ratio(0.5)) };
        let expected = simplify_within(&mesh, 0.02, &rust, &mut Monitor::silent()).expect("options are good");
        let mut origins = vec![0; mesh.positions().len()];
        let mut options = c_calls::options();
        options.placement = in_c;
        options.origins = origins.as_mut_ptr();
        let buffers = c_calls::buffers(&mesh);
        let mut report = c_calls::report();
        // SAFETY: the pointers point to what the calls' comments say, and each handle is destroyed last.
        unsafe {
            let mut bound = std::mem::zeroed::<decimesh_bound_result>();
            decimesh_bound_result_init(&mut bound, size_of::<decimesh_bound_result>());
            let (mut own, mut found) = (ptr::null_mut(), ptr::null_mut());
            succeeded(decimesh_mesh_from_buffers(&buffers, &mut own));
            succeeded(decimesh_simplify_within(own, 0.02, &options, &mut found, &mut report, &mut bound));
            assert_eq!((bound.lower, bound.upper), (expected.bound.lower, expected.bound.upper));
            assert_eq!(report.error.to_bits(), expected.simplified.error.to_bits());
            let count = 3 * decimesh_mesh_triangle_count(found);
            let indices = std::slice::from_raw_parts(decimesh_mesh_indices(found), count);
            assert_eq!(indices, expected.simplified.mesh.triangles().as_flattened());
            decimesh_mesh_destroy(found);
            decimesh_mesh_destroy(own);
        }
        assert_eq!(Some(origins), expected.simplified.origins);
    }
}

#[test]
fn refined_meshes_are_those_of_rust() {
    let mesh = shapes::bumpy_sphere(24, 2);
    let plain = Options::new(Target::Ratio(0.2));
    let refined = Options { refine: true, ..plain.clone() };
    let [plain, refined] = [plain, refined]
        .map(|options| simplify(&mesh, &options, &mut Monitor::silent()).expect("the options are good").mesh);
    assert_ne!(plain.positions(), refined.positions());
    let mut options = decimesh_simplify_options { target_value: 0.2, refine: 1, ..c_calls::options() };
    // SAFETY: the pointers point to what the calls' comments say.
    unsafe {
        let (mut input, mut output) = (ptr::null_mut(), ptr::null_mut());
        succeeded(decimesh_mesh_from_buffers(&c_calls::buffers(&mesh), &mut input));
        succeeded(decimesh_simplify(input, &options, &mut output, ptr::null_mut()));
        let count = 3 * decimesh_mesh_vertex_count(output);
        let positions = std::slice::from_raw_parts(decimesh_mesh_positions(output), count);
        assert_eq!(positions, refined.positions().as_flattened());
        decimesh_mesh_destroy(output);
        let mut refused = |change: &dyn Fn(&mut decimesh_simplify_options), status| {
            let kept = options;
            change(&mut options);
            assert_eq!(decimesh_simplify(input, &options, &mut output, ptr::null_mut()), status);
            options = kept;
        };
        refused(&|options| options.refine = 2, DECIMESH_ERROR_OPTION);
        refused(&|options| options.placement = DECIMESH_PLACEMENT_EXISTING, DECIMESH_ERROR_OPTION);
        refused(&|options| options.level_origins = 2, DECIMESH_ERROR_OPTION);
        decimesh_mesh_destroy(input);
    }
}

#[test]
fn hierarchies_give_the_meshes_that_they_give_to_rust() {
    let (columns, rows) = (70, 45);
    let heights: Vec<f32> = (0..columns * rows).map(|sample| ((sample * sample) % 251) as f32).collect();
    let field = HeightField::new(columns, rows, heights.clone(), Some(3.0)).expect("a field");
    let field = field.with_spacing([2.0, 0.5]).expect("a spacing");
    let decomposition = Decomposition::new(field, &DecompositionOptions::default(), &mut Monitor::silent());
    let decomposition = decomposition.expect("a decomposition");
    // SAFETY: as an init function is called; then the pointers point to what the call's comment says.
    let hierarchy = unsafe {
        let mut options = std::mem::zeroed::<decimesh_hierarchy_options>();
        decimesh_hierarchy_options_init(&mut options, size_of::<decimesh_hierarchy_options>());
        (options.has_no_data, options.no_data) = (1, 3.0);
        (options.column_spacing, options.row_spacing) = (2.0, 0.5);
        let mut hierarchy = ptr::null_mut();
        succeeded(decimesh_hierarchy_create(heights.as_ptr(), columns, rows, &options, &mut hierarchy));
        hierarchy
    };
    for (kind, value, detail) in [
        (DECIMESH_DETAIL_VERTICES, 900.0, Detail::Vertices(900)),
        (DECIMESH_DETAIL_RATIO, 0.5, Detail::Ratio(0.5)),
        (DECIMESH_DETAIL_RMS, 20.0, Detail::Rms(20.0)),
        (DECIMESH_DETAIL_MAX_ERROR, 99.0, Detail::MaxError(99.0)),
    ] {
        for bound in [f64::INFINITY, 150.0] {
            let expected = match bound.is_finite() {
                true => decomposition.at_within(detail, bound),
                false => decomposition.at(detail),
            };
            let expected = expected.expect("a mesh");
            // SAFETY: as above; the views are used before the mesh ends.
            unsafe {
                let mut report = std::mem::zeroed::<decimesh_hierarchy_report>();
                decimesh_hierarchy_report_init(&mut report, size_of::<decimesh_hierarchy_report>());
                let mut mesh = ptr::null_mut();
                succeeded(decimesh_hierarchy_at(hierarchy, kind, value, bound, &mut mesh, &mut report));
                assert_eq!(report.vertices as usize, expected.samples.len());
                assert_eq!(report.triangles as usize, expected.mesh.triangles().len());
                assert_eq!((report.rms, report.certified_gap), (expected.rms, expected.certified_gap));
                assert_eq!(report.max_error, decomposition.measure(&expected).maximum);
                let indices = std::slice::from_raw_parts(
                    decimesh_mesh_indices(mesh),
                    3 * decimesh_mesh_triangle_count(mesh),
                );
                assert_eq!(indices, expected.mesh.triangles().as_flattened());
                let positions = std::slice::from_raw_parts(
                    decimesh_mesh_positions(mesh),
                    3 * decimesh_mesh_vertex_count(mesh),
                );
                assert_eq!(positions, expected.mesh.positions().as_flattened());
                decimesh_mesh_destroy(mesh);
            }
        }
    }
    // SAFETY: it is not used any more.
    unsafe { decimesh_hierarchy_destroy(hierarchy) };
}

#[test]
fn multiple_choice_and_distances_of_vertices_are_those_of_rust() {
    let mesh = shapes::bumpy_sphere(12, 1);
    let selection =
        Selection::MultipleChoice { candidates: NonZeroU32::new(4).expect("it is not 0"), seed: 9 };
    let locked = [3, 77, 77];
    let mut decimation =
        Decimation::with_locked(&mesh, Cost::Visual, selection, &locked).expect("the vertices exist");
    assert!(decimation.reduce_to(300, &mut Monitor::silent()).expect("nobody cancels"));
    let (expected, sources) =
        mesh.of_triangles(&decimation.triangles()).expect("the triangles are the mesh's");
    let away = vertex_distances(&mesh, &expected, 1, &mut Monitor::silent()).expect("there are triangles");

    let buffers = c_calls::buffers(&mesh);
    let mut distances = vec![0.0f32; mesh.positions().len()];
    let mut written = vec![u32::MAX; mesh.positions().len()];
    // SAFETY: the pointers point to what the calls' comments say, and each handle is destroyed last.
    unsafe {
        let mut options = std::mem::zeroed::<decimesh_multiple_choice_options>();
        decimesh_multiple_choice_options_init(&mut options, size_of::<decimesh_multiple_choice_options>());
        (options.candidates, options.seed) = (4, 9);
        (options.locked_vertices, options.locked_count) = (locked.as_ptr(), locked.len());
        options.sources = written.as_mut_ptr();
        let (mut own, mut found, mut stopped_by) = (ptr::null_mut(), ptr::null_mut(), 77);
        succeeded(decimesh_mesh_from_buffers(&buffers, &mut own));
        succeeded(decimesh_multiple_choice(own, 300, &options, &mut found, &mut stopped_by));
        assert_eq!(stopped_by, DECIMESH_STOPPED_BY_TARGET);
        let indices =
            std::slice::from_raw_parts(decimesh_mesh_indices(found), 3 * decimesh_mesh_triangle_count(found));
        assert_eq!(indices, expected.triangles().as_flattened());
        succeeded(decimesh_vertex_distances(own, found, ptr::null(), distances.as_mut_ptr()));
        decimesh_mesh_destroy(found);
        decimesh_mesh_destroy(own);
    }
    let (named, rest) = written.split_at(sources.len());
    assert_eq!(named, sources);
    assert!(
        rest.iter().all(|&element| element == u32::MAX),
        "beyond the result's vertices nothing is written"
    );
    let bits = |distances: Vec<f32>| distances.into_iter().map(f32::to_bits).collect::<Vec<_>>();
    assert_eq!(bits(distances), bits(away));
}
