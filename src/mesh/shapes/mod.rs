//! Meshes made by rule, of any size and with known properties: for tests, benches and demonstrations.
//!
//! All face outwards (open ones up, along z). The same arguments give the same mesh, whatever the
//! threads; [`torus`] and [`statue`] take sines from the platform's mathematics library, in `f64`, so
//! that on another platform a coordinate may differ in its last `f32` digit. Arguments out of range are
//! held to the range stated. All take linear time and no more memory than the mesh.

mod noise;
mod statue;

use std::f64::consts::TAU;

use rayon::prelude::*;

use self::noise::{fractal_noise, ridged_noise};
pub use self::statue::statue;
use super::{Attributes, Mesh, MeshError};

/// The largest number of cells along an edge.
pub const MAX_CELLS: usize = 8192;

/// The unit square in the plane z = 0 in `n` by `n` cells, `1..=MAX_CELLS`: `2n²` triangles,
/// `(n + 1)²` vertices, row by row.
pub fn plane(n: usize) -> Mesh {
    let n = n.clamp(1, MAX_CELLS);
    built(plane_positions(n, |_, _| 0.0), plane_triangles(n))
}

/// The graph of `height` over the unit square: triangles and vertices as in [`plane`].
///
/// An error if a height is infinite or not a number.
pub fn height_field(n: usize, height: impl Fn(f32, f32) -> f32) -> Result<Mesh, MeshError> {
    let n = n.clamp(1, MAX_CELLS);
    Mesh::new(plane_positions(n, height), plane_triangles(n))
}

/// The surface of the unit cube from 0 to 1, each side in `n` by `n` cells, `1..=MAX_CELLS`: `12n²`
/// triangles, `6n² + 2` vertices, closed.
pub fn cube(n: usize) -> Mesh {
    let lattice = Lattice { n: n.clamp(1, MAX_CELLS) };
    let positions = lattice.points().map(|point| point.map(|x| x as f32 / lattice.n as f32)).collect();
    built(positions, lattice.triangles())
}

/// The unit sphere about the origin, a [`cube`] blown up: `12n²` triangles, `6n² + 2` vertices, closed.
pub fn sphere(n: usize) -> Mesh {
    let lattice = Lattice { n: n.clamp(1, MAX_CELLS) };
    let positions = lattice.directions().map(|direction| direction.map(|x| x as f32)).collect();
    built(positions, lattice.triangles())
}

/// A [`sphere`] weathered to a stone by seven octaves of noise: `12n²` triangles (`n` of 76 makes
/// 69 thousand, of 1155 sixteen million), `6n² + 2` vertices, closed, star-shaped about the origin,
/// between 0.5 and 1.5 from it.
pub fn bumpy_sphere(n: usize, seed: u32) -> Mesh {
    let lattice = Lattice { n: n.clamp(1, MAX_CELLS) };
    let mut positions: Vec<[f32; 3]> =
        lattice.directions().map(|direction| direction.map(|x| x as f32)).collect();
    positions.par_iter_mut().for_each(|position| {
        let lumps = 0.3 * fractal_noise(position.map(|x| 1.3 * x), 3, seed);
        let cracks = 0.03 * ridged_noise(position.map(|x| 5.0 * x), 2, seed.wrapping_add(3));
        let grain = 0.006 * fractal_noise(position.map(|x| 40.0 * x), 2, seed.wrapping_add(5));
        let radius = (1.0 + lumps + cracks + grain).clamp(0.5, 1.5);
        *position = position.map(|x| x * radius);
    });
    built(positions, lattice.triangles())
}

/// A torus about the z axis, 1 from it to the middle of the tube, 0.4 thick to either side: `n` cells
/// round the axis, `m` round the tube, `3..=MAX_CELLS` each: `2nm` triangles, `nm` vertices, closed.
pub fn torus(n: usize, m: usize) -> Mesh {
    let (n, m) = (n.clamp(3, MAX_CELLS), m.clamp(3, MAX_CELLS));
    let positions = (0..n).flat_map(|i| {
        let (sin_i, cos_i) = (TAU * i as f64 / n as f64).sin_cos();
        (0..m).map(move |j| {
            let (sin_j, cos_j) = (TAU * j as f64 / m as f64).sin_cos();
            let radius = 1.0 + 0.4 * cos_j;
            [radius * cos_i, radius * sin_i, 0.4 * sin_j].map(|x| x as f32)
        })
    });
    built(positions.collect(), ring_triangles(n, m))
}

/// A mesh from parts that are valid by construction.
fn built(positions: Vec<[f32; 3]>, triangles: Vec<[u32; 3]>) -> Mesh {
    Mesh { positions, triangles, attributes: Attributes::default() }
}

/// The two triangles of a cell with its corners counter-clockwise.
fn split([a, b, c, d]: [usize; 4]) -> [[u32; 3]; 2] {
    [[a as u32, b as u32, c as u32], [a as u32, c as u32, d as u32]]
}

