use std::fs;

use decimesh::io::Format::{Glb, Gltf};
use decimesh::io::read as read_file;

use super::{read, refusal};

/// Four vertices with everything, shown twice: moved under a turned parent, and mirrored. Its
/// primitives are a strip, a triangle of the same vertices, one of points, and one without colours.
pub(super) const SCENE: &str = r#"{
  "asset": {"version": "2.0"},
  "extensionsRequired": ["KHR_materials_unlit"],
  "scene": 1,
  "scenes": [{"nodes": [3]}, {"nodes": [0, 2]}],
  "nodes": [
    {"rotation": [0, 0, 0.70710678, 0.70710678], "translation": [0, 0, 1], "children": [1]},
    {"translation": [10, 0, 0], "mesh": 0},
    {"scale": [-2, 2, 2], "mesh": 0},
    {"mesh": 0}
  ],
  "meshes": [{"primitives": [
    {"attributes": {"POSITION": 0, "NORMAL": 1, "COLOR_0": 2, "TEXCOORD_0": 3}, "indices": 4, "mode": 5},
    {"attributes": {"POSITION": 0, "NORMAL": 1, "COLOR_0": 2, "TEXCOORD_0": 3}, "indices": 5},
    {"attributes": {"POSITION": 0}, "mode": 0},
    {"attributes": {"POSITION": 0, "NORMAL": 1, "_CUSTOM": 9}, "mode": 6}
  ]}],
  "accessors": [
    {"bufferView": 0, "componentType": 5126, "type": "VEC3", "count": 4},
    {"bufferView": 0, "byteOffset": 48, "componentType": 5126, "type": "VEC3", "count": 4},
    {"bufferView": 1, "componentType": 5121, "normalized": true, "type": "VEC3", "count": 4},
    {"bufferView": 2, "componentType": 5123, "normalized": true, "type": "VEC2", "count": 4},
    {"bufferView": 3, "componentType": 5121, "type": "SCALAR", "count": 4},
    {"bufferView": 3, "byteOffset": 4, "componentType": 5123, "type": "SCALAR", "count": 3}
  ],
  "bufferViews": [
    {"buffer": 0, "byteLength": 96},
    {"buffer": 0, "byteOffset": 96, "byteLength": 16, "byteStride": 4},
    {"buffer": 0, "byteOffset": 112, "byteLength": 16},
    {"buffer": 0, "byteOffset": 128, "byteLength": 10}
  ],
  "buffers": [{"byteLength": 140, "uri": "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAACAPwAAgD8AAAAAAAAAAAAAAAAAAIA/AAAAAAAAAAAAAIA/AAAAAAAAAAAAAIA/AAAAAAAAAAAAAIA//wAAAAD/AAAAAP8ACQkJAAAAAAD//wAAAAD///////8AAQIDAAABAAIAAAA="}]
}"#;

/// No scene; one value of three replaced.
pub(super) const SPARSE: &str = r#"{
  "asset": {"version": "2.0"},
  "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
  "accessors": [{
    "bufferView": 0, "componentType": 5126, "type": "VEC3", "count": 3, "sparse": {
      "count": 1,
      "indices": {"bufferView": 1, "byteOffset": 12, "componentType": 5121},
      "values": {"bufferView": 1}
    }
  }],
  "bufferViews": [
    {"buffer": 0, "byteLength": 36},
    {"buffer": 0, "byteOffset": 36, "byteLength": 16}
  ],
  "buffers": [{"byteLength": 52, "uri": "data:;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAACgQAAAwEAAAOBAAQAAAA=="}]
}"#;

#[test]
fn a_scene_is_read_as_it_shows() {
    let mesh = read(Gltf, SCENE);
    // Each time: four vertices for the strip and the triangle, four for the fan.
    let (positions, triangles) = (mesh.positions(), mesh.triangles());
    assert_eq!(triangles[..5], [[0, 1, 2], [2, 1, 3], [0, 1, 2], [4, 5, 6], [4, 6, 7]]);
    let mirrored: Vec<_> = triangles[..5].iter().map(|&[a, b, c]| [a + 8, c + 8, b + 8]).collect();
    assert_eq!(triangles[5..], mirrored, "a mirrored mesh is not inside out");
    for (vertex, expected) in [
        (0, [0.0, 10.0, 1.0]),
        (1, [0.0, 11.0, 1.0]),
        (2, [-1.0, 10.0, 1.0]),
        (9, [-2.0, 0.0, 0.0]),
        (15, [-2.0, 2.0, 0.0]),
    ] {
        let distance = |axis: usize| (positions[vertex][axis] - expected[axis]).abs();
        assert!((0..3).all(|axis| distance(axis) < 1e-6), "{vertex}: {:?}", positions[vertex]);
    }
    let attributes = mesh.attributes();
    assert_eq!(attributes.normals, Some(vec![[0.0, 0.0, 1.0]; 16]));
    let colors = attributes.colors.as_deref().expect("colours");
    assert_eq!(colors[..5], [[255, 0, 0, 255], [0, 255, 0, 255], [0, 0, 255, 255], [9, 9, 9, 255], [255; 4]]);
    assert_eq!(colors[12..], [[255; 4]; 4]);
    let uvs = attributes.uvs.as_deref().expect("texture coordinates");
    assert_eq!(uvs[..5], [[0.0, 1.0], [1.0, 1.0], [0.0, 0.0], [1.0, 0.0], [0.0, 0.0]]);
}

