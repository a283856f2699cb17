//! Hierarchies in files: what is written comes back, and what cannot be a hierarchy is refused.

#![cfg(feature = "io")]

use decimesh::Monitor;
use decimesh::rate_distortion::{Decomposition, DecompositionOptions, Detail, HeightField};
use proptest::collection::vec;
use proptest::prelude::*;

fn fields() -> impl Strategy<Value = HeightField> {
    let void = prop_oneof![3 => Just(0.0), 1 => Just(0.2)];
    (2usize..20, 2usize..20, void, any::<bool>()).prop_flat_map(|(columns, rows, void, weighted)| {
        let samples = columns * rows;
        let heights = vec((-100.0f32..100.0, prop::bool::weighted(void)), samples);
        (heights, vec(0.0f32..4.0, samples)).prop_filter_map("all void", move |(heights, weights)| {
            let heights = heights.into_iter().map(|(height, void)| if void { f32::NAN } else { height });
            let field = HeightField::new(columns, rows, heights.collect(), Some(f32::NAN)).ok()?;
            let field = field.with_spacing([2.0, 3.0]).unwrap();
            Some(if weighted { field.with_importance(weights).unwrap() } else { field })
        })
    })
}

fn decompose(field: HeightField) -> Decomposition {
    Decomposition::new(field, &DecompositionOptions::default(), &mut Monitor::silent()).unwrap()
}

fn to_bytes(decomposition: &Decomposition) -> Vec<u8> {
    let mut bytes = Vec::new();
    decomposition.write_to(&mut bytes).unwrap();
    bytes
}

fn assert_same(one: &Decomposition, other: &Decomposition) {
    assert_eq!(to_bytes(one), to_bytes(other));
    let samples = one.samples();
    for vertices in [0, samples / 10, samples / 3, samples] {
        for detail in [Detail::Vertices(vertices), Detail::Rms(3.0), Detail::MaxError(10.0)] {
            assert_eq!(one.at(detail).unwrap(), other.at(detail).unwrap());
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(100))]

    #[test]
    fn what_is_written_comes_back(field in fields()) {
        let decomposition = decompose(field);
        let bytes = to_bytes(&decomposition);
        assert_same(&Decomposition::read_from_slice(&bytes).unwrap(), &decomposition);
    }
}

/// A field of hills, with a hole.
fn hills() -> HeightField {
    let (columns, rows) = (12, 9);
    let height = |sample: usize| match sample {
        40 | 41 => f32::NAN,
        _ => ((sample % columns) as f32 * 0.9).sin() * 5.0 + ((sample / columns) as f32).cos() * 7.0,
    };
    HeightField::new(columns, rows, (0..columns * rows).map(height).collect(), Some(f32::NAN)).unwrap()
}

/// Where the slopes of a file of `hills` start: after the magic, seven numbers, the spacing and the heights.
const SLOPES: usize = 8 + 7 * 4 + 8 + 12 * 9 * 4;

#[test]
fn files_are_replaced_whole() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("hills.drd");
    let decomposition = decompose(hills());
    decomposition.write(&path).unwrap();
    assert_eq!(std::fs::read(&path).unwrap(), to_bytes(&decomposition));
    assert_same(&Decomposition::read(&path).unwrap(), &decomposition);
    decomposition.write(&directory.path().join("nowhere/hills.drd")).expect_err("no such directory");
    assert_eq!(std::fs::read_dir(directory.path()).unwrap().count(), 1);
    let error = Decomposition::read(&directory.path().join("missing.drd")).expect_err("no file");
    assert!(error.to_string().contains("missing.drd"), "{error}");
}

#[test]
fn every_truncation_and_every_addition_is_an_error() {
    let mut bytes = to_bytes(&decompose(hills()));
    for length in 0..bytes.len() {
        let error = Decomposition::read_from_slice(&bytes[..length]).expect_err("too short");
        assert!(!error.to_string().is_empty());
    }
    bytes.push(0);
    let error = Decomposition::read_from_slice(&bytes).expect_err("too long");
    assert!(error.to_string().contains("bytes follow the last class"), "{error}");
}

#[test]
fn what_cannot_be_is_named() {
    let good = to_bytes(&decompose(hills()));
    // How many slopes there are is the count of the last class, before its sum.
    let vertices = u64::from_le_bytes(good[good.len() - 16..][..8].try_into().unwrap()) as usize;
    let refuse = |at: usize, bytes: &[u8], part: &str| {
        let mut file = good.clone();
        file[at..at + bytes.len()].copy_from_slice(bytes);
        let error = Decomposition::read_from_slice(&file).expect_err(part);
        assert!(error.to_string().contains(part), "{error} does not say {part}");
    };
    refuse(0, b"PLY", "this is no hierarchy file");
    refuse(8, &[2], "version 2 of the hierarchy format cannot be read");
    refuse(12, &[6], "a hierarchy with the flags 0x6 cannot be read");
    refuse(16, &[1], "1 columns and 9 rows make no surface");
    refuse(16, &[0xff; 8], "heights are promised");
    refuse(24, &[7], "a hierarchy of 7 times");
    refuse(32, &[31], "of depth 31 for 12 columns and 9 rows cannot be read");
    refuse(36, &[0; 4], "must be positive and finite");
    refuse(44, &f32::INFINITY.to_le_bytes(), "height inf in column 0, row 0");
    refuse(SLOPES, &f32::NAN.to_le_bytes(), "the slope of vertex 0 is NaN");
    refuse(SLOPES, &(-1e30f32).to_le_bytes(), "vertex 0 goes before another that hangs on it");
    // All vertices may go, says a file whose heights say otherwise.
    let mut file = good.clone();
    let mut stayed = 0;
    for slope in &mut file[SLOPES..].as_chunks_mut::<4>().0[..vertices] {
        if f32::from_le_bytes(*slope) > 1e30 {
            *slope = 1e29f32.to_le_bytes();
            stayed += 1;
        }
    }
    assert!(stayed > 0 && stayed < vertices);
    let error = Decomposition::read_from_slice(&file).expect_err("a triangle over a void");
    assert!(error.to_string().contains("would leave triangles over voids"), "{error}");
    // Nobody counts classes down.
    refuse(good.len() - 20, &[0; 4], "class 0 cannot come here");
    refuse(good.len() - 8, &f64::NAN.to_le_bytes(), "cannot come here");
    refuse(good.len() - 16, &[1, 0, 0, 1], "slopes are in classes");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn no_damage_makes_reading_panic(
        damage in vec((any::<prop::sample::Index>(), any::<u8>(), 0u8..4), 1..6),
    ) {
        let mut bytes = to_bytes(&decompose(hills()));
        for (place, value, kind) in damage {
            let place = place.index(bytes.len());
            match kind {
                0 => bytes[place] = value,
                1 => bytes[place] ^= 1 << (value % 8),
                2 => bytes.insert(place, value),
                _ => bytes[place] = 0xff,
            }
        }
        // What is still a hierarchy gives meshes.
        if let Ok(decomposition) = Decomposition::read_from_slice(&bytes) {
            for vertices in [0, 20, 200] {
                decomposition.at(Detail::Vertices(vertices)).unwrap();
            }
            decomposition.at(Detail::MaxError(1.0)).unwrap();
        }
    }
}
