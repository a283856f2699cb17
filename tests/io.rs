//! Mesh files: what is written comes back, what other programs write is understood, and what
//! nobody should have written is refused.

#![cfg(feature = "io")]

mod io_files;

use std::io::Write;
use std::path::Path;

use decimesh::io::{Encoding, Format, WriteError, WriteOptions, read, read_from_slice, write, write_to};
use decimesh::{Attributes, Mesh};
use proptest::collection::vec;
use proptest::prelude::*;

const KINDS: [(&str, Format, Encoding); 9] = [
    ("ply", Format::Ply, Encoding::Binary),
    ("ply", Format::Ply, Encoding::BinaryBigEndian),
    ("ply", Format::Ply, Encoding::Ascii),
    ("obj", Format::Obj, Encoding::Ascii),
    ("stl", Format::Stl, Encoding::Binary),
    ("stl", Format::Stl, Encoding::Ascii),
    ("off", Format::Off, Encoding::Ascii),
    ("gltf", Format::Gltf, Encoding::Binary),
    ("glb", Format::Glb, Encoding::Binary),
];

fn coordinate() -> impl Strategy<Value = f32> {
    use proptest::num::f32::{NEGATIVE, NORMAL, POSITIVE, SUBNORMAL, ZERO};
    prop_oneof![POSITIVE | NEGATIVE | NORMAL | SUBNORMAL | ZERO, (-2i8..2).prop_map(f32::from), -1e3f32..1e3]
}

fn unit_vector() -> impl Strategy<Value = [f32; 3]> {
    prop::array::uniform3(-1.0f32..1.0).prop_filter_map("too short to have a direction", |v| {
        let length = v.iter().map(|x| x * x).sum::<f32>().sqrt();
        (length > 0.1).then(|| v.map(|x| x / length))
    })
}

fn mesh() -> impl Strategy<Value = Mesh> {
    (1usize..40).prop_flat_map(|vertices| {
        let index = 0..vertices as u32;
        (
            vec(prop::array::uniform3(coordinate()), vertices),
            vec(prop::array::uniform3(index), 0..60),
            prop::option::of(vec(unit_vector(), vertices)),
            prop::option::of(vec(any::<[u8; 4]>(), vertices)),
            prop::option::of(vec(prop::array::uniform2(-4.0f32..4.0), vertices)),
        )
            .prop_map(|(positions, triangles, normals, colors, uvs)| {
                let attributes = Attributes { normals, colors, uvs };
                Mesh::with_attributes(positions, triangles, attributes).expect("a valid mesh")
            })
    })
}

fn bits(positions: &[[f32; 3]]) -> Vec<[u32; 3]> {
    positions.iter().map(|position| position.map(f32::to_bits)).collect()
}

/// What `mesh` must become by way of a file of `format`.
fn assert_survives(mesh: &Mesh, found: &Mesh, format: Format) {
    let (expected, actual) = (mesh.attributes(), found.attributes());
    if format == Format::Stl {
        let corners = |mesh: &Mesh| -> Vec<[f32; 3]> {
            mesh.triangles().as_flattened().iter().map(|&index| mesh.positions()[index as usize]).collect()
        };
        assert_eq!(corners(mesh), corners(found));
        let mut seen: Vec<[f32; 3]> = Vec::new();
        for corner in corners(mesh) {
            if !seen.contains(&corner) {
                seen.push(corner);
            }
        }
        assert_eq!(found.positions(), seen, "one vertex a position, in order of appearance");
        assert_eq!(*actual, Attributes::default());
        return;
    }
    if matches!(format, Format::Gltf | Format::Glb) && mesh.triangles().is_empty() {
        assert_eq!(*found, Mesh::default());
        return;
    }
    assert_eq!(bits(mesh.positions()), bits(found.positions()));
    assert_eq!(mesh.triangles(), found.triangles());
    match format {
        Format::Obj => {
            let opaque = |&[r, g, b, _]: &[u8; 4]| [r, g, b, 255];
            let colors: Option<Vec<_>> = expected.colors.as_ref().map(|all| all.iter().map(opaque).collect());
            assert_eq!(colors, actual.colors);
            // Only corners tie normals and texture coordinates to vertices.
            let has_corners = !mesh.triangles().is_empty();
            assert_eq!(expected.normals.is_some() && has_corners, actual.normals.is_some());
            assert_eq!(expected.uvs.is_some() && has_corners, actual.uvs.is_some());
            for &index in mesh.triangles().as_flattened() {
                let index = index as usize;
                assert_eq!(
                    expected.normals.as_ref().map(|all| all[index]),
                    actual.normals.as_ref().map(|all| all[index])
                );
                assert_eq!(
                    expected.uvs.as_ref().map(|all| all[index]),
                    actual.uvs.as_ref().map(|all| all[index])
                );
            }
        }
        Format::Gltf | Format::Glb => {
            assert_eq!((&expected.normals, &expected.colors), (&actual.normals, &actual.colors));
            assert_eq!(expected.uvs.is_some(), actual.uvs.is_some());
            let uvs = |attributes: &Attributes| attributes.uvs.clone().unwrap_or_default();
            for (expected, actual) in uvs(expected).as_flattened().iter().zip(uvs(actual).as_flattened()) {
                assert!((expected - actual).abs() < 1e-6, "{expected} became {actual}");
            }
        }
        _ => assert_eq!(expected, actual),
    }
}

