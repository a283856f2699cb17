//! What files may hold, and what is refused.

use decimesh::mesh::shapes;
use decimesh::out_of_core::{OutOfCoreError, simplify_file};
use decimesh::{AttributeWeights, Monitor, Options, Placement, Target};

use crate::workbench::{MEGABYTE, Workbench};

#[test]
fn encodings_make_no_difference() {
    let bench = Workbench::with(&shapes::bumpy_sphere(76, 1));
    let mesh = decimesh::io::read(&bench.path("in.ply")).unwrap();
    let mut outputs = Vec::new();
    for encoding in [
        decimesh::io::Encoding::Binary,
        decimesh::io::Encoding::BinaryBigEndian,
        decimesh::io::Encoding::Ascii,
    ] {
        let options = decimesh::io::WriteOptions { encoding };
        decimesh::io::write(&mesh, &bench.path("in.ply"), &options).unwrap();
        bench.simplify(&Options::new(Target::Ratio(0.1)), 4 * MEGABYTE);
        outputs.push(bench.output());
    }
    assert!(outputs[0] == outputs[1] && outputs[0] == outputs[2]);
}

#[test]
fn polygons_and_strange_properties_are_read_as_elsewhere() {
    // Faces come first, as quads; vertices have doubles, and more than a mesh can hold.
    let side = 60_u32;
    let quads = (0..side * side).map(|k| k / side * (side + 1) + k % side);
    let mut bytes = format!(
        "ply\nformat binary_little_endian 1.0\nelement face {}\nproperty uchar flags\nproperty list uchar uint \
         vertex_indices\nelement vertex {}\nproperty double x\nproperty list uchar short odd\nproperty double y\n\
         property double z\nend_header\n",
        side * side,
        (side + 1) * (side + 1)
    )
    .into_bytes();
    for k in quads {
        bytes.extend([9, 4]);
        bytes.extend([k, k + 1, k + side + 2, k + side + 1].map(u32::to_le_bytes).as_flattened());
    }
    for k in 0..(side + 1) * (side + 1) {
        let (x, y) = (f64::from(k % (side + 1)), f64::from(k / (side + 1)));
        bytes.extend(x.to_le_bytes());
        bytes.extend([1, 5, 0]);
        bytes.extend(y.to_le_bytes());
        bytes.extend((0.1 * x * y).sin().to_le_bytes());
    }
    let bench = Workbench::new(&bytes);
    let mesh = decimesh::io::read(&bench.path("in.ply")).unwrap();
    let options = Options::new(Target::Ratio(0.2));
    let (outcome, simplified) = bench.simplify(&options, 8 * MEGABYTE);
    assert_eq!(outcome.triangles_in, 2 * (side * side) as usize);
    let expected = decimesh::simplify(&mesh, &options, &mut Monitor::silent()).unwrap().mesh;
    assert_eq!(simplified, expected);
}

#[test]
fn meshes_of_nothing_are_meshes() {
    for body in
        ["element vertex 0\n", "element vertex 2\nproperty float x\nproperty float y\nproperty float z\n"]
    {
        let rows = if body.contains("property") { "0 0 0\n1 1 1\n" } else { "" };
        let bench = Workbench::new(format!("ply\nformat ascii 1.0\n{body}end_header\n{rows}").as_bytes());
        let (outcome, mesh) = bench.simplify(&Options::new(Target::Triangles(5)), 8 * MEGABYTE);
        assert_eq!((outcome.triangles, mesh.triangles().len()), (0, 0));
    }
}

