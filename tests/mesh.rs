//! The ground floor against brute force: small random meshes on a coarse grid, where everything that
//! can coincide does.

use std::collections::{BTreeMap, BTreeSet};

use decimesh::mesh::topology::visit_edges;
use decimesh::mesh::{Components, Rings, Weld, WeldError, Welded, shapes};
use decimesh::{Attributes, Mesh, MeshError};
use proptest::prelude::*;

/// Up to a dozen vertices on a grid of 27 points, some of them at negative zero, and up to two dozen
/// triangles on any of them.
fn dirty_mesh() -> impl Strategy<Value = Mesh> {
    let coordinate = prop_oneof![Just(0.0f32), Just(-0.0), Just(1.0), Just(2.0)];
    let positions = prop::collection::vec([coordinate.clone(), coordinate.clone(), coordinate], 1..12);
    positions.prop_flat_map(|positions| {
        let index = 0..positions.len() as u32;
        let triangles = prop::collection::vec([index.clone(), index.clone(), index], 0..24);
        triangles.prop_map(move |triangles| Mesh::new(positions.clone(), triangles).unwrap())
    })
}

fn is_face(&[a, b, c]: &[u32; 3]) -> bool {
    a != b && b != c && c != a
}

/// The triangles with three different vertices, and where they are in the list.
fn faces(mesh: &Mesh) -> Vec<(usize, [u32; 3])> {
    mesh.triangles().iter().copied().enumerate().filter(|(_, triangle)| is_face(triangle)).collect()
}

/// By the ends of each edge its faces, and whether they run from the lower end to the higher.
fn edges(mesh: &Mesh) -> BTreeMap<[u32; 2], Vec<(usize, bool)>> {
    let mut edges = BTreeMap::new();
    for (face, triangle) in faces(mesh) {
        for place in 0..3 {
            let (from, to) = (triangle[place], triangle[(place + 1) % 3]);
            let sides: &mut Vec<_> = edges.entry([from.min(to), from.max(to)]).or_default();
            sides.push((face, from < to));
        }
    }
    edges
}

/// The classes into which `related` divides `items`, by flood fill.
fn classes<T: Copy>(items: &[T], related: impl Fn(T, T) -> bool) -> Vec<Vec<T>> {
    let mut left = items.to_vec();
    let mut classes = Vec::new();
    while !left.is_empty() {
        let mut class = vec![left.remove(0)];
        let mut next = 0;
        while next < class.len() {
            let (joined, apart): (Vec<T>, _) = left.into_iter().partition(|&item| related(class[next], item));
            left = apart;
            class.extend(joined);
            next += 1;
        }
        classes.push(class);
    }
    classes
}

fn shared(a: [u32; 3], b: [u32; 3]) -> usize {
    a.iter().filter(|vertex| b.contains(vertex)).count()
}

/// The fans of faces at a vertex.
fn fans(mesh: &Mesh, vertex: u32) -> Vec<Vec<(usize, [u32; 3])>> {
    let around: Vec<_> = faces(mesh).into_iter().filter(|(_, triangle)| triangle.contains(&vertex)).collect();
    classes(&around, |a, b| shared(a.1, b.1) >= 2)
}

fn count_loops(mesh: &Mesh) -> usize {
    let border = edges(mesh).into_iter().filter(|(_, sides)| sides.len() == 1);
    let border: Vec<_> = border.map(|(ends, _)| ends).collect();
    classes(&border, |a, b| a.iter().any(|vertex| b.contains(vertex))).len()
}

fn doubled_area_squared(mesh: &Mesh, triangle: [u32; 3]) -> i64 {
    let [a, b, c] = triangle.map(|vertex| mesh.positions()[vertex as usize].map(|x| x as i64));
    let [u, v] = [b, c].map(|p| [p[0] - a[0], p[1] - a[1], p[2] - a[2]]);
    let cross = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
    cross.iter().map(|x| x * x).sum()
}