#[test]
fn without_a_scene_every_mesh_is_read_as_it_is() {
    let mesh = read(Gltf, SPARSE);
    assert_eq!(mesh.positions(), [[0.0; 3], [5.0, 6.0, 7.0], [0.0, 1.0, 0.0]]);
    assert_eq!(mesh.triangles(), [[0, 1, 2]]);
    let without_base = SPARSE.replace("\"bufferView\": 0, \"componentType\"", "\"componentType\"");
    assert_eq!(read(Gltf, &without_base).positions(), [[0.0; 3], [5.0, 6.0, 7.0], [0.0; 3]]);
    assert_eq!(
        refusal(Gltf, without_base.replace("\"count\": 3", "\"count\": 4000000000")),
        "a scene of more than 4194304 vertices and corners out of 52 bytes cannot be read"
    );
    let indices = SCENE.replace("{\"bufferView\": 3, \"byteOffset\": 4, ", "{");
    assert_eq!(
        refusal(Gltf, indices.replace("\"SCALAR\", \"count\": 3", "\"SCALAR\", \"count\": 300")),
        "accessors[5]: meshes[0].primitives[1]: 300 elements without a bufferView, in a file too \
         small for as many"
    );
}

#[test]
fn a_mesh_whose_normals_are_not_everywhere_has_none() {
    let text = SCENE.replace("\"NORMAL\": 1, \"_CUSTOM\"", "\"_CUSTOM\"");
    assert_eq!(read(Gltf, text).attributes().normals, None);
}

#[test]
fn what_a_document_says_is_checked_before_it_is_followed() {
    for (from, to, refused) in [
        ("\"scene\": 1", "\"scene\": 7", "scenes[7]: the default scene does not exist"),
        ("[0, 2]", "[0, 9]", "nodes[9]: the document names it, but does not have it"),
        ("[0, 2]", "[0, 1]", "nodes[1]: it has more than one parent: nodes must form trees"),
        (
            "\"mesh\": 0}",
            "\"mesh\": 0, \"children\": [0]}",
            "nodes[0]: it has more than one parent: nodes must form trees",
        ),
        (
            "[10, 0, 0], \"mesh\": 0",
            "[10, 0, 0], \"mesh\": 3",
            "meshes[3]: a node names it, but it does not exist",
        ),
        (
            "\"POSITION\": 0",
            "\"POSITION\": 77",
            "accessors[77]: meshes[0].primitives[0]: the document names it, but does not have it",
        ),
        (
            "\"NORMAL\": 1",
            "\"NORMAL\": 3",
            "accessors[3]: meshes[0].primitives[0]: it is a Vec2, where a Vec3 must be",
        ),
        (
            "\"NORMAL\": 1",
            "\"NORMAL\": 5",
            "accessors[5]: meshes[0].primitives[0]: 3 elements for 4 vertices",
        ),
        (
            "\"indices\": 4",
            "\"indices\": 0",
            "accessors[0]: meshes[0].primitives[0]: indices must be unsigned integers",
        ),
        (
            "\"indices\": 5",
            "\"indices\": 4",
            "indices: meshes[0].primitives[1]: 4 indices do not make whole triangles",
        ),
        (
            "\"byteOffset\": 4, \"componentType\": 5123",
            "\"byteOffset\": 2, \"componentType\": 5123",
            "indices: meshes[0].primitives[1]: index 770 at place 0, but there are 4 vertices",
        ),
        (
            "\"SCALAR\", \"count\": 3",
            "\"SCALAR\", \"count\": 300",
            "accessors[5]: meshes[0].primitives[1]: 300 elements of 2 bytes, 2 apart, from byte 4 on go \
             beyond the 10 bytes of bufferViews[3]",
        ),
        (
            "\"byteLength\": 96",
            "\"byteLength\": 9600",
            "bufferViews[0]: meshes[0].primitives[0]: it goes beyond the end of its buffer",
        ),
        (
            "\"byteOffset\": 96",
            "\"byteOffset\": 18446744073709551600",
            "bufferViews[1]: meshes[0].primitives[0]: it goes beyond the end of its buffer",
        ),
        (
            "\"byteStride\": 4",
            "\"byteStride\": 2",
            "bufferViews[1]: meshes[0].primitives[0]: a byteStride of 2 for elements of 3 bytes",
        ),
        (
            "\"byteLength\": 140",
            "\"byteLength\": 200",
            "buffers[0]: byteLength is 200, but there are 140 bytes",
        ),
        (
            "KHR_materials_unlit",
            "KHR_draco_mesh_compression",
            "a glTF file that requires the extension KHR_draco_mesh_compression cannot be read",
        ),
        ("\"2.0\"", "\"1.0\"", "glTF version '1.0' cannot be read"),
        ("data:application/octet-stream;base64,", "file:///etc/hostname?", ""),
        ("[10, 0, 0]", "[1e39, 0, 0]", ""),
    ] {
        assert!(SCENE.contains(from), "{from}");
        let found = refusal(Gltf, SCENE.replacen(from, to, 1));
        assert!(found == refused || refused.is_empty(), "{from} -> {to}: {found}");
    }
}

