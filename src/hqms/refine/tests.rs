//! Oracles for what a refinement is made of.

use super::facet::Facet;
use super::fit::Shape;
use super::flips::flips;
use super::neighbours::opposites;
use super::samples::{samples, sort};
use super::{fixed, total};
use crate::collapse::surface::{NONE, Setting, Surface, Track};
use crate::mesh::{Mesh, shapes};
use crate::workers::Workers;
use glam::Vec3A;
use proptest::prelude::*;

fn vector() -> impl Strategy<Value = Vec3A> {
    [-2.0f32..2.0, -2.0f32..2.0, -2.0f32..2.0].prop_map(Vec3A::from_array)
}

/// A mesh as a surface of which nothing has been collapsed.
fn surface(mesh: &Mesh) -> Surface {
    let setting = Setting { track: Track { origins: true, ..Track::default() }, ..Setting::default() };
    let mut surface = Surface::new(std::borrow::Cow::Borrowed(mesh), &setting, &Workers::Caller);
    surface.find_rings();
    surface.classify(false, &Workers::Caller);
    surface
}

/// The mesh with its vertices moved a little, each in a direction of its own.
fn jittered(mesh: &Mesh, by: f32) -> Mesh {
    let positions = mesh.positions().iter().enumerate().map(|(vertex, position)| {
        std::array::from_fn(|axis| position[axis] + by * ((7 * vertex + 3 * axis) as f32).sin())
    });
    Mesh::new(positions.collect(), mesh.triangles().to_vec()).unwrap()
}

proptest! {
    #[test]
    fn the_nearest_point_of_a_triangle(corners in [vector(), vector(), vector()], point in vector()) {
        let [a, b, c] = corners;
        prop_assume!((b - a).cross(c - a).length() > 0.05);
        let facet = Facet::new(corners).unwrap();
        let foot = facet.nearest(point, facet.weights(point));
        prop_assert!(foot.weights.iter().all(|&weight| weight >= 0.0));
        prop_assert!((foot.weights.iter().sum::<f32>() - 1.0).abs() < 1e-3);
        let [x, y, z] = foot.weights;
        let distance = (x * a + y * b + z * c).distance(point);
        prop_assert!((distance - foot.distance_squared.sqrt()).abs() < 2e-3);
        prop_assert!((foot.height - facet.normal.dot(point - a)).abs() < 1e-4);
        const STEPS: u16 = 24;
        for i in 0..=STEPS {
            for j in 0..=STEPS - i {
                let [s, t] = [i, j].map(|k| f32::from(k) / f32::from(STEPS));
                let other = a + s * (b - a) + t * (c - a);
                prop_assert!(other.distance(point) > distance - 2e-3);
            }
        }
    }

    /// A wall that leans over a floor, as far as is thought of.
    #[test]
    fn what_is_not_doubtful_is_nearest_in_a_valley(
        height in 0.01f32..1.0, along in 0.0f32..0.7, slope in 0.0f32..2.2,
    ) {
        let floor = Facet::new([Vec3A::ZERO, Vec3A::X, Vec3A::Y]).unwrap();
        let (sine, cosine) = slope.sin_cos();
        let wall = Facet::new([Vec3A::ZERO, Vec3A::X, Vec3A::new(0.0, -cosine, sine)]).unwrap();
        let point = Vec3A::new(0.25, along, height);
        let [on_floor, on_wall] = [floor, wall].map(|facet| facet.nearest(point, facet.weights(point)));
        if on_wall.distance_squared < on_floor.distance_squared - 1e-5 {
            // The side between them is opposite to the third corner.
            prop_assert!(floor.doubtful(point, floor.weights(point))[2]);
        }
    }
}

#[test]
fn neighbours_are_mutual() {
    let mut mesh = shapes::torus(9, 7);
    for closed in [true, false] {
        let surface = surface(&mesh);
        let across = opposites(&surface, &Workers::Caller);
        let mut open = 0;
        for (face, corners) in (0u32..).zip(&across) {
            for (corner, &opposite) in (0u32..).zip(corners) {
                if opposite == NONE {
                    open += 1;
                    continue;
                }
                assert_eq!(across[(opposite >> 2) as usize][(opposite & 3) as usize], face << 2 | corner);
                let (here, there) = (surface.corners(face), surface.corners(opposite >> 2));
                let (k, l) = (corner as usize, (opposite & 3) as usize);
                assert_eq!((here[(k + 1) % 3], here[(k + 2) % 3]), (there[(l + 2) % 3], there[(l + 1) % 3]));
            }
        }
        assert_eq!(open, if closed { 0 } else { 3 });
        let fixed = fixed(&surface, &across);
        assert_eq!(fixed.iter().filter(|&&fixed| fixed).count(), open);
        let triangles = mesh.triangles()[1..].to_vec();
        mesh = Mesh::new(mesh.positions().to_vec(), triangles).unwrap();
    }
}