fn plane_positions(n: usize, height: impl Fn(f32, f32) -> f32) -> Vec<[f32; 3]> {
    let mut positions = Vec::with_capacity((n + 1) * (n + 1));
    for j in 0..=n {
        for i in 0..=n {
            let (x, y) = (i as f32 / n as f32, j as f32 / n as f32);
            positions.push([x, y, height(x, y)]);
        }
    }
    positions
}

fn plane_triangles(n: usize) -> Vec<[u32; 3]> {
    let at = |i: usize, j: usize| j * (n + 1) + i;
    let mut triangles = Vec::with_capacity(2 * n * n);
    for j in 0..n {
        for i in 0..n {
            triangles.extend(split([at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]));
        }
    }
    triangles
}

/// The triangles of `n` rings of `m` vertices, joined in a ring.
fn ring_triangles(n: usize, m: usize) -> Vec<[u32; 3]> {
    let at = |i: usize, j: usize| i % n * m + j % m;
    let mut triangles = Vec::with_capacity(2 * n * m);
    for i in 0..n {
        for j in 0..m {
            triangles.extend(split([at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]));
        }
    }
    triangles
}

/// The points on the surface of a cube of `n` cells along each edge, numbered layer by layer: the
/// bottom whole, row by row; of the layers between only the rim, counter-clockwise; the top whole.
#[derive(Debug, Clone, Copy)]
struct Lattice {
    n: usize,
}

impl Lattice {
    fn points(self) -> impl Iterator<Item = [usize; 3]> {
        let n = self.n;
        let whole = move |z| (0..=n).flat_map(move |y| (0..=n).map(move |x| [x, y, z]));
        let rims = (1..n).flat_map(move |z| {
            (0..4 * n).map(move |step| match step / n {
                0 => [step, 0, z],
                1 => [n, step - n, z],
                2 => [3 * n - step, n, z],
                _ => [0, 4 * n - step, z],
            })
        });
        whole(0).chain(rims).chain(whole(n))
    }

    /// The number of a point in [`Lattice::points`].
    fn index(self, [x, y, z]: [usize; 3]) -> usize {
        let n = self.n;
        let whole = (n + 1) * (n + 1);
        if z == 0 {
            return y * (n + 1) + x;
        }
        let below = whole + (z - 1) * 4 * n;
        if z == n {
            below + y * (n + 1) + x
        } else if y == 0 {
            below + x
        } else if x == n {
            below + n + y
        } else if y == n {
            below + 3 * n - x
        } else {
            below + 4 * n - y
        }
    }

    fn triangles(self) -> Vec<[u32; 3]> {
        let n = self.n;
        let mut triangles = Vec::with_capacity(12 * n * n);
        for axis in 0..3 {
            for outside in [0, n] {
                // Seen from outside, the two other axes turn the other way on the lower side.
                let (right, up) = ((axis + 1) % 3, (axis + 2) % 3);
                let (right, up) = if outside == 0 { (up, right) } else { (right, up) };
                let at = |i: usize, j: usize| {
                    let mut point = [outside; 3];
                    point[right] = i;
                    point[up] = j;
                    self.index(point)
                };
                for j in 0..n {
                    for i in 0..n {
                        triangles.extend(split([at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]));
                    }
                }
            }
        }
        triangles
    }

    /// The points moved out to the unit sphere, with cells of much the same size everywhere.
    ///
    /// Nowell's map: it takes square roots only, which are the same on every platform.
    fn directions(self) -> impl Iterator<Item = [f64; 3]> {
        self.points().map(move |point| {
            let [x, y, z] = point.map(|x| 2.0 * x as f64 / self.n as f64 - 1.0);
            let [xx, yy, zz] = [x * x, y * y, z * z];
            [
                x * (1.0 - yy / 2.0 - zz / 2.0 + yy * zz / 3.0).sqrt(),
                y * (1.0 - zz / 2.0 - xx / 2.0 + zz * xx / 3.0).sqrt(),
                z * (1.0 - xx / 2.0 - yy / 2.0 + xx * yy / 3.0).sqrt(),
            ]
        })
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    /// Six times the volume that a closed mesh encloses.
    fn sextuple_volume(mesh: &Mesh) -> f64 {
        let corners = |triangle: &[u32; 3]| triangle.map(|v| mesh.positions()[v as usize].map(f64::from));
        mesh.triangles().iter().map(|triangle| sextuple(corners(triangle))).sum()
    }

    fn sextuple([a, b, c]: [[f64; 3]; 3]) -> f64 {
        a[0] * (b[1] * c[2] - b[2] * c[1])
            + a[1] * (b[2] * c[0] - b[0] * c[2])
            + a[2] * (b[0] * c[1] - b[1] * c[0])
    }

    /// Checks that a mesh is free of flaws, in one piece, with this many triangles, vertices and loops
    /// and this Euler characteristic.
    fn check(mesh: &Mesh, triangles: usize, vertices: usize, loops: usize, euler: i64) {
        let statistics = mesh.statistics();
        assert_eq!((statistics.triangles, statistics.vertices), (triangles, vertices));
        assert_eq!(statistics.flaws, Default::default());
        assert_eq!((statistics.unreferenced_vertices, statistics.duplicate_positions), (0, 0));
        let topology = statistics.topology;
        assert!(topology.is_oriented_manifold());
        assert_eq!((topology.boundary_loops, topology.components), (loops, 1));
        assert_eq!(topology.euler_characteristic(), euler);
        assert_eq!(topology.is_closed(), loops == 0);
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(24))]