fn to_bytes(mesh: &Mesh, format: Format, encoding: Encoding) -> Vec<u8> {
    let mut bytes = Vec::new();
    write_to(mesh, format, &WriteOptions { encoding }, &mut bytes).expect("memory takes any mesh");
    bytes
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn every_format_brings_a_mesh_back(mesh in mesh()) {
        for (_, format, encoding) in KINDS {
            let found = read_from_slice(&to_bytes(&mesh, format, encoding), format);
            assert_survives(&mesh, &found.unwrap_or_else(|error| panic!("{format:?}: {error}")), format);
        }
    }

    #[test]
    fn gltf_passes_the_validation_of_another_implementation(mesh in mesh()) {
        for format in [Format::Gltf, Format::Glb] {
            let bytes = to_bytes(&mesh, format, Encoding::Binary);
            let gltf = gltf::Gltf::from_slice(&bytes).unwrap_or_else(|error| panic!("{error}"));
            let Some(primitive) = gltf.meshes().flat_map(|mesh| mesh.primitives()).next() else {
                prop_assert!(mesh.triangles().is_empty());
                continue;
            };
            let Some(blob) = &gltf.blob else { continue };
            let reader = primitive.reader(|_| Some(blob));
            let positions: Vec<_> = reader.read_positions().expect("positions").collect();
            prop_assert_eq!(bits(&positions), bits(mesh.positions()));
            let indices: Vec<_> = reader.read_indices().expect("indices").into_u32().collect();
            prop_assert_eq!(indices, mesh.triangles().as_flattened());
            let bounds = primitive.bounding_box();
            for position in positions {
                let within = (0..3).all(|axis| (bounds.min[axis]..=bounds.max[axis]).contains(&position[axis]));
                prop_assert!(within, "{position:?} is outside of {bounds:?}");
            }
        }
    }
}

fn sample() -> Mesh {
    let positions = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.5], [0.0, 1.0, 0.0], [0.1, 0.2, 3e-9]];
    let attributes = Attributes {
        normals: Some(vec![[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.6, 0.8, 0.0]]),
        colors: Some(vec![[255, 0, 0, 255], [0, 12, 0, 9], [0, 0, 255, 128], [1, 2, 3, 4]]),
        uvs: Some(vec![[0.0, 0.25], [1.0, 0.5], [0.5, 1.0], [0.75, 0.125]]),
    };
    Mesh::with_attributes(positions, vec![[0, 1, 2], [0, 3, 1], [1, 3, 2]], attributes).expect("valid")
}

#[test]
fn files_are_written_and_read_by_their_extension() {
    let directory = tempfile::tempdir().expect("a directory");
    for (extension, format, encoding) in KINDS {
        for extension in [extension.to_owned(), extension.to_uppercase()] {
            let path = directory.path().join(format!("mesh.{extension}"));
            write(&sample(), &path, &WriteOptions { encoding }).expect("written");
            assert_survives(&sample(), &read(&path).expect("read"), format);
        }
    }
    let error = read(Path::new("mesh.doc")).expect_err("no mesh format");
    assert_eq!(error.to_string(), "mesh.doc: the extension is none of ply, obj, stl, off, gltf, glb");
    let error = read(&directory.path().join("missing.ply")).expect_err("no file");
    assert!(error.to_string().contains("missing.ply: No such file"), "{error}");
}

fn listing(directory: &Path) -> Vec<String> {
    let entries = std::fs::read_dir(directory).expect("a directory");
    let mut names: Vec<_> =
        entries.map(|entry| entry.expect("an entry").file_name().to_string_lossy().into_owned()).collect();
    names.sort();
    names
}

#[test]
fn a_failed_write_leaves_everything_as_it_was() {
    let directory = tempfile::tempdir().expect("a directory");
    let options = WriteOptions::default();
    // The last step fails: a file cannot replace a directory.
    let blocked = directory.path().join("blocked.glb");
    std::fs::create_dir(&blocked).expect("a directory");
    std::fs::write(blocked.join("inside"), "kept").expect("a file");
    write(&sample(), &blocked, &options).expect_err("a directory is in the way");
    // The first step fails.
    let protected = directory.path().join("protected.ply");
    std::fs::write(&protected, "old").expect("a file");
    let mut permissions = std::fs::metadata(&protected).expect("metadata").permissions();
    permissions.set_readonly(true);
    std::fs::set_permissions(&protected, permissions).expect("permissions");
    write(&sample(), &protected, &options).expect_err("the file is write-protected");
    write(&sample(), &directory.path().join("nowhere/mesh.ply"), &options).expect_err("no such directory");
    assert_eq!(std::fs::read_to_string(&protected).expect("still there"), "old");
    assert_eq!(listing(directory.path()), ["blocked.glb", "protected.ply"]);
}

