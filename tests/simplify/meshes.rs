//! Meshes to simplify, and changes to them whose effect on the result is known.

use decimesh::mesh::shapes;
use decimesh::{Attributes, Mesh};
use proptest::prelude::*;

/// A number that looks random and is the same for the same arguments (SplitMix64).
pub(crate) fn noise(seed: u64, index: usize) -> u64 {
    let mut x = seed.wrapping_add((index as u64 + 1).wrapping_mul(0x9E37_79B9_7F4A_7C15));
    x = (x ^ x >> 30).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    x = (x ^ x >> 27).wrapping_mul(0x94D0_49BB_1331_11EB);
    x ^ x >> 31
}

/// [`noise`] between -1 and 1.
pub(crate) fn signed_noise(seed: u64, index: usize) -> f32 {
    (noise(seed, index) >> 40) as f32 / (1 << 23) as f32 - 1.0
}

/// 0 to `count`, shuffled.
pub(crate) fn permutation(count: usize, seed: u64) -> Vec<u32> {
    let mut order: Vec<u32> = (0..count as u32).collect();
    order.sort_by_key(|&index| noise(seed, index as usize));
    order
}

/// The same surface with vertices, faces and the first corners of faces in another order.
pub(crate) fn shuffled(mesh: &Mesh, seed: u64) -> Mesh {
    let place = permutation(mesh.positions().len(), seed);
    let mut positions = vec![[0.0; 3]; place.len()];
    for (vertex, &place) in place.iter().enumerate() {
        positions[place as usize] = mesh.positions()[vertex];
    }
    let faces = permutation(mesh.triangles().len(), seed ^ 1);
    let triangles = faces.iter().map(|&face| {
        let mut triangle = mesh.triangles()[face as usize].map(|vertex| place[vertex as usize]);
        triangle.rotate_left((noise(seed, face as usize) % 3) as usize);
        triangle
    });
    Mesh::new(positions, triangles.collect()).unwrap()
}

/// The mesh with each position changed.
pub(crate) fn moved(mesh: &Mesh, change: impl Fn([f32; 3]) -> [f32; 3]) -> Mesh {
    Mesh::new(mesh.positions().iter().map(|&x| change(x)).collect(), mesh.triangles().to_vec()).unwrap()
}

/// Several meshes in one.
pub(crate) fn joined(meshes: &[Mesh]) -> Mesh {
    let mut positions = Vec::new();
    let mut triangles = Vec::new();
    for mesh in meshes {
        let first = positions.len() as u32;
        positions.extend(mesh.positions());
        triangles.extend(mesh.triangles().iter().map(|triangle| triangle.map(|vertex| vertex + first)));
    }
    Mesh::new(positions, triangles).unwrap()
}

/// The mesh with attributes that differ from vertex to vertex, but keep to a part of their range.
pub(crate) fn attributed(mesh: Mesh, seed: u64) -> Mesh {
    let (positions, triangles, _) = mesh.into_parts();
    let vertices = 0..positions.len();
    let normal = |vertex: usize| {
        let direction = [3 * vertex, 3 * vertex + 1, 3 * vertex + 2].map(|index| signed_noise(seed, index));
        let length = direction.iter().map(|x| x * x).sum::<f32>().sqrt();
        if length > 0.01 { direction.map(|x| x / length) } else { [0.0, 0.0, 1.0] }
    };
    let color = |vertex| {
        let bits = noise(seed ^ 2, vertex).to_le_bytes();
        [bits[0] / 2, 255 - bits[1] / 4, bits[2] / 3 + 90, 255]
    };
    let uv = |vertex| [signed_noise(seed ^ 3, vertex), 2.0 + signed_noise(seed ^ 4, vertex)];
    let attributes = Attributes {
        normals: Some(vertices.clone().map(normal).collect()),
        colors: Some(vertices.clone().map(color).collect()),
        uvs: Some(vertices.map(uv).collect()),
    };
    Mesh::with_attributes(positions, triangles, attributes).unwrap()
}

/// Vertices on a small grid of integers and triangles on any of them: vertices that coincide,
/// triangles that are degenerate, flat or there twice, edges with many faces, faces inside out,
/// vertices that nothing uses, all of it at once.
pub(crate) fn dirty_mesh() -> impl Strategy<Value = Mesh> {
    let coordinate = (0i8..4).prop_map(f32::from);
    let positions = prop::collection::vec([coordinate.clone(), coordinate.clone(), coordinate], 1..24);
    positions.prop_flat_map(|positions| {
        let index = 0..positions.len() as u32;
        let triangles = prop::collection::vec([index.clone(), index.clone(), index], 0..60);
        triangles.prop_map(move |triangles| Mesh::new(positions.clone(), triangles).unwrap())
    })
}

/// Spheres, tori, cubes and planes of up to some hundred triangles with their vertices jittered,
/// some of their faces removed (which opens holes and leaves non-manifold vertices and loose
/// pieces), in any order.
pub(crate) fn torn_mesh() -> impl Strategy<Value = Mesh> {
    let shape = prop_oneof![
        (1usize..7).prop_map(shapes::sphere),
        (3usize..12, 3usize..9).prop_map(|(n, m)| shapes::torus(n, m)),
        (1usize..6).prop_map(shapes::cube),
        (1usize..12).prop_map(shapes::plane),
        (1usize..5)
            .prop_map(|n| joined(&[shapes::sphere(n), moved(&shapes::cube(n), |x| x.map(|x| x + 2.0))])),
    ];
    let jitter = prop_oneof![Just(0.0f32), 0.0f32..0.15];
    let torn = prop_oneof![2 => Just(0u64), 1 => 0u64..40];
    (shape, jitter, torn, any::<bool>(), any::<u64>()).prop_map(|(mesh, jitter, torn, shuffle, seed)| {
        let positions = mesh.positions().iter().enumerate().map(|(vertex, position)| {
            std::array::from_fn(|axis| position[axis] + jitter * signed_noise(seed, 3 * vertex + axis))
        });
        let kept = |&(face, _): &(usize, &[u32; 3])| noise(seed ^ 1, face) % 100 >= torn;
        let triangles = mesh.triangles().iter().enumerate().filter(kept).map(|(_, triangle)| *triangle);
        let mesh = Mesh::new(positions.collect(), triangles.collect()).unwrap();
        if shuffle { shuffled(&mesh, seed) } else { mesh }
    })
}

/// A flat disc of `blades` triangles around one vertex.
pub(crate) fn fan(blades: usize) -> Mesh {
    let rim = (0..blades).map(|blade| {
        let angle = std::f64::consts::TAU * blade as f64 / blades as f64;
        [angle.cos() as f32, angle.sin() as f32, 0.0]
    });
    let positions = std::iter::once([0.0; 3]).chain(rim).collect();
    let triangles = (0..blades).map(|blade| [0, blade as u32 + 1, ((blade + 1) % blades) as u32 + 1]);
    Mesh::new(positions, triangles.collect()).unwrap()
}

/// A tetrahedron of this size with a corner here.
pub(crate) fn tetrahedron([x, y, z]: [f32; 3], size: f32) -> Mesh {
    let positions = vec![[x, y, z], [x + size, y, z], [x, y + size, z], [x, y, z + size]];
    Mesh::new(positions, vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]).unwrap()
}