proptest! {
    #[test]
    fn rings_hold_every_corner_once_in_order(mesh in dirty_mesh()) {
        let rings = Rings::new(&mesh);
        prop_assert_eq!(rings.vertices(), mesh.positions().len());
        let mut corners = 0;
        for vertex in 0..rings.vertices() {
            let ring = rings.corners(vertex);
            prop_assert!(ring.is_sorted_by(|a, b| a < b));
            for corner in ring {
                prop_assert_eq!(mesh.triangles()[corner.face()][corner.place()] as usize, vertex);
                prop_assert_eq!(corner.packed(), (corner.face() << 2 | corner.place()) as u32);
                prop_assert_eq!(corner.next().place(), (corner.place() + 1) % 3);
                prop_assert_eq!(corner.next().next().next(), *corner);
                prop_assert_eq!(corner.next().previous(), *corner);
                prop_assert_eq!(corner.next().face(), corner.face());
            }
            prop_assert!(rings.faces_around(vertex).eq(ring.iter().map(|corner| corner.face())));
            corners += ring.len();
        }
        prop_assert_eq!(corners, 3 * mesh.triangles().len());
    }

    #[test]
    fn edges_are_those_of_brute_force(mesh in dirty_mesh()) {
        let mut visited = Vec::new();
        visit_edges(&mesh, &Rings::new(&mesh), |edge| {
            let sides: Vec<_> = edge.sides.iter().map(|side| (side.face, side.ascending)).collect();
            visited.push((edge.vertices, sides));
        });
        let expected: Vec<_> = edges(&mesh).into_iter().collect();
        prop_assert_eq!(visited, expected);
    }

    #[test]
    fn topology_is_that_of_brute_force(mesh in dirty_mesh()) {
        let topology = mesh.topology();
        let (faces, edges) = (faces(&mesh), edges(&mesh));
        let used: BTreeSet<u32> = faces.iter().flat_map(|(_, triangle)| *triangle).collect();
        prop_assert_eq!(topology.vertices, used.len());
        prop_assert_eq!(topology.edges, edges.len());
        prop_assert_eq!(topology.faces, faces.len());
        let with = |is_counted: fn(usize) -> bool| edges.values().filter(|s| is_counted(s.len())).count();
        prop_assert_eq!(topology.border_edges, with(|sides| sides == 1));
        prop_assert_eq!(topology.non_manifold_edges, with(|sides| sides > 2));
        let inconsistent = edges.values().filter(|sides| sides.len() == 2 && sides[0].1 == sides[1].1);
        prop_assert_eq!(topology.inconsistent_edges, inconsistent.count());
        let pinched = used.iter().filter(|&&vertex| fans(&mesh, vertex).len() > 1);
        prop_assert_eq!(topology.non_manifold_vertices, pinched.count());
        prop_assert_eq!(topology.boundary_loops, count_loops(&mesh));
        let euler = used.len() as i64 - edges.len() as i64 + faces.len() as i64;
        prop_assert_eq!(topology.euler_characteristic(), euler);
    }

    #[test]
    fn components_are_those_of_flood_fill(mesh in dirty_mesh()) {
        let components = Components::new(&mesh);
        let mut labels = vec![Components::NONE; mesh.triangles().len()];
        let pieces = classes(&faces(&mesh), |a, b| shared(a.1, b.1) > 0);
        for (label, piece) in pieces.iter().enumerate() {
            for &(face, _) in piece {
                labels[face] = label as u32;
            }
        }
        prop_assert_eq!(components.count, pieces.len());
        prop_assert_eq!(components.labels, labels);
        prop_assert_eq!(mesh.topology().components, pieces.len());
    }

    #[test]
    fn statistics_are_those_of_brute_force(mesh in dirty_mesh()) {
        let statistics = mesh.statistics();
        let faces = faces(&mesh);
        let mut sets = BTreeSet::new();
        let mut duplicates = 0;
        for &(_, mut triangle) in &faces {
            triangle.sort();
            duplicates += usize::from(!sets.insert(triangle));
        }
        prop_assert_eq!(statistics.flaws.duplicate_triangles, duplicates);
        prop_assert_eq!(statistics.flaws.degenerate_triangles, mesh.triangles().len() - faces.len());
        let squares: Vec<_> = faces.iter().map(|&(_, face)| doubled_area_squared(&mesh, face)).collect();
        let flat = squares.iter().filter(|&&square| square == 0).count();
        prop_assert_eq!(statistics.flaws.zero_area_triangles, flat);
        let area: f64 = squares.iter().map(|&square| (square as f64).sqrt() / 2.0).sum();
        prop_assert!((statistics.surface_area - area).abs() <= 1e-12 * area);
        let used: BTreeSet<u32> = mesh.triangles().as_flattened().iter().copied().collect();
        prop_assert_eq!(statistics.unreferenced_vertices, mesh.positions().len() - used.len());
        let places = mesh.positions().iter().map(|position| position.map(|x| x as i32));
        let places: BTreeSet<_> = places.collect();
        prop_assert_eq!(statistics.duplicate_positions, mesh.positions().len() - places.len());
        let bounds = (!used.is_empty()).then(|| {
            let corners = used.iter().map(|&vertex| mesh.positions()[vertex as usize]);
            let along = |axis: usize| corners.clone().map(move |corner| corner[axis]);
            let low = [0, 1, 2].map(|axis| along(axis).fold(f32::INFINITY, f32::min));
            let high = [0, 1, 2].map(|axis| along(axis).fold(f32::NEG_INFINITY, f32::max));
            (low, high)
        });
        prop_assert_eq!(statistics.bounds, bounds);
    }

    #[test]
    fn exact_welding_is_that_of_brute_force(mesh in dirty_mesh()) {
        let welded = mesh.weld(Weld::Exact).unwrap();
        check_weld(&mesh, &welded, |a, b| a == b)?;
        prop_assert_eq!(&mesh.weld(Weld::Tolerance(0.0)).unwrap(), &welded);
        prop_assert_eq!(&mesh.weld(Weld::Tolerance(-0.0)).unwrap(), &welded);
        prop_assert_eq!(welded.mesh.statistics().duplicate_positions, 0);
        prop_assert_eq!(&welded.mesh.weld(Weld::Exact).unwrap().mesh, &welded.mesh);
        check_tolerance(mesh.positions(), 0.5)?;
    }

    #[test]
    fn welding_within_a_tolerance_is_that_of_brute_force(
        places in prop::collection::vec([-8i32..8, -8..8, -8..8], 1..40),
        step in -30..30i32,
        tolerance in 0.0f32..6.0,
    ) {
        // Multiples of a power of two: distances land on the tolerance exactly, cell borders as well.
        let scale = 2f32.powi(step);
        let positions: Vec<_> = places.iter().map(|place| place.map(|x| x as f32 * scale)).collect();
        for tolerance in [tolerance, tolerance.round(), (tolerance / 2.0).round() * 0.5] {
            check_tolerance(&positions, tolerance * scale)?;
        }
    }

    #[test]
    fn a_tolerance_of_another_magnitude_than_the_mesh_is_harmless(
        bits in prop::collection::vec([any::<u32>(), any::<u32>(), any::<u32>()], 1..30),
        tolerance in any::<u32>(),
    ) {
        let finite = |bits: u32| Some(f32::from_bits(bits)).filter(|x| x.is_finite()).unwrap_or(0.0);
        // Each position twice, and once more a step of f32 away.
        let positions: Vec<_> = bits
            .iter()
            .map(|bits| bits.map(finite))
            .flat_map(|[x, y, z]| [[x, y, z], [x, y, z], [x.next_up().min(f32::MAX), y, z]])
            .collect();
        for tolerance in [finite(tolerance).abs(), f32::from_bits(1), f32::MIN_POSITIVE, 1.0, f32::MAX] {
            check_tolerance(&positions, tolerance)?;
        }
    }

    #[test]
    fn steps_of_f32_far_from_the_origin_weld_by_their_distance(
        steps in prop::collection::vec([0u32..20, 0..20, 0..20], 1..40),
        from in 0.0f32..1e9,
        tolerance in 0.0f32..12.0,
    ) {
        let positions: Vec<_> =
            steps.iter().map(|step| step.map(|x| f32::from_bits(from.to_bits() + x))).collect();
        check_tolerance(&positions, tolerance * (from.next_up() - from))?;
    }
}

