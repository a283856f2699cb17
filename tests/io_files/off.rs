use decimesh::io::Format::Off;

use super::{read, refusal};

pub(super) const COMMENTED: &str = "OFF # the format
# the counts, and an edge count nobody needs

4 3 0
0 0 0 # first
1 0 0 9 9 9

1 1 0
0 1 0
4 0 1 2 3  255 0 0
2 0 1
3 0 0 1
";

pub(super) const COLORED: &str = "STCNOFF 3 1
0 0 0  0 0 1  1.0 0 0      0 0.5
1 0 0  0 0 1  0 0.5 0      1 0.5
0 1 0  0 0 1  0 0 0 0.25   0 1
3 0 1 2
";

#[test]
fn comments_polygons_and_surplus_are_understood() {
    let mesh = read(Off, COMMENTED);
    assert_eq!(mesh.positions(), [[0.0; 3], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]]);
    assert_eq!(mesh.triangles(), [[0, 1, 2], [0, 2, 3], [0, 0, 1]]);
    assert_eq!(*mesh.attributes(), Default::default());
    assert_eq!(read(Off, &COMMENTED[4..]), mesh, "the keyword may be missing");
}

#[test]
fn all_variants_and_both_ranges_of_colors_are_read() {
    let mesh = read(Off, COLORED);
    let attributes = mesh.attributes();
    let colors = vec![[255, 0, 0, 255], [0, 128, 0, 255], [0, 0, 0, 64]];
    assert_eq!(attributes.colors, Some(colors.clone()));
    assert_eq!(attributes.normals, Some(vec![[0.0, 0.0, 1.0]; 3]));
    assert_eq!(attributes.uvs, Some(vec![[0.0, 0.5], [1.0, 0.5], [0.0, 1.0]]));
    let coff = "COFF\n3 0 0\n0 0 0 255 0 0\n0 0 0 0 128 0 255\n0 0 0 0 0 0 64\n";
    assert_eq!(read(Off, coff).attributes().colors, Some(colors));
}

#[test]
fn broken_lines_are_named() {
    for (from, to, refused) in [
        ("OFF", "PLY", "line 1: an OFF file starts with 'OFF', not with 'PLY'"),
        ("OFF", "4OFF", "the OFF variant '4OFF' cannot be read"),
        ("OFF #", "OFF BINARY #", "binary OFF cannot be read"),
        ("4 3 0", "4", "line 4: the counts of the header: '' is not a number that can stand here"),
        (
            "4 3 0",
            "400 3 0",
            "byte 71: 400 vertices are promised, which take at least 2000 bytes, but 72 are left",
        ),
        (
            "4 3 0",
            "4 300 0",
            "byte 71: 300 faces are promised, which take at least 300 bytes, but 72 are left",
        ),
        ("4 3 0", "4 5 0", "line 13: face 3 of 5: the file ends here"),
        ("4 3 0", "4294967296 0 0", "4294967296 vertices are more than decimesh can hold (4294967295)"),
        ("1 1 0", "1 1", "line 8: vertex 2 of 4: a position needs 3 numbers, but has 2"),
        ("1 1 0", "1 -inf 1", "line 8: vertex 2 of 4: '-inf' is not a finite number"),
        ("3 0 0 1", "3 0 4 1", "line 12: face 2 of 3: index 4, but there are 4 vertices"),
        ("3 0 0 1", "3 0 -1 1", "line 12: face 2 of 3: index -1, but there are 4 vertices"),
        ("3 0 0 1", "9999999999 0 0 1", "line 12: face 2 of 3: 9999999999 corners, but only 3 indices"),
    ] {
        assert!(COMMENTED.contains(from));
        assert_eq!(refusal(Off, COMMENTED.replacen(from, to, 1)), refused, "{from} -> {to}");
    }
    assert_eq!(
        refusal(Off, COLORED.replace("0.5 0      1", "0.5 1")),
        "line 3: vertex 1 of 3: a colour needs 3 or 4 numbers, but has 2"
    );
}
