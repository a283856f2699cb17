use decimesh::io::Format::Ply;

use super::{read, refusal, with_body};

/// Polygons, a face of two corners, other elements before and between, carriage returns, a comment.
pub(super) const RICH: &str = "ply\r
format ascii 1.0\r
comment by someone, with a number 5\r
obj_info and more\r
element camera 1\r
property float view_px\r
property list uchar int flags\r
element vertex 5\r
property double x\r
property float y\r
property short z\r
property float scalar_distance[<0.5]\r
property float red\r
property float green\r
property float blue\r
property float texture_u\r
property float texture_v\r
element face 4\r
property uchar quality\r
property list uchar uint vertex_index\r
property list uchar float texcoord\r
element nothing 4000000000\r
end_header\r
7 2 1 1\r
0 .5 -3 9 1 0 0.5 0 1\r
1 5. 2 nan 1 1 1 1 0\r
2 -1e-3 1 9 0 0 0 .25 .75\r
\r
3 0 0 9 0 0 0 0 0\r
4 0 0 9 0 0 0 0 0\r
9 5 0 1 2 3 4 0\r
9 2 0 1 2 0.5 0.5\r
9 3 2 2 1 0\r
9 0 0\r
";

pub(super) const STRIPS: &str = "ply
format ascii 1.0
element vertex 5
property float x
property float y
property float z
element tristrips 1
property list int int vertex_indices
end_header
0 0 0
1 0 0
0 1 0
1 1 0
0 2 0
11 0 1 2 3 -1 2 3 3 4 2 1
";

#[test]
fn everything_a_header_may_declare_is_understood_or_skipped() {
    let mesh = read(Ply, RICH);
    assert_eq!(
        mesh.positions(),
        [[0.0, 0.5, -3.0], [1.0, 5.0, 2.0], [2.0, -1e-3, 1.0], [3.0, 0.0, 0.0], [4.0, 0.0, 0.0]]
    );
    assert_eq!(mesh.triangles(), [[0, 1, 2], [0, 2, 3], [0, 3, 4], [2, 2, 1]]);
    let attributes = mesh.attributes();
    assert_eq!(attributes.normals, None);
    let black = [0, 0, 0, 255];
    assert_eq!(attributes.colors.as_deref(), Some(&[[255, 0, 128, 255], [255; 4], black, black, black][..]));
    assert_eq!(attributes.uvs.as_ref().map(|uvs| uvs[2]), Some([0.25, 0.75]));
}

#[test]
fn strips_alternate_and_their_steering_triangles_go() {
    let mesh = read(Ply, STRIPS);
    assert_eq!(mesh.triangles(), [[0, 1, 2], [2, 1, 3], [3, 4, 2], [2, 4, 1]]);
}

#[test]
fn names_and_comments_need_not_be_utf8() {
    let bytes = RICH.replace("someone", "\u{1}").into_bytes();
    let bytes: Vec<u8> = bytes.into_iter().map(|byte| if byte == 1 { 0xe9 } else { byte }).collect();
    assert_eq!(read(Ply, bytes), read(Ply, RICH));
}

const HEADER: &str = "ply\nformat binary_little_endian 1.0\nelement vertex 1\nproperty float x\n\
                      property float y\nproperty float z\nelement face 2\n\
                      property list uchar int vertex_indices\nend_header\n";

#[test]
fn faces_that_name_no_vertex_are_named() {
    let zeros = [0; 12];
    let face = |index: i32| {
        let index = index.to_le_bytes();
        with_body(HEADER, &[&zeros, &[3], &[0; 12], &[3], &[0; 4], &index, &[0; 4]])
    };
    assert_eq!(read(Ply, face(0)).triangles(), [[0, 0, 0], [0, 0, 0]]);
    let place = HEADER.len() + 12 + 13 + 1 + 8;
    assert_eq!(
        refusal(Ply, face(-2)),
        format!("byte {place}: face 1 of 2: index -2, but there are 1 vertices")
    );
    assert_eq!(
        refusal(Ply, face(1)),
        format!("byte {place}: face 1 of 2: index 1, but there are 1 vertices")
    );
    let text = STRIPS.replace("0 1 2 3 -1", "0 1 5 3 -1");
    assert_eq!(refusal(Ply, text), "line 15: tristrips 0 of 1: index 5, but there are 5 vertices");
}

#[test]
fn promises_beyond_the_end_of_the_file_are_refused() {
    let huge = HEADER.replace("vertex 1", "vertex 4000000000");
    assert_eq!(
        refusal(Ply, with_body(&huge, &[&[0; 30]])),
        format!(
            "byte {}: 4000000000 rows of element 'vertex' are promised, which take at least 48000000000 \
             bytes, but 30 are left",
            huge.len()
        )
    );
    let huge = HEADER.replace("face 2", "face 18446744073709551615");
    assert!(refusal(Ply, with_body(&huge, &[&[0; 30]])).contains("but 18 are left"));
    let beyond = HEADER.replace("vertex 1", "vertex 5000000000");
    assert!(refusal(Ply, beyond).contains("5000000000 vertices are more than decimesh can hold"));
    let list = HEADER.replace("list uchar", "list uint");
    let body = with_body(&list, &[&[0; 12], &(1u32 << 31).to_le_bytes(), &[0; 30]]);
    let refused = refusal(Ply, body);
    assert!(refused.contains("face 0 of 2: 2147483648 values of a list are promised"), "{refused}");
    let list = HEADER.replace("list uchar", "list int");
    let refused = refusal(Ply, with_body(&list, &[&[0; 12], &[0xff; 4], &[0; 30]]));
    assert!(refused.contains("face 0 of 2: a list of -1 values"), "{refused}");
}

#[test]
fn broken_headers_and_rows_are_named_by_line() {
    for (from, to, refused) in [
        ("ply", "plx", "byte 0: a PLY file starts with a line 'ply', and this one does not"),
        ("format ascii", "format morse", "line 2: 'morse' is no PLY format"),
        ("format ascii 1.0\n", "", "line 8: the header ends without a 'format' line"),
        ("property float y", "property floaty y", "line 5: 'floaty' is no PLY type"),
        ("property float y\n", "", "byte 141: the vertices have no property 'y'"),
        ("element vertex 5", "element vertex five", "line 3: 'five' is not a number that can stand here"),
        ("element vertex 5", "element vertex -5", "line 3: '-5' is not a number that can stand here"),
        ("list int int", "list float int", "line 8: the length of a list is no integer type"),
        ("end_header", "end_headers", "line 9: 'end_headers' does not belong into a PLY header"),
        ("1 0 0", "1 0", "line 11: vertex 1 of 5: the line has fewer values than the header declares"),
        ("1 0 0", "1 0 0 7", "line 11: vertex 1 of 5: '7' is more than the header declares"),
        ("1 0 0", "1 \u{e9} 0", "line 11: vertex 1 of 5: '\u{e9}' is not a number that can stand here"),
        ("1 0 0", "1 inf 0", "position of vertex 1 is not finite"),
        ("1 0 0", "1 0 nan", "position of vertex 1 is not finite"),
        (
            "list int int vertex_indices",
            "list int float vertex_indices",
            "line 14: element 'tristrips' has no list of integers named 'vertex_indices' or 'vertex_index'",
        ),
    ] {
        assert!(STRIPS.contains(from));
        let file = STRIPS.replacen(from, to, 1);
        let found = refusal(Ply, &file);
        if refused.starts_with("byte 141") {
            assert!(found.ends_with("the vertices have no property 'y'"), "{found}");
        } else {
            assert_eq!(found, refused, "{from} -> {to}");
        }
    }
}