/// Welds a chain of triangles over `positions` and compares with the rule as it is written.
fn check_tolerance(positions: &[[f32; 3]], tolerance: f32) -> Result<(), TestCaseError> {
    let count = positions.len() as u32;
    let triangles = (0..count).map(|i| [i, (i + 1) % count, (i + 2) % count]).collect();
    let mesh = Mesh::new(positions.to_vec(), triangles).unwrap();
    let welded = mesh.weld(Weld::Tolerance(tolerance)).unwrap();
    check_weld(&mesh, &welded, |a, b| {
        let squared: f64 = (0..3).map(|axis| (f64::from(a[axis]) - f64::from(b[axis])).powi(2)).sum();
        squared <= f64::from(tolerance) * f64::from(tolerance)
    })?;
    let again = welded.mesh.weld(Weld::Tolerance(tolerance)).unwrap();
    prop_assert_eq!(again.mesh, welded.mesh);
    Ok(())
}

fn check_weld(
    mesh: &Mesh,
    welded: &Welded,
    together: impl Fn([f32; 3], [f32; 3]) -> bool,
) -> Result<(), TestCaseError> {
    let mut kept: Vec<[f32; 3]> = Vec::new();
    let mut map = Vec::new();
    for &position in mesh.positions() {
        let found = kept.iter().position(|&other| together(position, other));
        map.push(found.unwrap_or(kept.len()) as u32);
        if found.is_none() {
            kept.push(position);
        }
    }
    let bits = |positions: &[[f32; 3]]| positions.iter().map(|p| p.map(f32::to_bits)).collect::<Vec<_>>();
    prop_assert_eq!(&welded.map, &map);
    prop_assert_eq!(bits(welded.mesh.positions()), bits(&kept));
    let triangles = mesh.triangles().iter().map(|triangle| triangle.map(|vertex| map[vertex as usize]));
    prop_assert_eq!(welded.mesh.triangles(), triangles.filter(is_face).collect::<Vec<_>>());
    Ok(())
}

