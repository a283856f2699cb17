//! How far normals and texture coordinates of one mesh are from those of another, over their surfaces.

use std::cell::Cell;

use decimesh::Mesh;
use parry3d::bounding_volume::Aabb;
use parry3d::glamx::Vec3;
use parry3d::math::Vector;
use parry3d::partitioning::{Bvh, BvhBuildStrategy, BvhNode};
use rayon::prelude::*;

/// Places as near as the nearest up to this share of the diagonal are as near: both sides of a seam.
const TIE: f32 = 1e-5;

/// Steps of the sequence that fills a square most evenly: powers of the inverse of the plastic number.
const STEPS: [f64; 2] = [0.754_877_666_246_693, 0.569_840_290_998_053_3];

/// RMS over the surface; `None` where a mesh has no such attribute.
#[derive(Debug, Clone, Copy)]
pub(crate) struct AttributeError {
    /// Length of the difference of two unit normals.
    pub(crate) normal: Option<f64>,
    /// Length of the difference, in texture coordinates.
    pub(crate) uv: Option<f64>,
}

/// The larger error of the two directions, each of `samples` points.
pub(crate) fn attribute_error(a: &Mesh, b: &[u32], samples: usize) -> AttributeError {
    let whole = Side::new(a, a.triangles().as_flattened());
    let part = Side::new(a, b);
    let [there, back] = [(&whole, &part), (&part, &whole)].map(|(from, to)| from.error(to, samples));
    let larger = |there: Option<f64>, back: Option<f64>| there.zip(back).map(|(there, back)| there.max(back));
    AttributeError { normal: larger(there.normal, back.normal), uv: larger(there.uv, back.uv) }
}

/// Triangles of a mesh, ready to be asked for the nearest place.
struct Side<'a> {
    mesh: &'a Mesh,
    triangles: &'a [[u32; 3]],
    tree: Bvh,
    tie: f32,
}

/// A place on a side.
#[derive(Clone, Copy)]
struct Place {
    triangle: u32,
    /// Weights of the corners.
    weights: [f32; 3],
}

impl<'a> Side<'a> {
    fn new(mesh: &'a Mesh, indices: &'a [u32]) -> Self {
        let triangles = indices.as_chunks::<3>().0;
        let boxes = triangles.iter().map(|corners| {
            let [a, b, c] = corners.map(|vertex| Vec3::from(mesh.positions()[vertex as usize]));
            Aabb::new(a.min(b).min(c), a.max(b).max(c))
        });
        let tree = Bvh::from_iter(BvhBuildStrategy::Binned, boxes.enumerate());
        let bounds = tree.root_aabb();
        let tie = TIE * (bounds.maxs - bounds.mins).length();
        Self { mesh, triangles, tree, tie }
    }

    fn corners(&self, triangle: u32) -> [Vec3; 3] {
        self.triangles[triangle as usize].map(|vertex| Vec3::from(self.mesh.positions()[vertex as usize]))
    }

    /// Twice the area, along the normal.
    fn normal(&self, triangle: u32) -> Vec3 {
        let [a, b, c] = self.corners(triangle);
        (b - a).cross(c - a)
    }

    fn point(&self, place: Place) -> Vec3 {
        let corners = self.corners(place.triangle);
        (0..3).map(|corner| corners[corner] * place.weights[corner]).sum()
    }

    /// The unit normal that a renderer would shade `place` with.
    fn shading_normal(&self, place: Place) -> Option<Vec3> {
        let normals = self.mesh.attributes().normals.as_ref()?;
        let corners = self.triangles[place.triangle as usize];
        let sum: Vec3 =
            (0..3).map(|corner| Vec3::from(normals[corners[corner] as usize]) * place.weights[corner]).sum();
        Some(sum.normalize_or_zero())
    }

    fn uv(&self, place: Place) -> Option<[f32; 2]> {
        let uvs = self.mesh.attributes().uvs.as_ref()?;
        let corners = self.triangles[place.triangle as usize];
        Some([0, 1].map(|axis| {
            (0..3).map(|corner| uvs[corners[corner] as usize][axis] * place.weights[corner]).sum()
        }))
    }

    /// `samples` places, spread evenly over the area.
    fn places(&self, samples: usize) -> Vec<Place> {
        let mut total = 0.0;
        let areas: Vec<f64> = (0..self.triangles.len() as u32)
            .map(|triangle| {
                total += f64::from(self.normal(triangle).length());
                total
            })
            .collect();
        let place = |sample: usize| {
            let area = (sample as f64 + 0.5) / samples as f64 * total;
            let triangle = areas.partition_point(|&sum| sum <= area).min(areas.len() - 1) as u32;
            let [across, along] = STEPS.map(|step| (0.5 + step * sample as f64).fract());
            let across = across.sqrt();
            let weights = [1.0 - across, across * (1.0 - along), across * along].map(|weight| weight as f32);
            Place { triangle, weights }
        };
        if total > 0.0 { (0..samples).map(place).collect() } else { Vec::new() }
    }

