//! All levels in one GLB.

use decimesh::lod::NestedLevels;
use decimesh::mesh::shapes;
use decimesh::{Mesh, Monitor, Options, Target, io};
use serde_json::{Value, json};

use crate::meshes::attributed;

fn written(mesh: &Mesh, ratios: &[f64]) -> (NestedLevels, Vec<u8>, Mesh) {
    let targets: Vec<Target> = ratios.iter().map(|&ratio| Target::Ratio(ratio)).collect();
    let options = Options::new(Target::Ratio(1.0));
    let levels = NestedLevels::build(mesh, &targets, &options, &mut Monitor::silent()).unwrap();
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("levels.glb");
    levels.write_glb(&path).unwrap();
    (levels, std::fs::read(&path).unwrap(), io::read(&path).unwrap())
}

#[test]
fn every_level_is_a_node_on_the_same_vertices() {
    let (levels, bytes, shown) = written(&attributed(shapes::sphere(12), 1), &[0.5, 0.1]);
    // The scene shows the finest level, attributes and all.
    assert_eq!(shown.triangles(), levels.triangles(0));
    assert_eq!(shown.positions(), levels.mesh().positions());
    assert_eq!(shown.attributes().colors, levels.mesh().attributes().colors);

    let gltf::Gltf { document, blob } = gltf::Gltf::from_slice(&bytes).unwrap();
    let blob = blob.unwrap();
    assert_eq!(document.meshes().len(), 3);
    let mut views = Vec::new();
    for (mesh, (number, level)) in document.meshes().zip(levels.levels().iter().enumerate()) {
        let primitive = mesh.primitives().next().unwrap();
        for (_, accessor) in primitive.attributes() {
            assert_eq!(accessor.count(), level.vertices);
            assert!(accessor.view().unwrap().stride().is_some(), "a shared view needs a stride");
        }
        let reader = primitive.reader(|_| Some(&blob));
        let positions: Vec<_> = reader.read_positions().unwrap().collect();
        assert_eq!(positions, levels.mesh().positions()[..level.vertices]);
        let indices: Vec<u32> = reader.read_indices().unwrap().into_u32().collect();
        assert_eq!(indices, levels.triangles(number).as_flattened());
        let view = |(_, accessor): (_, gltf::Accessor)| accessor.view().unwrap().index();
        views.push(primitive.attributes().map(view).collect::<Vec<_>>());
        let bounds = primitive.bounding_box();
        for axis in 0..3 {
            let least = positions.iter().map(|position| position[axis]).fold(f32::INFINITY, f32::min);
            assert_eq!(bounds.min[axis], least);
        }
    }
    assert!(views.iter().all(|level| *level == views[0]), "levels do not share their vertices");

    let json: Value = serde_json::from_slice(&gltf::Glb::from_slice(&bytes).unwrap().json).unwrap();
    assert_eq!(json["extensionsUsed"], json!(["MSFT_lod"]));
    assert_eq!(json["nodes"][0]["extensions"]["MSFT_lod"]["ids"], json!([1, 2]));
    assert_eq!(json["scenes"][0]["nodes"], json!([0]));
    for (node, level) in json["nodes"].as_array().unwrap().iter().zip(levels.levels()) {
        assert_eq!(node["extras"]["error"].as_f64().unwrap() as f32, level.error);
    }
}

#[test]
fn levels_of_nothing_are_left_out() {
    let (_, bytes, shown) = written(&Mesh::default(), &[0.5]);
    assert!(shown.triangles().is_empty());
    assert!(gltf::Gltf::from_slice(&bytes).is_ok());
    // A level alone is an ordinary document.
    let (_, bytes, shown) = written(&shapes::cube(2), &[]);
    assert_eq!(shown.triangles().len(), 48);
    let json: Value = serde_json::from_slice(&gltf::Glb::from_slice(&bytes).unwrap().json).unwrap();
    assert!(json.get("extensionsUsed").is_none());
}