#[test]
fn welding_keeps_the_attributes_of_the_first() {
    let attributes = Attributes {
        normals: Some(vec![[0.0, 0.0, 1.0], [0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, -1.0]]),
        colors: Some(vec![[1; 4], [2; 4], [3; 4], [4; 4]]),
        uvs: Some(vec![[0.1; 2], [0.2; 2], [0.3; 2], [0.4; 2]]),
    };
    let positions = vec![[0.0; 3], [1.0, 0.0, 0.0], [-0.0; 3], [0.0, 1.0, 0.0]];
    let mesh = Mesh::with_attributes(positions, vec![[0, 1, 3], [0, 1, 2]], attributes).unwrap();
    let welded = mesh.weld(Weld::Exact).unwrap();
    assert_eq!(welded.map, [0, 1, 0, 2]);
    assert_eq!(welded.mesh.triangles(), [[0, 1, 2]]);
    let kept = welded.mesh.attributes();
    assert_eq!(kept.normals, Some(vec![[0.0, 0.0, 1.0], [0.0, 1.0, 0.0], [0.0, 0.0, -1.0]]));
    assert_eq!(kept.colors, Some(vec![[1; 4], [2; 4], [4; 4]]));
    assert_eq!(kept.uvs, Some(vec![[0.1; 2], [0.2; 2], [0.4; 2]]));
}

#[test]
fn near_vertices_do_not_weld_in_a_chain() {
    let positions = [0.0, 0.9, 1.8, 2.7].map(|x| [x, 0.0, 0.0]).to_vec();
    let welded = Mesh::new(positions, Vec::new()).unwrap().weld(Weld::Tolerance(1.0)).unwrap();
    assert_eq!(welded.map, [0, 0, 1, 1]);
}

#[test]
fn a_tolerance_must_be_finite_and_not_negative() {
    let mesh = shapes::plane(1);
    for tolerance in [-1.0, f32::NEG_INFINITY, f32::INFINITY] {
        assert_eq!(mesh.weld(Weld::Tolerance(tolerance)), Err(WeldError::InvalidTolerance(tolerance)));
    }
    let error = mesh.weld(Weld::Tolerance(f32::NAN)).unwrap_err();
    assert_eq!(error.to_string(), "the weld tolerance must be finite and not negative, not NaN");
}

#[test]
fn crowds_are_welded_in_linear_time() {
    // Quadratic behaviour would be twenty thousand million distances.
    let crowd = (0..200_000).map(|i| [i as f32 * 1e-9, 0.0, 0.0]).collect();
    let welded = Mesh::new(crowd, Vec::new()).unwrap().weld(Weld::Tolerance(1.0)).unwrap();
    assert_eq!(welded.mesh.positions().len(), 1);
}

#[test]
fn a_vertex_of_very_many_faces_is_surveyed_in_linear_time() {
    let rim = 200_000u32;
    let triangles = (0..rim).map(|i| [0, 1 + i, 1 + (i + 1) % rim]).collect();
    let topology = Mesh::new(vec![[0.0; 3]; rim as usize + 1], triangles).unwrap().topology();
    assert_eq!((topology.border_edges, topology.boundary_loops), (rim as usize, 1));
    assert_eq!((topology.non_manifold_vertices, topology.components), (0, 1));
    assert_eq!(topology.euler_characteristic(), 1);
}