#[test]
fn a_successful_write_leaves_one_ordinary_file() {
    let directory = tempfile::tempdir().expect("a directory");
    let path = directory.path().join("mesh.stl");
    std::fs::write(&path, "old").expect("a file");
    write(&sample(), &path, &WriteOptions::default()).expect("written");
    assert_eq!(listing(directory.path()), ["mesh.stl"]);
    assert_eq!(read(&path).expect("read").triangles().len(), 3);
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        let mode = |path: &Path| std::fs::metadata(path).expect("metadata").permissions().mode() & 0o777;
        std::fs::set_permissions(&path, PermissionsExt::from_mode(0o640)).expect("permissions");
        write(&sample(), &path, &WriteOptions::default()).expect("written");
        assert_eq!(mode(&path), 0o640, "those of the file replaced");
        let (new, plain) = (directory.path().join("new.stl"), directory.path().join("plain"));
        write(&sample(), &new, &WriteOptions::default()).expect("written");
        std::fs::write(&plain, "").expect("a file");
        assert_eq!(mode(&new), mode(&plain), "those of any new file");
        let link = directory.path().join("link.stl");
        std::os::unix::fs::symlink(&path, &link).expect("a link");
        write(&Mesh::default(), &link, &WriteOptions::default()).expect("written");
        assert!(link.is_symlink());
        assert!(read(&path).expect("read").triangles().is_empty());
    }
}

#[test]
fn a_full_disk_is_an_error_in_every_format() {
    struct Full(usize);
    impl Write for Full {
        fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
            let taken = bytes.len().min(self.0);
            self.0 -= taken;
            if taken == 0 { Err(std::io::ErrorKind::StorageFull.into()) } else { Ok(taken) }
        }
        fn flush(&mut self) -> std::io::Result<()> {
            Ok(())
        }
    }
    for (_, format, encoding) in KINDS {
        let length = to_bytes(&sample(), format, encoding).len();
        for room in [0, 1, length / 2, length - 1] {
            let result = write_to(&sample(), format, &WriteOptions { encoding }, Full(room));
            assert!(matches!(result, Err(WriteError::Io(_))), "{format:?} with room for {room}");
        }
        write_to(&sample(), format, &WriteOptions { encoding }, Full(length)).expect("room enough");
    }
}

/// The sample in every kind of file, for damage to be done to.
fn specimens() -> Vec<(Format, Vec<u8>)> {
    let plain = Mesh::new(sample().positions().to_vec(), sample().triangles().to_vec()).expect("valid");
    let mut all: Vec<_> = [sample(), plain]
        .iter()
        .flat_map(|mesh| KINDS.map(|(_, format, encoding)| (format, to_bytes(mesh, format, encoding))))
        .collect();
    all.extend(io_files::ALL.iter().map(|&(format, text)| (format, text.as_bytes().to_vec())));
    all
}

#[test]
fn every_truncation_is_an_error_or_a_mesh() {
    for (format, bytes) in specimens() {
        read_from_slice(&bytes, format).unwrap_or_else(|error| panic!("{format:?}: {error}"));
        let mut refused = 0;
        for length in 0..bytes.len() {
            if let Err(error) = read_from_slice(&bytes[..length], format) {
                assert!(!error.to_string().is_empty());
                refused += 1;
            }
        }
        assert!(refused > 0, "{format:?}");
        if matches!(format, Format::Glb) || bytes.starts_with(b"binary STL") {
            assert_eq!(refused, bytes.len(), "{format:?} counts its bytes");
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn no_damage_makes_a_reader_panic(
        damage in vec((any::<prop::sample::Index>(), any::<u8>(), 0u8..4), 1..6),
    ) {
        for (format, mut bytes) in specimens() {
            for (place, value, kind) in &damage {
                let place = place.index(bytes.len());
                match kind {
                    0 => bytes[place] = *value,
                    1 => bytes[place] ^= 1 << (value % 8),
                    2 => bytes.insert(place, *value),
                    _ => {
                        // A number of the text becomes another, or a number of the file a huge one.
                        let digit = bytes[place].is_ascii_digit();
                        bytes[place] = if digit { b'0' + value % 10 } else { 0xff };
                    }
                }
            }
            let _ = read_from_slice(&bytes, format);
        }
    }

    #[test]
    fn no_bytes_make_a_reader_panic(bytes in vec(any::<u8>(), 0..400)) {
        for (_, format, _) in KINDS {
            let _ = read_from_slice(&bytes, format);
        }
    }
}