#[test]
fn broken_files_are_refused_and_leave_nothing() {
    let good = Workbench::with(&shapes::bumpy_sphere(20, 1));
    let bytes = std::fs::read(good.path("in.ply")).unwrap();
    let body = bytes.windows(11).position(|window| window == b"end_header\n").unwrap() + 11;
    let changed = |at: usize, with: [u8; 4]| {
        let mut bytes = bytes.clone();
        bytes[at..at + 4].copy_from_slice(&with);
        bytes
    };
    let header = |old: &str, new: &str| {
        let text = String::from_utf8(bytes[..body].to_vec()).unwrap().replace(old, new);
        [text.as_bytes(), &bytes[body..]].concat()
    };
    for (bytes, part) in [
        (bytes[..bytes.len() - 1].to_vec(), "are left"),
        (bytes[..body + 1000].to_vec(), "are promised"),
        (bytes[..body - 11].to_vec(), "within the header"),
        (Vec::new(), "the file is empty"),
        (b"solid no ply".to_vec(), "starts with a line 'ply'"),
        (changed(body + 24, f32::NAN.to_le_bytes()), "position of vertex 2 is not finite"),
        (changed(bytes.len() - 4, u32::MAX.to_le_bytes()), "index"),
        (header("element face 4800", "element face 4000000000"), "are promised"),
        (header("element vertex 2402", "element vertex 5000000000"), "vertices are more"),
        (header("element vertex 2402", "element vertex 99999999999999999999"), "not a number"),
        (header("list uchar int", "list uint int"), "face "),
        (header("float x", "float w"), "no property 'x'"),
    ] {
        let bench = Workbench::new(&bytes);
        std::fs::write(bench.path("out.ply"), "what was there").unwrap();
        let error =
            bench.try_simplify(&Options::new(Target::Ratio(0.5)), 8 * MEGABYTE, usize::MAX).unwrap_err();
        assert!(matches!(error, OutOfCoreError::Read(_)), "{error}");
        assert!(error.to_string().contains(part), "{error} does not say {part}");
        assert!(error.to_string().contains("in.ply"), "{error}");
        assert_eq!(bench.output(), b"what was there");
        assert_eq!(bench.files(), ["in.ply", "out.ply"], "{error}");
    }
}

#[test]
fn what_cannot_be_done_is_refused_before_anything_is() {
    let bench = Workbench::with(&shapes::bumpy_sphere(120, 1));
    let half = || Options::new(Target::Ratio(0.5));
    let weights = AttributeWeights { normals: 1.0, ..AttributeWeights::default() };
    for (options, part) in [
        (Options::new(Target::Vertices(9)), "the target is a number of triangles or a ratio"),
        (Options::new(Target::MaxError(0.1)), "the target is a number of triangles or a ratio"),
        (Options::new(Target::Ratio(1.5)), "not between 0 and 1"),
        (Options::new(Target::Ratio(f64::NAN)), "not between 0 and 1"),
        (Options { placement: Placement::Existing, ..half() }, "vertices move"),
        (Options { locked: vec![1], ..half() }, "locks, groups, weights and tracks"),
        (Options { attribute_weights: weights, ..half() }, "locks, groups, weights and tracks"),
        (Options { track_origins: true, ..half() }, "locks, groups, weights and tracks"),
    ] {
        let error = bench.try_simplify(&options, 64 * MEGABYTE, usize::MAX).unwrap_err();
        assert!(matches!(error, OutOfCoreError::InvalidOption(_)), "{error}");
        assert!(error.to_string().contains(part), "{error} does not say {part}");
    }
    for memory in [0, 1000, MEGABYTE, 2 * MEGABYTE] {
        let error = bench.try_simplify(&half(), memory, usize::MAX).unwrap_err();
        let OutOfCoreError::TooLittleMemory { given, needed, vertices } = error else { panic!("{error}") };
        assert_eq!((given, vertices), (memory, 6 * 120 * 120 + 2));
        assert!(needed > memory);
        // It is no more than is said.
        let enough = bench.try_simplify(&half(), needed + needed / 20, 5).unwrap_err();
        assert!(matches!(enough, OutOfCoreError::Cancelled(_)), "{enough}");
        std::fs::remove_dir_all(bench.path("out.ply.work")).unwrap();
    }
    let simplify = |from: &str, to: &str| {
        let (from, to) = (bench.path(from), bench.path(to));
        simplify_file(&from, &to, &half(), 64 * MEGABYTE, &mut Monitor::silent()).unwrap_err()
    };
    assert!(matches!(simplify("missing.ply", "out.ply"), OutOfCoreError::Read(_)));
    assert!(matches!(simplify("in.ply", "missing/out.ply"), OutOfCoreError::Work { .. }));
    assert!(matches!(simplify("in.xyz", "out.ply"), OutOfCoreError::Read(_)));
    assert!(matches!(simplify("in.ply", "out.xyz"), OutOfCoreError::Write(_)));
    assert!(matches!(simplify("in.obj", "out.ply"), OutOfCoreError::InvalidOption(_)));
    assert!(matches!(simplify("in.ply", "out.obj"), OutOfCoreError::InvalidOption(_)));
    assert_eq!(bench.files(), ["in.ply"]);
}