        #[test]
        fn shapes_are_sound_and_of_the_size_stated(n in 1usize..20, m in 3usize..20, seed in any::<u32>()) {
            check(&plane(n), 2 * n * n, (n + 1) * (n + 1), 1, 1);
            check(&cube(n), 12 * n * n, 6 * n * n + 2, 0, 2);
            check(&sphere(n), 12 * n * n, 6 * n * n + 2, 0, 2);
            check(&bumpy_sphere(n, seed), 12 * n * n, 6 * n * n + 2, 0, 2);
            check(&torus(n.max(3), m), 2 * n.max(3) * m, n.max(3) * m, 0, 0);
        }

        #[test]
        fn a_stone_is_star_shaped(n in 8usize..40, seed in any::<u32>()) {
            let stone = bumpy_sphere(n, seed);
            for triangle in stone.triangles() {
                let corners = triangle.map(|vertex| stone.positions()[vertex as usize].map(f64::from));
                prop_assert!(sextuple(corners) > 0.0);
            }
            for position in stone.positions() {
                let radius = position.iter().map(|x| x * x).sum::<f32>().sqrt();
                prop_assert!((0.499..1.501).contains(&radius));
            }
        }

        #[test]
        fn a_statue_is_sound_and_of_about_the_size_asked(triangles in 1_000usize..40_000) {
            let statue = statue(triangles);
            let count = statue.triangles().len();
            check(&statue, count, count / 2, 0, 0);
            prop_assert!(count <= triangles);
            if triangles >= 10_000 {
                prop_assert!(count as f64 > 0.99 * triangles as f64);
            }
            prop_assert!(sextuple_volume(&statue) > 0.0);
        }
    }

    #[test]
    fn surfaces_and_volumes_are_those_of_the_solids() {
        assert!((plane(7).statistics().surface_area - 1.0).abs() < 1e-6);
        assert!((cube(5).statistics().surface_area - 6.0).abs() < 1e-6);
        assert!((sextuple_volume(&cube(5)) - 6.0).abs() < 1e-6);
        let pi = std::f64::consts::PI;
        assert!((sextuple_volume(&sphere(64)) / (8.0 * pi) - 1.0).abs() < 1e-3);
        assert!((sextuple_volume(&torus(200, 200)) / (12.0 * pi * pi * 0.16) - 1.0).abs() < 1e-3);
        for position in sphere(9).positions() {
            assert!((position.iter().map(|x| x * x).sum::<f32>().sqrt() - 1.0).abs() < 1e-6);
        }
    }

    #[test]
    fn the_lattice_numbers_its_points_in_their_order() {
        for n in 1..7 {
            let lattice = Lattice { n };
            assert!(lattice.points().map(|point| lattice.index(point)).eq(0..6 * n * n + 2));
        }
    }

    #[test]
    fn a_height_field_is_the_graph_of_its_function() {
        let field = height_field(10, |x, y| x * 2.0 - y).unwrap();
        assert_eq!(field.triangles(), plane(10).triangles());
        assert!(field.positions().iter().all(|&[x, y, z]| z == x * 2.0 - y));
        let error = height_field(2, |x, _| if x == 1.0 { f32::NAN } else { 0.0 }).unwrap_err();
        assert_eq!(error, MeshError::NotFinite { what: "position", vertex: 2 });
    }

    #[test]
    fn threads_do_not_change_a_shape_and_a_seed_does() {
        let alone = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
        let three = rayon::ThreadPoolBuilder::new().num_threads(3).build().unwrap();
        let make = || (bumpy_sphere(30, 1), statue(30_000));
        assert_eq!(alone.install(make), three.install(make));
        assert_ne!(bumpy_sphere(3, 1), bumpy_sphere(3, 2));
    }

    #[test]
    fn sizes_out_of_range_are_held_to_it() {
        assert_eq!(plane(0), plane(1));
        assert_eq!(cube(0), cube(1));
        assert_eq!(torus(0, 1), torus(3, 3));
        assert_eq!(statue(0), statue(1_000));
    }

    #[test]
    fn noise_is_smooth_bounded_and_not_flat() {
        let mut largest = 0f32;
        for step in 0..20_000 {
            let position = [step as f32 * 0.013, 0.37 - step as f32 * 0.007, step as f32 * 0.003];
            let here = noise::gradient_noise(position, 5);
            let beside = noise::gradient_noise([position[0] + 1e-3, position[1], position[2]], 5);
            assert!((here - beside).abs() < 5e-3, "a jump at {position:?}");
            largest = largest.max(here.abs());
        }
        assert!((0.4..1.1).contains(&largest), "largest {largest}");
    }
}
