use decimesh::io::Format::Obj;

use super::{read, refusal};

/// Two quads that share an edge, along which texture and normal break; groups, a material, a
/// continued line, relative indices, a name that is not ASCII, a line and a point.
pub(super) const SEAM: &str = "# a comment
mtllib some.mtl
o caf\u{e9}
v 0 0 0
v 1 0 0 1.0
v 1 1 0
v 0 1 0
v 9 9 9
v 2 0 0
v 2 1 0
vt 0 0
vt 1 0 0
vt 1 1
vt 0.5
vn 0 0 2
vn 0 1 0
g left
usemtl red
f 1/1/1 2/2/1 3/3/1 4/4/1
g right
s off
l 1 2
p 3
f -6/-3/-1 \\
  -2/1/-1 7/3/2 3/2/2
";

pub(super) const COLORED: &str = "f 1 2 3\nv 0 0 0 1 0 0\nv 1 0 0 0.5 0.5 0.5\nv 0 1 0\n";

#[test]
fn positions_stay_and_seams_add_vertices_at_the_end() {
    let mesh = read(Obj, SEAM);
    let positions = mesh.positions();
    assert_eq!(positions[4], [9.0; 3], "vertices that no face uses stay");
    assert_eq!(mesh.triangles(), [[0, 1, 2], [0, 2, 3], [7, 5, 6], [7, 6, 8]]);
    assert_eq!(positions[7..], [positions[1], positions[2]]);
    let uvs = mesh.attributes().uvs.as_deref().expect("texture coordinates");
    assert_eq!(uvs[..4], [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.5, 0.0]]);
    assert_eq!(uvs[5..], [[0.0, 0.0], [1.0, 1.0], [1.0, 0.0], [1.0, 0.0]]);
    let normals = mesh.attributes().normals.as_deref().expect("normals");
    assert_eq!(normals[0], [0.0, 0.0, 1.0], "normals become unit length");
    assert_eq!(normals[7..], [[0.0, 1.0, 0.0]; 2]);
}

#[test]
fn without_attributes_a_file_is_taken_as_it_is() {
    let text: String = SEAM.lines().filter(|line| !line.starts_with('v') || line.starts_with("v ")).fold(
        String::new(),
        |text, line| {
            let plain = if line.starts_with('f') || line.starts_with(' ') {
                line.split(' ')
                    .map(|word| word.split('/').next().unwrap_or_default())
                    .collect::<Vec<_>>()
                    .join(" ")
            } else {
                line.to_owned()
            };
            text + &plain + "\n"
        },
    );
    let mesh = read(Obj, text);
    assert_eq!(mesh.positions().len(), 7);
    assert_eq!(mesh.triangles(), [[0, 1, 2], [0, 2, 3], [1, 5, 6], [1, 6, 2]]);
    assert_eq!(*mesh.attributes(), Default::default());
}

#[test]
fn normals_that_are_not_everywhere_are_nowhere_and_split_nothing() {
    let mesh = read(Obj, SEAM.replace("/1 2/2/1 3/3/1 4/4/1", " 2/2 3/3 4/4"));
    assert_eq!(mesh.attributes().normals, None);
    // Of the two shared positions, one still differs in texture coordinates.
    assert_eq!(mesh.positions().len(), 8);
    let mesh = read(Obj, SEAM.replace("/1 2/2/1 3/3/1 4/4/1", " 2/2 3/3 4/4").replace("3/2/2", "3/3/2"));
    assert_eq!(mesh.positions().len(), 7);
}

#[test]
fn colors_count_to_one_or_to_255() {
    let colors = |text: &str| read(Obj, text).attributes().colors.clone();
    let expected = Some(vec![[255, 0, 0, 255], [128, 128, 128, 255], [255; 4]]);
    assert_eq!(colors(COLORED), expected);
    let of_255 = COLORED.replace("1 0 0\nv 1", "255 0 0\nv 1").replace("0.5 0.5 0.5", "128 128 128");
    assert_eq!(colors(&of_255), expected);
    assert_eq!(colors("v 0 0 0 1 1 0\n"), Some(vec![[255, 255, 0, 255]]));
}

#[test]
fn broken_lines_are_named() {
    for (from, to, refused) in [
        ("v 9 9 9", "v 9 9", "line 8: a position needs 3 numbers, but has 2"),
        ("v 9 9 9", "v 9 9 x", "line 8: 'x' is not a number that can stand here"),
        ("v 9 9 9", "v 9 9 1e99", "line 8: '1e99' is not a finite number"),
        ("vn 0 1 0", "vn 0 nan 0", "line 16: 'nan' is not a finite number"),
        ("2/2/1", "0/2/1", "line 19: a face names v 0, which does not exist"),
        ("2/2/1", "8/2/1", "line 19: a face names v 8, which does not exist"),
        ("2/2/1", "2/5/1", "line 19: a face names vt 5, which does not exist"),
        ("2/2/1", "2/2/-3", "line 19: a face names vn -3, which does not exist"),
        ("2/2/1", "2/2/4294967296", "line 19: a face names vn 4294967296, which does not exist"),
        (
            "2/2/1",
            "99999999999999999999/2/1",
            "line 19: '99999999999999999999' is not a number that can stand here",
        ),
        ("2/2/1", "/2/1", "line 19: '/2/1' is no corner of a face"),
        ("2/2/1", "2/2/1/1", "line 19: '2/2/1/1' is no corner of a face"),
        (
            "2/2/1",
            "-9223372036854775808",
            "line 19: a face names v -9223372036854775808, which does not exist",
        ),
        ("2/2/1", "b", "line 19: 'b' is not a number that can stand here"),
    ] {
        assert!(SEAM.contains(from));
        assert_eq!(refusal(Obj, SEAM.replacen(from, to, 1)), refused);
    }
}

#[test]
fn a_line_without_an_end_is_refused_before_it_fills_memory() {
    let mut text = b"v ".to_vec();
    text.resize(40 << 20, b'1');
    assert_eq!(refusal(Obj, text), "line 1: the line is longer than 16777216 bytes");
}