    /// RMS over places of this side of the difference to the nearest place of `other` that faces the same
    /// way, as leaves and curtains have two faces at one place. Of places as near, as on the sides of a
    /// seam, the one that agrees best counts, for each attribute.
    fn error(&self, other: &Side, samples: usize) -> AttributeError {
        let squares: Vec<[Option<f64>; 2]> = self
            .places(samples)
            .into_par_iter()
            .map(|place| {
                let matches = other.matches(self.point(place), self.normal(place.triangle), self.tie);
                let least = |difference: &dyn Fn(Place) -> Option<f32>| {
                    matches.iter().filter_map(|&there| difference(there)).reduce(f32::min).map(f64::from)
                };
                let normal = self.shading_normal(place);
                let uv = self.uv(place);
                [
                    least(&|there| Some(normal?.distance_squared(other.shading_normal(there)?))),
                    least(&|there| {
                        let (here, there) = (uv?, other.uv(there)?);
                        Some((here[0] - there[0]).powi(2) + (here[1] - there[1]).powi(2))
                    }),
                ]
            })
            .collect();
        let rms = |attribute: usize| {
            let squares: Vec<f64> = squares.iter().filter_map(|of_place| of_place[attribute]).collect();
            (!squares.is_empty()).then(|| (squares.iter().sum::<f64>() / squares.len() as f64).sqrt())
        };
        AttributeError { normal: rms(0), uv: rms(1) }
    }

    /// The nearest places that face as `normal` does; where there are none, that face anywhere.
    fn matches(&self, point: Vec3, normal: Vec3, tie: f32) -> Vec<Place> {
        let facing = |triangle| self.normal(triangle).dot(normal) > 0.0;
        let found = self.nearest(point, tie, facing);
        if found.is_empty() { self.nearest(point, tie, |_| true) } else { found }
    }

    fn nearest(&self, point: Vec3, tie: f32, counts: impl Fn(u32) -> bool) -> Vec<Place> {
        let best = Cell::new(f32::INFINITY);
        self.tree.find_best(
            f32::INFINITY,
            |node: &BvhNode, _| distance_to_box(point, node),
            |triangle, _| -> Option<f32> {
                let distance = counts(triangle).then(|| nearest_on(point, self.corners(triangle)).0)?;
                best.set(best.get().min(distance));
                Some(distance)
            },
        );
        if best.get() == f32::INFINITY {
            return Vec::new();
        }
        let reach = best.get() + tie;
        let around = Aabb::new(point - Vector::splat(reach), point + Vector::splat(reach));
        self.tree
            .intersect_aabb(&around)
            .filter(|&triangle| counts(triangle))
            .filter_map(|triangle| {
                let (distance, weights) = nearest_on(point, self.corners(triangle));
                (distance <= reach).then_some(Place { triangle, weights })
            })
            .collect()
    }
}

fn distance_to_box(point: Vec3, node: &BvhNode) -> f32 {
    (node.mins() - point).max(point - node.maxs()).max(Vec3::ZERO).length()
}

/// The distance to a triangle, and the weights of its corners at the nearest point. Regions of corners,
/// edges and face after Ericson, "Real-Time Collision Detection", 5.1.5.
fn nearest_on(point: Vec3, [a, b, c]: [Vec3; 3]) -> (f32, [f32; 3]) {
    let (ab, ac, ap) = (b - a, c - a, point - a);
    let (bp, cp) = (point - b, point - c);
    let (d1, d2, d3, d4, d5, d6) = (ab.dot(ap), ac.dot(ap), ab.dot(bp), ac.dot(bp), ab.dot(cp), ac.dot(cp));
    let (va, vb, vc) = (d3 * d6 - d5 * d4, d5 * d2 - d1 * d6, d1 * d4 - d3 * d2);
    let weights = if d1 <= 0.0 && d2 <= 0.0 {
        [1.0, 0.0, 0.0]
    } else if d3 >= 0.0 && d4 <= d3 {
        [0.0, 1.0, 0.0]
    } else if d6 >= 0.0 && d5 <= d6 {
        [0.0, 0.0, 1.0]
    } else if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        let along = d1 / (d1 - d3);
        [1.0 - along, along, 0.0]
    } else if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        let along = d2 / (d2 - d6);
        [1.0 - along, 0.0, along]
    } else if va <= 0.0 && d4 >= d3 && d5 >= d6 {
        let along = (d4 - d3) / ((d4 - d3) + (d5 - d6));
        [0.0, 1.0 - along, along]
    } else {
        [va, vb, vc].map(|weight| weight / (va + vb + vc))
    };
    let nearest = a * weights[0] + b * weights[1] + c * weights[2];
    (point.distance(nearest), weights)
}
