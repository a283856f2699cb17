//! The progressive file.

use decimesh::io::ReadError;
use decimesh::lod::{Extent, Mark, Progressive};
use decimesh::mesh::shapes;
use decimesh::multiple_choice::{Cost, Decimation, Selection};
use decimesh::{Mesh, Monitor};
use proptest::prelude::*;

use crate::collapses::{case, seamed};
use crate::meshes::attributed;
use crate::progressive::check;

fn bytes(progressive: &Progressive) -> Vec<u8> {
    let mut bytes = Vec::new();
    progressive.write_to(&mut bytes).unwrap();
    bytes
}

fn of(mesh: &Mesh) -> Progressive {
    let mut decimation = Decimation::new(mesh, Cost::Quadric, Selection::LazyHeap);
    decimation.reduce_to(10, &mut Monitor::silent()).unwrap();
    let mut progressive = Progressive::new(mesh, decimation.collapses()).unwrap();
    let half = progressive.steps() / 2;
    progressive.set_marks(vec![Mark { step: half, error: 0.5 }, Mark { step: 0, error: 1.5 }]).unwrap();
    progressive
}

fn assert_same_levels(progressive: &Progressive, again: &Progressive, up_to: usize) {
    for step in 0..=up_to {
        assert_eq!(progressive.mesh_at(step), again.mesh_at(step), "step {step}");
    }
}

fn refusal(bytes: &[u8]) -> String {
    Progressive::read_from_slice(bytes, Extent::Whole).unwrap_err().to_string()
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 200, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn what_is_written_is_read(case in case()) {
        let progressive = Progressive::new(&case.mesh, &case.collapses).unwrap();
        let bytes = bytes(&progressive);
        let again = Progressive::read_from_slice(&bytes, Extent::Whole).unwrap();
        prop_assert_eq!(again.steps(), progressive.steps());
        prop_assert!(again.order().is_none());
        assert_same_levels(&progressive, &again, progressive.steps());
        prop_assert_eq!(self::bytes(&again), bytes);
    }

    /// Nothing after the part asked for is looked at.
    #[test]
    fn a_part_is_a_coarse_part(case in case(), count in 0usize..200) {
        let progressive = Progressive::new(&case.mesh, &case.collapses).unwrap();
        let part = Progressive::read_from_slice(&bytes(&progressive), Extent::Triangles(count)).unwrap();
        prop_assert_eq!(part.steps(), progressive.step_within(count));
        assert_same_levels(&progressive, &part, part.steps());
        check(&part);
    }

    /// Any damage gives an error or a mesh that can be played, and the same from a reader.
    #[test]
    fn damage_is_found_or_harmless(case in case(), places in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..4)) {
        let mut bytes = bytes(&Progressive::new(&case.mesh, &case.collapses).unwrap());
        for (place, byte) in places {
            let place = place.index(bytes.len());
            bytes[place] ^= byte;
        }
        if let Ok(damaged) = Progressive::read_from_slice(&bytes, Extent::Whole) {
            check(&damaged);
            prop_assert_eq!(self::bytes(&damaged).len(), bytes.len());
        }
        if let Ok(part) = Progressive::read_from(&bytes[..], Extent::Triangles(20)) {
            check(&part);
        }
    }
}

#[test]
fn a_file_cut_anywhere_is_refused() {
    let progressive = of(&attributed(seamed(4), 3));
    let bytes = bytes(&progressive);
    for length in 0..bytes.len() {
        Progressive::read_from_slice(&bytes[..length], Extent::Whole).unwrap_err();
        Progressive::read_from(&bytes[..length], Extent::Whole).unwrap_err();
    }
    assert_eq!(
        refusal(&[&bytes[..], b"x"].concat()),
        format!("byte {}: bytes follow the last step", bytes.len())
    );
}

#[test]
fn a_cut_file_can_be_played_as_far_as_it_goes() {
    let progressive = of(&shapes::bumpy_sphere(12, 1));
    let bytes = bytes(&progressive);
    let half = progressive.triangle_count(progressive.steps() / 2);
    let part = Progressive::read_from_slice(&bytes[..bytes.len() * 7 / 10], Extent::Triangles(half)).unwrap();
    assert_same_levels(&progressive, &part, progressive.step_within(half));
    assert_eq!(part.marks(), progressive.marks());
    let base = Progressive::read_from_slice(&bytes, Extent::Triangles(0)).unwrap();
    assert_eq!((base.steps(), base.marks()), (0, &progressive.marks()[1..]));
}

/// The header's numbers start at byte 8: version, attributes, vertices, triangles, those of the coarsest
/// level, steps, marks.
#[test]
fn lies_are_found_before_memory_is_taken() {
    let mut progressive = of(&shapes::sphere(3));
    let marked = bytes(&progressive);
    progressive.set_marks(Vec::new()).unwrap();
    let good = bytes(&progressive);
    let with = |field: usize, number: u32| {
        let mut bytes = good.clone();
        bytes[8 + 4 * field..12 + 4 * field].copy_from_slice(&number.to_le_bytes());
        bytes
    };
    for (field, number, part) in [
        (0, 2, "version 2 of the progressive format cannot be read"),
        (1, 8, "attributes 0x8 cannot be read"),
        (2, u32::MAX - 1, "vertices are promised"),
        (3, (1 << 30) - 1, "triangles are promised"),
        (3, u32::MAX, "more than decimesh can hold"),
        (4, u32::MAX - 1, "the coarsest level is larger than the finest"),
        (4, 0, "names no vertex of the coarsest level"),
        (5, u32::MAX, "the coarsest level is larger"),
        (6, u32::MAX, "cannot each make a vertex"),
        (6, 1, "the steps end at"),
        (7, u32::MAX, "marks are promised"),
    ] {
        let message = refusal(&with(field, number));
        assert!(message.contains(part), "field {field} = {number}: {message}");
        // Where the length is not known, memory comes as bytes do.
        Progressive::read_from(&with(field, number)[..], Extent::Whole).unwrap_err();
    }
    let mut marks_beyond = marked;
    marks_beyond[32..36].copy_from_slice(&1u32.to_le_bytes());
    assert!(refusal(&marks_beyond).contains("mark 0 is wrong: there is no step"));
    assert!(refusal(b"ply\n").contains("this is no progressive mesh"));
    assert!(refusal(b"").contains("this is no progressive mesh"));
}

#[test]
fn numbers_that_are_not_finite_are_refused() {
    let mut bytes = bytes(&of(&shapes::sphere(3)));
    let first_vertex = 40 + 2 * 8;
    bytes[first_vertex..first_vertex + 4].copy_from_slice(&f32::NAN.to_le_bytes());
    let error = Progressive::read_from_slice(&bytes, Extent::Whole).unwrap_err();
    assert!(matches!(error, ReadError::Mesh(_)), "{error}");
}

#[test]
fn files_appear_whole_or_not_at_all() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("sphere.dpm");
    let progressive = of(&attributed(shapes::sphere(5), 1));
    progressive.write(&path).unwrap();
    let again = Progressive::read(&path, Extent::Whole).unwrap();
    assert_same_levels(&progressive, &again, progressive.steps());
    assert_eq!(again.marks(), progressive.marks());
    let missing = directory.path().join("missing/sphere.dpm");
    assert!(progressive.write(&missing).unwrap_err().to_string().contains("missing"));
    assert!(Progressive::read(&missing, Extent::Whole).is_err());
    assert_eq!(std::fs::read_dir(directory.path()).unwrap().count(), 1);
}