#[test]
fn samples_are_at_the_nearest_of_all_faces() {
    let input = shapes::sphere(12);
    let mut surface = surface(&input);
    let other = self::surface(&jittered(&input, 0.01));
    surface.points.copy_from_slice(&other.points);
    let across = opposites(&surface, &Workers::Caller);
    let shape = Shape { surface: &surface, opposites: &across };
    let mut samples = samples(shape, &input, &Workers::Caller);
    assert_eq!(samples.len(), 3 * input.triangles().len());
    let sums = shape.fit(&mut samples, &Workers::Caller);
    let mut error = 0.0;
    for sample in &samples {
        let distances = (0..surface.faces.len() as u32).map(|face| {
            let facet = shape.facet(face).unwrap();
            facet.nearest(sample.point(), facet.weights(sample.point())).distance_squared
        });
        let least = distances.fold(f32::INFINITY, f32::min);
        let facet = shape.facet(sample.face).unwrap();
        let found = facet.nearest(sample.point(), facet.weights(sample.point())).distance_squared;
        assert!(found <= least + 1e-6, "{found} {least}");
        error += f64::from(sample.weight * found);
    }
    assert!((total(&sums) / error - 1.0).abs() < 1e-4);
}

#[test]
fn sorted_samples_keep_their_order() {
    let input = shapes::sphere(6);
    let surface = surface(&input);
    let across = opposites(&surface, &Workers::Caller);
    let mut samples = samples(Shape { surface: &surface, opposites: &across }, &input, &Workers::Caller);
    samples.reverse();
    let mut expected = samples.clone();
    expected.sort_by_key(|sample| sample.face);
    let starts = sort(&mut samples, surface.faces.len());
    let points = |samples: &[super::samples::Sample]| -> Vec<_> {
        samples.iter().map(|sample| (sample.face, sample.point())).collect()
    };
    assert_eq!(points(&samples), points(&expected));
    for (face, range) in starts.windows(2).enumerate() {
        let of_face = &samples[range[0] as usize..range[1] as usize];
        assert!(of_face.iter().all(|sample| sample.face as usize == face));
    }
    assert_eq!(starts.last().map(|&end| end as usize), Some(samples.len()));
}

#[test]
fn an_edge_across_a_ridge_is_turned() {
    // Of the two roofs one is folded along diagonals of its quads.
    let roofs = [|x: f32, y: f32| -0.3 * (x - y).abs(), |x: f32, y: f32| -0.3 * (x + y - 1.0).abs()];
    let turned = roofs.into_iter().filter(|height| {
        let roof = shapes::height_field(10, height).unwrap();
        let mut surface = surface(&roof);
        let found = |surface: &Surface| {
            let across = opposites(surface, &Workers::Caller);
            let shape = Shape { surface, opposites: &across };
            let mut samples = samples(shape, &roof, &Workers::Caller);
            let starts = sort(&mut samples, surface.faces.len());
            let sums = shape.fit(&mut samples, &Workers::Caller);
            let fixed = fixed(surface, &across);
            (flips(shape, &samples, &starts, &sums, &fixed, &Workers::Caller), total(&sums))
        };
        // The surface is the input.
        assert!(found(&surface).0.is_empty());
        let across = opposites(&surface, &Workers::Caller);
        let is_on_fold = |vertex: u32| {
            let [x, y, z] = roof.positions()[vertex as usize];
            z.abs() < 1e-6 && (0.15..0.85).contains(&x) && (0.15..0.85).contains(&y)
        };
        let inner = (0..3 * surface.faces.len()).map(|index| (index as u32 / 3, index % 3)).find(
            |&(face, corner)| {
                let own = surface.corners(face);
                is_on_fold(own[(corner + 1) % 3]) && is_on_fold(own[(corner + 2) % 3])
            },
        );
        let Some((face, corner)) = inner else { return false };
        let opposite = across[face as usize][corner];
        let own = surface.corners(face);
        let [top, from, to] = [own[corner], own[(corner + 1) % 3], own[(corner + 2) % 3]];
        let bottom = surface.vertex(opposite);
        surface.set_corners(face, [top, from, bottom]);
        surface.set_corners(opposite >> 2, [bottom, to, top]);
        surface.find_rings();
        let (flips, before) = found(&surface);
        let [flip] = &flips[..] else { panic!("{flips:?}") };
        let mut faces = flip.faces;
        faces.sort_unstable();
        assert_eq!(faces, [face.min(opposite >> 2), face.max(opposite >> 2)]);
        for side in 0..2 {
            surface.set_corners(flip.faces[side], flip.triangles[side]);
        }
        surface.find_rings();
        let (_, after) = found(&surface);
        assert!(after < 1e-3 * before, "{before} became {after}");
        true
    });
    assert_eq!(turned.count(), 1);
}
