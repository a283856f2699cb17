use decimesh::io::Format::Stl;

use super::{read, refusal};

/// Two solids in the style of several programs; the square's diagonal is shared, and a zero is
/// negative once.
pub(super) const TWO_SOLIDS: &str = "solid first thing
  facet normal 0.0e+000 0 nan
    OUTER LOOP
      vertex 0 0 0
      vertex 1.0e+000 0 0
      vertex 1 1 0
    ENDLOOP
  endfacet
endsolid first thing
solid
facet normal 0 0 1 outer loop vertex -0 0 0 vertex 1 1 0 vertex 0 1 0 endloop endfacet
endsolid
";

#[test]
fn corners_at_one_position_are_one_vertex() {
    let mesh = read(Stl, TWO_SOLIDS);
    assert_eq!(mesh.positions(), [[0.0; 3], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]]);
    assert_eq!(mesh.triangles(), [[0, 1, 2], [0, 2, 3]]);
}

fn binary(header: &[u8], count: u32, triangles: usize) -> Vec<u8> {
    let mut bytes = vec![b' '; 80];
    bytes[..header.len()].copy_from_slice(header);
    bytes.extend(count.to_le_bytes());
    for triangle in 0..triangles {
        let corner = triangle as f32;
        for value in [0.0, 0.0, 1.0, corner, 0.0, 0.0, corner + 1.0, 0.0, 0.0, 0.0, 1.0, 0.0] {
            bytes.extend(f32::to_le_bytes(value));
        }
        bytes.extend([0; 2]);
    }
    bytes
}

#[test]
fn binary_files_that_call_themselves_solid_are_still_binary() {
    for header in [&b"solid made by a CAD program"[..], b"", b"solid\nfacet normal 0 0 1\n"] {
        let mesh = read(Stl, binary(header, 3, 3));
        assert_eq!((mesh.positions().len(), mesh.triangles().len()), (5, 3));
    }
    assert_eq!(read(Stl, binary(b"solid", 0, 0)).triangles().len(), 0);
}

#[test]
fn a_binary_count_must_be_right() {
    assert_eq!(
        refusal(Stl, binary(b"", 4_000_000_000, 1)),
        "byte 84: 4000000000 triangles are promised, which take at least 200000000000 bytes, but 50 are left"
    );
    assert_eq!(
        refusal(Stl, binary(b"solid", 3, 2)),
        "byte 84: 3 triangles are promised, which take at least 150 bytes, but 100 are left"
    );
    assert_eq!(
        refusal(Stl, binary(b"", 1, 2)),
        "byte 134: the header counts 1 triangles, but the file goes on"
    );
    let mut bytes = binary(b"", 2, 2);
    bytes[84 + 50 + 16..84 + 50 + 20].copy_from_slice(&f32::NAN.to_le_bytes());
    assert_eq!(refusal(Stl, bytes), "byte 184: triangle 1 has a corner that is not finite");
    assert_eq!(
        refusal(Stl, "short"),
        "byte 0: neither a text that starts with 'solid' nor long enough for the 84 bytes of a binary header"
    );
    assert_eq!(refusal(Stl, ""), "byte 0: the file is empty");
}

#[test]
fn broken_lines_are_named() {
    for (from, to, refused) in [
        ("vertex 1 1 0\n", "\n", "line 7: a loop of 2 vertices, where only 3 can be"),
        (
            "vertex 1 1 0\n",
            "vertex 1 1 0\nvertex 2 2 2\n",
            "line 8: a loop of 4 vertices, where only 3 can be",
        ),
        ("vertex 1 1 0\n", "vertex 1 1\n", "line 6: a vertex needs 3 numbers, but has 2"),
        ("vertex 1 1 0\n", "vertex 1 1 1e39\n", "line 6: '1e39' is not a finite number"),
        ("vertex 1 1 0\n", "edge 1 1 0\n", "line 6: 'edge' cannot stand here, in a loop"),
        ("    ENDLOOP\n", "", "line 7: 'endfacet' cannot stand here, in a loop"),
        ("endsolid first thing\n", "", "line 9: 'solid' cannot stand here, in a solid"),
        ("endfacet\nendsolid\n", "endfacet\n", "line 12: the file ends before 'endsolid'"),
        ("endfacet\nendsolid\n", "", "line 12: the file ends before 'endfacet'"),
    ] {
        assert!(TWO_SOLIDS.contains(from));
        assert_eq!(refusal(Stl, TWO_SOLIDS.replacen(from, to, 1)), refused, "{from:?} -> {to:?}");
    }
}