/// As a scene may show one mesh any number of times, a few kilobytes can ask for gigabytes; and
/// where nothing comes of it, for hours.
#[test]
fn a_small_file_cannot_ask_for_a_huge_mesh() {
    let repeat = |part: &str| vec![part; 3000].join(",");
    let roots = (0..3000).map(|node| node.to_string()).collect::<Vec<_>>().join(",");
    let nodes = repeat(r#"{"mesh": 0}"#);
    let scene = format!(r#""scenes": [{{"nodes": [{roots}]}}], "nodes": [{nodes}], "meshes""#);
    let text = SPARSE.replace("\"meshes\"", &scene);
    assert_eq!(read(Gltf, &text).triangles().len(), 3000);
    let one = r#"{"attributes": {"POSITION": 0}}"#;
    for many in [
        one,
        r#"{"attributes": {"POSITION": 0}, "mode": 5}"#,
        r#"{"attributes": {"POSITION": 0}, "mode": 0}"#,
    ] {
        let refused = refusal(Gltf, text.replace(one, &repeat(many)));
        assert_eq!(
            refused,
            "a scene of more than 4194304 vertices and corners out of 52 bytes cannot be read"
        );
    }
}

#[test]
fn buffers_beside_the_document_are_found() {
    let directory = tempfile::tempdir().expect("a directory");
    let path = directory.path().join("scene.gltf");
    let start = SCENE.find("data:").expect("a data URI");
    let end = start + SCENE[start..].find('"').expect("its end");
    let document = |uri: &str| format!("{}{uri}{}", &SCENE[..start], &SCENE[end..]);
    let base64 = &SCENE[start + "data:application/octet-stream;base64,".len()..end];
    let bytes = base64::Engine::decode(&base64::engine::general_purpose::STANDARD, base64).expect("base64");

    fs::write(&path, document("a%20buffer.bin")).expect("written");
    let error = read_file(&path).expect_err("no buffer yet").to_string();
    assert!(error.contains("buffers[0]") && error.contains("a buffer.bin"), "{error}");
    fs::write(directory.path().join("a buffer.bin"), &bytes).expect("written");
    assert_eq!(read_file(&path).expect("read"), read(Gltf, SCENE));
    assert!(refusal(Gltf, document("a%20buffer.bin")).contains("of a document that is not a file"));

    fs::write(directory.path().join("a buffer.bin"), &bytes[..100]).expect("written");
    let error = read_file(&path).expect_err("too short").to_string();
    assert!(error.ends_with("buffers[0]: byteLength is 140, but there are 100 bytes"), "{error}");
    for uri in ["/dev/zero", "file:///dev/zero", "https://example.org/a.bin", ".", "%ff.bin"] {
        fs::write(&path, document(uri)).expect("written");
        read_file(&path).expect_err("no buffer to be read");
    }
}

fn glb(version: u32, length: u32, chunks: &[(u32, &[u8; 4], &[u8])]) -> Vec<u8> {
    let mut bytes = [&b"glTF"[..], &version.to_le_bytes(), &length.to_le_bytes()].concat();
    for (length, kind, content) in chunks {
        bytes.extend(length.to_le_bytes());
        bytes.extend(*kind);
        bytes.extend(*content);
    }
    bytes
}

#[test]
fn the_container_is_checked() {
    let json = SPARSE.as_bytes();
    let length = json.len() as u32;
    let chunk = (length, b"JSON", json);
    let whole = glb(2, length + 20 + 12, &[chunk, (4, b"more", b"1234")]);
    assert_eq!(read(Glb, &whole), read(Gltf, SPARSE), "unknown chunks are skipped");
    assert_eq!(read(Gltf, &whole), read(Gltf, SPARSE), "whatever the extension says");
    for (bytes, refused) in [
        (glb(1, length + 20, &[chunk]), "version 1 of GLB cannot be read"),
        (glb(2, 4, &[chunk]), "byte 12: a length of 4 bytes, less than the header takes"),
        (glb(2, u32::MAX, &[chunk]), ""),
        (
            glb(2, length + 20, &[(u32::MAX, b"JSON", json)]),
            "byte 20: a chunk of 4294967295 bytes goes beyond the length in the header",
        ),
        (
            glb(2, length + 20, &[(length, b"BIN\0", json)]),
            "byte 20: the first chunk of a GLB file is not its JSON",
        ),
        (glb(2, 12, &[]), "byte 12: a GLB file without a chunk"),
    ] {
        let found = refusal(Glb, bytes);
        assert!(found == refused || refused.is_empty(), "{found}");
    }
    let refused = refusal(Gltf, SPARSE.replacen("[{", "[{{", 1));
    assert!(refused.starts_with("line 3: the JSON is no glTF document: "), "{refused}");
    let deep = [b'['; 100_000];
    refusal(Gltf, deep);
}