#[test]
fn holes_that_touch_in_a_point_are_one_loop() {
    let holed = |holes: [usize; 2]| {
        let grid = shapes::plane(5);
        let left = grid.triangles().iter().enumerate().filter(|(face, _)| !holes.contains(&(face / 2)));
        Mesh::new(grid.positions().to_vec(), left.map(|(_, &triangle)| triangle).collect()).unwrap()
    };
    // Diagonal neighbours, and cells with another between them: beside the outer border.
    for (holes, loops, pinched) in [([6, 12], 2, 1), ([6, 18], 3, 0)] {
        let topology = holed(holes).topology();
        assert_eq!((topology.boundary_loops, topology.components), (loops, 1));
        assert_eq!(topology.non_manifold_vertices, pinched);
    }
}

#[test]
fn an_empty_mesh_has_empty_numbers() {
    let statistics = Mesh::default().statistics();
    assert_eq!(statistics, Default::default());
    assert!(statistics.topology.is_closed() && statistics.topology.is_oriented_manifold());
    assert_eq!(Mesh::default().weld(Weld::Exact).unwrap().mesh, Mesh::default());
    assert_eq!(Rings::new(&Mesh::default()).vertices(), 0);
}

#[test]
fn the_diagonal_of_the_largest_mesh_is_finite() {
    let (low, high) = ([-f32::MAX; 3], [f32::MAX; 3]);
    let mesh = Mesh::new(vec![[1.0; 3], low, high], vec![[1, 2, 1]]).unwrap();
    assert_eq!(mesh.bounds(), Some((low, high)));
    let expected = 2.0 * 3f64.sqrt() * f64::from(f32::MAX);
    assert!((mesh.diagonal() / expected - 1.0).abs() < 1e-15);
    let distant = Mesh::new(vec![[0.0; 3], [3.0, 0.0, 0.0], [0.0, 4.0, 0.0], [1e9; 3]], vec![[0, 1, 2]]);
    assert_eq!(distant.unwrap().diagonal(), 5.0, "a vertex that no triangle uses does not count");
}

#[test]
fn buffers_that_make_no_mesh_are_told_apart() {
    let positions = vec![[0.0f32; 3]; 12];
    let mut triangles = vec![[0, 1, 2]; 8];
    triangles[5] = [3, 17, 40];
    let error = Mesh::new(positions.clone(), triangles).unwrap_err();
    assert_eq!(error, MeshError::IndexOutOfRange { triangle: 5, index: 17, vertices: 12 });
    assert_eq!(error.to_string(), "triangle 5 has index 17, but there are 12 vertices");

    let error = Mesh::from_buffers(&positions, &[0, 1, 2, 3]).unwrap_err();
    assert_eq!(error, MeshError::IncompleteTriangle { count: 4 });
    assert_eq!(Mesh::from_buffers(&positions, &[0, 1, 2]).unwrap().triangles(), [[0, 1, 2]]);

    let rejected = |attributes| Mesh::with_attributes(positions.clone(), Vec::new(), attributes).unwrap_err();
    for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        let mut broken = positions.clone();
        broken[7][2] = bad;
        let error = Mesh::new(broken, Vec::new()).unwrap_err();
        assert_eq!(error, MeshError::NotFinite { what: "position", vertex: 7 });
        let mut normals = positions.clone();
        normals[3][0] = bad;
        let error = rejected(Attributes { normals: Some(normals), ..Default::default() });
        assert_eq!(error, MeshError::NotFinite { what: "normal", vertex: 3 });
        let mut uvs = vec![[0.0; 2]; 12];
        uvs[11][1] = bad;
        let error = rejected(Attributes { uvs: Some(uvs), ..Default::default() });
        assert_eq!(error, MeshError::NotFinite { what: "uv", vertex: 11 });
    }

    let short = [
        ("normals", Attributes { normals: Some(vec![[0.0; 3]; 11]), ..Default::default() }),
        ("colors", Attributes { colors: Some(vec![[0; 4]; 11]), ..Default::default() }),
        ("uvs", Attributes { uvs: Some(vec![[0.0; 2]; 11]), ..Default::default() }),
    ];
    for (what, attributes) in short {
        let error = rejected(attributes);
        assert_eq!(error, MeshError::AttributeCount { what, count: 11, vertices: 12 });
    }
}
